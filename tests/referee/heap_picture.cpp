// Paths start at the camera. Where nothing refracts, each scattering asks for the light (next event); else a path finds
// it by leaving the heap towards it.
#include "heap_picture.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "directions.h"
#include "interface.h"
#include "parallel.h"
#include "rng.h"
#include "roulette.h"

namespace mesograin::referee {
namespace {

constexpr double pi = std::numbers::pi;

class Path {
 public:
  Path(const HeapCase& setup, const BallGrid& grid, Rng& rng, HeapRadiance& found)
      : material_(setup.material),
        light_(setup.light),
        grid_(grid),
        rng_(rng),
        found_(found),
        sigma_t_(setup.material.sigma_s + setup.material.sigma_a),
        surface_{setup.material.eta},
        asks_((setup.material.diffuse || setup.material.eta == 1) && !setup.light.sky && setup.light.cosine == 1) {}

  void follow(glm::dvec3 origin, glm::dvec3 direction) {
    std::optional<BallGrid::Hit> hit = grid_.first(origin, direction);
    if (!hit) return;
    seen_ = hit->number;
    while (hit) {
      origin += hit->distance * direction;
      const bool other = hit->number != seen_;
      if (other) crossed_ = true;
      if (!meet(hit->number, origin, direction)) return;
      // Only light that was scattered in no other is the first ball's own.
      if (!left_ && !elsewhere_ && !other) {
        left_ = true;
        if (changed_) found_.alone += weight_ * seen_light(direction);
      }
      hit = grid_.first(origin, direction);
    }
    if (!changed_) return;
    const double light = weight_ * seen_light(direction);
    found_.all += light;
    if (!elsewhere_)
      (crossed_ ? found_.crossed : found_.direct) += light;
    else if (is_behind())
      found_.behind += light;
  }

 private:
  /// Radiance from outside the heap, of what is not asked for.
  double seen_light(const glm::dvec3& direction) const {
    if (asks_) return 0;
    if (light_.sky) return direction.z > 0 ? 1 : 0;
    const double half = light_.cosine;
    // A disc's irradiance on a plane that faces it is pi radiance sin^2.
    return glm::dot(direction, light_.direction) > half ? 1 / ((1 - half) * (1 + half)) : 0;
  }

  /// `share`: of the light that arrives, towards where the path comes from, a steradian.
  void ask(std::uint32_t number, const glm::dvec3& place, double share) {
    if (!asks_ || !(share > 0)) return;
    const double light = weight_ * share * pi;
    const double way = grid_.way_in_balls(place, light_.direction, number);
    const bool first = !elsewhere_ && number == seen_ && !left_;
    if (first) found_.alone += light;
    const double passed = material_.diffuse ? (way > 1e-9 ? 0 : 1) : std::exp(-sigma_t_ * way);
    found_.all += light * passed;
    if (elsewhere_) {
      if (is_behind()) found_.behind += light * passed;
      return;
    }
    // A way through a ball that merely touches is none.
    const bool free = !crossed_ && way < 1e-9;
    (free ? found_.direct : found_.crossed) += light * passed;
  }

  void scattered_in(std::uint32_t number) {
    if (!changed_) scatterer_ = number;
    if (number != scatterer_) between_ = true;
    changed_ = true;
    if (number != seen_) elsewhere_ = true;
  }

  bool is_behind() const { return surface_.matched() && !between_ && scatterer_ != seen_; }

  /// Until it leaves the ball that it has come to; false where it ends.
  bool meet(std::uint32_t number, glm::dvec3& place, glm::dvec3& direction) {
    const Ball& ball = grid_.ball(number);
    const glm::dvec3 normal = (place - ball.middle) / ball.radius;
    if (material_.diffuse) {
      scattered_in(number);
      weight_ *= material_.reflectance;
      ask(number, place, std::max(glm::dot(normal, light_.direction), 0.0) / pi);
      direction = sample_cosine(normal, rng_);
      return survives(weight_, rng_);
    }
    if (!surface_.matched()) {
      changed_ = true;
      const double cosine = std::min(-glm::dot(normal, direction), 1.0);
      if (rng_.uniform() < surface_.reflectance_from_outside(cosine)) {
        direction += 2 * cosine * normal;
        if (number != seen_) elsewhere_ = true;
        return true;
      }
      direction = refract(direction, normal, surface_.eta);
      if (number != seen_) elsewhere_ = true;
    }
    return walk(number, place, direction);
  }

  bool walk(std::uint32_t number, glm::dvec3& place, glm::dvec3& direction) {
    const Ball& ball = grid_.ball(number);
    while (true) {
      const glm::dvec3 from_middle = place - ball.middle;
      const double along = glm::dot(from_middle, direction);
      const double chord =
          -along +
          std::sqrt(std::max(along * along + ball.radius * ball.radius - glm::dot(from_middle, from_middle), 0.0));
      const double flight = sigma_t_ > 0 ? -std::log(rng_.uniform_positive()) / sigma_t_ : chord;
      if (flight < chord) {
        place += flight * direction;
        weight_ *= material_.sigma_s / sigma_t_;
        scattered_in(number);
        ask_inside(number, place, direction);
        if (!survives(weight_, rng_)) return false;
        direction = sample_phase(direction, material_.g, rng_);
        continue;
      }
      place += chord * direction;
      const glm::dvec3 normal = glm::normalize(place - ball.middle);
      place = ball.middle + ball.radius * normal;
      if (surface_.matched()) return true;
      const double cosine = std::min(glm::dot(normal, direction), 1.0);
      if (rng_.uniform() < surface_.reflectance_from_inside(cosine)) {
        direction = glm::normalize(direction - 2 * cosine * normal);
        continue;
      }
      direction = glm::normalize(refract(direction, -normal, 1 / surface_.eta));
      return true;
    }
  }

  void ask_inside(std::uint32_t number, const glm::dvec3& place, const glm::dvec3& direction) {
    if (!asks_) return;
    const Ball& ball = grid_.ball(number);
    const glm::dvec3 from_middle = place - ball.middle;
    const double along = glm::dot(from_middle, light_.direction);
    const double out =
        -along +
        std::sqrt(std::max(along * along + ball.radius * ball.radius - glm::dot(from_middle, from_middle), 0.0));
    ask(number, place, phase(glm::dot(direction, light_.direction), material_.g) * std::exp(-sigma_t_ * out));
  }

  const HeapMaterial& material_;
  const HeapLight& light_;
  const BallGrid& grid_;
  Rng& rng_;
  HeapRadiance& found_;
  const double sigma_t_;
  const Interface surface_;
  const bool asks_;
  std::uint32_t seen_ = 0;
  double weight_ = 1;
  bool changed_ = false;         // it is not the light itself that would be seen
  bool crossed_ = false;         // it has met another ball than the one that is seen
  bool elsewhere_ = false;       // and was scattered there
  bool left_ = false;            // it has left the ball that is seen
  std::uint32_t scatterer_ = 0;  // where it was scattered first
  bool between_ = false;         // and then in another
};

}  // namespace

HeapPicture trace_heap(const HeapCase& setup) {
  const BallGrid grid(setup.balls);
  const std::size_t pixels = static_cast<std::size_t>(setup.width) * static_cast<std::size_t>(setup.height);
  HeapPicture picture{std::vector<HeapRadiance>(pixels), std::vector<double>(pixels)};
  const HeapCamera& camera = setup.camera;
  parallel(static_cast<std::size_t>(setup.height), setup.threads, [&](std::size_t row) {
    Rng rng(setup.seed, row);
    for (int column = 0; column < setup.width; ++column) {
      HeapRadiance& sum =
          picture.radiance[row * static_cast<std::size_t>(setup.width) + static_cast<std::size_t>(column)];
      double squares = 0;
      for (int sample = 0; sample < setup.samples; ++sample) {
        const double x = 2 * (column + rng.uniform()) / setup.width - 1;
        const double y = 1 - 2 * (static_cast<double>(row) + rng.uniform()) / setup.height;
        const glm::dvec3 origin = camera.centre + x * camera.half_width * camera.right +
                                  y * camera.half_height * camera.up -
                                  100.0 * (camera.half_width + camera.half_height) * camera.direction;
        const double before = sum.all;
        Path(setup, grid, rng, sum).follow(origin, camera.direction);
        squares += (sum.all - before) * (sum.all - before);
      }
      for (double* value : {&sum.all, &sum.direct, &sum.crossed, &sum.behind, &sum.alone}) *value /= setup.samples;
      picture.noise[row * static_cast<std::size_t>(setup.width) + static_cast<std::size_t>(column)] =
          std::sqrt(std::max(squares / setup.samples - sum.all * sum.all, 0.0) / setup.samples);
    }
  });
  return picture;
}

}  // namespace mesograin::referee
