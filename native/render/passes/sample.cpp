// Where a sample is seen from, and what of it is lit from nearby.
#include "render/passes/sample.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace mesograin::render {

namespace {

// Instances are in a group with others of about their size.
constexpr double largest_of_typical = 2.0;

constexpr double golden_ratio = 0.6180339887498949;  // less 1

}  // namespace

glm::vec4 Sample::viewer(const glm::dvec3& origin) const {
  const glm::dmat4 camera_to_world = glm::inverse(camera.world_to_camera);
  // A perspective projection takes its w from depth; an orthographic one is affine and sees along one direction.
  const bool orthographic = camera.camera_to_clip[2][3] == 0.0;
  return orthographic ? glm::vec4(glm::normalize(glm::dvec3(camera_to_world[2])), 0.0)
                      : glm::vec4(glm::dvec3(camera_to_world[3]) - origin, 1.0);
}

bool Sample::lights_about(std::size_t unit) const {
  const DeviceMaterial& material = this->material(unit);
  const scene::ModelTraits traits = scene::traits_of(material.model());
  const bool inside = traits.mesh || traits.taps;
  if (!material.light_maps() && !inside) return false;
  if (const Draw* draw = content.draw(unit))
    return traits.near_lamps.empty() && lighting.nearness(draw->centre, 0.0, draw->reach, inside) > 0.0;
  const Instances& instances = *content.instances();
  const InstanceGroup& group = instances.groups()[unit];
  const Bounds& bounds = instances.bounds();
  return lighting.nearness(
             content.anchor() + 0.5 * (bounds.lower + bounds.upper), 0.5 * glm::distance(bounds.lower, bounds.upper),
             largest_of_typical * group.typical_scale * instances.prototypes()[group.prototype].mesh->reach(),
             inside) > 0.0;
}

bool Sample::gathers_all_of(std::size_t number) const { return gathers && exchange.gathers_all_of(number, traced); }

std::vector<bool> near_lamps(const Sample& sample) {
  if (!sample.lighting.any_local()) return {};
  // Evenly spread over the samples, and first of all in the middle: a single one shows what most of them do.
  const double turn = glm::fract(0.5 + golden_ratio * sample.index);
  std::vector<bool> near(sample.content.units(), false);
  for (std::size_t unit = 0; unit < near.size(); ++unit) {
    const Draw* draw = sample.content.draw(unit);
    near[unit] = draw != nullptr && !scene::traits_of(draw->look.model).near_lamps.empty() &&
                 turn < sample.lighting.nearness(draw->centre, 0.0, draw->reach, false);
  }
  return near;
}

}  // namespace mesograin::render
