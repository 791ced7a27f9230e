// Each kind of light by its own overload.
#include "light_source.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <variant>

#include "base/error.h"
#include "directions.h"
#include "view.h"

namespace mesograin::referee {
namespace {

constexpr double pi = std::numbers::pi;

glm::dvec3 in_disc(const glm::dvec3& axis, double radius, Rng& rng) {
  if (radius <= 0.0) return glm::dvec3(0.0);
  double square;
  const glm::dvec2 at = sample_disc(rng, square);
  glm::dvec3 first, second;
  frame(axis, first, second);
  return radius * (at.x * first + at.y * second);
}

/// A direction towards a ball, and the solid angle of all of them.
glm::dvec3 towards(const Target& to, const glm::dvec3& place, Rng& rng, double& solid_angle) {
  const glm::dvec3 way = to.middle - place;
  const double sine = to.radius / glm::length(way);
  const double cosine = sine < 1.0 ? std::sqrt(1.0 - sine * sine) : -1.0;
  solid_angle = 2.0 * pi * (1.0 - cosine);
  return sample_cone(glm::normalize(way), 1.0 - rng.uniform() * (1.0 - cosine), rng);
}

SentRay send(const scene::DirectionalLight& sun, const Target& to, double away, Rng& rng) {
  const glm::dvec3 to_light = sample_sun(sun, rng);
  const glm::dvec3 place = to.middle + in_disc(to_light, to.radius, rng) + away * to_light;
  return {place, -to_light, pi * to.radius * to.radius * sun.irradiance};
}

SeenPoint see(const scene::DirectionalLight& sun, const glm::dvec3& /*place*/, Rng& rng) {
  return {sample_sun(sun, rng), std::numeric_limits<double>::infinity(), sun.irradiance};
}

// A disc that faces whatever it lights.
SentRay send(const scene::PointLight& lamp, const Target& to, double /*away*/, Rng& rng) {
  double solid_angle;
  const glm::dvec3 direction = towards(to, lamp.position, rng, solid_angle);
  return {lamp.position + in_disc(direction, lamp.radius, rng), direction, solid_angle * lamp.radiant_intensity};
}

SeenPoint see(const scene::PointLight& lamp, const glm::dvec3& place, Rng& rng) {
  const glm::dvec3 axis = glm::normalize(lamp.position - place);
  const glm::dvec3 way = lamp.position + in_disc(axis, lamp.radius, rng) - place;
  const double distance = glm::length(way);
  return {way / distance, distance, glm::dot(way, axis) / distance / (distance * distance) * lamp.radiant_intensity};
}

glm::dvec3 along(const scene::PointLight& lamp, const glm::dvec3& origin, const glm::dvec3& direction, double reach) {
  const glm::dvec3 way = lamp.position - origin;
  const double distance = glm::length(way);
  const double cosine = glm::dot(way, direction) / distance;
  if (lamp.radius <= 0.0 || cosine <= 0.0 || distance / cosine > reach) return glm::dvec3(0.0);
  const glm::dvec3 aside = distance / cosine * direction - way;
  return glm::length(aside) < lamp.radius ? lamp.radiant_intensity / (pi * lamp.radius * lamp.radius) : glm::dvec3(0.0);
}

glm::dvec3 normal_of(const scene::AreaLight& area) { return glm::normalize(-glm::cross(area.half_x, area.half_y)); }

double size_of(const scene::AreaLight& area) {
  return (area.ellipse ? pi : 4.0) * glm::length(glm::cross(area.half_x, area.half_y));
}

glm::dvec3 point_of(const scene::AreaLight& area, Rng& rng) {
  glm::dvec2 at(2.0 * rng.uniform() - 1.0, 2.0 * rng.uniform() - 1.0);
  double square;
  if (area.ellipse) at = sample_disc(rng, square);
  return area.position + at.x * area.half_x + at.y * area.half_y;
}

SentRay send(const scene::AreaLight& area, const Target& to, double /*away*/, Rng& rng) {
  const glm::dvec3 place = point_of(area, rng);
  double solid_angle;
  const glm::dvec3 direction = towards(to, place, rng, solid_angle);
  const double cosine = std::max(glm::dot(direction, normal_of(area)), 0.0);
  return {place, direction, solid_angle * cosine * size_of(area) * area.radiance};
}

SeenPoint see(const scene::AreaLight& area, const glm::dvec3& place, Rng& rng) {
  const glm::dvec3 way = point_of(area, rng) - place;
  const double distance = glm::length(way);
  const double cosine = std::max(-glm::dot(way, normal_of(area)) / distance, 0.0);
  return {way / distance, distance, cosine / (distance * distance) * size_of(area) * area.radiance};
}

glm::dvec3 along(const scene::AreaLight& area, const glm::dvec3& origin, const glm::dvec3& direction, double reach) {
  const glm::dvec3 normal = normal_of(area);
  const double speed = glm::dot(direction, normal);
  if (!(speed < 0.0)) return glm::dvec3(0.0);
  const double distance = glm::dot(area.position - origin, normal) / speed;
  if (!(distance > 0.0) || distance > reach) return glm::dvec3(0.0);
  const glm::dvec3 at = origin + distance * direction - area.position;
  // Of a parallelogram's axes, which need not be at right angles.
  const glm::dvec3 across = glm::cross(area.half_x, area.half_y);
  const double square = glm::dot(across, across);
  const double x = glm::dot(glm::cross(at, area.half_y), across) / square;
  const double y = glm::dot(glm::cross(area.half_x, at), across) / square;
  const bool in = area.ellipse ? x * x + y * y <= 1.0 : std::abs(x) <= 1.0 && std::abs(y) <= 1.0;
  return in ? area.radiance : glm::dvec3(0.0);
}

scene::PointLight without_cone(const scene::SpotLight& spot) {
  return {spot.position, spot.radiant_intensity, spot.radius, spot.shape};
}

/// How much of a spot shines along a direction: of its soft edge, Cycles' smooth step over the cosine.
double in_cone(const scene::SpotLight& spot, const glm::dvec3& direction) {
  const double cosine = glm::dot(direction, glm::normalize(spot.axis)), edge = std::cos(0.5 * spot.angle);
  if (!(cosine > edge)) return 0.0;
  const double soft = spot.blend * (1.0 - edge);
  const double part = soft > 0.0 ? std::min((cosine - edge) / soft, 1.0) : 1.0;
  return part * part * (3.0 - 2.0 * part) * (spot.cosine ? cosine : 1.0);
}

SentRay send(const scene::SpotLight& spot, const Target& to, double away, Rng& rng) {
  SentRay sent = send(without_cone(spot), to, away, rng);
  sent.power *= in_cone(spot, sent.direction);
  return sent;
}

SeenPoint see(const scene::SpotLight& spot, const glm::dvec3& place, Rng& rng) {
  SeenPoint seen = see(without_cone(spot), place, rng);
  seen.irradiance *= in_cone(spot, -seen.direction);
  return seen;
}

glm::dvec3 along(const scene::SpotLight& spot, const glm::dvec3& origin, const glm::dvec3& direction, double reach) {
  return in_cone(spot, -direction) * along(without_cone(spot), origin, direction, reach);
}

// No ray meets a sun before it has left.
glm::dvec3 along(const scene::DirectionalLight& /*sun*/, const glm::dvec3& /*origin*/, const glm::dvec3& /*direction*/,
                 double /*reach*/) {
  return glm::dvec3(0.0);
}

}  // namespace

SentRay send_ray(const scene::Light& light, const Target& to, double away, Rng& rng) {
  return std::visit([&](const auto& kind) { return send(kind, to, away, rng); }, light);
}

SeenPoint see_point(const scene::Light& light, const glm::dvec3& place, Rng& rng) {
  return std::visit([&](const auto& kind) { return see(kind, place, rng); }, light);
}

glm::dvec3 radiance_along(const scene::Light& light, const glm::dvec3& origin, const glm::dvec3& direction,
                          double reach) {
  return std::visit([&](const auto& kind) { return along(kind, origin, direction, reach); }, light);
}

glm::dvec3 colour_of(const scene::Light& light) {
  if (const auto* sun = std::get_if<scene::DirectionalLight>(&light)) return sun->irradiance;
  if (const auto* area = std::get_if<scene::AreaLight>(&light)) return area->radiance;
  if (const auto* spot = std::get_if<scene::SpotLight>(&light)) return spot->radiant_intensity;
  return std::get<scene::PointLight>(light).radiant_intensity;
}

void check_source(const scene::Light& light) {
  const auto* spot = std::get_if<scene::SpotLight>(&light);
  if (spot != nullptr && spot->wide_x != glm::dvec3(0.0)) throw Error("The referee's spots are round: none stretched.");
  const auto* area = std::get_if<scene::AreaLight>(&light);
  if (area != nullptr && area->spread < 3.14)
    throw Error("The referee's areas shine to all sides: spread must be 180 degrees.");
}

}  // namespace mesograin::referee
