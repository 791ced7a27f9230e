// A grain's walks, sorted by what is known where light leaves. By symmetry the viewer may stand on one side.
#include "heap/entries.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "transport/directions.h"

namespace mesograin::heap {
namespace {

/// Seen from the light: away from below it, and across that.
struct Axes {
  glm::vec3 away;
  glm::vec3 across;
};

Axes axes_of(const glm::vec3& normal, const glm::vec3& to_light, const glm::vec3& to_viewer) {
  Axes axes;
  const glm::vec3 tangential = normal - glm::dot(normal, to_light) * to_light;
  const float length = glm::length(tangential);
  glm::vec3 other;
  transport::make_frame(to_light, axes.away, other);
  if (length > 1e-5F) axes.away = tangential / length;
  axes.across = glm::cross(to_light, axes.away);
  if (glm::dot(axes.across, to_viewer) < 0.0F) axes.across = -axes.across;
  return axes;
}

int interval(float share, int count) {
  return std::clamp(static_cast<int>(share * static_cast<float>(count)), 0, count - 1);
}

struct Weighed {
  glm::vec2 offset;
  float weight;
};

/// As many as there is room for, each as likely as it was heavy, in order.
void keep(std::vector<Weighed>& found, std::vector<glm::vec2>& kept) {
  std::sort(found.begin(), found.end(), [](const Weighed& a, const Weighed& b) { return a.offset.x < b.offset.x; });
  double all = 0.0;
  for (const Weighed& one : found) all += one.weight;
  double until = 0.0;
  int drawn = 0;
  for (const Weighed& one : found) {
    until += one.weight;
    for (; (drawn + 0.5) * all < until * Entries::each && drawn < Entries::each; ++drawn) kept.push_back(one.offset);
  }
  // Light that never leaves there, or that is lost by rounding, came in where it leaves.
  while (drawn++ < Entries::each) kept.push_back(found.empty() ? glm::vec2(0.0F) : found.back().offset);
}

}  // namespace

std::size_t Entries::bin(const glm::vec3& normal, const glm::vec3& to_light, const glm::vec3& to_viewer) {
  constexpr float pi = std::numbers::pi_v<float>;
  const float cosine = glm::dot(normal, to_light);
  const float mu = glm::dot(normal, to_viewer);
  const glm::vec3 light_aside = to_light - cosine * normal;
  const glm::vec3 viewer_aside = to_viewer - mu * normal;
  const float lengths = glm::length(light_aside) * glm::length(viewer_aside);
  const float between = lengths > 1e-10F ? glm::dot(light_aside, viewer_aside) / lengths : 0.0F;
  const int angle = interval(std::acos(std::clamp(cosine, -1.0F, 1.0F)) / pi, angles);
  const int azimuth = interval(std::acos(std::clamp(between, -1.0F, 1.0F)) / pi, azimuths);
  const int bin = (angle * cosines + interval(mu * mu, cosines)) * azimuths + azimuth;
  return static_cast<std::size_t>(bin);
}

Entries::Entries(const std::vector<Passage>& passages) {
  std::vector<std::vector<Weighed>> found(bins);
  const glm::vec3 entry(0.0F, 0.0F, 1.0F);
  for (const Passage& passage : passages) {
    const Outcome& outcome = passage.outcome;
    // What the surface reflects has not come in.
    if (outcome.normal == entry) continue;
    const float weight = (outcome.weight.r + outcome.weight.g + outcome.weight.b) / 3.0F;
    if (!(weight > 0.0F)) continue;
    const glm::vec3 to_light(-std::sqrt(std::max(0.0F, (1.0F - passage.mu) * (1.0F + passage.mu))), 0.0F, passage.mu);
    const Axes axes = axes_of(outcome.normal, to_light, outcome.direction);
    const glm::vec3 way = entry - outcome.normal;
    found[bin(outcome.normal, to_light, outcome.direction)].push_back(
        {{glm::dot(way, axes.away), glm::dot(way, axes.across)}, weight});
  }
  offsets_.reserve(bins * each);
  for (std::vector<Weighed>& of_bin : found) keep(of_bin, offsets_);
}

}  // namespace mesograin::heap
