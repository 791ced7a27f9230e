// Gathers a view's grains, has the exchange between them solved, and packs the answer.
#include "render/exchange.h"

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
  const Instances& instances = *content.instances();
  for (const InstanceGroup& group : instances.groups())
    for (std::uint32_t i = group.first; i < group.first + group.count; ++i)
      gatherer.add(instances.prototypes()[group.prototype].mesh, group.source, instances.ball(i));
  for (const Draw& draw : content.draws())
    gatherer.add(draw.source, draw.look,
                 glm::vec4(glm::vec3(draw.centre - content.anchor()), static_cast<float>(draw.reach)));
  return gatherer;
}

void append(std::vector<glm::vec4>& numbers, const heap::Coefficients& coefficients) {
  numbers.insert(numbers.end(), coefficients.channels.begin(), coefficients.channels.end());
}

}  // namespace

void Exchange::set(const Content& content, const scene::Scene& scene) {
  Gatherer gathered;
  if (scene.exchange != scene::Exchange::off && content.instances() != nullptr) gathered = gather(content);
  if (gathered.grains.grains.size() < 2) {
    solving_.reset();
    known_.reset();
    device_.reset();
    return;
  }
  heap::Heap heap{std::move(gathered.grains), content.anchor(), scene.lights, scene.world};
  const bool regrouped = !solving_ || grain_of_ != gathered.grain_of;
  if (!regrouped && solving_->heap() == heap) return;
  solving_ = heap::Solvers::instance().ask(std::move(heap), solving_);
  news_ = 0;
  grain_of_ = std::move(gathered.grain_of);
  if (regrouped) send();
}

bool Exchange::take_news() {
  if (!solving_) return false;
  heap::News news = solving_->news();
  if (news.number == news_ || !news.light) return false;
  news_ = news.number;
  known_ = Known{solving_->heap().grains, std::move(news.light)};
  send();
  return true;
}

ExchangeStatistics Exchange::statistics() const {
  ExchangeStatistics result;
  if (!solving_) return result;
  const heap::Grains& grains = solving_->heap().grains;
  result.grains = grains.grains.size();
  result.others = grain_of_.size() - result.grains;
  result.kinds = grains.kinds.size();
  result.final = solving_->news().final;
  if (!known_) return result;
  const heap::HeapLight& light = *known_->light;
  result.links = light.links;
  result.steps = light.steps;
  result.residual = light.residual;
  result.milliseconds = light.milliseconds;
  result.parts = light.parts;
  return result;
}

void Exchange::send() {
  std::vector<glm::vec4> numbers;
  numbers.reserve(grain_of_.size() * object_numbers);
  const std::size_t kinds_begin = grain_of_.size() * object_numbers;
  constexpr std::size_t kind_numbers = heap::GrainTable::lobe_nodes + 1;
  const std::size_t known = known_ ? known_->grains.grains.size() : 0;
  for (const std::optional<std::uint32_t>& grain : grain_of_) {
    // A grain that has just come is dark for a moment.
    const bool lit = grain && *grain < known;
    append(numbers, lit ? known_->light->answer[*grain] : heap::Coefficients{});
    append(numbers, lit ? known_->light->behind[*grain] : heap::Coefficients{});
    const std::size_t kind = lit ? kinds_begin + kind_numbers * known_->grains.grains[*grain].kind : 0;
    numbers.emplace_back(lit ? static_cast<float>(kind) : -1.0F, 0.0F, 0.0F, 0.0F);
  }
  for (std::size_t kind = 0; known_ && kind < known_->light->kinds.size(); ++kind) {
    const heap::Optics& optics = known_->grains.kinds[kind];
    // What is not transparent lets nothing through.
    numbers.emplace_back(optics.transparent() ? glm::vec3(optics.sigma_t) : glm::vec3(1e30F), 0.0F);
    for (const glm::vec3& node : known_->light->kinds[kind].from_light->lobe()) numbers.emplace_back(node, 0.0F);
  }
  device_.emplace(numbers);
}

}  // namespace mesograin::render
