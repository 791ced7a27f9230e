// By Fresnel's equations, at the surface or at one of its facets.
#include "transport/interface.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "physics/physics.h"
#include "transport/directions.h"

namespace mesograin::transport {
namespace {

glm::dvec3 drawn_facet(const glm::dvec3& normal, const glm::dvec3& view, double alpha, Random& random) {
  const double first = random.uniform();
  return physics::ggx_visible_facet(normal, view, alpha, {first, random.uniform()});
}

}  // namespace

Interface::Entry Interface::enter(const glm::vec3& direction, const glm::vec3& normal, Random& random) const {
  if (matched()) return {direction, direction, 1.0F};
  const float cosine = std::clamp(-glm::dot(normal, direction), 0.0F, 1.0F);
  if (alpha_ == 0.0)
    return {refracted(direction, normal, static_cast<float>(eta_)), direction + 2.0F * cosine * normal,
            static_cast<float>(1.0 - physics::fresnel_reflectance(cosine, eta_))};
  const glm::dvec3 outwards(normal), to_light(-direction);
  const glm::dvec3 facet = drawn_facet(outwards, to_light, alpha_, random);
  const double on_facet = std::clamp(glm::dot(facet, to_light), 0.0, 1.0);
  const glm::dvec3 mirrored = glm::normalize(2.0 * on_facet * facet - to_light);
  const double passed =
      physics::dielectric_facet_passed(on_facet, glm::dot(outwards, mirrored), cosine, eta_, alpha_, true);
  return {physics::refracted_by_facet(outwards, facet, to_light, on_facet, eta_), mirrored, static_cast<float>(passed)};
}

Interface::Reflection Interface::reflect(const glm::vec3& direction, const glm::vec3& normal, Random& random) const {
  const auto outside = static_cast<float>(1.0 / eta_);
  if (alpha_ == 0.0) {
    const float cosine = std::min(glm::dot(normal, direction), 1.0F);
    return {glm::normalize(direction - 2.0F * cosine * normal), refracted(direction, -normal, outside),
            static_cast<float>(physics::fresnel_reflectance(cosine, 1.0 / eta_))};
  }
  // Seen from inside facets lie upside down, and are as likely.
  const glm::dvec3 outwards(normal), along(direction);
  const glm::dvec3 facet = drawn_facet(outwards, along, alpha_, random);
  const double on_facet = std::clamp(glm::dot(facet, along), 0.0, 1.0);
  const glm::vec3 beyond = refracted(direction, -glm::vec3(facet), outside);
  const double reflected = physics::dielectric_facet_kept(on_facet, glm::dot(normal, beyond), eta_, alpha_);
  return {physics::reflected_by_facet(outwards, facet, along), beyond, static_cast<float>(reflected)};
}

}  // namespace mesograin::transport
