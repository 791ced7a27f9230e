// Finds how fine the maps must be, and has them drawn.
#include "render/passes/light_map_pass.h"

#include <algorithm>

namespace mesograin::render {
namespace {

double pixels_across(const Sample& sample, const Draw& draw) {
  return sample.unwrapping != nullptr ? std::max(sample.size.x, sample.size.y)
                                      : draw.pixels_across(sample.camera, sample.size.x, sample.size.y);
}

std::vector<glm::dvec3> directions_of(const std::vector<LightDirection>& lights) {
  std::vector<glm::dvec3> to_light;
  to_light.reserve(lights.size());
  for (const LightDirection& light : lights) to_light.push_back(light.to_light);
  return to_light;
}

}  // namespace

bool LightMapPass::run(const Sample& sample, const ArrayVisibility& arrays) {
  maps_drawn_ = 0;
  const auto program = [&](bool tessellated) -> const gl::Program& {
    return sample.cache.light_map_program(tessellated);
  };
  // So that what was asked for is drawn before it is asked whether to go on.
  const auto drawn = [&](int maps) {
    maps_drawn_ += maps;
    if (maps > 0) glFinish();
    return sample.go_on();
  };
  const auto update = [&](std::size_t number) {
    Draw& draw = sample.content.draws()[number];
    if (!draw.light_maps || !sample.asks_model(sample.content.unit(number))) return true;
    const int resolution = light_map_resolution(pixels_across(sample, draw), draw.mean_free_paths_across);
    return drawn(draw.light_maps->update(*draw.mesh, program,
                                         directions_of(sample.lighting.at(sample.lights, draw.centre)), resolution));
  };
  if (sample.unwrapping != nullptr)
    return std::all_of(sample.unwrapping->draws.begin(), sample.unwrapping->draws.end(), update);
  for (std::size_t number = 0; number < sample.content.draws().size(); ++number)
    if (!update(number)) return false;

  Instances* instances = sample.content.instances();
  if (instances == nullptr) return true;
  const std::vector<glm::dvec3> to_light = directions_of(sample.lights.distant);
  for (std::size_t i = 0; i < instances->prototypes().size(); ++i) {
    Prototype& prototype = instances->prototypes()[i];
    if (!prototype.light_maps) continue;
    double mean_free_paths = 0.0;
    bool asked = false;
    for (std::size_t unit = 0; unit < instances->groups().size(); ++unit) {
      const InstanceGroup& group = instances->groups()[unit];
      if (group.prototype != i || !sample.asks_model(unit)) continue;
      asked = true;
      mean_free_paths = std::max(mean_free_paths, group.mean_free_paths_across);
    }
    if (!asked) continue;
    const double pixels_across = arrays.selection()->selection.largest_pixels_across;
    const int resolution = light_map_resolution(pixels_across, mean_free_paths);
    LightMapDirections directions = instances->light_directions(i, to_light);
    // A light amid the heap meets its grains from everywhere.
    if (sample.lighting.any_local()) directions.ask_for_all();
    // Where light between grains is being found, what is asked of models next may be nothing.
    prototype.light_maps->update(*prototype.details, prototype.details->level(pixels_across), program, directions,
                                 resolution, sample.exchange.awaits_more(), [&] { return drawn(1); });
    if (!sample.go_on()) return false;
  }
  return true;
}

}  // namespace mesograin::render
