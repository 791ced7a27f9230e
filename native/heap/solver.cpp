// Tables follow from materials, links from places, what lights do from both; each is found again only where what it
// follows from has changed. A quick solution at other materials takes the links as they were, and scales them.
#include "heap/solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <utility>

#include "heap/direct_light.h"
#include "heap/moves.h"
#include "heap/solve.h"

namespace mesograin::heap {
namespace {

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

glm::vec3 quotient(const glm::vec3& of, const glm::vec3& by) {
  glm::vec3 result(0.0F);
  for (int channel = 0; channel < 3; ++channel)
    if (by[channel] > 0.0F) result[channel] = of[channel] / by[channel];
  return result;
}

/// What was scattered over the share of light that is: of what lights send, that of the grains' tables.
void scale_scattered(Field& field, const Seats& seats, const Grains& grains, const std::vector<Kind>& kinds) {
  for (std::size_t i = 0; i < seats.answering(); ++i) {
    const Kind& kind = kinds[grains.grains[seats.number(i)].kind];
    field[i] = field[i] * quotient(glm::vec3(1.0F), kind.from_light->scattered());
  }
}

/// The same of what others send, and the world: how many of a grain's rays were scattered is none of the light's doing.
void scale_scattered(Field& field, const Links& links, const Grains& grains, const std::vector<Kind>& kinds) {
  for (std::size_t i = 0; i < links.seats->answering(); ++i) {
    const GrainTable& table = *kinds[grains.grains[links.seats->number(i)].kind].from_viewer;
    field[i] = field[i] * quotient(table.scattered_out(), table.scattered() * links.scattered[i].share);
  }
}

void add(Field& sum, const Field& of, const glm::vec3& by) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = sum[i] + of[i] * by;
}

/// Of all that answer; `change`: of what each sends out; or null.
void add(Field& sum, const Field& of, const Seats& seats, const Change* change, const glm::vec3& by) {
  if (change == nullptr) return add(sum, of, by);
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = sum[i] + of[i] * (by * change->answered[seats.number(i)]);
}

// Of grains, that may have moved where seats are kept.
constexpr std::size_t most_moved_of = 20;

/// Whether seats found before are these grains', too: all that share them are where they were, and nearly all others.
bool still_seated(const Seats& seats, const std::vector<Grain>& before, const std::vector<Grain>& now) {
  if (before.size() != now.size()) return false;
  std::size_t moved = 0;
  for (std::uint32_t i = 0; i < now.size(); ++i) {
    if (before[i].middle == now[i].middle && before[i].radius == now[i].radius) continue;
    if (seats.shares(i) || ++moved > now.size() / most_moved_of) return false;
  }
  return true;
}

/// What is seen of grains, if any is something else to others; else nothing.
std::vector<Kind> seen_of(std::vector<Optics> kinds, int walks, const transport::Effort& effort) {
  if (std::none_of(kinds.begin(), kinds.end(), std::mem_fn(&Optics::veiled))) return {};
  std::transform(kinds.begin(), kinds.end(), kinds.begin(), seen_among_others);
  return kinds_of(kinds, walks, effort);
}

/// How many cells of Seats below the surface grains begin to share: farther than light goes on one way.
int cells_below(const Grains& grains, const std::vector<Kind>& kinds) {
  std::vector<std::size_t> counts(kinds.size(), 0);
  for (const Grain& grain : grains.grains) ++counts[grain.kind];
  double met = 0.0;
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    const glm::vec3& of = kinds[kind].from_light->met();
    met += static_cast<double>(counts[kind]) * static_cast<double>(of.r + of.g + of.b) / 3.0;
  }
  met /= static_cast<double>(std::max(grains.grains.size(), std::size_t{1}));
  constexpr double fewest = 1.0;
  constexpr double most = 64.0;
  return static_cast<int>(std::ceil(std::clamp(0.9 / std::max(met, 1e-6), fewest, most)));
}

/// Whether no grain sends out nearly all that comes to it.
bool all_absorb(const std::vector<Kind>& kinds) {
  constexpr float most = 0.9F;
  return std::all_of(kinds.begin(), kinds.end(), [](const Kind& kind) {
    const glm::vec3& albedo = kind.from_viewer->albedo();
    return std::max({albedo.r, albedo.g, albedo.b}) <= most;
  });
}

/// What was sent by grains in other seats.
Field carried(const Field& sent, const Seats& from, const Space& to) {
  Coefficients mean;
  for (const Coefficients& one : sent) mean = mean + one * glm::vec3(1.0F / static_cast<float>(sent.size()));
  Field answers(to.size(), mean);
  for (std::size_t i = 0; i < to.seats()->answering(); ++i)
    if (const std::uint32_t number = to.seats()->number(i); number < from.grains()) answers[i] = from.of(sent, number);
  const std::size_t nodes = to.patches().nodes().size();
  if (sent.size() - from.told() == nodes)
    std::copy(sent.end() - static_cast<std::ptrdiff_t>(nodes), sent.end(),
              answers.end() - static_cast<std::ptrdiff_t>(nodes));
  return to.seats()->told(std::move(answers));
}

/// The numbers of the first grains as they were, and their mean for those that came.
Field resized(Field field, std::size_t count) {
  if (field.empty() || field.size() > 2 * count || count > 2 * field.size()) return {};
  Coefficients mean;
  for (const Coefficients& one : field) mean = mean + one;
  field.resize(count, mean * glm::vec3(1.0F / static_cast<float>(field.size())));
  return field;
}

}  // namespace

bool Solver::serves(const std::shared_ptr<const Matter>& other, int rays, int wanted, const Quality& quality) const {
  if (rays < wanted || other->seats != matter_->seats) return false;
  if (other->grains == matter_->grains && other->walks >= quality.walks) return true;
  return quality.quick && same_places(other->grains, matter_->grains) && other->grains.panes == matter_->grains.panes &&
         change_from(*other);
}

// The mean of light from everywhere tells it well enough until it is found anew.
glm::vec3 Solver::more_entered(const Matter& other, std::size_t seat) const {
  if (&other == matter_.get()) return glm::vec3(1.0F);
  const std::size_t number = other.space->seats()->number(seat);
  return ratio(matter_->kinds[matter_->grains.grains[number].kind].from_light->entered_share(),
               other.kinds[other.grains.grains[number].kind].from_light->entered_share());
}

std::optional<Change> Solver::change_from(const Matter& other) const {
  Change change;
  const std::size_t count = matter_->grains.grains.size();
  change.answered.reserve(count);
  change.received.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Kind& now = matter_->kinds[matter_->grains.grains[i].kind];
    const Kind& then = other.kinds[other.grains.grains[i].kind];
    if (now.from_light->is_turbid() != then.from_light->is_turbid()) return std::nullopt;
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

void Solver::take_seats(const Matter& of, Matter& by) const {
  if (by.seats || !of.seats || of.cells_below != by.cells_below) return;
  if (of.eights && !by.eights) return;
  if (!still_seated(*of.seats, *of.seated, by.grains.grains)) return;
  by.eights = of.eights;
  by.seats = of.seats;
  by.seated = of.seated;
}

void Solver::find_matter(const std::shared_ptr<const Heap>& heap, const Quality& quality,
                         const transport::Effort& effort) {
  const Grains& grains = heap->grains;
  if (matter_ && matter_->grains == grains && matter_->walks >= quality.walks) return;
  auto matter = std::make_shared<Matter>(std::shared_ptr<const Grains>(heap, &grains));
  matter->walks = quality.walks;
  if (matter_ && matter_->space && same_places(matter_->grains, grains))
    matter->neighbourhood = matter_->space->neighbourhood();
  if (matter_ && matter_->grains.kinds == grains.kinds && matter_->walks >= quality.walks) {
    matter->walks = matter_->walks;
    matter->kinds = matter_->kinds;
    matter->seen = matter_->seen;
  } else {
    matter->kinds = kinds_of(of_others(grains.kinds), quality.walks, effort);
    matter->seen = seen_of(grains.kinds, quality.walks, effort);
    ++parts_.tables;
  }
  if (grains.grains.size() >= (any_clear(matter->kinds) ? quality.clear_shared_from : quality.shared_from)) {
    matter->cells_below = cells_below(grains, matter->kinds);
    matter->eights = all_absorb(matter->kinds);
    if (traced_) take_seats(*traced_->matter, *matter);
    if (matter_) take_seats(*matter_, *matter);
  }
  matter_ = std::move(matter);
}

const Space& Solver::space() {
  if (matter_->space) return *matter_->space;
  Space space(matter_->grains, matter_->kinds, matter_->seats, patches_about(matter_->grains), matter_->neighbourhood);
  if (matter_->cells_below > 0 && !matter_->seats) {
    constexpr float far = 12.0F;  // in radii
    const std::vector<Grain>& grains = matter_->grains.grains;
    const auto open = [&](std::uint32_t grain) { return space.is_open(grain, far * grains[grain].radius); };
    // A cell more tells what is seen still closer, where there is memory for it.
    constexpr std::size_t most_own = 250'000;
    auto seats = std::make_shared<const Seats>(grains, matter_->cells_below + 1, matter_->eights, open);
    if (seats->own() > most_own)
      seats = std::make_shared<const Seats>(grains, matter_->cells_below, matter_->eights, open);
    matter_->seats = std::move(seats);
    matter_->seated = std::shared_ptr<const std::vector<Grain>>(matter_->held, &grains);
    space.seat(matter_->seats);
  }
  return matter_->space.emplace(std::move(space));
}

Deep Solver::find_deep(const transport::Effort& effort) {
  // What lies deeper has a share in what is seen, but none of its noise.
  constexpr int ways = 2;
  // Fewer have few that lie deep.
  constexpr std::size_t many = 5000;
  return matter_->grains.grains.size() < many ? nullptr : heap::find_deep(space(), ways, effort);
}

bool Solver::is_refined(const Matter& other) {
  if (!space().seats()->shared() || other.seats != matter_->seats) return false;
  const auto plain = [](const std::vector<Kind>& kinds) {
    return std::none_of(kinds.begin(), kinds.end(),
                        [](const Kind& kind) { return kind.from_viewer->is_clear() || kind.from_viewer->is_fine(); });
  };
  // Were this given up, links of two materials would be taken for those of one.
  return plain(matter_->kinds) && other.grains == matter_->grains;
}

void Solver::find_ways(const Quality& quality, const transport::Effort& effort) {
  if (traced_ && serves(traced_->matter, traced_->rays.of_grain, quality.rays, quality)) return;
  constexpr glm::vec3 radiance(1.0F);
  if (traced_ && traced_->rays.of_grain >= quality.rays)
    if (const std::optional<Moves> moves = moves_from(*traced_->matter)) {
      parts_.renewed += renew(space(), *moves, traced_->rays, traced_->rays_through, radiance, traced_->ways, effort);
      traced_->matter = matter_;
      return;
    }
  Traced traced{matter_, {quality.rays, quality.wall_rays}, {quality.seen_rays, 0}, {}};
  traced.rays.own = space().seats()->own();
  traced.rays.of_sharing = quality.sharing_rays;
  if (!space().seats()->shared() && quality.rays > quality.deep_rays) {
    traced.rays.deep = traced.rays_through.deep = find_deep(transport::part_of(effort, 0.0, 0.1));
    traced.rays.of_deep = traced.rays_through.of_deep = quality.deep_rays;
  }
  const bool refines = traced_ && is_refined(*traced_->matter);
  heap::find_ways(space(), traced.rays, traced.rays_through, radiance, refines ? traced_->ways : traced.ways,
                  transport::part_of(effort, 0.1, 1.0));
  if (refines) traced.ways = std::move(traced_->ways);
  traced_ = std::move(traced);
  ++parts_.links;
}

std::optional<Moves> Solver::moves_from(const Matter& other) {
  const bool same_tables =
      std::equal(other.kinds.begin(), other.kinds.end(), matter_->kinds.begin(), matter_->kinds.end(),
                 [](const Kind& one, const Kind& of_other) {
                   return one.from_light == of_other.from_light && one.from_viewer == of_other.from_viewer;
                 });
  if (!same_tables || other.seats != matter_->seats) return std::nullopt;
  std::optional<Moves> moves = Moves::between(other.grains, matter_->grains);
  // Where there are walls, what is known of them must be told by the same numbers.
  if (moves && !(other.space->patches() == space().patches())) return std::nullopt;
  return moves;
}

const Solver::Source& Solver::find_source(Heap light, const Quality& quality, const transport::Effort& effort) {
  const auto same =
      std::find_if(sources_.begin(), sources_.end(), [&](const Source& source) { return source.light == light; });
  if (same != sources_.end() && serves(same->matter, same->rays.of_grain, quality.light_rays, quality)) return *same;
  Source source{std::move(light), matter_, {quality.light_rays, quality.light_rays}, {}};
  source.rays.own = traced_->rays.own;
  source.rays.of_sharing = quality.sharing_rays;
  if (traced_->rays.deep && quality.light_rays > quality.deep_rays) {
    source.rays.deep = traced_->rays.deep;
    source.rays.of_deep = quality.deep_rays;
  }
  std::optional<Moves> moves;
  if (same != sources_.end() && same->rays.of_grain >= quality.light_rays) moves = moves_from(*same->matter);
  const bool refines = same != sources_.end() && !moves && is_refined(*same->matter);
  if (moves) {
    source.rays = same->rays;
    source.lit = same->lit;
  } else {
    ++parts_.sources;
  }
  if (!moves && !refines) {
    const std::size_t count = space().size();
    source.lit = {Field(count), Field(count), Field(space().any_clear() ? count : 0), {}};
  }
  find_direct_light(space(), source.light, source.rays, moves ? &*moves : nullptr, refines ? same->lit : source.lit,
                    effort);
  if (refines) source.lit = std::move(same->lit);
  if (same == sources_.end()) return sources_.emplace_back(std::move(source));
  return *same = std::move(source);
}

Solver::Direct Solver::find_direct(const Heap& heap, const Quality& quality, const transport::Effort& effort) {
  std::vector<Heap> lights;
  for (const scene::Light& light : heap.lights) lights.push_back({{}, heap.anchor, {light}, {}});
  if (heap.world.image && heap.world.shines()) lights.push_back({{}, heap.anchor, {}, heap.world});
  std::erase_if(sources_, [&](const Source& source) {
    return std::find(lights.begin(), lights.end(), source.light) == lights.end();
  });
  const std::size_t count = traced_->ways.world.direct.size();
  Lit sum{Field(count), Field(count), Field(traced_->ways.world.scattered.size()),
          PackedField(traced_->ways.world.entered.size())};
  const auto add_lit = [&](const Lit& lit, const Matter& with, const glm::vec3& by) {
    std::optional<Change> change;
    if (with.grains != matter_->grains) change = change_from(with);
    add(sum.direct, lit.direct, *with.space->seats(), change ? &*change : nullptr, by);
    add(sum.crossed, lit.crossed, *with.space->seats(), change ? &*change : nullptr, by);
    const std::size_t entered = std::min(sum.entered.size(), lit.entered.size());
    for (std::size_t i = 0; i < entered; ++i)
      sum.entered[i] =
          PackedCoefficients(sum.entered[i].whole() + lit.entered[i].whole() * (by * more_entered(with, i)));
  };
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const auto all = static_cast<double>(lights.size());
    const transport::Effort part =
        transport::part_of(effort, static_cast<double>(i) / all, static_cast<double>(i + 1) / all);
    const Source& source = find_source(lights[i], quality, part);
    const Matter& matter = *source.matter;
    add_lit(source.lit, matter, glm::vec3(1.0F));
    if (source.lit.scattered.empty()) continue;
    Field scattered = source.lit.scattered;
    scale_scattered(scattered, *matter.space->seats(), matter.grains, matter.kinds);
    add(sum.scattered, scattered, glm::vec3(1.0F));
  }
  const Seats& seats = *traced_->ways.links.seats;
  Field lights_crossed = seats.told(sum.crossed);
  if (!heap.world.image) {
    add_lit(traced_->ways.world, *traced_->matter, glm::vec3(heap.world.radiance));
    Field scattered = traced_->ways.world.scattered;
    if (!scattered.empty())
      scale_scattered(scattered, traced_->ways.links, traced_->matter->grains, traced_->matter->kinds);
    add(sum.scattered, scattered, glm::vec3(heap.world.radiance));
  }
  const auto told = [&](Field& field) { return field.empty() ? Field() : seats.told(std::move(field)); };
  return {{told(sum.direct), told(sum.crossed), told(sum.scattered), std::move(sum.entered)},
          std::move(lights_crossed)};
}

Quality Solver::within_memory(const Quality& quality) {
  const std::size_t grains = matter_->grains.grains.size();
  if (matter_->cells_below == 0) return affordable(quality, grains);
  if (quality.quick && traced_ && serves(traced_->matter, traced_->rays.of_grain, quality.rays, quality))
    return quality;
  const Seats& seats = *space().seats();
  if (!seats.shared()) return affordable(quality, grains);
  return affordable(quality, seats.own(), seats.answering() - seats.own());
}

Field Solver::guess() const {
  const Space& space = *traced_->matter->space;
  if (!sent_seats_ || sent_seats_ == space.seats() || (!sent_seats_->shared() && !space.seats()->shared()))
    return resized(sent_, space.size() - space.seats()->answering() + space.seats()->told());
  return carried(sent_, *sent_seats_, space);
}

void Solver::show_seen(const Heap& heap, HeapLight& light, const transport::Effort& effort) const {
  Space space(matter_->grains, matter_->kinds, light.seats, light.patches, light.neighbourhood);
  space.answer_as(matter_->seen);
  Ways ways;
  heap::find_ways(space, traced_->rays, {}, glm::vec3(1.0F), ways, effort);
  if (!traced_->ways.links.fine.empty()) ways.links.fine.resize(space.size(), false);  // others' are told so
  Field answer;
  ways.links.gather(light.sent, answer, effort);
  const glm::vec3 world = heap.world.image ? glm::vec3(0.0F) : glm::vec3(heap.world.radiance);
  // What has no seat of its own lies too deep to be seen.
  for (std::size_t seat = 0; seat < light.seats->own(); ++seat)
    if (heap.grains.kinds[heap.grains.grains[light.seats->number(seat)].kind].veiled())
      light.answer[seat] = answer[seat] + light.crossed[seat] + ways.world.crossed[seat] * world;
  light.seen_kinds = matter_->seen;
}

HeapLight Solver::solve(const std::shared_ptr<const Heap>& shared, const Quality& given,
                        const transport::Effort& effort, const MakeSums& make_sums) {
  const Heap& heap = *shared;
  const auto started = std::chrono::steady_clock::now();
  const std::size_t renewed_before = parts_.renewed;
  find_matter(shared, given, transport::part_of(effort, 0.0, 0.1));
  const Quality quality = within_memory(given);
  find_ways(quality, transport::part_of(effort, 0.1, 0.5));
  auto [lit, lights_crossed] = find_direct(heap, quality, transport::part_of(effort, 0.5, 0.7));
  std::optional<Change> change;
  if (traced_->matter->grains != matter_->grains) change = change_from(*traced_->matter);
  Field first = std::move(lit.crossed);
  for (std::size_t i = 0; i < first.size(); ++i) first[i] = lit.direct[i] + first[i];
  if (heap.straight_elsewhere) lit.direct = first;
  // Where a few grains have moved, what the solution before has left everywhere else is none of their doing.
  const bool few_moved = parts_.renewed != renewed_before && left_.size() == first.size();
  constexpr float left_of_moves = 0.02F;
  if (few_moved) add(first, left_, glm::vec3(-1.0F));
  Solved solved = heap::solve(traced_->ways.links, change ? &*change : nullptr, first, guess(),
                              {quality.tolerance, few_moved ? left_of_moves : 1.0F},
                              transport::part_of(effort, 0.7, 0.9), make_sums);
  if (few_moved) add(solved.left, left_, glm::vec3(1.0F));
  left_ = std::move(solved.left);
  ++parts_.solutions;
  HeapLight light;
  light.kinds = matter_->kinds;
  light.crossed = std::move(lights_crossed);
  light.seats = traced_->ways.links.seats;
  light.patches = traced_->matter->space->patches();
  light.neighbourhood = traced_->matter->space->neighbourhood();
  first = {};
  light.answer = std::move(lit.direct);
  for (std::size_t i = 0; i < light.answer.size(); ++i) light.answer[i] = solved.sent[i] - light.answer[i];
  if (change)
    change->answered.clear();  // no grain answers what is seen behind it, nor is a share of light more or less
  if (!lit.scattered.empty()) {
    Field answer;
    traced_->ways.links.gather_scattered(solved.sent, answer, effort, change ? &*change : nullptr);
    scale_scattered(answer, traced_->ways.links, traced_->matter->grains, traced_->matter->kinds);
    light.scattered_answer = light.seats->told(std::move(answer));
    light.scattered = lit.scattered;
    add(light.scattered, light.scattered_answer, glm::vec3(1.0F));
  }
  light.entered = std::move(lit.entered);
  light.open = traced_->ways.links.open;
  light.open.resize(light.seats->own());
  for (std::size_t i = 0; i < light.open.size(); ++i)
    if (matter_->kinds[heap.grains.grains[light.seats->number(i)].kind].from_viewer->crossing(0.0F) != glm::vec3(0.0F))
      light.open[i] = traced_->ways.behind.open[i];
  if (heap.straight_elsewhere)
    light.behind.assign(traced_->ways.behind.of.size(), {});
  else
    traced_->ways.behind.gather(solved.sent, light.behind, effort, change ? &*change : nullptr);
  sent_ = light.sent = SharedField(std::move(solved.sent));
  sent_seats_ = light.seats;
  if (!matter_->seen.empty()) show_seen(heap, light, transport::part_of(effort, 0.9, 1.0));
  light.links = traced_->ways.links.count();
  light.steps = solved.steps;
  light.residual = solved.residual;
  light.summed_on_device = solved.summed_on_device;
  light.parts = parts_;
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - started;
  light.milliseconds = took.count();
  return light;
}

}  // namespace mesograin::heap
