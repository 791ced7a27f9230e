// Light meets the disk that a grain shows it, and goes through the grain's table. A ray that leaves at the normal n
// with a share w of irradiance E adds E w (1 + 3 n . n') / (4 pi) to the exitance over pi of a sphere: what passes a
// disk of area pi leaves through a surface of area 4 pi.
#include "heap/direct_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "heap/draws.h"
#include "heap/spread.h"

namespace mesograin::heap {
namespace {

void light_grain(const Space& space, std::uint32_t number, const glm::dvec3& anchor, const Draw& draw, int rays,
                 transport::Random& random, Coefficients& direct, Coefficients& crossed) {
  const Grain& grain = space.grains()[number];
  const GrainTable& table = *space.kind(number).from_light;
  const glm::dvec3 middle = anchor + glm::dvec3(grain.middle);
  const Spread spread(random);
  const Spread of_light(random);
  for (int i = 0; i < rays; ++i) {
    const std::array<float, 5> point = spread.point(i);
    const std::array<float, 5> light_point = of_light.point(i);
    const lights::LightDraw light = draw(middle, {light_point[0], light_point[1]});
    const glm::vec3 irradiance(light.irradiance);
    if (!(std::max({irradiance.r, irradiance.g, irradiance.b}) > 0.0F)) continue;
    const glm::vec3 to_light(light.to_light);
    const float mu = std::sqrt(point[0]);
    const glm::vec3 normal = TurnedFrame(to_light, point[1]) * glm::vec3(std::sqrt(1.0F - point[0]), 0.0F, mu);
    Ray ray{space.place(grain, normal), to_light, glm::vec3(1.0F)};
    const glm::vec3 left = space.passed(ray, static_cast<float>(std::min(light.reach, 1e30)) - grain.radius);
    if (left == glm::vec3(0.0F)) continue;
    const Outcome outcome = table.draw(mu, point[2]);
    const TurnedFrame frame(normal, -to_light);
    const float share = 1.0F / (4.0F * std::numbers::pi_v<float> * static_cast<float>(rays));
    const glm::vec3 leaves_at = table.seen_place(frame * outcome.normal, frame * outcome.direction);
    (ray.crossed ? crossed : direct).add(share * irradiance * left * outcome.weight, leaves_at);
  }
}

void light_wall(const Space& space, const Patches::Node& node, const glm::dvec3& anchor, const Draw& draw, int rays,
                transport::Random& random, Coefficients& direct, Coefficients& crossed) {
  constexpr glm::vec3 nowhere(0.0F);
  const glm::vec3 share =
      space.kind(node).from_light->albedo() / (std::numbers::pi_v<float> * static_cast<float>(rays));
  const Spread spread(random);
  for (int i = 0; i < rays; ++i) {
    const std::array<float, 5> point = spread.point(i);
    const WallPlace at = space.place(node, point[0], point[1]);
    const lights::LightDraw light = draw(anchor + glm::dvec3(at.place), {point[2], point[3]});
    const glm::vec3 to_light(light.to_light);
    const float cosine = glm::dot(to_light, at.normal);
    if (!(cosine > 0.0F)) continue;
    Ray ray{at.place, to_light, glm::vec3(1.0F)};
    const glm::vec3 left = space.passed(ray, static_cast<float>(std::min(light.reach, 1e30)));
    (ray.crossed ? crossed : direct).add(share * cosine * glm::vec3(light.irradiance) * left, nowhere);
  }
}

}  // namespace

void add_direct_light(const Space& space, const Heap& heap, int rays, Field& direct, Field& crossed,
                      const transport::Effort& effort) {
  const std::vector<Draw> draws = draws_of(heap);
  if (draws.empty()) return;
  constexpr std::size_t grains_a_piece = 64;
  const std::size_t grains = space.grains().size();
  const std::size_t count = space.size();
  transport::run_pieces(effort, (count + grains_a_piece - 1) / grains_a_piece, [&](std::size_t piece) {
    for (std::size_t i = piece * grains_a_piece; i < std::min(count, (piece + 1) * grains_a_piece); ++i) {
      transport::Random random(effort.seed + 1, i);
      for (const Draw& draw : draws)
        if (i < grains)
          light_grain(space, static_cast<std::uint32_t>(i), heap.anchor, draw, rays, random, direct[i], crossed[i]);
        else
          light_wall(space, space.patches().nodes()[i - grains], heap.anchor, draw, rays, random, direct[i],
                     crossed[i]);
    }
  });
}

}  // namespace mesograin::heap
