// Tables follow from materials, links from places, what lights do from both; each is found again only where what it
// follows from has changed. A quick solution at other materials takes the links as they were, and scales them.
#include "heap/solver.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "heap/direct_light.h"
#include "heap/solve.h"

namespace mesograin::heap {
namespace {

bool same_places(const Grains& a, const Grains& b) {
  const bool same_walls = std::equal(
      a.walls.begin(), a.walls.end(), b.walls.begin(), b.walls.end(),
      [](const Wall& one, const Wall& other) { return one.mesh == other.mesh && one.to_heap == other.to_heap; });
  return same_walls && std::equal(a.grains.begin(), a.grains.end(), b.grains.begin(), b.grains.end(),
                                  [](const Grain& one, const Grain& other) {
                                    return one.middle == other.middle && one.radius == other.radius;
                                  });
}

// Beyond that a material is another, and its links tell nothing.
constexpr float greatest_change = 4.0F;

glm::vec3 ratio(const glm::vec3& over, const glm::vec3& under) {
  glm::vec3 result(1.0F);
  for (int channel = 0; channel < 3; ++channel)
    if (over[channel] != under[channel]) result[channel] = over[channel] / std::max(under[channel], 1e-30F);
  return result;
}

bool is_small(const glm::vec3& change) {
  return std::max({change.r, change.g, change.b}) <= greatest_change &&
         std::min({change.r, change.g, change.b}) * greatest_change >= 1.0F;
}

void scale(Coefficients& coefficients, const glm::vec3& by) {
  for (int channel = 0; channel < 3; ++channel) coefficients.channels[static_cast<std::size_t>(channel)] *= by[channel];
}

void scale(Field& field, const std::vector<glm::vec3>& by) {
  for (std::size_t i = 0; i < field.size(); ++i) scale(field[i], by[i]);
}

void scale(Links& links, const std::vector<glm::vec3>* answered, const std::vector<glm::vec3>& received) {
  for (std::size_t i = 0; i + 1 < links.first.size(); ++i)
    for (std::size_t l = links.first[i]; l < links.first[i + 1]; ++l) {
      Link& link = links.links[l];
      const glm::vec3 by = received[link.from] * (answered != nullptr ? (*answered)[i] : glm::vec3(1.0F));
      for (int channel = 0; channel < 3; ++channel) link.weight[channel] *= by[channel];
    }
}

void add(Field& sum, const Field& of, const glm::vec3& by) {
  for (std::size_t i = 0; i < sum.size(); ++i) {
    Coefficients scaled = of[i];
    scale(scaled, by);
    sum[i] = sum[i] + scaled;
  }
}

/// The numbers of the first grains as they were, and their mean for those that came.
Field resized(Field field, std::size_t count) {
  if (field.empty() || field.size() > 2 * count || count > 2 * field.size()) return {};
  Coefficients mean;
  for (const Coefficients& one : field) mean = mean + one;
  scale(mean, glm::vec3(1.0F / static_cast<float>(field.size())));
  field.resize(count, mean);
  return field;
}

}  // namespace

bool Solver::serves(const std::shared_ptr<const Matter>& other, int rays, int wanted, const Quality& quality) const {
  if (rays < wanted) return false;
  if (other->grains == matter_->grains && other->walks >= quality.walks) return true;
  return quality.quick && same_places(other->grains, matter_->grains) && change_from(*other);
}

std::optional<Solver::Change> Solver::change_from(const Matter& other) const {
  Change change;
  const std::size_t count = matter_->grains.grains.size();
  change.answered.reserve(count);
  change.received.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Kind& now = matter_->kinds[matter_->grains.grains[i].kind];
    const Kind& then = other.kinds[other.grains.grains[i].kind];
    change.answered.push_back(ratio(now.from_viewer->albedo(), then.from_viewer->albedo()));
    change.received.push_back(ratio(then.from_light->met(), now.from_light->met()));
    if (!is_small(change.answered.back()) || !is_small(change.received.back())) return std::nullopt;
  }
  for (const Patches::Node& node : other.space->patches().nodes()) {
    const Kind& now = matter_->kinds[matter_->grains.walls[node.wall].kind];
    const Kind& then = other.kinds[other.grains.walls[node.wall].kind];
    change.answered.push_back(ratio(now.from_viewer->albedo(), then.from_viewer->albedo()));
    change.received.emplace_back(1.0F);
    if (!is_small(change.answered.back())) return std::nullopt;
  }
  return change;
}

void Solver::find_matter(const Grains& grains, const Quality& quality, const transport::Effort& effort) {
  if (matter_ && matter_->grains == grains && matter_->walks >= quality.walks) return;
  auto matter = std::make_shared<Matter>();
  matter->grains = grains;
  matter->walks = quality.walks;
  if (matter_ && matter_->grains.kinds == grains.kinds && matter_->walks >= quality.walks) {
    matter->walks = matter_->walks;
    matter->kinds = matter_->kinds;
  } else {
    matter->kinds = kinds_of(grains, quality.walks, effort);
    ++parts_.tables;
  }
  matter_ = std::move(matter);
}

const Space& Solver::space() {
  if (!matter_->space) matter_->space.emplace(matter_->grains, matter_->kinds);
  return *matter_->space;
}

void Solver::find_ways(const Quality& quality, const transport::Effort& effort) {
  if (ways_ && serves(ways_->matter, ways_->rays, quality.rays, quality)) return;
  Ways ways{matter_, quality.rays, {}, {}, {}};
  ways.links = find_links(space(), {quality.rays, quality.wall_rays}, glm::vec3(1.0F), ways.world,
                          transport::part_of(effort, 0.0, 0.8));
  ways.behind = find_behind(space(), quality.seen_rays, transport::part_of(effort, 0.8, 1.0));
  ways_ = std::move(ways);
  ++parts_.links;
}

const Solver::Source& Solver::find_source(Heap light, const Quality& quality, const transport::Effort& effort) {
  const auto same =
      std::find_if(sources_.begin(), sources_.end(), [&](const Source& source) { return source.light == light; });
  if (same != sources_.end() && serves(same->matter, same->rays, quality.light_rays, quality)) return *same;
  Source source{std::move(light), matter_, quality.light_rays, {}};
  const std::size_t count = space().size();
  source.lit = {Field(count), Field(count)};
  add_direct_light(space(), source.light, quality.light_rays, source.lit.direct, source.lit.crossed, effort);
  ++parts_.sources;
  if (same == sources_.end()) return sources_.emplace_back(std::move(source));
  return *same = std::move(source);
}

WorldLit Solver::find_direct(const Heap& heap, const Quality& quality, const transport::Effort& effort) {
  std::vector<Heap> lights;
  for (const scene::Light& light : heap.lights) lights.push_back({{}, heap.anchor, {light}, {}});
  if (heap.world.image && heap.world.shines()) lights.push_back({{}, heap.anchor, {}, heap.world});
  std::erase_if(sources_, [&](const Source& source) {
    return std::find(lights.begin(), lights.end(), source.light) == lights.end();
  });
  const std::size_t count = ways_->world.direct.size();
  WorldLit sum{Field(count), Field(count)};
  const auto add_lit = [&](WorldLit lit, const Matter& with, const glm::vec3& by) {
    if (with.grains != matter_->grains) {
      const std::optional<Change> change = change_from(with);
      scale(lit.direct, change->answered);
      scale(lit.crossed, change->answered);
    }
    add(sum.direct, lit.direct, by);
    add(sum.crossed, lit.crossed, by);
  };
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const auto all = static_cast<double>(lights.size());
    const transport::Effort part =
        transport::part_of(effort, static_cast<double>(i) / all, static_cast<double>(i + 1) / all);
    const Source& source = find_source(lights[i], quality, part);
    add_lit(source.lit, *source.matter, glm::vec3(1.0F));
  }
  lights_crossed_ = sum.crossed;
  if (!heap.world.image) add_lit(ways_->world, *ways_->matter, glm::vec3(heap.world.radiance));
  return sum;
}

HeapLight Solver::solve(const Heap& heap, const Quality& quality, const transport::Effort& effort) {
  const auto started = std::chrono::steady_clock::now();
  find_matter(heap.grains, quality, transport::part_of(effort, 0.0, 0.1));
  find_ways(quality, transport::part_of(effort, 0.1, 0.5));
  const WorldLit lit = find_direct(heap, quality, transport::part_of(effort, 0.5, 0.7));
  const Links* links = &ways_->links;
  const Links* behind = &ways_->behind;
  Links scaled, scaled_behind;
  if (ways_->matter->grains != matter_->grains) {
    const std::optional<Change> change = change_from(*ways_->matter);
    scaled = *links;
    scale(scaled, &change->answered, change->received);
    scaled_behind = *behind;
    scale(scaled_behind, nullptr, change->received);
    links = &scaled;
    behind = &scaled_behind;
  }
  Field first(lit.direct.size());
  for (std::size_t i = 0; i < first.size(); ++i) first[i] = lit.direct[i] + lit.crossed[i];
  Solved solved =
      heap::solve(*links, first, resized(sent_, first.size()), quality.tolerance, transport::part_of(effort, 0.7, 1.0));
  ++parts_.solutions;
  HeapLight light;
  light.kinds = matter_->kinds;
  light.crossed = lights_crossed_;
  light.patches = ways_->matter->space->patches();
  light.answer.resize(first.size());
  for (std::size_t i = 0; i < first.size(); ++i) light.answer[i] = solved.sent[i] - lit.direct[i];
  behind->gather(solved.sent, light.behind, effort);
  sent_ = solved.sent;
  light.sent = std::move(solved.sent);
  light.links = links->links.size();
  light.steps = solved.steps;
  light.residual = solved.residual;
  light.parts = parts_;
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - started;
  light.milliseconds = took.count();
  return light;
}

}  // namespace mesograin::heap
