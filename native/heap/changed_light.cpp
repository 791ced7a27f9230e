// Of light that grains send, a share x answers to what others send, and 1 - x to lights. Were each to answer rho times
// as much, what they send would be rho (1 - x) / (1 - rho x) times what it was: a geometric series, order by order.
// What crosses grains goes on to others: rho of the series is that of what does not.
#include "heap/changed_light.h"

#include <algorithm>
#include <cstddef>
#include <glm/common.hpp>
#include <vector>

#include "heap/answered_more.h"

namespace mesograin::heap {
namespace {

// Of what is sent, at most: a heap that loses nothing is not known from its share.
constexpr float most_answered = 0.98F;

// And what may grow by more is not taken to: its light is soon known.
constexpr float most_growth = 4.0F;

glm::vec3 mean_of(const Coefficients& of) { return {of.channels[0].w, of.channels[1].w, of.channels[2].w}; }

glm::vec3 quotient(const glm::vec3& of, const glm::vec3& by, float if_none) {
  glm::vec3 result(if_none);
  for (int channel = 0; channel < 3; ++channel)
    if (by[channel] > 0.0F) result[channel] = of[channel] / by[channel];
  return result;
}

/// All grains together.
struct Whole {
  glm::vec3 more;         ///< they answer so many times as much
  glm::vec3 more_of_met;  ///< the same of what does not cross them
  glm::vec3 growth;       ///< of what comes to them
};

Whole whole_of(const HeapLight& light, const Grains& grains, const std::vector<AnsweredMore>& more) {
  glm::dvec3 sent(0.0);
  glm::dvec3 answered(0.0);
  glm::dvec3 sent_now(0.0);
  glm::dvec3 sent_of_met(0.0);
  for (std::size_t seat = 0; seat < light.seats->own(); ++seat) {
    const Grain& grain = grains.grains[light.seats->number(seat)];
    const double area = static_cast<double>(grain.radius) * grain.radius;
    const glm::dvec3 sends = area * glm::dvec3(glm::max(mean_of(light.sent[seat]), 0.0F));
    sent += sends;
    answered += area * glm::dvec3(glm::max(mean_of(light.answer[seat]), 0.0F));
    sent_now += sends * glm::dvec3(more[grain.kind].of_all);
    sent_of_met += sends * glm::dvec3(more[grain.kind].of_met);
  }
  const glm::vec3 share = glm::clamp(quotient(glm::vec3(answered), glm::vec3(sent), 0.0F), 0.0F, most_answered);
  const glm::vec3 rho = quotient(glm::vec3(sent_of_met), glm::vec3(sent), 1.0F);
  const glm::vec3 growth = (1.0F - share) / glm::max(1.0F - rho * share, 1e-3F);
  return {quotient(glm::vec3(sent_now), glm::vec3(sent), 1.0F), rho,
          glm::clamp(growth, 1.0F / most_growth, most_growth)};
}

}  // namespace

void change(HeapLight& light, const Grains& before, const Grains& now) {
  if (light.sent.size() == 0) return;  // none is exchanged
  const std::vector<AnsweredMore> more = answered_more(of_others(now.kinds), of_others(before.kinds));
  const Whole whole = whole_of(light, now, more);
  const Seats& seats = *light.seats;
  Field sent = light.sent;
  const glm::vec3 of_others = whole.more_of_met * whole.growth;
  const auto scale = [&](std::size_t told, const glm::vec3& by) {
    sent[told].scale(by * whole.growth);
    light.answer[told].scale(by * of_others);
    light.crossed[told].scale(by);
    if (told < light.behind.size()) light.behind[told].scale(of_others);
    if (told < light.scattered.size()) light.scattered[told].scale(whole.growth);
    if (told < light.scattered_answer.size()) light.scattered_answer[told].scale(of_others);
  };
  for (std::size_t seat = 0; seat < seats.own(); ++seat) {
    const AnsweredMore& of_kind = more[now.grains[seats.number(seat)].kind];
    scale(seat, of_kind.of_all);
    if (seat < light.entered.size()) heap::scale(light.entered[seat], of_kind.of_entered);
  }
  for (std::size_t term = seats.own(); term < seats.told(); ++term) scale(term, whole.more);
  const std::vector<Patches::Node>& nodes = light.patches.nodes();
  for (std::size_t node = 0; node < nodes.size() && seats.told() + node < sent.size(); ++node)
    scale(seats.told() + node, more[now.walls[nodes[node].wall].kind].of_all);
  light.sent = SharedField(std::move(sent));
}

}  // namespace mesograin::heap
