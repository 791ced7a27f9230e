// Orders what lamps do in grains, and sends it.
#include "render/stored_lamps.h"

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

// As many as the bits of a number tell, in shaders/models/stored_lamps.glsl.
constexpr std::size_t most_lights = 31;

double sum(const glm::dvec3& numbers) { return numbers.r + numbers.g + numbers.b; }

/// A lamp from the grain's middle, along the world's axes, as the prototype has it. Its colour does not matter.
transport::Lamp lamp_of(const lights::DeviceLight& light, const glm::dmat3& grain_to_prototype) {
  transport::Lamp lamp;
  for (const glm::dvec4& row : {light.place, light.axis, light.x, light.y})
    lamp.about += fmt::format("{:.12g} {:.12g} {:.12g} {:.12g}\n", row.x, row.y, row.z, row.w);
  lamp.about += fmt::format("{:.12g}\n", light.emission.w);
  for (int column = 0; column < 3; ++column)
    lamp.about += fmt::format("{:.12g} {:.12g} {:.12g}\n", grain_to_prototype[column].x, grain_to_prototype[column].y,
                              grain_to_prototype[column].z);
  lamp.at = [light, grain_to_prototype](const glm::dvec3& place, const glm::dvec2& random) {
    const lights::LightDraw drawn = lights::draw_light(light, glm::transpose(grain_to_prototype) * place, random);
    return transport::LampRay{grain_to_prototype * drawn.to_light,
                              sum(drawn.irradiance) / sum(glm::dvec3(light.emission)), drawn.reach};
  };
  return lamp;
}

/// Whether a lamp is so near that it is another for each place of a grain.
bool is_near(const lights::DeviceLight& light, double radius) {
  return lights::radii_away(light, glm::dvec3(0.0), 0.0, radius) < farthest ||
         lights::edge_across(light, glm::dvec3(0.0), 0.0, radius) > 0.0;
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
    for (std::size_t i = 0; i < stored->sources.size(); ++i)
      all.push_back(stored->sources[i] * stored->lobes[i % channels]);
  }
  return all;
}

}  // namespace

void StoredLamps::set(const Content& content, const Lighting& lighting) {
  const std::vector<OfDraw> before = std::exchange(draws_, std::vector<OfDraw>(content.draws().size()));
  for (std::size_t i = 0; i < draws_.size(); ++i) {
    const Draw& draw = content.draws()[i];
    if (!scene::traits_of(draw.look.model).mesh || !models::stores_lamps(draw.look)) continue;
    const std::vector<lights::DeviceLight> lights = lighting.local(draw.centre);
    for (std::size_t light = 0; light < std::min(lights.size(), most_lights); ++light) {
      if (!is_near(lights[light], draw.reach) || !(sum(glm::dvec3(lights[light].emission)) > 0.0)) continue;
      const glm::dmat3 stretch = models::turn_and_stretch(glm::dmat3(draw.object_to_world)).stretch;
      transport::Order order = models::transport_order(draw.look, draw.source, stretch);
      order.lamp = std::make_shared<const transport::Lamp>(lamp_of(lights[light], draw.grain_to_prototype));
      std::shared_ptr<const transport::Computation> computation = ask(order, before);
      draws_[i].lamps.push_back({light, std::move(order), std::move(computation)});
    }
  }
  take_news();
}

std::shared_ptr<const transport::Computation> StoredLamps::ask(const transport::Order& order,
                                                               const std::vector<OfDraw>& before) const {
  for (const std::vector<OfDraw>* draws : {&before, &draws_})
    for (const OfDraw& of : *draws)
      for (const Lamp& lamp : of.lamps)
        if (same(lamp.order, order)) return lamp.computation;
  return transport::Works::instance().ask(order);
}

std::vector<std::shared_ptr<const transport::Computation>> StoredLamps::computations() const {
  std::vector<std::shared_ptr<const transport::Computation>> all;
  for (const OfDraw& of : draws_)
    for (const Lamp& lamp : of.lamps)
      if (std::ranges::find(all, lamp.computation) == all.end()) all.push_back(lamp.computation);
  return all;
}

bool StoredLamps::take_news() {
  bool any = false;
  for (OfDraw& of : draws_) any = take_news(of) || any;
  return any;
}

bool StoredLamps::take_news(OfDraw& of) {
  std::vector<std::shared_ptr<const transport::StoredTransport>> known;
  known.reserve(of.lamps.size());
  for (const Lamp& lamp : of.lamps) known.push_back(lamp.computation->news().stored);
  if (known == of.known) return false;
  of.known = std::move(known);
  of.stored = 0;
  int blocks = 0;
  const transport::StoredTransport* first = nullptr;
  for (std::size_t i = 0; i < of.lamps.size(); ++i) {
    if (!of.known[i]) continue;
    first = of.known[i].get();
    of.stored |= 1 << of.lamps[i].light;
    ++blocks;
  }
  of.sources.reset();
  if (first == nullptr) return false;
  of.sources.emplace(first->channels == 1 ? GL_R32F : GL_RGB32F, first->size.x, first->size.y, first->size.z * blocks);
  of.sources->upload(first->channels == 1 ? GL_RED : GL_RGB, texels(of.known).data());
  return true;
}

// What is told coarsely so far, or by another model, has other nodes.
void StoredLamps::bind(const gl::Program& program, std::size_t draw, const DeviceMaterial& material) const {
  const OfDraw& of = draws_[draw];
  const auto first = std::ranges::find_if(of.known, [](const auto& stored) { return stored != nullptr; });
  const models::UniformValue* last = material.uniform("stored.last_node");
  const bool fits =
      first != of.known.end() && last != nullptr && std::get<glm::vec3>(*last) == glm::vec3((*first)->size - 1);
  program.set("stored_lamps", fits ? of.stored : 0);
  if (of.sources) program.set("lamp_sources", *of.sources);
}

}  // namespace mesograin::render
