// Projected Gauss-Seidel: contact by contact, what would come too near is pushed apart, and what slides is held back as
// far as friction can; it begins with the last step's pushes.
#include "pile/solver.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "pile/parallel.h"

namespace mesograin::pile {
namespace {

constexpr int iterations = 4;
constexpr std::size_t most_contacts = 4;     // of one grain with another that count: those that are nearest
constexpr float most_taken_back = 0.15F;     // of an overlap, in a step
constexpr std::size_t at_once = 4096;        // meetings
constexpr std::size_t worth_threads = 3000;  // contacts

glm::vec3 way(const Contact& contact, const std::vector<Body>& bodies) {
  const Body& a = bodies[contact.a];
  const glm::vec3 of_a = a.moved + glm::cross(a.turned, contact.arm_a);
  if (contact.b == nobody) return of_a;
  const Body& b = bodies[contact.b];
  return of_a - b.moved - glm::cross(b.turned, contact.arm_b);
}

void push(const Contact& contact, float by, std::vector<Body>& bodies) {
  const glm::vec3 along = by * contact.normal;
  Body& a = bodies[contact.a];
  a.moved += a.lightness * along;
  a.turned += by * contact.turning_a;
  if (contact.b == nobody) return;
  Body& b = bodies[contact.b];
  b.moved -= b.lightness * along;
  b.turned -= by * contact.turning_b;
}

void rub(const Contact& contact, const glm::vec3& by, std::vector<Body>& bodies) {
  Body& a = bodies[contact.a];
  a.moved += a.lightness * by;
  a.turned += a.ease * glm::cross(contact.arm_a, by);
  if (contact.b == nobody) return;
  Body& b = bodies[contact.b];
  b.moved -= b.lightness * by;
  b.turned -= b.ease * glm::cross(contact.arm_b, by);
}

void hold_apart(Contact& contact, std::vector<Body>& bodies) {
  const float missing = contact.least - glm::dot(contact.normal, way(contact, bodies));
  const float wanted = std::max(0.0F, contact.push + missing * contact.mass);
  if (wanted == contact.push) return;
  push(contact, wanted - contact.push, bodies);
  contact.push = wanted;
}

void hold_back(Contact& contact, float friction, std::vector<Body>& bodies) {
  if (contact.push <= 0.0F && contact.rub == glm::vec3(0.0F)) return;
  const glm::vec3 moved = way(contact, bodies);
  const glm::vec3 slid = moved - glm::dot(moved, contact.normal) * contact.normal;
  const float square = glm::dot(slid, slid);
  glm::vec3 wanted = contact.rub;
  if (square > 1e-20F) wanted -= slid * (square / glm::dot(slid, contact.lightness * slid));
  wanted -= glm::dot(wanted, contact.normal) * contact.normal;
  const float most = friction * contact.push;
  const float size = glm::length(wanted);
  if (size > most) wanted *= most / size;
  rub(contact, wanted - contact.rub, bodies);
  contact.rub = wanted;
}

// Its columns are how a place moves by pushes of 1 along the axes.
glm::mat3 lightness_of(const Body& body, const glm::vec3& arm) {
  const glm::mat3 across(0.0F, arm.z, -arm.y, -arm.z, 0.0F, arm.x, arm.y, -arm.x, 0.0F);
  return glm::mat3(body.lightness) + glm::transpose(across) * body.ease * across;
}

void forget(Meeting& meeting) {
  meeting.push = 0.0F;
  meeting.rub = glm::vec3(0.0F);
}

bool of_one_pair(const Meeting& one, const Meeting& other) { return one.a == other.a && one.b == other.b; }

}  // namespace

void Solver::slice(const std::vector<Grain>& grains) {
  places_.resize(grains.size());
  slice_of_.resize(grains.size());
  for (std::size_t i = 0; i < grains.size(); ++i) places_[i] = grains[i].middle.x;
  std::array<double, slices - 1> limits{};
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const auto limit = places_.begin() + static_cast<std::ptrdiff_t>((i + 1) * grains.size() / slices);
    std::nth_element(places_.begin(), limit, places_.end());
    limits[i] = *limit;
  }
  for (std::size_t i = 0; i < grains.size(); ++i)
    slice_of_[i] =
        static_cast<std::uint8_t>(std::upper_bound(limits.begin(), limits.end(), grains[i].middle.x) - limits.begin());
}

std::size_t Solver::list_of(const Contact& contact) const {
  const std::size_t one = slice_of_[contact.a];
  const std::size_t other = contact.b == nobody ? one : slice_of_[contact.b];
  const std::size_t lower = std::min(one, other);
  const std::size_t between = std::max(one, other) - lower;
  return between == 0 ? lower : between == 1 ? slices + lower : lists - 1;
}

void Solver::take(const std::vector<Grain>& grains, std::span<Meeting> meetings, std::span<const float> speeds,
                  const std::vector<Body>& bodies) {
  parts_.resize(meetings.size() / at_once + 1);
  overlaps_.assign(parts_.size(), 0.0F);
  // Where the meetings of a pair begin.
  const auto begin = [&](std::size_t part) {
    std::size_t first = std::min(part * at_once, meetings.size());
    while (first > 0 && first < meetings.size() && of_one_pair(meetings[first - 1], meetings[first])) ++first;
    return first;
  };
  in_parallel(parts_.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t part = first; part < last; ++part) {
      for (std::vector<Contact>& list : parts_[part]) list.clear();
      const std::span<Meeting> some = meetings.subspan(begin(part), begin(part + 1) - begin(part));
      for (const Meeting& meeting : some) overlaps_[part] = std::max(overlaps_[part], -meeting.gap);
      choose(some, speeds, grains, bodies, parts_[part]);
    }
  });
  in_parallel(lists, 4, [&](std::size_t first, std::size_t last) {
    for (std::size_t list = first; list < last; ++list) {
      contacts_[list].clear();
      for (const Lists& part : parts_)
        contacts_[list].insert(contacts_[list].end(), part[list].begin(), part[list].end());
    }
  });
  overlap_ = *std::max_element(overlaps_.begin(), overlaps_.end());
}

void Solver::choose(std::span<Meeting> meetings, std::span<const float> speeds, const std::vector<Grain>& grains,
                    const std::vector<Body>& bodies, Lists& found) const {
  std::vector<Meeting*> chosen;
  for (std::size_t first = 0, last = 0; first < meetings.size(); first = last) {
    chosen.clear();
    for (last = first; last < meetings.size() && of_one_pair(meetings[first], meetings[last]); ++last) {
      Meeting& meeting = meetings[last];
      const float other = meeting.b == nobody ? 0.0F : speeds[meeting.b];
      if (meeting.gap < near_in_step(speeds[meeting.a], other))
        chosen.push_back(&meeting);
      else
        forget(meeting);
    }
    if (meetings[first].b != nobody && chosen.size() > most_contacts) {
      std::nth_element(chosen.begin(), chosen.begin() + most_contacts, chosen.end(),
                       [](const Meeting* one, const Meeting* two) { return one->gap < two->gap; });
      for (std::size_t i = most_contacts; i < chosen.size(); ++i) forget(*chosen[i]);
      chosen.resize(most_contacts);
    }
    for (Meeting* meeting : chosen) add(*meeting, grains, bodies, found);
  }
}

void Solver::add(Meeting& meeting, const std::vector<Grain>& grains, const std::vector<Body>& bodies,
                 Lists& found) const {
  Contact contact{};
  contact.meeting = &meeting;
  contact.a = meeting.a;
  contact.b = meeting.b;
  contact.normal = meeting.normal;
  contact.arm_a = meeting.arm;
  const Body& a = bodies[meeting.a];
  contact.turning_a = a.ease * glm::cross(contact.arm_a, meeting.normal);
  contact.lightness = lightness_of(a, contact.arm_a);
  if (meeting.b != nobody) {
    const Body& b = bodies[meeting.b];
    contact.arm_b = meeting.arm + glm::vec3(grains[meeting.a].middle - grains[meeting.b].middle);
    contact.turning_b = b.ease * glm::cross(contact.arm_b, meeting.normal);
    contact.lightness += lightness_of(b, contact.arm_b);
  }
  contact.least = std::min(-meeting.gap, most_taken_back);
  contact.mass = 1.0F / glm::dot(meeting.normal, contact.lightness * meeting.normal);
  contact.push = meeting.push;
  contact.rub = meeting.rub - glm::dot(meeting.rub, meeting.normal) * meeting.normal;
  found[list_of(contact)].push_back(contact);
}

// Lists of which none has a grain of another are done at the same time.
template <typename Work>
void Solver::on_all(const Work& work) {
  std::size_t count = 0;
  for (const std::vector<Contact>& list : contacts_) count += list.size();
  const std::size_t least = count < worth_threads ? lists : 1;
  const auto some = [&](std::size_t first, std::size_t step, std::size_t lists_of_it) {
    in_parallel(lists_of_it, least, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i)
        for (Contact& contact : contacts_[first + step * i]) work(contact);
    });
  };
  some(0, 1, slices);
  some(slices, 2, slices / 2);
  some(slices + 1, 2, slices / 2 - 1);
  some(lists - 1, 1, 1);
}

void Solver::solve(std::vector<Body>& bodies, float friction) {
  on_all([&](Contact& contact) {
    push(contact, contact.push, bodies);
    rub(contact, contact.rub, bodies);
  });
  for (int i = 0; i < iterations; ++i)
    on_all([&](Contact& contact) {
      hold_apart(contact, bodies);
      hold_back(contact, friction, bodies);
    });
  on_all([&](Contact& contact) {
    hold_apart(contact, bodies);
    if (contact.push > 0.0F) {
      bodies[contact.a].touched = true;
      if (contact.b != nobody) bodies[contact.b].touched = true;
    }
    contact.meeting->push = contact.push;
    contact.meeting->rub = contact.rub;
  });
}

}  // namespace mesograin::pile
