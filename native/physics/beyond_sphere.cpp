// The kernel's own integrals over sphere and plane against what these send out.
#include "physics/beyond_sphere.h"

#include <algorithm>
#include <cmath>

#include "physics/channels.h"
#include "physics/physics.h"
#include "physics/sphere_exitance.h"

namespace mesograin::physics {
namespace {

// Where sphere and plane send out the same but for this share, what lies beyond is as the kernel says.
constexpr double same = 1e-3;

// The kernel's exitance where the light falls straight down, on the plane and on the unit sphere.
struct Gathered {
  glm::dvec3 plane{0.0};
  glm::dvec3 sphere{0.0};
};

glm::dvec3 kernel_at(const Table& profile, int column, double cosine) {
  const double row = cosine * (profile.height - 1);
  const int lower = std::min(static_cast<int>(row), profile.height - 2);
  const auto texel = [&](int each) { return glm::dvec3(profile.texels[each * profile.width + column]); };
  return glm::mix(texel(lower), texel(lower + 1), row - lower);
}

Gathered gather(const KernelTables& tables) {
  Gathered sum;
  glm::dvec3 plane_before(0.0);
  glm::dvec3 sphere_before(0.0);
  double distance_before = 0.0;
  for (int column = 0; column < tables.profile.width; ++column) {
    const double distance = tables.shortest * std::expm1(column * tables.step);
    const double ring = 2.0 * PI * distance;
    // Rings of one chord have equal areas on sphere and plane (Archimedes); the sphere's turn away from the light.
    const double cosine = std::max(1.0 - 0.5 * distance * distance, 0.0);
    const glm::dvec3 plane = ring * kernel_at(tables.profile, column, 1.0);
    const glm::dvec3 sphere = ring * cosine * kernel_at(tables.profile, column, cosine);
    sum.plane += 0.5 * (distance - distance_before) * (plane_before + plane);
    sum.sphere += 0.5 * (distance - distance_before) * (sphere_before + sphere);
    plane_before = plane;
    sphere_before = sphere;
    distance_before = distance;
  }
  return sum;
}

}  // namespace

glm::dvec3 share_beyond_sphere(const KernelTables& tables, const std::array<BodyMedium, 3>& media,
                               const BodySurface& surface) {
  const Gathered gathered = gather(tables);
  const auto plane = for_each_channel(
      media, [&](const BodyMedium& medium) { return half_space_multiple_exitance(medium, surface, {1.0}).front(); });
  const auto sphere = for_each_channel(
      media, [&](const BodyMedium& medium) { return sphere_multiple_exitance(medium, surface, {1.0}).front(); });
  glm::dvec3 share;
  for (int channel = 0; channel < 3; ++channel) {
    const double nothing = same * plane[channel] + 1e-300;
    const double sent = std::max(plane[channel] - sphere[channel], 0.0) + nothing;
    const double found = std::max(gathered.plane[channel] - gathered.sphere[channel], 0.0) + nothing;
    share[channel] = std::min(sent / found, 1.0);
  }
  return share;
}

}  // namespace mesograin::physics
