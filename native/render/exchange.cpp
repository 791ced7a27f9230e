// Gathers a view's grains, has the exchange between them solved on a thread of its own, and packs the answer.
#include "render/exchange.h"

#include <chrono>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <utility>

namespace mesograin::render {
namespace {

// As shaders/heap/light_from_grains.glsl counts.
constexpr std::size_t object_numbers = 7;

/// What the exchange takes of a mesh for a grain.
struct Shape {
  bool grain;
  double radius_over_reach;  // of the sphere of its area
};

// A ground, a wall or a bowl encloses little for its area (the isoperimetric quotient; a sphere's is 1, a cube's .52).
constexpr double least_roundness = 0.02;

Shape shape_of(const scene::Mesh& mesh) {
  double area = 0.0;
  double volume = 0.0;
  for (const glm::uvec3& triangle : mesh.triangles()) {
    const glm::dvec3 a(mesh.positions()[triangle.x]);
    const glm::dvec3 b(mesh.positions()[triangle.y]);
    const glm::dvec3 c(mesh.positions()[triangle.z]);
    const glm::dvec3 doubled = glm::cross(b - a, c - a);
    area += 0.5 * glm::length(doubled);
    volume += glm::dot(a, doubled) / 6.0;
  }
  const double roundness = 36.0 * std::numbers::pi * volume * volume / std::max(area * area * area, 1e-300);
  const double radius = std::sqrt(area / (4.0 * std::numbers::pi));
  return {roundness > least_roundness && mesh.reach() > 0.0, radius / std::max(mesh.reach(), 1e-300)};
}

// Sizes of a kind's optics. Each grain is at most 4.5 % thicker or thinner than its kind, and as many are the one as
// the other.
constexpr double radii_an_octave = 8.0;

double rounded(double radius) {
  return std::exp2(std::round(std::log2(std::max(radius, 1e-300)) * radii_an_octave) / radii_an_octave);
}

class Gatherer {
 public:
  void add(const scene::MeshPointer& mesh, const scene::Material& material, const glm::vec4& ball) {
    const auto [shape, added] = shapes_.try_emplace(mesh.get());
    if (added) shape->second = shape_of(*mesh);
    const double radius = ball.w * shape->second.radius_over_reach;
    if (!shape->second.grain || !(radius > 0.0)) {
      grain_of.emplace_back(std::nullopt);
      return;
    }
    grain_of.emplace_back(static_cast<std::uint32_t>(grains.grains.size()));
    grains.grains.push_back(
        {glm::vec3(ball), static_cast<float>(radius), grains.kind(heap::optics_of(material, rounded(radius)))});
  }

  heap::Grains grains;
  std::vector<std::optional<std::uint32_t>> grain_of;

 private:
  std::map<const scene::Mesh*, Shape> shapes_;
};

Gatherer gather(const Content& content) {
  Gatherer gatherer;
  if (const Instances* instances = content.instances())
    for (const InstanceGroup& group : instances->groups())
      for (std::uint32_t i = group.first; i < group.first + group.count; ++i)
        gatherer.add(instances->prototypes()[group.prototype].mesh, group.source, instances->ball(i));
  for (const Draw& draw : content.draws())
    gatherer.add(draw.source, draw.look,
                 glm::vec4(glm::vec3(draw.centre - content.anchor()), static_cast<float>(draw.reach)));
  return gatherer;
}

void append(std::vector<glm::vec4>& numbers, const heap::Coefficients& coefficients) {
  numbers.insert(numbers.end(), coefficients.channels.begin(), coefficients.channels.end());
}

}  // namespace

Exchange::~Exchange() { stop(); }

void Exchange::stop() {
  stop_ = true;
  if (solving_.valid()) solving_.wait();
  solving_ = {};
  stop_ = false;
}

void Exchange::set(const Content& content, const scene::Scene& scene) {
  Gatherer gathered = gather(content);
  if (scene.exchange == scene::Exchange::off || gathered.grains.grains.size() < 2) {
    stop();
    heap_.reset();
    device_.reset();
    return;
  }
  heap::Heap heap{std::move(gathered.grains), content.anchor(), scene.lights, scene.world};
  const bool same = heap_ && grain_of_ == gathered.grain_of && *heap_ == heap;
  if (same) return;
  stop();
  heap_ = std::move(heap);
  grain_of_ = std::move(gathered.grain_of);
  solving_ = std::async(std::launch::async, [this, copy = *heap_, before = sent_] {
    const auto started = std::chrono::steady_clock::now();
    transport::Effort effort;
    effort.stop = &stop_;
    heap::HeapLight light = heap::solve_exchange(copy, {}, before, effort);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - started;
    return Solved{std::move(light), took.count()};
  });
}

bool Exchange::wait(const GoOn& go_on) {
  milliseconds_ = 0.0;
  if (!solving_.valid()) return true;
  constexpr std::chrono::milliseconds between_questions(5);
  while (solving_.wait_for(between_questions) != std::future_status::ready)
    if (!go_on()) return false;
  Solved solved = solving_.get();
  send(solved.light);
  sent_ = std::move(solved.light.sent);
  milliseconds_ = solved.milliseconds;
  return true;
}

void Exchange::send(const heap::HeapLight& light) {
  std::vector<glm::vec4> numbers;
  numbers.reserve(grain_of_.size() * object_numbers);
  const std::size_t kinds_begin = grain_of_.size() * object_numbers;
  constexpr std::size_t kind_numbers = heap::GrainTable::lobe_nodes + 1;
  for (const std::optional<std::uint32_t>& grain : grain_of_) {
    append(numbers, grain ? light.answer[*grain] : heap::Coefficients{});
    append(numbers, grain ? light.behind[*grain] : heap::Coefficients{});
    const std::size_t kind = grain ? kinds_begin + kind_numbers * heap_->grains.grains[*grain].kind : 0;
    numbers.emplace_back(grain ? static_cast<float>(kind) : -1.0F, 0.0F, 0.0F, 0.0F);
  }
  for (std::size_t kind = 0; kind < light.kinds.size(); ++kind) {
    const heap::Optics& optics = heap_->grains.kinds[kind];
    // What is not transparent lets nothing through.
    numbers.emplace_back(optics.transparent() ? glm::vec3(optics.sigma_t) : glm::vec3(1e30F), 0.0F);
    for (const glm::vec3& node : light.kinds[kind].from_light->lobe()) numbers.emplace_back(node, 0.0F);
  }
  device_.emplace(numbers);
}

}  // namespace mesograin::render
