// Balls of one grain are asked for in the distances of the other, and the other way round.
#include "pile/touching.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <tuple>

#include "pile/contacts.h"
#include "pile/parallel.h"

namespace mesograin::pile {
namespace {

constexpr std::size_t grains_at_once = 64;
constexpr std::size_t most_of_pair = 8;  // balls of a grain that another may meet until it looks again, the nearest

bool nearer(const Meeting& one, const Meeting& other) {
  return std::tie(one.gap, one.ball) < std::tie(other.gap, other.ball);
}

}  // namespace

Touching::Touching(const std::vector<Grain>& grains, const Triangles& surface, double floor, const Walls& walls)
    : grains_(grains), surface_(surface), planes_{{{0.0, 0.0, 1.0}, floor}}, gone_(grains.size()) {
  if (!walls.any()) return;
  for (const double sign : {1.0, -1.0}) {
    planes_.push_back({{sign, 0.0, 0.0}, -walls.half.x});
    planes_.push_back({{0.0, sign, 0.0}, -walls.half.y});
  }
}

void Touching::turn() {
  turns_.resize(grains_.size());
  in_parallel(grains_.size(), 4096, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) turns_[i] = glm::mat3(glm::mat3_cast(grains_[i].turn));
  });
}

void Touching::recall(std::size_t first) {
  const auto key = [](const Meeting& meeting) { return std::tie(meeting.a, meeting.b, meeting.side, meeting.ball); };
  const auto before = [&](const Meeting& one, const Meeting& other) { return key(one) < key(other); };
  std::sort(known_.begin(), known_.end(), before);
  in_parallel(meetings_.size() - first, 4096, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = first + from; i < first + to; ++i) {
      Meeting& meeting = meetings_[i];
      const auto same = std::lower_bound(known_.begin(), known_.end(), meeting, before);
      if (same == known_.end() || key(*same) != key(meeting)) continue;
      meeting.push = same->push;
      meeting.rub = same->rub;
    }
  });
}

void Touching::find(const std::vector<Outlook>& outlooks) {
  const std::size_t count = grains_.size();
  // Those that fall together come no nearer to each other.
  glm::dvec3 common(0.0);
  for (const Outlook& outlook : outlooks) common += outlook.way / static_cast<double>(count);
  std::vector<glm::dvec3> middles(count);
  std::vector<double> reaches(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Grain& grain = grains_[i];
    const Outlook& outlook = outlooks[i];
    middles[i] = grain.middle;
    // What rests is asked for by what moves, which is good for so many steps at most.
    const int steps = std::min(outlook.steps, most_ahead);
    reaches[i] = grain.size * grain.shape->reach + outlook.slack + steps * glm::length(outlook.way - common);
  }
  const Neighbours neighbours(middles, reaches);
  found_.resize(count / grains_at_once + 1);
  in_parallel(found_.size(), 2, [&](std::size_t first, std::size_t last) {
    for (std::size_t part = first; part < last; ++part) {
      found_[part].clear();
      for (std::size_t i = part * grains_at_once; i < std::min(count, (part + 1) * grains_at_once); ++i) {
        if (!outlooks[i].old) continue;
        const auto a = static_cast<std::uint32_t>(i);
        neighbours.visit(a, [&](std::uint32_t b) {
          if (outlooks[b].old && b < a) return;
          const double range =
              outlooks[a].slack + outlooks[b].slack +
              std::min(outlooks[a].steps, outlooks[b].steps) * glm::length(outlooks[a].way - outlooks[b].way);
          if (apart(a, b, range)) return;
          of_pair(a, b, range, found_[part]);
          if (!grains_[a].shape->field.empty() || !grains_[b].shape->field.empty()) of_pair(b, a, range, found_[part]);
        });
      }
    }
  });
}

void Touching::look(const std::vector<Outlook>& outlooks, std::span<const float> speeds) {
  turn();
  find(outlooks);
  const auto is_old = [&](const Meeting& meeting) {
    return outlooks[meeting.a].old || (meeting.b != nobody && outlooks[meeting.b].old);
  };
  known_.clear();
  std::erase_if(meetings_, [&](const Meeting& meeting) {
    const bool old = is_old(meeting);
    if (old && meeting.push > 0.0F) known_.push_back(meeting);
    return old;
  });
  const std::size_t kept = meetings_.size();
  measure_first(kept, speeds);
  triangles_of_.resize(grains_.size());
  for (std::uint32_t a = 0; a < grains_.size(); ++a) {
    if (!outlooks[a].old) continue;
    triangles_of_[a].clear();
    of_ground(a, outlooks[a].slack + outlooks[a].steps * glm::length(outlooks[a].way), meetings_);
  }
  for (const std::vector<Meeting>& part : found_) meetings_.insert(meetings_.end(), part.begin(), part.end());
  recall(kept);
}

// Between planes across the line of their middles, each of which only touches a grain.
bool Touching::apart(std::uint32_t a, std::uint32_t b, double range) const {
  const Grain& one = grains_[a];
  const Grain& other = grains_[b];
  const glm::vec3 away(one.middle - other.middle);
  const float distance = glm::length(away);
  if (!(distance > 0.0F)) return false;
  const glm::vec3 along = away / distance;
  const double between = static_cast<double>(distance) - one.size * one.shape->support(-along * turns_[a]) -
                         other.size * other.shape->support(along * turns_[b]);
  return between > range;
}

void Touching::of_pair(std::uint32_t a, std::uint32_t b, double range, std::vector<Meeting>& found) const {
  const Grain& one = grains_[a];
  const Grain& other = grains_[b];
  // As the other grain sees them, which is as large as the unit sphere.
  const auto unit = static_cast<float>(1.0 / other.size);
  const auto size = static_cast<float>(one.size) * unit;
  const float most_gap = static_cast<float>(range) * unit;
  const glm::mat3 turn = size * (glm::transpose(turns_[b]) * turns_[a]);
  const glm::vec3 middle = unit * (glm::vec3(one.middle - other.middle) * turns_[b]);
  const float distance = glm::length(middle);
  const glm::vec3 along = distance > 0.0F ? middle / distance : glm::vec3(0.0F, 0.0F, 1.0F);
  // A plane that touches the other grain, and its own axes: what is beyond these need not be asked for.
  const float beyond = distance - other.shape->support(along) - most_gap;
  const glm::vec3 towards = along * turn;
  const glm::mat3 axes(other.shape->axes);
  const glm::vec3 half(other.shape->half);
  const std::size_t most = std::min(by_grains_, one.shape->balls.size());
  const std::size_t before = found.size();
  for (std::uint32_t ball = 0; ball < most; ++ball) {
    const Ball& there = one.shape->balls[ball];
    const float radius = size * there.radius;
    if (beyond + glm::dot(towards, there.middle) > radius) continue;
    const glm::vec3 place = middle + turn * there.middle;
    const glm::vec3 outside = glm::max(glm::abs(place * axes) - half, glm::vec3(0.0F));
    const float near = radius + most_gap;
    if (glm::dot(outside, outside) > near * near) continue;
    if (!other.shape->field.empty() && other.shape->field.front().distance(place) > near) continue;
    Meeting meeting;
    meeting.a = a;
    meeting.b = b;
    meeting.ball = ball;
    measure(meeting);
    if (meeting.gap < static_cast<float>(range)) found.push_back(meeting);
  }
  if (found.size() - before <= most_of_pair) return;
  const auto first = found.begin() + static_cast<std::ptrdiff_t>(before);
  std::nth_element(first, first + most_of_pair, found.end(), nearer);
  found.resize(before + most_of_pair);
}

void Touching::of_ground(std::uint32_t a, double range, std::vector<Meeting>& found) {
  const Grain& grain = grains_[a];
  const double reach = grain.size * grain.shape->reach + range;
  const auto add = [&](std::size_t side) {
    Meeting meeting;
    meeting.a = a;
    meeting.side = static_cast<std::uint32_t>(side);
    for (meeting.ball = 0; meeting.ball < std::min(by_ground_, grain.shape->balls.size()); ++meeting.ball) {
      measure(meeting);
      if (meeting.gap < static_cast<float>(range)) found.push_back(meeting);
    }
  };
  for (std::size_t i = 0; i < planes_.size(); ++i)
    if (glm::dot(planes_[i].normal, grain.middle) - planes_[i].from_origin <= reach) add(surface_.size() + i);
  surface_.near(grain.middle, reach, triangles_of_[a]);
  for (const std::uint32_t triangle : triangles_of_[a]) add(triangle);
}

void Touching::measure(std::span<const float> speeds) {
  turn();
  measure_first(meetings_.size(), speeds);
}

void Touching::measure_first(std::size_t count, std::span<const float> speeds) {
  in_parallel(count, 4096, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      Meeting& meeting = meetings_[i];
      if (meeting.b != nobody) {
        const auto nearer = static_cast<float>(gone_[meeting.a] + gone_[meeting.b]) - meeting.gone;
        if (nearer == 0.0F || meeting.gap - nearer > near_in_step(speeds[meeting.a], speeds[meeting.b])) continue;
      }
      measure(meeting);
    }
  });
}

void Touching::measure(Meeting& meeting) const {
  if (meeting.b == nobody) return measure_side(meeting);
  const Grain& grain = grains_[meeting.a];
  const Grain& other = grains_[meeting.b];
  const Ball& ball = grain.shape->balls[meeting.ball];
  const auto size = static_cast<float>(grain.size);
  const auto other_size = static_cast<float>(other.size);
  const glm::vec3 arm = size * (turns_[meeting.a] * ball.middle);
  const glm::vec3 away = glm::vec3(grain.middle - other.middle) + arm;
  meeting.gone = static_cast<float>(gone_[meeting.a] + gone_[meeting.b]);
  if (other.shape->field.empty()) {
    const float distance = glm::length(away);
    meeting.normal = distance > 0.0F ? away / distance : glm::vec3(0.0F, 0.0F, 1.0F);
    meeting.gap = distance - other_size * static_cast<float>(other.shape->reach) - size * ball.radius;
  } else {
    const Field::Value value = other.shape->field.front().at(away * turns_[meeting.b] / other_size);
    meeting.normal = turns_[meeting.b] * value.outwards;
    meeting.gap = other_size * value.distance - size * ball.radius;
  }
  meeting.arm = arm - size * ball.radius * meeting.normal;
}

void Touching::measure_side(Meeting& meeting) const {
  const Grain& grain = grains_[meeting.a];
  const Ball& ball = grain.shape->balls[meeting.ball];
  const double radius = grain.size * ball.radius;
  const glm::dvec3 arm = grain.size * glm::dvec3(turns_[meeting.a] * ball.middle);
  const glm::dvec3 middle = grain.middle + arm;
  glm::dvec3 normal;
  double gap = 0.0;
  if (meeting.side >= surface_.size()) {
    const Plane& plane = planes_[meeting.side - surface_.size()];
    normal = plane.normal;
    gap = glm::dot(normal, middle) - plane.from_origin - radius;
  } else {
    const Triangle& triangle = surface_[meeting.side];
    const double above = glm::dot(grain.middle - triangle.corners[0], triangle.normal);
    normal = above < 0.0 ? -triangle.normal : triangle.normal;
    const double height = glm::dot(middle - triangle.corners[0], normal);
    if (height < 0.0) {
      // It has gone through this triangle, or around its edge.
      gap = crossing(triangle, grain.middle, middle) ? height - radius : std::numeric_limits<double>::infinity();
    } else {
      const glm::dvec3 away = middle - nearest_on(triangle, middle);
      const double distance = glm::length(away);
      if (distance > 1e-9) normal = away / distance;
      gap = distance - radius;
    }
  }
  meeting.normal = glm::vec3(normal);
  meeting.gap = static_cast<float>(gap);
  meeting.arm = glm::vec3(arm - radius * normal);
}

bool Touching::passes(std::uint32_t a, const glm::dvec3& moved) const {
  const glm::dvec3& middle = grains_[a].middle;
  const auto& near = triangles_of_[a];
  return std::any_of(near.begin(), near.end(), [&](std::uint32_t triangle) {
    return crossing(surface_[triangle], middle, middle + moved).has_value();
  });
}

}  // namespace mesograin::pile
