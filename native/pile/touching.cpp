// Balls of one grain are asked for in the distances of the other, and the other way round.
#include "pile/touching.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <tuple>

#include "pile/parallel.h"

namespace mesograin::pile {
namespace {

constexpr std::size_t pairs_at_once = 256;

}  // namespace

void Touching::turn() {
  turns_.resize(grains_.size());
  for (std::size_t i = 0; i < grains_.size(); ++i) turns_[i] = glm::mat3_cast(grains_[i].turn);
}

void Touching::recall(std::size_t first) {
  const auto key = [](const Meeting& meeting) {
    return std::tie(meeting.a, meeting.b, meeting.triangle, meeting.ball);
  };
  std::sort(known_.begin(), known_.end(),
            [&](const Meeting& one, const Meeting& other) { return key(one) < key(other); });
  for (std::size_t i = first; i < meetings_.size(); ++i) {
    Meeting& meeting = meetings_[i];
    const auto before =
        std::lower_bound(known_.begin(), known_.end(), meeting,
                         [&](const Meeting& one, const Meeting& other) { return key(one) < key(other); });
    if (before == known_.end() || key(*before) != key(meeting)) continue;
    meeting.push = before->push;
    meeting.rub = before->rub;
  }
}

void Touching::look(const std::vector<Outlook>& outlooks) {
  turn();
  // Those that fall together come no nearer to each other.
  glm::dvec3 common(0.0);
  for (const Outlook& outlook : outlooks) common += outlook.way / static_cast<double>(outlooks.size());
  std::vector<glm::dvec3> middles;
  std::vector<double> reaches;
  for (const Grain& grain : grains_) {
    middles.push_back(grain.middle);
    reaches.push_back(grain.size * grain.shape->reach + outlooks[middles.size() - 1].slack +
                      outlooks[middles.size() - 1].steps * glm::length(outlooks[middles.size() - 1].way - common));
  }
  balls_.clear();
  first_ball_.clear();
  for (std::size_t i = 0; i < grains_.size(); ++i) {
    const Grain& grain = grains_[i];
    first_ball_.push_back(balls_.size());
    for (std::size_t k = 0; k < std::min(by_grains_, grain.shape->balls.size()); ++k) {
      const Ball& ball = grain.shape->balls[k];
      balls_.push_back({grain.middle + grain.size * (turns_[i] * ball.middle), grain.size * ball.radius});
    }
  }
  Pairs pairs;
  find_pairs(middles, reaches, 0.0, pairs);
  std::vector<std::vector<Meeting>> found(pairs.size() / pairs_at_once + 1);
  in_parallel(found.size(), 4, [&](std::size_t first, std::size_t last) {
    for (std::size_t part = first; part < last; ++part)
      for (std::size_t i = part * pairs_at_once; i < std::min(pairs.size(), (part + 1) * pairs_at_once); ++i) {
        const auto& [a, b] = pairs[i];
        if (!outlooks[a].old && !outlooks[b].old) continue;
        const double range =
            outlooks[a].slack + outlooks[b].slack +
            std::min(outlooks[a].steps, outlooks[b].steps) * glm::length(outlooks[a].way - outlooks[b].way);
        if (glm::distance(grains_[a].middle, grains_[b].middle) >
            grains_[a].size * grains_[a].shape->reach + grains_[b].size * grains_[b].shape->reach + range)
          continue;
        of_pair(a, b, range, found[part]);
        if (!grains_[a].shape->field.empty() || !grains_[b].shape->field.empty()) of_pair(b, a, range, found[part]);
      }
  });
  // A plane's pushes are found anew.
  known_.clear();
  const auto is_old = [&](const Meeting& meeting) {
    return outlooks[meeting.a].old || (meeting.b != nobody && outlooks[meeting.b].old);
  };
  for (const Meeting& meeting : meetings_)
    if (is_old(meeting) && meeting.push > 0.0 && (meeting.b != nobody || meeting.triangle != nobody))
      known_.push_back(meeting);
  std::erase_if(meetings_, is_old);
  const std::size_t kept = meetings_.size();
  in_parallel(kept, 4096, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) measure(meetings_[i]);
  });
  triangles_of_.resize(grains_.size());
  for (std::uint32_t a = 0; a < grains_.size(); ++a) {
    if (!outlooks[a].old) continue;
    triangles_of_[a].clear();
    of_ground(a, outlooks[a].slack + outlooks[a].steps * glm::length(outlooks[a].way), meetings_);
  }
  for (const std::vector<Meeting>& part : found) meetings_.insert(meetings_.end(), part.begin(), part.end());
  recall(kept);
}

void Touching::of_pair(std::uint32_t a, std::uint32_t b, double range, std::vector<Meeting>& found) const {
  const Grain& one = grains_[a];
  const Grain& other = grains_[b];
  // Towards the other's own axes.
  const glm::dmat3 axes = turns_[b] * other.shape->axes;
  const double reach = other.size * other.shape->reach;
  const glm::dvec3 half = other.size * other.shape->half;
  const std::size_t most = std::min(by_grains_, one.shape->balls.size());
  for (std::uint32_t ball = 0; ball < most; ++ball) {
    const Ball& there = balls_[first_ball_[a] + ball];
    const glm::dvec3 place = there.middle - other.middle;
    const double near = reach + there.radius + range;
    if (glm::dot(place, place) > near * near) continue;
    const glm::dvec3 beyond = glm::max(glm::abs(place * axes) - half, glm::dvec3(0.0));
    if (glm::dot(beyond, beyond) > (there.radius + range) * (there.radius + range)) continue;
    Meeting meeting;
    meeting.a = a;
    meeting.b = b;
    meeting.ball = ball;
    measure(meeting);
    if (meeting.gap < range) found.push_back(meeting);
  }
}

void Touching::of_ground(std::uint32_t a, double range, std::vector<Meeting>& found) {
  const Grain& grain = grains_[a];
  const double reach = grain.size * grain.shape->reach + range;
  const auto add = [&](Meeting meeting) {
    meeting.a = a;
    for (meeting.ball = 0; meeting.ball < std::min(by_ground_, grain.shape->balls.size()); ++meeting.ball) {
      measure(meeting);
      if (meeting.gap < range) found.push_back(meeting);
    }
  };
  const auto plane = [&](const glm::dvec3& normal, double from_origin) {
    if (glm::dot(normal, grain.middle) - from_origin > reach) return;
    Meeting meeting;
    meeting.normal = normal;
    meeting.from_origin = from_origin;
    add(meeting);
  };
  plane({0.0, 0.0, 1.0}, floor_);
  if (walls_.any()) {
    plane({1.0, 0.0, 0.0}, -walls_.half.x);
    plane({-1.0, 0.0, 0.0}, -walls_.half.x);
    plane({0.0, 1.0, 0.0}, -walls_.half.y);
    plane({0.0, -1.0, 0.0}, -walls_.half.y);
  }
  surface_.near(grain.middle, reach, triangles_of_[a]);
  for (const std::uint32_t triangle : triangles_of_[a]) {
    Meeting meeting;
    meeting.triangle = triangle;
    add(meeting);
  }
}

void Touching::measure() {
  turn();
  in_parallel(meetings_.size(), 4096, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) measure(meetings_[i]);
  });
}

void Touching::measure(Meeting& meeting) const {
  const Grain& grain = grains_[meeting.a];
  const Ball& ball = grain.shape->balls[meeting.ball];
  const double radius = grain.size * ball.radius;
  const glm::dvec3 middle = grain.middle + grain.size * (turns_[meeting.a] * ball.middle);
  if (meeting.b != nobody) {
    const Grain& other = grains_[meeting.b];
    const glm::dvec3 apart = middle - other.middle;
    if (other.shape->field.empty()) {
      const double distance = glm::length(apart);
      meeting.normal = distance > 0.0 ? apart / distance : glm::dvec3(0.0, 0.0, 1.0);
      meeting.gap = distance - other.size * other.shape->reach - radius;
    } else {
      const Field::Value value = other.shape->field.front().at(apart * turns_[meeting.b] / other.size);
      meeting.normal = turns_[meeting.b] * value.outwards;
      meeting.gap = other.size * value.distance - radius;
    }
  } else if (meeting.triangle != nobody) {
    const Triangle& triangle = surface_[meeting.triangle];
    const double above = glm::dot(grain.middle - triangle.corners[0], triangle.normal);
    const glm::dvec3 up = above < 0.0 ? -triangle.normal : triangle.normal;
    const double height = glm::dot(middle - triangle.corners[0], up);
    meeting.normal = up;
    if (height < 0.0) {
      // It has gone through this triangle, or around its edge.
      meeting.gap =
          crossing(triangle, grain.middle, middle) ? height - radius : std::numeric_limits<double>::infinity();
    } else {
      const glm::dvec3 away = middle - nearest_on(triangle, middle);
      const double distance = glm::length(away);
      if (distance > 1e-9) meeting.normal = away / distance;
      meeting.gap = distance - radius;
    }
  } else {
    meeting.gap = glm::dot(meeting.normal, middle) - meeting.from_origin - radius;
  }
  meeting.place = middle - radius * meeting.normal;
}

bool Touching::passes(std::uint32_t a, const glm::dvec3& moved) const {
  const glm::dvec3& middle = grains_[a].middle;
  const auto& near = triangles_of_[a];
  return std::any_of(near.begin(), near.end(), [&](std::uint32_t triangle) {
    return crossing(surface_[triangle], middle, middle + moved).has_value();
  });
}

}  // namespace mesograin::pile
