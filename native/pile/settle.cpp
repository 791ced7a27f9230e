// Rigid bodies with contact and friction, a step at a time: what touches, or might within the step, may come no nearer
// than it is apart, and what slides is held back as far as Coulomb's cone lets it (Anitescu and Potra, "Formulating
// dynamic multi-rigid-body contact problems with friction as solvable linear complementarity problems", 1997). Overlap
// is taken back in the places themselves (Mueller et al., "Detailed rigid body simulation with extended position based
// dynamics", 2020). Lengths are in mean radii, a step is the unit of time, a grain of radius 1 that of mass.
#include "pile/settle.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "base/error.h"
#include "pile/parallel.h"
#include "pile/pouring.h"
#include "pile/solver.h"
#include "pile/touching.h"

namespace mesograin::pile {
namespace {

constexpr float gravity = 0.04F;
// Of the speed, in a step: grains that slide and roll on each other lose more of it, and so run out less far.
constexpr float kept_of_falling = 0.93F;
constexpr float kept_of_touching = 0.8F;
constexpr double longest_step = 0.6;
constexpr double near_enough = 0.06;  // who may meet before neighbours are looked for again
constexpr double farthest_ahead = 0.6;
constexpr double slow = 0.02;  // a step; so slow a grain is good for any number of them, until it has strayed
constexpr int any_steps = 1000;
constexpr int least_steps = 20;
constexpr double at_rest = 6e-3;              // a step, on average
constexpr double falling = 0.5;               // of the longest step, of one alone
constexpr std::size_t balls_of_falling = 12;  // of a grain, that are asked for before it rests
constexpr int most_steps = 120;               // beyond the fall
constexpr int pouring_steps = 6;              // between two looks for free places
constexpr std::size_t balls_at_rest = 72;     // by another grain; the ground asks for all
constexpr std::size_t all_balls = std::numeric_limits<std::size_t>::max();
constexpr int fading_steps = 12;  // under a weight that fades
constexpr int last_steps = 80;    // under none
constexpr float small_overlap = 0.015F;
constexpr std::size_t bodies_at_once = 2048;

class Settling {
 public:
  Settling(std::vector<Grain>& grains, const Triangles& surface, double floor, const Walls& walls, double friction)
      : grains_(grains),
        touching_(grains, surface, floor, walls),
        floor_(floor),
        friction_(static_cast<float>(friction)) {
    grow();
  }

  /// Lets them fall, and those that are poured after them.
  double run(Pouring* pouring, const std::function<void(double)>& go_on) {
    touching_.set_detail(balls_of_falling, 2 * balls_of_falling);
    double speed = gravity;
    // Steps since grains came last.
    for (int step = 0; step < most_fall() + most_steps; ++step) {
      go_on(0.85 * step / (most_fall() + most_steps));
      const bool resting = speed <= at_rest && fastest_ <= falling * longest_ && step >= least_steps;
      if (pouring != nullptr && !pouring->done() && (resting || step % pouring_steps == 0) &&
          pouring->pour(grains_) > 0) {
        grow();
        step = 0;
      } else if (resting) {
        break;
      }
      speed = advance(gravity, kept_of_falling, kept_of_touching);
    }
    touching_.set_detail(balls_at_rest, all_balls);
    most_ahead_ = 1;
    outlooks_.assign(bodies_.size(), {});
    // Weight presses grains into each other: it fades, and then they part.
    for (int step = 0; step < fading_steps; ++step) {
      go_on(0.85 + 0.05 * step / fading_steps);
      advance(gravity * (1.0F - static_cast<float>(step + 1) / fading_steps), 0.5F, 0.5F);
    }
    for (int step = 0; step < last_steps && (step == 0 || solver_.overlap() > small_overlap); ++step) {
      go_on(0.9 + 0.1 * step / last_steps);
      advance(0.0F, 0.0F, 0.0F);
    }
    go_on(1.0);
    return overlap();
  }

 private:
  // For grains that are new.
  void grow() {
    const std::size_t before = bodies_.size();
    const std::size_t count = grains_.size();
    touching_.grow();
    bodies_.resize(count);
    eases_.resize(count);
    speeds_.resize(count);
    went_.resize(count);
    outlooks_.resize(count);
    for (std::size_t i = before; i < count; ++i) {
      const Grain& grain = grains_[i];
      bodies_[i].lightness = static_cast<float>(1.0 / (grain.size * grain.size * grain.size));
      eases_[i] = glm::mat3(glm::inverse(grain.shape->inertia) / std::pow(grain.size, 5.0));
      top_ = std::max(top_, grain.middle.z - floor_);
      // Nothing thin may be passed within a step.
      longest_ = std::max(std::min(longest_, grain.size * grain.shape->thickness), 0.2);
    }
  }

  int most_fall() const { return static_cast<int>(top_ / longest_); }

  // How far a grain goes on average.
  double advance(float weight, float kept_alone, float kept_touching) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      Body& body = bodies_[i];
      const float kept = body.touched ? kept_touching : kept_alone;
      body.touched = false;
      body.moved = kept * body.moved - glm::vec3(0.0F, 0.0F, weight);
      body.turned *= kept;
      speeds_[i] = limit(body, i);
    }
    look(weight);
    in_parallel(bodies_.size(), bodies_at_once, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        const glm::mat3& turn = touching_.turns()[i];
        bodies_[i].ease = turn * eases_[i] * glm::transpose(turn);
      }
    });
    solver_.slice(grains_);
    solver_.take(grains_, touching_.meetings(), speeds_, bodies_);
    solver_.solve(bodies_, friction_);
    return move();
  }

  float reach(std::size_t i) const { return static_cast<float>(grains_[i].size * grains_[i].shape->reach); }

  float limit(Body& body, std::size_t i) const {
    const float length = glm::length(body.moved) + glm::length(body.turned) * reach(i);
    const auto longest = static_cast<float>(longest_);
    if (length <= longest) return length;
    body.moved *= longest / length;
    body.turned *= longest / length;
    return longest;
  }

  // As long as a grain strays no farther from the way it went when it looked, what it may meet is known.
  // Weight is left out, as what rests goes nowhere, and what falls falls together.
  void look(double weight) {
    const glm::dvec3 fallen(0.0, 0.0, weight);
    bool known = true;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Body& body = bodies_[i];
      Outlook& outlook = outlooks_[i];
      const double strayed = glm::length(outlook.strayed + glm::dvec3(body.moved) + fallen - outlook.way);
      outlook.old = --outlook.steps_known < 0 || strayed + outlook.turned > outlook.slack;
      if (!outlook.old) continue;
      known = false;
      const double length = glm::length(went_[i]);
      const double turning = glm::length(body.turned) * reach(i);
      if (length < slow) {
        outlook = {glm::dvec3(0.0), glm::dvec3(0.0), 0.0, near_enough + most_ahead_ * turning,
                   any_steps,       any_steps - 1,   true};
        continue;
      }
      const int steps = std::clamp(static_cast<int>(farthest_ahead / length), 1, most_ahead_);
      outlook = {went_[i], glm::dvec3(0.0), 0.0, near_enough + steps * turning, steps, steps - 1, true};
    }
    if (known)
      touching_.measure(speeds_);
    else
      touching_.look(outlooks_, speeds_);
  }

  double move() {
    double sum = 0.0;
    fastest_ = 0.0;
    for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
      Body& body = bodies_[i];
      if (touching_.passes(i, body.moved)) body.moved = glm::vec3(0.0F);
      touching_.went(i, limit(body, i));
      const glm::dvec3 moved(body.moved);
      outlooks_[i].strayed += moved - outlooks_[i].way;
      grains_[i].middle += moved;
      went_[i] = moved;
      const double length = glm::length(moved);
      sum += length;
      fastest_ = std::max(fastest_, length);
      const glm::dvec3 turned(body.turned);
      const double angle = glm::length(turned);
      outlooks_[i].turned += angle * reach(i);
      if (angle > 0.0) grains_[i].turn = glm::normalize(glm::angleAxis(angle, turned / angle) * grains_[i].turn);
    }
    return sum / static_cast<double>(bodies_.size());
  }

  double overlap() {
    touching_.look(std::vector<Outlook>(bodies_.size()), speeds_);
    double largest = 0.0;
    for (const Meeting& meeting : touching_.meetings())
      if (meeting.b != nobody)
        largest = std::max(largest, -meeting.gap / std::min(grains_[meeting.a].size, grains_[meeting.b].size));
    return largest;
  }

  std::vector<Grain>& grains_;
  Touching touching_;
  Solver solver_;
  double floor_;
  float friction_;
  std::vector<Body> bodies_;
  std::vector<glm::mat3> eases_;  // of turning, along a grain's own axes
  double top_ = 0.0;
  double fastest_ = 0.0;
  double longest_ = longest_step;
  int most_ahead_ = most_ahead;
  std::vector<float> speeds_;     // how far each may go in this step
  std::vector<glm::dvec3> went_;  // in the step before
  std::vector<Outlook> outlooks_;
};

void check(const Grains& grains, const Walls& walls, double friction) {
  if (grains.radii.empty()) throw Error("A pile needs at least one grain; got none.");
  for (const double radius : grains.radii)
    if (!(radius > 0.0 && std::isfinite(radius)))
      throw Error("A grain's radius must be greater than 0; got {}.", radius);
  if (!(friction >= 0.0)) throw Error("Friction must be at least 0; got {}.", friction);
  const double largest = *std::max_element(grains.radii.begin(), grains.radii.end());
  if (walls.any() && !(std::min(walls.half.x, walls.half.y) >= largest))
    throw Error("The walls leave no room: they are {} and {} apart, and the largest grain is {} across.",
                2.0 * walls.half.x, 2.0 * walls.half.y, 2.0 * largest);
  if (!grains.meshes.empty() && grains.shapes.size() != grains.radii.size())
    throw Error("Each of {} grains needs a shape; got {}.", grains.radii.size(), grains.shapes.size());
  for (const std::uint32_t shape : grains.shapes)
    if (shape >= grains.meshes.size())
      throw Error("A grain's shape must be below {}; got {}.", grains.meshes.size(), shape);
}

}  // namespace

Pile settle(const Grains& grains, const Ground& ground, const Walls& walls, double friction, std::uint64_t seed,
            const Progress& progress) {
  check(grains, walls, friction);
  const auto go_on = [&](double share) {
    if (!progress(share)) throw Error("The pile was cancelled.");
  };
  const auto count = static_cast<double>(grains.radii.size());
  const double unit = std::accumulate(grains.radii.begin(), grains.radii.end(), 0.0) / count;
  std::vector<Shape> shapes;
  for (const Mesh& mesh : grains.meshes) {
    go_on(0.0);
    shapes.push_back(shape_of(mesh));
  }
  if (shapes.empty()) shapes.push_back(ball_shape(1.0));
  Mesh scaled = ground.mesh;
  for (glm::dvec3& vertex : scaled.vertices) vertex /= unit;
  const Triangles surface(scaled);
  std::vector<Grain> placed(grains.radii.size());
  for (std::size_t i = 0; i < placed.size(); ++i) {
    placed[i].number = static_cast<std::uint32_t>(i);
    placed[i].size = grains.radii[i] / unit;
    placed[i].shape = &shapes[grains.meshes.empty() ? 0 : grains.shapes[i]];
  }
  const double floor = ground.floor / unit;
  const Walls held = ground.inside ? Walls{} : Walls{walls.half / unit};
  std::optional<Pouring> pouring;
  if (ground.inside) {
    if (surface.empty()) throw Error("A mesh that grains shall lie inside needs at least one triangle.");
    pouring.emplace(std::exchange(placed, {}), surface, seed);
    pouring->pour(placed);
  } else {
    place(placed, surface, floor, held, seed);
  }
  Pile pile;
  pile.largest_overlap = Settling(placed, surface, floor, held, friction).run(pouring ? &*pouring : nullptr, go_on);
  std::sort(placed.begin(), placed.end(),
            [](const Grain& one, const Grain& other) { return one.number < other.number; });
  for (const Grain& grain : placed) {
    pile.numbers.push_back(grain.number);
    pile.middles.push_back(unit * grain.middle);
    pile.turns.push_back(grain.turn);
  }
  return pile;
}

}  // namespace mesograin::pile
