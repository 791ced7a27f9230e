// Light that nothing has scattered, where it can be written down.
#include "transport/unscattered.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "shapes.h"
#include "transport/grid.h"
#include "transport/octahedron.h"

namespace mesograin::transport {
namespace {

/// Of unpolarised light, from outside (Born and Wolf, Principles of Optics, section 1.5.2).
double reflectance(double cosine, double eta) {
  const double inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (eta * eta));
  const double across = (cosine - eta * inside) / (cosine + eta * inside);
  const double along = (eta * cosine - inside) / (eta * cosine + inside);
  return 0.5 * (across * across + along * along);
}

// Two plates without absorption, lit from above: of what leaves the upper one the lower one has its share, and sends
// some back. With R a surface's reflectance a plate reflects 2 R / (1 + R) in all and passes the rest (Born and Wolf,
// Principles of Optics, section 1.6.4 without interference), and has inside as much flux, up and down together, as
// comes to it.
TEST(UnscatteredLight, EntersWhatLiesBehind) {
  constexpr double eta = 1.5;
  const Body body(plates(0.5F, 0.5F));
  ASSERT_FALSE(body.convex());
  const Grid grid(body, 2000);
  constexpr int texel_above = octahedron_side / 2 * octahedron_side + octahedron_side / 2;  // and three more beside +z
  const float highest = octahedron_direction(texel_above).z;
  double upper = 0.0, lower = 0.0;
  std::mutex mutex;
  unscattered_light(body, grid, Interface(eta), {1e-6}, octahedron_side, 16,
                    [&](std::size_t texel, const std::vector<float>& radiance) {
                      if (octahedron_direction(static_cast<int>(texel)).z < highest - 1e-4F) return;
                      const std::lock_guard lock(mutex);
                      for (std::size_t node = 0; node < radiance.size(); ++node) {
                        // Towards the sides, light comes in by them.
                        const glm::dvec3 place = body.unit() * glm::dvec3(grid.places()[node]);
                        const double inner = std::max(0.0, 1.0 - (place.x * place.x + place.y * place.y) / 0.64);
                        (place.z > 0.0 ? upper : lower) += inner * inner * radiance[node] * grid.volumes()[node];
                      }
                    },
                    {});
  const double surface = reflectance(highest, eta);
  const double plate = 2.0 * surface / (1.0 + surface);
  const double down = (1.0 - plate) / (1.0 - plate * plate);
  EXPECT_NEAR(lower / upper, down / (1.0 + plate * down), 0.05);  // the rays' noise: 0.02
}

}  // namespace
}  // namespace mesograin::transport
