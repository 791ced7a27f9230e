// Bounds and sizes of an instance.
#include "render/draw.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "models/prototype_inputs.h"

namespace mesograin::render {

Draw::Draw(DeviceCache& cache, const scene::Instance& from, std::size_t index)
    : instance(index),
      source(from.mesh),
      mesh(cache.mesh(from.mesh)),
      look(from.material),
      // The cube root takes a mirrored or stretched grain for the one of the same volume.
      size(std::max(
          from.mesh->equivalent_radius() * std::cbrt(std::abs(glm::determinant(glm::dmat3(from.object_to_world)))),
          1e-30)),
      object_to_world(from.object_to_world),
      convex(cache.convex(from.mesh)) {
  measure();
  settled = centre;
  if (scene::traits_of(from.material.model).mesh) {
    const models::TurnAndStretch parts = models::turn_and_stretch(glm::dmat3(from.object_to_world));
    grain_to_prototype = glm::transpose(parts.turn);
    material = cache.material(from.material, from.mesh, parts.stretch);
  } else {
    material = cache.material(from.material, size);
  }
  const scene::Material& medium = from.material;
  const glm::dvec3 reduced = medium.scale * (medium.sigma_a + (1.0 - medium.g) * medium.sigma_s);
  mean_free_paths_across = 2.0 * radius * std::max({reduced.r, reduced.g, reduced.b});
}

void Draw::measure() {
  const glm::dvec3 lower(source->lower());
  const glm::dvec3 upper(source->upper());
  const glm::dmat3 linear(object_to_world);
  const glm::dvec3 half = 0.5 * (upper - lower);
  centre = glm::dvec3(object_to_world * glm::dvec4(0.5 * (lower + upper), 1.0));
  radius = glm::length(
      glm::dvec3(glm::length(linear[0] * half.x), glm::length(linear[1] * half.y), glm::length(linear[2] * half.z)));
  const glm::dmat3 squared = glm::transpose(linear) * linear;
  double stretch_squared = 0.0;  // a bound, exact for rotations, scales and mirrors
  for (int row = 0; row < 3; ++row)
    stretch_squared =
        std::max(stretch_squared, std::abs(squared[0][row]) + std::abs(squared[1][row]) + std::abs(squared[2][row]));
  reach = source->reach() * std::sqrt(stretch_squared);
}

std::array<glm::vec4, 3> Draw::rows(const glm::dvec3& anchor) const {
  const glm::dvec3 place = centre - anchor;
  std::array<glm::vec4, 3> rows;
  for (int row = 0; row < 3; ++row)
    rows[static_cast<std::size_t>(row)] =
        glm::vec4(object_to_world[0][row], object_to_world[1][row], object_to_world[2][row], place[row]);
  return rows;
}

void Draw::place(const glm::dmat4& to_world) {
  object_to_world = to_world;
  measure();
  if (scene::traits_of(look.model).mesh)
    grain_to_prototype = glm::transpose(models::turn_and_stretch(glm::dmat3(to_world)).turn);
  if (light_maps && !light_maps->are_of(source, object_to_grain()))
    light_maps = std::make_unique<LightMaps>(source, object_to_grain());
}

glm::dmat4 Draw::object_to_grain() const {
  glm::dmat4 matrix = object_to_world;
  matrix[3] -= glm::dvec4(centre, 0.0);
  return matrix;
}

double Draw::pixels_across(const scene::Camera& camera, int width, int height) const {
  const double largest = std::max(width, height);
  const glm::dvec4 from_camera = camera.world_to_camera * glm::dvec4(centre, 1.0);
  // w of a point at the centre's depth; a grain that the camera is inside of counts as filling the picture.
  const double w = camera.camera_to_clip[2][3] * from_camera.z + camera.camera_to_clip[3][3];
  if (w <= 0.0) return largest;
  const double half_image = radius / w;
  return std::min(largest, std::max(half_image * std::abs(camera.camera_to_clip[0][0]) * width,
                                    half_image * std::abs(camera.camera_to_clip[1][1]) * height));
}

const DeviceMaterial* Draw::near_lamps(DeviceCache& cache) const {
  const std::string_view model = scene::traits_of(look.model).near_lamps;
  if (model.empty()) return nullptr;
  if (!near_lamps_) {
    scene::Material other = look;
    other.model = scene::parse_choice<scene::Model>(model);
    near_lamps_ = cache.material(other, size);
  }
  return near_lamps_.get();
}

void Draw::take_light_maps(std::vector<Draw>& others) {
  if (!material->light_maps()) return;
  // Maps as fine as another material needed them would show this one as it was never drawn by itself.
  const auto least = [](const Draw& draw) { return light_map_resolution(0.0, draw.mean_free_paths_across); };
  for (Draw& other : others)
    if (other.light_maps && other.light_maps->are_of(source, object_to_grain()) && least(other) == least(*this)) {
      light_maps = std::move(other.light_maps);
      return;
    }
  light_maps = std::make_unique<LightMaps>(source, object_to_grain());
}

}  // namespace mesograin::render
