// Rigid bodies with contact and friction, a step at a time: what touches, or might within the step, may come no nearer
// than it is apart, and what slides is held back as far as Coulomb's cone lets it (Anitescu and Potra, "Formulating
// dynamic multi-rigid-body contact problems with friction as solvable linear complementarity problems", 1997), solved
// by projected Gauss-Seidel, which begins with the last step's pushes. Overlap is taken back in the places themselves
// (Mueller et al., "Detailed rigid body simulation with extended position based dynamics", 2020). Lengths are in mean
// radii, a step is the unit of time, a grain of radius 1 that of mass.
#include "pile/settle.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "pile/touching.h"

namespace mesograin::pile {
namespace {

constexpr double gravity = 0.04;
constexpr double kept_of_speed = 0.93;
constexpr double longest_step = 0.6;
constexpr double near_enough = 0.1;  // who may meet before neighbours are looked for again
constexpr int most_ahead = 6;        // steps, for which a grain looks for others
constexpr double farthest_ahead = 0.6;
constexpr int most_contacts = 4;              // of one grain with another that count: those that are nearest
constexpr double at_rest = 6e-3;              // a step, on average
constexpr double most_taken_back = 0.15;      // of an overlap, in a step
constexpr std::size_t balls_of_falling = 10;  // of a grain, that are asked for before it rests
constexpr int most_steps = 120;               // beyond the fall
constexpr int iterations = 4;
constexpr std::size_t balls_at_rest = 72;  // by another grain; the ground asks for all
constexpr std::size_t all_balls = std::numeric_limits<std::size_t>::max();
constexpr int fading_steps = 12;  // under a weight that fades
constexpr int last_steps = 80;    // under none
constexpr double small_overlap = 0.015;

struct Body {
  double lightness = 1.0;  // 1 / mass
  glm::dmat3 ease{0.0};    // of turning: the inverse inertia
  glm::dvec3 moved{0.0};   // within a step
  glm::dvec3 turned{0.0};
};

// A meeting within a step.
struct Contact {
  Meeting* meeting;
  Body* a;
  Body* b;
  glm::dvec3 arm_a, arm_b;
  glm::dvec3 turning_a, turning_b;  // by a push of 1
  double least;                     // how far they may come nearer, less than 0; or must part
  double mass;                      // a push for a way
};

glm::dvec3 way(const Contact& contact) {
  return contact.a->moved + glm::cross(contact.a->turned, contact.arm_a) - contact.b->moved -
         glm::cross(contact.b->turned, contact.arm_b);
}

void push(const Contact& contact, double by) {
  const glm::dvec3 along = by * contact.meeting->normal;
  contact.a->moved += contact.a->lightness * along;
  contact.a->turned += by * contact.turning_a;
  contact.b->moved -= contact.b->lightness * along;
  contact.b->turned -= by * contact.turning_b;
}

void rub(const Contact& contact, const glm::dvec3& by) {
  contact.a->moved += contact.a->lightness * by;
  contact.a->turned += contact.a->ease * glm::cross(contact.arm_a, by);
  contact.b->moved -= contact.b->lightness * by;
  contact.b->turned -= contact.b->ease * glm::cross(contact.arm_b, by);
}

// How far a push of 1 along a direction moves the place, along it.
double lightness_along(const Contact& contact, const glm::dvec3& direction) {
  const auto of = [&](const Body& body, const glm::dvec3& arm) {
    const glm::dvec3 about = glm::cross(arm, direction);
    return body.lightness + glm::dot(about, body.ease * about);
  };
  return of(*contact.a, contact.arm_a) + of(*contact.b, contact.arm_b);
}

void hold_apart(const Contact& contact) {
  Meeting& meeting = *contact.meeting;
  const double missing = contact.least - glm::dot(meeting.normal, way(contact));
  const double wanted = std::max(0.0, meeting.push + missing * contact.mass);
  if (wanted == meeting.push) return;
  push(contact, wanted - meeting.push);
  meeting.push = wanted;
}

void hold_back(const Contact& contact, double friction) {
  Meeting& meeting = *contact.meeting;
  if (meeting.push <= 0.0 && meeting.rub == glm::dvec3(0.0)) return;
  const glm::dvec3 moved = way(contact);
  const glm::dvec3 slid = moved - glm::dot(moved, meeting.normal) * meeting.normal;
  const double length = glm::length(slid);
  glm::dvec3 wanted = meeting.rub;
  if (length > 1e-12) wanted -= slid / lightness_along(contact, slid / length);
  wanted -= glm::dot(wanted, meeting.normal) * meeting.normal;
  const double most = friction * meeting.push;
  const double size = glm::length(wanted);
  if (size > most) wanted *= most / size;
  rub(contact, wanted - meeting.rub);
  meeting.rub = wanted;
}

class Settling {
 public:
  Settling(std::vector<Grain>& grains, const Triangles& surface, double floor, const Walls& walls, double friction)
      : grains_(grains),
        touching_(grains, surface, floor, walls),
        friction_(friction),
        bodies_(grains.size()),
        speeds_(grains.size()),
        outlooks_(grains.size()) {
    top_ = 0.0;
    for (std::size_t i = 0; i < grains.size(); ++i) {
      const Grain& grain = grains[i];
      bodies_[i].lightness = 1.0 / (grain.size * grain.size * grain.size);
      top_ = std::max(top_, grain.middle.z - floor);
      // Nothing thin may be passed within a step.
      longest_ = std::min(longest_, grain.size * grain.shape->thickness);
    }
    longest_ = std::max(longest_, 0.2);
  }

  double run(const std::function<void(double)>& go_on) {
    const int fall = static_cast<int>(top_ / longest_);
    touching_.set_detail(balls_of_falling, 2 * balls_of_falling);
    bool resting = false;
    for (int step = 0; step < fall + most_steps && !resting; ++step) {
      go_on(0.85 * step / (fall + most_steps));
      resting = advance(gravity, kept_of_speed) < at_rest && step > 20;
    }
    touching_.set_detail(balls_at_rest, all_balls);
    outlooks_.assign(bodies_.size(), {});
    // Weight presses grains into each other: it fades, and then they part.
    for (int step = 0; step < fading_steps; ++step) {
      go_on(0.85 + 0.05 * step / fading_steps);
      advance(gravity * (1.0 - (step + 1.0) / fading_steps), 0.5);
    }
    for (int step = 0; step < last_steps && overlap_ > small_overlap; ++step) {
      go_on(0.9 + 0.1 * step / last_steps);
      advance(0.0, 0.0);
    }
    go_on(1.0);
    return overlap();
  }

 private:
  // How far a grain goes on average.
  double advance(double weight, double kept) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      Body& body = bodies_[i];
      body.moved = kept * body.moved - glm::dvec3(0.0, 0.0, weight);
      body.turned *= kept;
      speeds_[i] = limit(body, grains_[i], longest_);
    }
    look();
    meet();
    for (int i = 0; i < iterations; ++i) {
      for (const Contact& contact : contacts_) {
        hold_apart(contact);
        hold_back(contact, friction_);
      }
    }
    for (const Contact& contact : contacts_) hold_apart(contact);
    return move();
  }

  static double limit(Body& body, const Grain& grain, double longest) {
    const double length = glm::length(body.moved) + glm::length(body.turned) * grain.size * grain.shape->reach;
    if (length <= longest) return length;
    body.moved *= longest / length;
    body.turned *= longest / length;
    return longest;
  }

  // As long as a grain strays no farther from the way it went when it looked, what it may meet is known.
  void look() {
    bool known = true;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Body& body = bodies_[i];
      Outlook& outlook = outlooks_[i];
      outlook.old =
          --outlook.steps_known < 0 || glm::length(outlook.strayed + body.moved - outlook.way) > outlook.slack;
      if (!outlook.old) continue;
      known = false;
      const double length = glm::length(body.moved);
      const int steps =
          length * most_ahead > farthest_ahead ? std::max(1, static_cast<int>(farthest_ahead / length)) : most_ahead;
      const double turning = glm::length(body.turned) * grains_[i].size * grains_[i].shape->reach;
      outlook = {body.moved, glm::dvec3(0.0), near_enough + steps * turning, steps, steps - 1, true};
    }
    if (known)
      touching_.measure();
    else
      touching_.look(outlooks_);
  }

  void meet() {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Grain& grain = grains_[i];
      const glm::dmat3& turn = touching_.turns()[i];
      bodies_[i].ease =
          turn * ease_of(*grain.shape) * glm::transpose(turn) * (bodies_[i].lightness / (grain.size * grain.size));
    }
    contacts_.clear();
    overlap_ = 0.0;
    std::vector<Meeting>& meetings = touching_.meetings();
    for (std::size_t first = 0, last = 0; first < meetings.size(); first = last) {
      // Of one grain and another.
      chosen_.clear();
      for (last = first;
           last < meetings.size() && meetings[last].a == meetings[first].a && meetings[last].b == meetings[first].b;
           ++last) {
        Meeting& meeting = meetings[last];
        overlap_ = std::max(overlap_, -meeting.gap);
        const double other = meeting.b == nobody ? 0.0 : speeds_[meeting.b];
        if (meeting.gap < speeds_[meeting.a] + other + 0.02)
          chosen_.push_back(&meeting);
        else
          forget(meeting);
      }
      if (meetings[first].b != nobody && chosen_.size() > most_contacts) {
        std::nth_element(chosen_.begin(), chosen_.begin() + most_contacts, chosen_.end(),
                         [](const Meeting* one, const Meeting* two) { return one->gap < two->gap; });
        for (std::size_t i = most_contacts; i < chosen_.size(); ++i) forget(*chosen_[i]);
        chosen_.resize(most_contacts);
      }
      for (Meeting* meeting : chosen_) add(*meeting);
    }
    for (const Contact& contact : contacts_) {
      push(contact, contact.meeting->push);
      rub(contact, contact.meeting->rub);
    }
  }

  static void forget(Meeting& meeting) {
    meeting.push = 0.0;
    meeting.rub = glm::dvec3(0.0);
  }

  void add(Meeting& meeting) {
    Contact contact{};
    contact.meeting = &meeting;
    contact.a = &bodies_[meeting.a];
    contact.b = meeting.b == nobody ? &ground_ : &bodies_[meeting.b];
    contact.arm_a = meeting.place - grains_[meeting.a].middle;
    if (meeting.b != nobody) contact.arm_b = meeting.place - grains_[meeting.b].middle;
    contact.turning_a = contact.a->ease * glm::cross(contact.arm_a, meeting.normal);
    contact.turning_b = contact.b->ease * glm::cross(contact.arm_b, meeting.normal);
    contact.least = std::min(-meeting.gap, most_taken_back);
    contact.mass = 1.0 / lightness_along(contact, meeting.normal);
    meeting.rub -= glm::dot(meeting.rub, meeting.normal) * meeting.normal;
    contacts_.push_back(contact);
  }

  const glm::dmat3& ease_of(const Shape& shape) {
    for (const auto& [known, ease] : eases_)
      if (known == &shape) return ease;
    return eases_.emplace_back(&shape, glm::inverse(shape.inertia)).second;
  }

  double move() {
    double sum = 0.0;
    for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
      Body& body = bodies_[i];
      if (touching_.passes(i, body.moved)) body.moved = glm::dvec3(0.0);
      limit(body, grains_[i], longest_);
      outlooks_[i].strayed += body.moved - outlooks_[i].way;
      sum += glm::length(body.moved);
      grains_[i].middle += body.moved;
      const double angle = glm::length(body.turned);
      if (angle > 0.0) grains_[i].turn = glm::normalize(glm::angleAxis(angle, body.turned / angle) * grains_[i].turn);
    }
    return sum / static_cast<double>(bodies_.size());
  }

  double overlap() {
    touching_.look(std::vector<Outlook>(bodies_.size()));
    double largest = 0.0;
    for (const Meeting& meeting : touching_.meetings())
      if (meeting.b != nobody)
        largest = std::max(largest, -meeting.gap / std::min(grains_[meeting.a].size, grains_[meeting.b].size));
    return largest;
  }

  std::vector<Grain>& grains_;
  Touching touching_;
  double friction_;
  std::vector<Body> bodies_;
  Body ground_{0.0};
  std::vector<Contact> contacts_;
  std::vector<std::pair<const Shape*, glm::dmat3>> eases_;
  double top_ = 0.0;
  double longest_ = longest_step;
  std::vector<double> speeds_;  // how far each may go in this step
  std::vector<Outlook> outlooks_;
  std::vector<Meeting*> chosen_;
  double overlap_ = 1.0;
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
    placed[i].size = grains.radii[i] / unit;
    placed[i].shape = &shapes[grains.meshes.empty() ? 0 : grains.shapes[i]];
  }
  const Walls held{walls.half / unit};
  place(placed, surface, ground.floor / unit, held, seed);
  Pile pile;
  pile.largest_overlap = Settling(placed, surface, ground.floor / unit, held, friction).run(go_on);
  for (const Grain& grain : placed) {
    pile.middles.push_back(unit * grain.middle);
    pile.turns.push_back(grain.turn);
  }
  return pile;
}

}  // namespace mesograin::pile
