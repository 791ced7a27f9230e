// Tells each model's program what it is to shade, and has it do so.
#include "render/passes/shade_pass.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "render/device_layout.h"
#include "render/stencil.h"

namespace mesograin::render {
namespace {

// around: a scene::World or scene::Backdrop; image: its own, if it has one.
template <typename Around>
void set_around(const gl::Program& program, const Around& around, const gl::Texture* image) {
  program.set("world_radiance", glm::vec3(around.radiance));
  program.set("has_image", static_cast<int>(image != nullptr));
  program.set("world_to_image", glm::mat3(around.world_to_image));
  if (image != nullptr) program.set("world_image", *image);
}

void set_world(const gl::Program& program, const Lighting& lighting) {
  set_around(program, lighting.world(), lighting.world_image());
}

bool shows_backdrop(const Lighting& lighting) { return lighting.world().seen && lighting.world().backdrop; }

// Behind everything.
void set_seen_world(const gl::Program& program, const Lighting& lighting) {
  if (shows_backdrop(lighting))
    set_around(program, *lighting.world().backdrop, lighting.backdrop_image());
  else
    set_world(program, lighting);
}

// Through a grain that does not refract.
void offer_backdrop(const gl::Program& program, const Lighting& lighting) {
  if (!shows_backdrop(lighting)) return;
  const gl::Texture* image = lighting.backdrop_image();
  program.offer("backdrop_radiance", glm::vec3(lighting.world().backdrop->radiance));
  program.offer("backdrop_has_image", static_cast<int>(image != nullptr));
  program.offer("world_to_backdrop", glm::mat3(lighting.world().backdrop->world_to_image));
  if (image != nullptr) program.offer("backdrop_image", *image);
}

void confine_to(const PixelBox& box) {
  glScissor(box.first.x, box.first.y, box.end.x - box.first.x, box.end.y - box.first.y);
}

// What a single draw's bounds cover; everything if they reach behind the camera, and for a group of instances.
PixelBox box_of(const Sample& sample, std::size_t unit) {
  const PixelBox everything{glm::ivec2(0), sample.size};
  if (sample.content.draw(unit) == nullptr) return everything;
  const Draw& draw = *sample.content.draw(unit);
  const glm::dmat4 to_clip = sample.camera.camera_to_clip * (sample.camera.world_to_camera * draw.object_to_world);
  const glm::dvec2 size(sample.size);
  glm::dvec2 lower = size;
  glm::dvec2 upper(0.0);
  for (unsigned corner = 0; corner < 8; ++corner) {
    const glm::bvec3 high((corner & 1U) != 0, (corner & 2U) != 0, (corner & 4U) != 0);
    const glm::dvec4 clip =
        to_clip * glm::dvec4(glm::mix(glm::dvec3(draw.source->lower()), glm::dvec3(draw.source->upper()), high), 1.0);
    if (!(clip.w > 0.0)) return everything;
    const glm::dvec2 pixel = (0.5 * glm::dvec2(clip) / clip.w + 0.5) * size;
    lower = glm::min(lower, pixel);
    upper = glm::max(upper, pixel);
  }
  // The jitter moves the picture by up to half a pixel.
  const glm::ivec2 first(glm::clamp(glm::floor(lower - 1.0), glm::dvec2(0.0), size));
  const glm::ivec2 end(glm::clamp(glm::ceil(upper + 1.0), glm::dvec2(0.0), size));
  return {first, glm::max(first, end)};
}

// About as many as show it, or texels if it is baked.
double pixels_of(const Sample& sample, const Draw& draw) {
  if (sample.unwrapping != nullptr) return static_cast<double>(sample.size.x) * sample.size.y;
  const double across = draw.pixels_across(sample.camera, sample.size.x, sample.size.y);
  return across * across;
}

void begin_shading() {
  glEnable(GL_STENCIL_TEST);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glEnable(GL_SCISSOR_TEST);
  glFrontFace(GL_CCW);
}

void end_shading() {
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
}

}  // namespace

ShadePass::ShadePass()
    : background_program_("background", gl::ShaderSource({"passes/full_screen.vert"}, {}),
                          gl::ShaderSource({"passes/background.frag"}, {})) {}

void ShadePass::clear(const Sample& sample) {
  sample.targets.shade.bind();
  glDisable(GL_BLEND);
  if (sample.unwrapping != nullptr) {
    sample.targets.shade.clear();
    return;
  }
  sample.targets.shade.clear_colour();
  if (sample.mirrors == Mirrors::hindered) sample.targets.mirror->shade.clear_colour();
  if (sample.lighting.world().seen && sample.portion.value_or(Portion::environment) == Portion::environment)
    draw_background(sample);
}

void ShadePass::draw_background(const Sample& sample) {
  glDisable(GL_DEPTH_TEST);
  background_program_.use();
  const glm::dmat4 world_to_clip = sample.camera.camera_to_clip * glm::dmat4(glm::dmat3(sample.camera.world_to_camera));
  background_program_.set("clip_to_world", glm::mat4(glm::inverse(world_to_clip)));
  background_program_.set("jitter", sample.jitter);
  background_program_.set("size", glm::vec2(sample.size));
  set_seen_world(background_program_, sample.lighting);
  full_screen_.draw();
}

bool ShadePass::shade_seen(const Sample& sample, const ShadowPass& shadows, const GatherPass& gathered,
                           std::size_t first) {
  begin_shading();
  glDisable(GL_BLEND);
  const bool whole = shade_seen_units(sample, shadows, gathered, first);
  end_shading();
  return whole;
}

bool ShadePass::shade_seen_units(const Sample& sample, const ShadowPass& shadows, const GatherPass& gathered,
                                 std::size_t first) {
  for (std::size_t unit = first; unit < std::min(first + most_in_stencil, sample.content.units()); ++unit) {
    if (sample.gathers_all_of(sample.content.first_number(unit)) && sample.portion != Portion::normal) {
      show_gathered(sample, gathered, unit, stencil_mark(unit, first));
      continue;
    }
    const DeviceMaterial& material = sample.material(unit);
    const bool looks_on = sample.mirrors == Mirrors::hindered && sample.portion != Portion::normal;
    const bool sees_behind = looks_on && !sample.exchange.tells_straight() && sample.content.shows_behind(unit);
    const gl::Program& program =
        prepare(sample, unit,
                {.instanced = sample.content.draw(unit) == nullptr,
                 .shadows = sample.portion == Portion::normal ? Shadows::none : shadows.kind(sample.content, material),
                 .gathered = gathered.ran() && sample.exchange.any(),
                 .sees_behind = sees_behind,
                 .mirrors_world = sample.mirrors != Mirrors::none && sample.portion != Portion::normal,
                 .mirrors_hindered = looks_on,
                 .portion = sample.portion});
    shadows.bind(program, material);
    gathered.bind(program);
    (looks_on && (material.facets() || sees_behind) ? sample.targets.mirror->shade : sample.targets.shade).bind();
    if (!shade_unit(sample, program, unit, stencil_mark(unit, first), box_of(sample, unit))) return false;
  }
  return true;
}

void ShadePass::show_gathered(const Sample& sample, const GatherPass& gathered, std::size_t unit, int mark) {
  const gl::Program& program = sample.cache.gathered_program(sample.portion);
  program.use();
  gathered.bind(program);
  sample.targets.shade.bind();
  confine_to(box_of(sample, unit));
  glStencilFunc(GL_EQUAL, mark, most_in_stencil);
  full_screen_.draw();
}

bool ShadePass::shade_mirrored(const Sample& sample, const ShadowPass& shadows, const MirroredBy& by,
                               const std::vector<PixelBox>& boxes, std::size_t first) {
  begin_shading();
  glDisable(GL_DEPTH_TEST);
  glBlendFunc(GL_ONE, GL_ONE);
  const bool whole = shade_mirrored_units(sample, shadows, by, boxes, first);
  glDisable(GL_BLEND);
  end_shading();
  return whole;
}

bool ShadePass::shade_mirrored_units(const Sample& sample, const ShadowPass& shadows, const MirroredBy& by,
                                     const std::vector<PixelBox>& boxes, std::size_t first) {
  sample.content.complete(sample.cache, [&](std::size_t unit) {
    const bool shown = unit < boxes.size() && boxes[unit].first != boxes[unit].end;
    return shown ? &sample.material(unit) : nullptr;
  });
  for (std::size_t unit = first; unit < std::min(first + most_in_stencil, boxes.size()); ++unit) {
    const PixelBox& box = boxes[unit];
    if (box.first == box.end) continue;
    const DeviceMaterial& material = sample.material(unit);
    const bool goes_on = by.onwards != nullptr && sample.content.shows_behind(unit);
    const gl::Program& program = prepare(sample, unit,
                                         {.instanced = sample.content.draw(unit) == nullptr,
                                          .mirrored = true,
                                          .shadows = shadows.kind_mirrored(sample.content, material),
                                          .sees_behind = goes_on});
    shadows.bind_mirrored(program, material);
    program.set("mirror_looks", by.through.looks);
    program.set("mirror_passes", by.through.passed);
    (goes_on ? by.onwards->shade : sample.targets.shade).bind();
    glDisable(GL_BLEND);
    glEnablei(GL_BLEND, 0);  // the rest of what it draws tells of it alone
    if (!shade_unit(sample, program, unit, stencil_mark(unit, first), box)) return false;
  }
  return true;
}

bool ShadePass::shade_unit(const Sample& sample, const gl::Program& program, std::size_t unit, int mark,
                           const PixelBox& box) {
  if (const Draw* draw = sample.content.draw(unit))
    set_draw(sample, program, *draw);
  else
    set_group(sample, program, unit);
  program.set("surface_position", sample.targets.position);
  program.set("surface_normal", sample.targets.normal);
  if (sample.targets.coordinates) program.offer("surface_coordinates", *sample.targets.coordinates);
  glStencilFunc(GL_EQUAL, mark, most_in_stencil);
  return draw_in_strips(sample, box);
}

bool ShadePass::draw_in_strips(const Sample& sample, const PixelBox& box) {
  const glm::dvec2 size(box.end - box.first);
  const int rows =
      static_cast<int>(std::clamp(sample.pixels_at_once / std::max(size.x, 1.0), 1.0, std::max(size.y, 1.0)));
  for (PixelBox strip = box; strip.first.y < box.end.y; strip.first.y += rows) {
    strip.end.y = std::min(strip.first.y + rows, box.end.y);
    confine_to(strip);
    full_screen_.draw();
    unfinished_ += size.x * rows;
    if (unfinished_ < sample.pixels_at_once) continue;
    // A device that is only told goes on to the end, whatever the answer.
    glFinish();
    unfinished_ = 0.0;
    if (!sample.go_on()) return false;
  }
  return true;
}

void ShadePass::shade_unwrapped(const Sample& sample, const ShadowPass& shadows) {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  for (const std::size_t baked : sample.unwrapping->draws) {
    const Draw& draw = sample.content.draws()[baked];
    const std::size_t unit = sample.content.unit(baked);
    const DeviceMaterial& material = sample.material(unit);
    const gl::Program& program =
        prepare(sample, unit, {.unwrapped = true, .shadows = shadows.kind(sample.content, material)});
    shadows.bind(program, material);
    set_draw(sample, program, draw);
    const glm::dmat4 object_to_grain = draw.object_to_grain();
    program.set("jitter", sample.jitter);
    program.set("from_camera", static_cast<int>(sample.unwrapping->view_from == ViewFrom::active_camera));
    program.set("instance", static_cast<int>(sample.content.number(baked)));
    program.set("object_to_grain", glm::mat4(object_to_grain));
    program.set("normal_to_grain", glm::mat3(glm::transpose(glm::inverse(glm::dmat3(object_to_grain)))));
    draw.mesh->draw();
  }
  glDisable(GL_DEPTH_TEST);
}

const gl::Program& ShadePass::prepare(const Sample& sample, std::size_t unit, Shading shading) {
  const DeviceMaterial& material = sample.material(unit);
  const bool world = sample.lighting.world().shines();
  // Stored transport knows what parts of its grain send each other.
  const bool knows = sample.exchange.any() && scene::traits_of(material.model()).mesh &&
                     sample.exchange.roles()[sample.content.first_number(unit)].hollow;
  shading.exchange = sample.exchange.any() && !knows;
  shading.told = sample.tells(unit);
  shading.world = world;
  shading.alone = sample.content.alone();
  shading.backdrop = shows_backdrop(sample.lighting);
  shading.film_transparent = sample.lighting.world().film_transparent;
  shading.lights_at_place = sample.lights_at_place(material, shading.instanced);
  shading.near_lights = sample.lighting.any_local() && material.light_maps();
  shading.lights_about = sample.lights_about(unit);
  const Draw* draw = sample.content.draw(unit);
  const std::size_t number = draw == nullptr ? 0 : static_cast<std::size_t>(draw - sample.content.draws().data());
  const double pixels = draw == nullptr ? 0.0 : pixels_of(sample, *draw);
  // Few pixels mirror a draw: sums pay there if they are at hand, of the only draw, which was shaded by them.
  shading.summed = draw != nullptr && (!shading.mirrored || shading.alone) && !sample.lighting.any_local() &&
                   ProductSums::pay(material, sample.lights.distant, pixels);
  shading.together = shading.summed && shading.shadows == Shadows::none &&
                     ProductSums::can_be_together(material, sample.lights.distant.size());
  const bool stored = draw != nullptr && scene::traits_of(material.model()).mesh && sample.stored_lights.any(number);
  if (shading.summed) {
    const int lines = LightLines::across(material, sample.lights.distant, pixels);
    shading.light_lines = lines > 0;
    sums_.sum(sample, *draw, stored ? std::optional(number) : std::nullopt, lines, shading.together);
  }
  shading.stored_lights = stored && !shading.summed;
  shading.stored_lamps = shading.stored_lights && sample.stored_lights.any_lamps(number);
  const gl::Program& program = sample.cache.shading(material, shading);
  material.bind(program);
  if (shading.summed) sums_.bind(program);
  if (shading.stored_lights) sample.stored_lights.bind(program, number, material, draw->grain_to_prototype);
  if (world || shading.mirrors_world) {
    set_world(program, sample.lighting);
    program.set("world_density", static_cast<float>(sample.lights.world_density));
    program.offer("world_directions",
                  static_cast<int>(std::ranges::count_if(
                      sample.lights.distant, [](const LightDirection& light) { return light.density > 0.0; })));
  }
  offer_backdrop(program, sample.lighting);
  program.offer("sample_index", static_cast<int>(sample.index));
  program.offer("taps", taps_);
  if (sample.exchange.any()) sample.exchange.bind();
  return program;
}

void ShadePass::set_draw(const Sample& sample, const gl::Program& program, const Draw& draw) {
  const Content& content = sample.content;
  const bool at_place = sample.lights_at_place(*draw.material, false);
  set_lights(sample, program, at_place ? sample.lights.distant : sample.lighting.at(sample.lights, draw.centre),
             draw.centre);
  // Another view may have taken in what the material has become since, and this one not yet.
  if (draw.light_maps && draw.material->light_maps()) draw.light_maps->bind(program);
  program.offer("grain_reach", static_cast<float>(draw.reach));
  program.offer("grain_to_prototype", glm::mat3(draw.grain_to_prototype));
  program.offer("place_of_grain", glm::vec3(draw.centre - content.anchor()));
  program.offer("to_settled", glm::vec3(draw.settled - draw.centre));
  program.offer("object_number",
                static_cast<int>(content.object_number(static_cast<std::size_t>(&draw - content.draws().data()))));
  program.offer("shades_itself", static_cast<int>(content.shades_itself(draw)));
  if (draw.material->textured()) program.set("grain_to_mesh", glm::mat4(glm::inverse(draw.object_to_grain())));
  program.set("viewer", sample.viewer(draw.centre));
}

void ShadePass::set_group(const Sample& sample, const gl::Program& program, std::size_t unit) {
  const InstanceGroup& group = sample.content.instances()->groups()[unit];
  const glm::dvec3& anchor = sample.content.anchor();
  set_lights(sample, program, sample.lights.distant, anchor);
  const Instances& instances = *sample.content.instances();
  const Prototype& prototype = instances.prototypes()[group.prototype];
  instances.bind();
  if (sample.material(unit).light_maps()) prototype.light_maps->bind(program);
  program.offer("typical_scale", static_cast<float>(group.typical_scale));
  program.offer("unstretch", group.unstretch);
  program.offer("grain_reach", static_cast<float>(prototype.mesh->reach() * group.typical_scale));
  program.offer("shades_itself", static_cast<int>(instances.shades_itself(group)));
  program.offer("middle_of_mesh", 0.5F * (prototype.mesh->lower() + prototype.mesh->upper()));
  program.set("viewer", sample.viewer(anchor));
}

void ShadePass::set_lights(const Sample& sample, const gl::Program& program,
                           const std::vector<LightDirection>& directions, const glm::dvec3& origin) {
  std::vector<layout::DistantLight> device;
  device.reserve(directions.size());
  for (const LightDirection& light : directions)
    device.push_back({glm::vec4(light.to_light, light.angle), glm::vec4(light.irradiance, light.density)});
  directions_.emplace(device);
  directions_->bind_storage(layout::DISTANT_LIGHTS_BINDING);
  program.set("light_count", static_cast<int>(device.size()));
  if (!sample.lighting.any_local()) return;
  lights_.emplace(sample.lighting.device_local(origin));
  lights_->bind_storage(layout::LOCAL_LIGHTS_BINDING);
  const std::vector<glm::vec2> randoms(sample.lights.randoms.begin(), sample.lights.randoms.end());
  randoms_.emplace(randoms);
  randoms_->bind_storage(layout::LOCAL_RANDOMS_BINDING);
  program.offer("local_light_count", static_cast<int>(randoms.size()));
  program.offer("distant_light_count", static_cast<int>(sample.lights.distant.size()));
}

}  // namespace mesograin::render
