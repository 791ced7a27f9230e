// The kernel's own integrals over cylinder and sphere against what these send out.
#include "physics/kernels/beyond_sphere.h"

#include <algorithm>
#include <cmath>

#include "physics/body/cylinder_exitance.h"
#include "physics/body/half_space_exitance.h"
#include "physics/body/sphere_exitance.h"
#include "physics/channels.h"
#include "physics/physics.h"
#include "physics/quadrature.h"

namespace mesograin::physics {
namespace {

// Where cylinder and sphere send out the same but for this share, what lies beyond is as the kernel says.
constexpr double same = 1e-3;

// The radius of the endless cylinder whose mean chord is the unit sphere's, 4 V / S.
constexpr double cylinder_radius = 2.0 / 3.0;

glm::dvec3 kernel_at(const KernelTables& tables, double distance, double cosine) {
  const Table& profile = tables.profile;
  const double column =
      std::clamp(kernel_column(distance, 1.0 / tables.shortest, tables.columns_per_octave()), 0.0, profile.width - 1.0);
  const double row = std::clamp(cosine, 0.0, 1.0) * (profile.height - 1);
  const int left = std::min(static_cast<int>(column), profile.width - 2);
  const int lower = std::min(static_cast<int>(row), profile.height - 2);
  const auto texel = [&](int x, int y) { return glm::dvec3(profile.texels[y * profile.width + x]); };
  const auto across = [&](int y) { return glm::mix(texel(left, y), texel(left + 1, y), column - left); };
  return glm::mix(across(lower), across(lower + 1), row - lower);
}

// The kernel's exitance where the light falls straight down, on the sphere as thick as the cylinder.
glm::dvec3 gathered_on_sphere(const KernelTables& tables) {
  glm::dvec3 sum(0.0);
  for (const QuadratureNode& node : gauss_legendre(64)) {
    // As far as the surface is turned to the light; squares, dense where the kernel is largest.
    const double farthest = std::sqrt(2.0) * cylinder_radius;
    const double distance = farthest * node.x * node.x;
    const double cosine = 1.0 - 0.5 * (distance / cylinder_radius) * (distance / cylinder_radius);
    // Rings of one chord have equal areas on sphere and plane (Archimedes).
    const double ring = 2.0 * PI * distance * 2.0 * farthest * node.x * node.weight;
    sum += ring * cosine * kernel_at(tables, distance, cosine);
  }
  return sum;
}

// The same on the cylinder, as far along its axis as the kernel reaches.
glm::dvec3 gathered_on_cylinder(const KernelTables& tables) {
  const double reach = kernel_distance(tables.profile.width - 1, tables.shortest, tables.columns_per_octave());
  glm::dvec3 sum(0.0);
  for (const QuadratureNode& around : gauss_legendre(48))
    for (const QuadratureNode& along : gauss_legendre(48)) {
      const double angle = 0.5 * PI * around.x * around.x;
      const double across = 2.0 * cylinder_radius * std::sin(0.5 * angle);
      const double axial = reach * along.x * along.x * along.x;
      const double area =
          cylinder_radius * PI * around.x * around.weight * 3.0 * reach * along.x * along.x * along.weight;
      const double cosine = std::cos(angle);
      // Four quarters are alike.
      sum += 4.0 * area * cosine * kernel_at(tables, std::hypot(across, axial), cosine);
    }
  return sum;
}

}  // namespace

glm::dvec3 share_beyond_sphere(const KernelTables& tables, const std::array<BodyMedium, 3>& media,
                               const BodySurface& surface) {
  const glm::dvec3 gathered = gathered_on_cylinder(tables) - gathered_on_sphere(tables);
  const auto thinner = [](const BodyMedium& medium) {
    return BodyMedium{medium.sigma_a * cylinder_radius, medium.sigma_s * cylinder_radius, medium.g};
  };
  const auto cylinder = for_each_channel(
      media, [&](const BodyMedium& medium) { return cylinder_multiple_exitance(thinner(medium), surface); });
  const auto sphere = for_each_channel(media, [&](const BodyMedium& medium) {
    return sphere_multiple_exitance(thinner(medium), surface, {1.0}).front();
  });
  glm::dvec3 share;
  for (int channel = 0; channel < 3; ++channel) {
    const double nothing = same * cylinder[channel] + 1e-300;
    const double sent = std::max(cylinder[channel] - sphere[channel], 0.0) + nothing;
    const double found = std::max(gathered[channel], 0.0) + nothing;
    share[channel] = std::min(sent / found, 1.0);
  }
  return share;
}

}  // namespace mesograin::physics
