// The lights of a view: what of them one sample sees.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "gl/texture.h"
#include "lights/device_light.h"
#include "lights/world_light.h"
#include "render/shadow_maps.h"
#include "render/world_directions.h"
#include "scene/scene.h"

namespace mesograin::render {

/// One direction that light comes from.
struct LightDirection {
  glm::dvec3 to_light;    ///< unit length
  glm::dvec3 irradiance;  ///< linear RGB, on a plane that faces it
  double angle;           ///< edge to edge, of what it is drawn from
  double density = 0.0;   ///< if of the world: of all its directions in the sample, per steradian
};

/// What one sample sees of the lights: a direction of each that is endlessly far, and a point of each that has a place.
struct SampledLights {
  std::vector<LightDirection> distant;
  std::vector<glm::dvec2> randoms;  ///< of each light that has a place, in their order
  double world_density = 0.0;       ///< as lights::WorldLight::density, of all directions of the world together
};

class Lighting {
 public:
  /// Takes the lights and the world of a scene.
  void set(const scene::Scene& scene);

  const scene::World& world() const { return world_; }

  /// The first of what at() and sample() tell, in that order.
  const std::vector<scene::DirectionalLight>& suns() const { return suns_; }

  /// Null unless the world is an image.
  const gl::Texture* world_image() const { return world_image_ ? &*world_image_ : nullptr; }

  /// The same of the world's backdrop.
  const gl::Texture* backdrop_image() const { return backdrop_image_ ? &*backdrop_image_ : nullptr; }

  /// Whether any light has a place.
  bool any_local() const { return !local_.empty(); }

  /// How near any of them is to one of some grains, no larger than `radius`, whose middles are as far as `within` from
  /// `middle` at most, 0 to 1: shaders/lights/near.glsl. `inside`: their model knows the grain inside.
  double nearness(const glm::dvec3& middle, double within, double radius, bool inside) const;

  /// Whether a surface of this radiance, within a ball, is an area light as well: its light on others is the light's.
  bool is_light(const glm::dvec3& middle, double radius, const glm::dvec3& radiance) const;

  /// `world_directions`: of how many directions the world's light is the mean.
  SampledLights sample(std::uint32_t index, std::uint32_t seed, int world_directions);

  /// Everything that comes to one place, the distant ones first.
  std::vector<LightDirection> at(const SampledLights& sampled, const glm::dvec3& place) const;

  /// Where the shadows of each are seen from, in the order of at(), from the anchor.
  std::vector<ShadowEye> eyes(const SampledLights& sampled, const glm::dvec3& anchor) const;

  /// The lights that have a place, from `origin`.
  std::vector<lights::DeviceLight> local(const glm::dvec3& origin) const;

  /// The same as shaders/lights/light.glsl has them.
  std::vector<std::array<glm::vec4, 5>> device_local(const glm::dvec3& origin) const;

 private:
  std::vector<scene::DirectionalLight> suns_;
  std::vector<scene::Light> local_;
  scene::World world_;
  std::optional<lights::WorldLight> world_light_;  // if it shines
  std::optional<WorldDirections> world_directions_;
  std::optional<gl::Texture> world_image_;
  std::optional<gl::Texture> backdrop_image_;
};

}  // namespace mesograin::render
