// Light meets the disk that a grain shows it, and goes through the grain's table. A ray that leaves at the normal n
// with a share w of irradiance E adds E w (1 + 3 n . n') / (4 pi) to the exitance over pi of a sphere: what passes a
// disk of area pi leaves through a surface of area 4 pi.
#include "heap/direct_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <vector>

#include "heap/draws.h"
#include "heap/moves.h"
#include "heap/spread.h"

namespace mesograin::heap {
namespace {

/// A ray towards a light, and what it brings if nothing is in its way.
struct Look {
  Ray ray;
  float reach;
  glm::vec3 brings;
  glm::vec3 normal{0.0F};  ///< where it leaves a grain
  float mu = 0.0F;         ///< at which cosine
  float choice = 0.0F;     ///< of what becomes of its light there
};

/// Whether a light is so near that it is another for each place of the grain. One inside is told as if it were not.
bool is_near(const lights::LightDraw& light, const Grain& grain) {
  const auto radii = static_cast<float>(light.reach / static_cast<double>(grain.radius));
  return radii > 1.0F && radii < near_radii;
}

/// From where a ray of such a lamp meets the grain: one of all that do, spread evenly as the lamp sees them.
std::optional<Look> look_at_lamp(const Space& space, const Grain& grain, const glm::dvec3& anchor, const Draw& draw,
                                 const lights::LightDraw& light, const std::array<float, 5>& point, float share) {
  const double radius = grain.radius;
  const double way = light.reach;
  // The cone that the ball fills; written so that a small one keeps its digits.
  const double sine = radius / way;
  const double cap = sine * sine / (1.0 + std::sqrt(1.0 - sine * sine));  // 1 - cos of half its angle
  const double height = static_cast<double>(point[0]) * cap;              // 1 - cos of the ray's
  const double aside = way * std::sqrt(height * (2.0 - height));          // of the ray from the middle
  const double inside = std::sqrt(std::max(radius * radius - aside * aside, 0.0));
  const double distance = way * (1.0 - height) - inside;
  const glm::vec3 to_lamp(light.to_light);
  const auto cosine = static_cast<float>(1.0 - height);
  const glm::vec3 outwards =
      TurnedFrame(-to_lamp, point[1]) *
      glm::vec3(static_cast<float>(std::sqrt(height * (2.0 - height))), 0.0F, cosine);  // from the lamp
  const glm::vec3 normal =
      glm::normalize((static_cast<float>(way) * to_lamp + static_cast<float>(distance) * outwards) / grain.radius);
  const glm::vec3 place = space.place(grain, normal);
  const lights::LightDraw there = draw(anchor + glm::dvec3(place), {point[3], point[4]});
  const glm::vec3 to_light(there.to_light);
  const float mu = glm::dot(normal, to_light);
  if (!(mu > 0.0F)) return std::nullopt;
  // Of what a parallel light would bring, as much more as it is brighter here and as its rays are more of the lamp's.
  const double more = 2.0 * cap * there.reach * there.reach / (radius * radius);
  return Look{{place, to_light, glm::vec3(1.0F)},
              static_cast<float>(std::min(there.reach, 1e30)),
              share * static_cast<float>(more) * glm::vec3(there.irradiance),
              normal,
              mu,
              point[2]};
}

void look_from_grain(const Space& space, const Grain& grain, const glm::dvec3& anchor, const Draw& draw, int rays,
                     transport::Random& random, std::vector<Look>& looks) {
  const glm::dvec3 middle = anchor + glm::dvec3(grain.middle);
  const Spread spread(random);  // of its axes two are of places on the light: in a spread of their own they would
                                // follow where the ray comes in
  const float share = 1.0F / (4.0F * std::numbers::pi_v<float> * static_cast<float>(rays));
  for (int i = 0; i < rays; ++i) {
    const std::array<float, 5> point = spread.point(i);
    const lights::LightDraw light = draw(middle, {point[3], point[4]});
    if (is_near(light, grain)) {
      if (const std::optional<Look> look = look_at_lamp(space, grain, anchor, draw, light, point, share))
        looks.push_back(*look);
      continue;
    }
    const glm::vec3 irradiance(light.irradiance);
    if (!(std::max({irradiance.r, irradiance.g, irradiance.b}) > 0.0F)) continue;
    const glm::vec3 to_light(light.to_light);
    const float mu = std::sqrt(point[0]);
    const glm::vec3 normal = TurnedFrame(to_light, point[1]) * glm::vec3(std::sqrt(1.0F - point[0]), 0.0F, mu);
    looks.push_back({{space.place(grain, normal), to_light, glm::vec3(1.0F)},
                     static_cast<float>(std::min(light.reach, 1e30)) - grain.radius,
                     share * irradiance,
                     normal,
                     mu,
                     point[2]});
  }
}

void look_from_node(const Space& space, const Patches::Node& node, const glm::dvec3& anchor, const Draw& draw, int rays,
                    transport::Random& random, std::vector<Look>& looks) {
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
    looks.push_back({{at.place, to_light, glm::vec3(1.0F)},
                     static_cast<float>(std::min(light.reach, 1e30)),
                     share * cosine * glm::vec3(light.irradiance)});
  }
}

/// What a grain makes of light.
struct Made {
  Coefficients* sum;
  Coefficients* scattered;  ///< of that, what a clear grain has; or null
  Coefficients* entered;    ///< what has entered a turbid one; or null
};

void add_grain(const GrainTable& table, const Look& look, const glm::vec3& left, bool fine, const Made& made) {
  const Outcome outcome = table.draw(look.mu, look.choice);
  const TurnedFrame frame(look.normal, -look.ray.direction);
  const glm::vec3 light = left * look.brings * outcome.weight;
  const glm::vec3 place = table.seen_place(frame * outcome.normal, frame * outcome.direction);
  made.sum->add(light, place, fine);
  if (made.scattered != nullptr && outcome.scattered && table.is_clear()) made.scattered->add(light, place, fine);
  if (made.entered != nullptr && table.is_turbid())
    table.response(look.mu).add_to(*made.entered, frame, left * look.brings);
}

/// Whether any of these meets a place where a grain was or is that has moved.
bool touched(const Moves& moves, const std::vector<Look>& looks) {
  return std::any_of(looks.begin(), looks.end(), [&](const Look& look) {
    const std::optional<float> distance = moves.distance(look.ray.origin, look.ray.direction);
    return distance && *distance <= look.reach;
  });
}

}  // namespace

void find_direct_light(const Space& space, const Heap& heap, const Rays& rays, const Moves* moves, Lit& lit,
                       const transport::Effort& effort) {
  const std::vector<Draw> draws = draws_of(heap, image_of(heap));
  const std::size_t count = space.size();
  lit.entered.resize(space.told_entered());
  if (draws.empty()) return;
  constexpr std::size_t grains_a_piece = 64;
  transport::run_pieces(effort, (count + grains_a_piece - 1) / grains_a_piece, [&](std::size_t piece) {
    std::vector<Look> looks;
    for (std::size_t i = piece * grains_a_piece; i < std::min(count, (piece + 1) * grains_a_piece); ++i) {
      const std::uint32_t number = space.seats()->number(i);
      const bool of_grain = space.of_grain(i);
      transport::Random random(effort.seed + 1, number);
      looks.clear();
      for (const Draw& draw : draws)
        if (of_grain)
          look_from_grain(space, space.grains()[number], heap.anchor, draw, rays.of(i), random, looks);
        else
          look_from_node(space, space.node(i), heap.anchor, draw, rays.of_node, random, looks);
      if (moves != nullptr && !(of_grain && moves->moved(number)) && !touched(*moves, looks)) continue;
      lit.direct[i] = {};
      lit.crossed[i] = {};
      Coefficients* scattered = lit.scattered.empty() ? nullptr : &lit.scattered[i];
      if (scattered != nullptr) *scattered = {};
      Coefficients entered;
      Coefficients* const told_entered = i < lit.entered.size() ? &entered : nullptr;
      for (Look& look : looks) {
        const glm::vec3 left = space.passed(look.ray, look.reach);
        if (left == glm::vec3(0.0F)) continue;
        Coefficients& sum = look.ray.crossed ? lit.crossed[i] : lit.direct[i];
        if (of_grain)
          add_grain(*space.kind(number).from_light, look, left, rays.fine(space, i), {&sum, scattered, told_entered});
        else
          sum.add(left * look.brings, glm::vec3(0.0F), false);  // as much at every normal
      }
      if (told_entered != nullptr) lit.entered[i] = PackedCoefficients(entered);
    }
  });
}

}  // namespace mesograin::heap
