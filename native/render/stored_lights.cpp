// Orders what lights do in grains, and sends it.
#include "render/stored_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/matrix.hpp>
#include <utility>
#include <variant>

#include "lights/device_light.h"
#include "models/prototype_inputs.h"

namespace mesograin::render {
namespace {

// Radii to a grain's middle from which on a lamp is a parallel light: it differs by a twentieth from one side of the
// grain to the other.
constexpr double farthest = 40.0;

// As many as the bits of a number tell, in shaders/models/stored_lights.glsl.
constexpr std::size_t most_lights = 31;

// Suns over grains, each over each. Where there are more none is found by itself, for that would take longer than all
// else that is awaited.
constexpr std::size_t most_suns = 16;

double sum(const glm::dvec3& numbers) { return numbers.r + numbers.g + numbers.b; }

/// Lines that tell a turn from all others.
std::string about_turn(const glm::dmat3& grain_to_prototype) {
  std::string about;
  for (int column = 0; column < 3; ++column)
    about += fmt::format("{:.12g} {:.12g} {:.12g}\n", grain_to_prototype[column].x, grain_to_prototype[column].y,
                         grain_to_prototype[column].z);
  return about;
}

/// A lamp from the grain's middle, along the world's axes, as the prototype has it. Its colour does not matter.
transport::Lamp lamp_of(const lights::DeviceLight& light, const glm::dmat3& grain_to_prototype) {
  transport::Lamp lamp;
  for (const glm::dvec4& row : {light.place, light.axis, light.x, light.y})
    lamp.about += fmt::format("{:.12g} {:.12g} {:.12g} {:.12g}\n", row.x, row.y, row.z, row.w);
  lamp.about += fmt::format("{:.12g}\n", light.emission.w) + about_turn(grain_to_prototype);
  lamp.at = [light, grain_to_prototype](const glm::dvec3& place, const glm::dvec2& random) {
    const lights::LightDraw drawn = lights::draw_light(light, glm::transpose(grain_to_prototype) * place, random);
    return transport::LampRay{grain_to_prototype * drawn.to_light,
                              sum(drawn.irradiance) / sum(glm::dvec3(light.emission)), drawn.reach};
  };
  return lamp;
}

/// A sun as the prototype has it, of irradiance 1.
transport::Lamp lamp_of(const scene::DirectionalLight& sun, const glm::dmat3& grain_to_prototype) {
  transport::Lamp lamp;
  const glm::dvec3& to_sun = sun.direction_to_light;
  lamp.about = fmt::format("sun {:.12g} {:.12g} {:.12g} {:.12g}{}\n", to_sun.x, to_sun.y, to_sun.z, sun.angle,
                           sun.flat ? " flat" : "") +
               about_turn(grain_to_prototype);
  lamp.at = [sun, grain_to_prototype](const glm::dvec3& place, const glm::dvec2& random) {
    const lights::LightDraw drawn = lights::sample(sun, place, random);
    return transport::LampRay{grain_to_prototype * drawn.to_light, 1.0, drawn.reach};
  };
  lamp.far = true;
  return lamp;
}

/// Whether a lamp is so near that it is another for each place of a grain.
bool is_near(const lights::DeviceLight& light, double radius) {
  return lights::radii_away(light, glm::dvec3(0.0), 0.0, radius) < farthest ||
         lights::edge_across(light, glm::dvec3(0.0), 0.0, radius) > 0.0;
}

/// Those that send any light, by their numbers.
std::vector<std::size_t> shining(const std::vector<scene::DirectionalLight>& suns) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < std::min(suns.size(), most_lights); ++i)
    if (sum(suns[i].irradiance) > 0.0) numbers.push_back(i);
  return numbers;
}

bool stores_lights(const Draw& draw) {
  return scene::traits_of(draw.look.model).mesh && models::stores_lights(draw.look);
}

bool same(const transport::Order& a, const transport::Order& b) {
  return a.mesh == b.mesh && a.stretch == b.stretch && a.medium == b.medium && a.lamp->about == b.lamp->about;
}

/// [block * nodes + node][channel], a block for each that is known.
std::vector<float> texels(const std::vector<std::shared_ptr<const transport::StoredTransport>>& known) {
  std::vector<float> all;
  for (const auto& stored : known) {
    if (!stored) continue;
    const auto channels = static_cast<std::size_t>(stored->channels);
    for (std::size_t node = 0; node < stored->nodes(); ++node)
      for (std::size_t channel = 0; channel < channels; ++channel)  // each has a term
        all.push_back(stored->sources[channel * stored->nodes() + node] *
                      stored->lobes[stored->lobe(channel, 0, channel)]);
  }
  return all;
}

}  // namespace

void StoredLights::set(const Content& content, const Lighting& lighting) {
  const std::vector<OfDraw> before = std::exchange(draws_, std::vector<OfDraw>(content.draws().size()));
  std::vector<std::size_t> suns = shining(lighting.suns());
  if (suns.size() * static_cast<std::size_t>(std::ranges::count_if(content.draws(), stores_lights)) > most_suns)
    suns.clear();
  for (std::size_t i = 0; i < draws_.size(); ++i) {
    const Draw& draw = content.draws()[i];
    if (!stores_lights(draw)) continue;
    OfDraw& of = draws_[i];
    of.grain_to_prototype = draw.grain_to_prototype;
    const glm::dmat3 stretch = models::turn_and_stretch(glm::dmat3(draw.object_to_world)).stretch;
    const auto add = [&](bool sun, std::size_t number, transport::Lamp lamp) {
      transport::Order order = models::transport_order(draw.look, draw.source, stretch);
      order.lamp = std::make_shared<const transport::Lamp>(std::move(lamp));
      std::shared_ptr<const transport::Computation> computation = ask(order, before);
      of.lights.push_back({sun, number, std::move(order), std::move(computation)});
    };
    const std::vector<lights::DeviceLight> lamps = lighting.local(draw.centre);
    for (std::size_t lamp = 0; lamp < std::min(lamps.size(), most_lights); ++lamp)
      if (is_near(lamps[lamp], draw.reach) && sum(glm::dvec3(lamps[lamp].emission)) > 0.0)
        add(false, lamp, lamp_of(lamps[lamp], draw.grain_to_prototype));
    for (const std::size_t sun : suns) add(true, sun, lamp_of(lighting.suns()[sun], draw.grain_to_prototype));
  }
  take_news();
}

bool StoredLights::any_lamps(std::size_t draw) const { return any(draw) && !draws_[draw].lights.front().sun; }

std::shared_ptr<const transport::Computation> StoredLights::ask(const transport::Order& order,
                                                                const std::vector<OfDraw>& before) const {
  for (const std::vector<OfDraw>* draws : {&before, &draws_})
    for (const OfDraw& of : *draws)
      for (const Light& light : of.lights)
        if (same(light.order, order)) return light.computation;
  return transport::Works::instance().ask(order);
}

std::vector<std::shared_ptr<const transport::Computation>> StoredLights::computations() const {
  std::vector<std::shared_ptr<const transport::Computation>> all;
  for (const OfDraw& of : draws_)
    for (const Light& light : of.lights)
      if (std::ranges::find(all, light.computation) == all.end()) all.push_back(light.computation);
  return all;
}

bool StoredLights::take_news() {
  bool any = false;
  for (OfDraw& of : draws_) any = take_news(of) || any;
  return any;
}

bool StoredLights::take_news(OfDraw& of) {
  std::vector<std::shared_ptr<const transport::StoredTransport>> known;
  known.reserve(of.lights.size());
  for (const Light& light : of.lights) known.push_back(light.computation->news().stored);
  if (known == of.known) return false;
  of.known = std::move(known);
  of.version = ++versions_;
  of.lamps = of.suns = 0;
  int blocks = 0;
  const transport::StoredTransport* first = nullptr;
  for (std::size_t i = 0; i < of.lights.size(); ++i) {
    if (!of.known[i]) continue;
    first = of.known[i].get();
    (of.lights[i].sun ? of.suns : of.lamps) |= 1 << of.lights[i].number;
    ++blocks;
  }
  of.sources.reset();
  if (first == nullptr) return false;
  of.sources.emplace(first->channels == 1 ? GL_R32F : GL_RGB32F, first->size.x, first->size.y, first->size.z * blocks);
  of.sources->upload(first->channels == 1 ? GL_RED : GL_RGB, texels(of.known).data());
  return true;
}

// What is told coarsely so far, or by another model, has other nodes.
void StoredLights::bind(const gl::Program& program, std::size_t draw, const DeviceMaterial& material,
                        const glm::dmat3& grain_to_prototype) const {
  const OfDraw& of = draws_[draw];
  const auto first = std::ranges::find_if(of.known, [](const auto& stored) { return stored != nullptr; });
  const models::UniformValue* last = material.uniform("stored.last_node");
  const bool fits =
      first != of.known.end() && last != nullptr && std::get<glm::vec3>(*last) == glm::vec3((*first)->size - 1);
  program.set("stored_lamps", fits ? of.lamps : 0);
  program.set("stored_suns", fits && grain_to_prototype == of.grain_to_prototype ? of.suns : 0);
  if (of.sources) program.set("light_sources", *of.sources);
}

}  // namespace mesograin::render
