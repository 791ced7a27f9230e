// Packs each kind of light; what is constant for a light is computed here, in double, once.
#include "lights/device_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <variant>

namespace mesograin::lights {
namespace {

/// Of a spread; what is narrower is drawn as this, as Cycles does against noise.
constexpr double least_half_spread = PI / 360.0;

/// Of a spot's edge, in cosines; a sharper one is drawn as this.
constexpr double least_edge = 1e-7;

double one_minus_cosine(double half_angle) {
  const double sine = std::sin(0.5 * half_angle);
  return 2.0 * sine * sine;
}

/// Any vector across a unit one, of unit length.
glm::dvec3 across(const glm::dvec3& axis) {
  return glm::normalize(
      glm::cross(axis, std::abs(axis.x) < 0.5 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0)));
}

class Packer {
 public:
  explicit Packer(const glm::dvec3& origin) : origin_(origin) {}

  DeviceLight operator()(const scene::DirectionalLight& sun) const {
    DeviceLight light{};
    light.place = {glm::normalize(sun.direction_to_light), LIGHT_SUN};
    light.emission = {sun.irradiance, one_minus_cosine(0.5 * sun.angle)};
    light.y.w = sun.flat ? 1.0 : 0.0;
    return light;
  }

  DeviceLight operator()(const scene::PointLight& point) const {
    return ball(point.position, point.radiant_intensity, point.radius, point.shape, LIGHT_POINT);
  }

  DeviceLight operator()(const scene::SpotLight& spot) const {
    DeviceLight light = ball(spot.position, spot.radiant_intensity, spot.radius, spot.shape, LIGHT_SPOT);
    const glm::dvec3 axis = glm::normalize(spot.axis);
    glm::dvec3 narrow_x = across(axis);
    glm::dvec3 narrow_y = glm::cross(axis, narrow_x);
    if (spot.wide_x != glm::dvec3(0.0)) {
      narrow_x = spot.wide_x / glm::dot(spot.wide_x, spot.wide_x);
      narrow_y = spot.wide_y / glm::dot(spot.wide_y, spot.wide_y);
    }
    const double rise = one_minus_cosine(0.5 * spot.angle);
    light.axis = {axis, 1.0 - rise};
    light.x = {narrow_x, 1.0 / std::max(rise * spot.blend, least_edge)};
    light.y = {narrow_y, light.y.w + (spot.cosine ? 2.0 : 0.0)};
    return light;
  }

  DeviceLight operator()(const scene::AreaLight& area) const {
    const glm::dvec3 normal = glm::cross(area.half_x, area.half_y);
    const double half_spread = std::max(0.5 * area.spread, least_half_spread);
    // tan(pi / 2) is no number to divide by.
    const double inverse_tangent = std::max(std::cos(half_spread), 0.0) / std::sin(half_spread);
    DeviceLight light{};
    light.place = {area.position - origin_, LIGHT_AREA};
    light.emission = {area.radiance, inverse_tangent};
    light.axis = {-glm::normalize(normal), 1.0 / (1.0 - half_spread * inverse_tangent)};
    light.x = {area.half_x, (area.ellipse ? PI : 4.0) * glm::length(normal)};
    light.y = {area.half_y, area.ellipse ? 1.0 : 0.0};
    return light;
  }

 private:
  DeviceLight ball(const glm::dvec3& position, const glm::dvec3& intensity, double radius, scene::LightShape shape,
                   int kind) const {
    DeviceLight light{};
    light.place = {position - origin_, kind};
    light.emission = {intensity, radius};
    light.y.w = shape == scene::LightShape::disc ? 1.0 : 0.0;
    return light;
  }

  glm::dvec3 origin_;
};

}  // namespace

DeviceLight pack(const scene::Light& light, const glm::dvec3& origin) { return std::visit(Packer(origin), light); }

std::array<glm::vec4, 5> to_device(const DeviceLight& light) {
  return {glm::vec4(light.place), glm::vec4(light.emission), glm::vec4(light.axis), glm::vec4(light.x),
          glm::vec4(light.y)};
}

LightDraw sample(const scene::Light& light, const glm::dvec3& place, const glm::dvec2& random) {
  return draw_light(pack(light, place), glm::dvec3(0.0), random);
}

}  // namespace mesograin::lights
