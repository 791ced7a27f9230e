// Many walks for each interval of cosines; of them as many are kept as the table has room for, so that each stands for
// as much light: rare heavy outcomes would be noise in every grain of the heap.
#include "heap/grain_table.h"

#include <algorithm>
#include <cmath>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <list>
#include <mutex>
#include <numeric>

#include "physics/physics.h"
#include "transport/directions.h"

namespace mesograin::heap {
namespace {

float mean(const glm::vec3& colour) { return (colour.r + colour.g + colour.b) / 3.0F; }

glm::dvec3 straight_through(const glm::vec3& sigma_t, double mu) { return glm::exp(-2.0 * mu * glm::dvec3(sigma_t)); }

/// 1 - e^-x, exact where it is small.
glm::dvec3 met_at(const glm::vec3& sigma_t, double mu) {
  const glm::dvec3 depth = 2.0 * mu * glm::dvec3(sigma_t);
  return -glm::dvec3(std::expm1(-depth.r), std::expm1(-depth.g), std::expm1(-depth.b));
}

/// Of light from everywhere, what enters a sphere whose surface refracts and meets something before it leaves, times
/// the albedo: inside it comes to the surface at the same angle ever again, and is reflected as often as outside.
glm::dvec3 scattered_once(const Optics& optics) {
  constexpr int steps = 256;
  glm::dvec3 sum(0.0);
  for (int step = 0; step < steps; ++step) {
    const double mu = std::sqrt((step + 0.5) / steps);
    const double reflected = physics::fresnel_reflectance(mu, optics.eta);
    if (!(reflected < 1.0)) continue;
    const double inside = std::sqrt(std::max(1.0 - (1.0 - mu * mu) / (optics.eta * optics.eta), 0.0));
    const glm::dvec3 met = met_at(glm::vec3(optics.sigma_t), inside);
    sum += (1.0 - reflected) * met / (1.0 - reflected * (1.0 - met));
  }
  return optics.albedo * sum / static_cast<double>(steps);
}

/// How far along a view ray the light was scattered last that is seen, mean of what is sent out evenly inside.
double seen_depth(const glm::vec3& sigma_t, double mu) {
  const double depth = 2.0 * mu * static_cast<double>(mean(sigma_t));
  if (depth < 0.05) return mu * (1.0 - depth / 6.0);
  return 2.0 * mu * (1.0 / depth - 1.0 / std::expm1(depth));
}

/// A subset in which every walk is as likely as it was heavy (systematic resampling: Kitagawa 1996, "Monte Carlo filter
/// and smoother for non-Gaussian nonlinear state space models", appendix), all of the same mean weight.
/// `tried`: how many there were, those that ended inside included.
void resample(const std::vector<Outcome>& walks, int tried, transport::Random& random, std::vector<Outcome>& kept) {
  double all = 0.0;
  for (const Outcome& outcome : walks) all += mean(outcome.weight);
  if (!(all > 0.0)) {
    kept.insert(kept.end(), GrainTable::outcomes, Outcome{{0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, 1.0F}, glm::vec3(0.0F)});
    return;
  }
  const double step = all / GrainTable::outcomes;
  const float each = static_cast<float>(all / tried);
  double next = step * random.uniform();
  double until = 0.0;
  int drawn = 0;
  for (const Outcome& outcome : walks) {
    until += mean(outcome.weight);
    for (; next < until && drawn < GrainTable::outcomes; next += step, ++drawn)
      kept.push_back({outcome.normal, outcome.direction, outcome.weight * (each / mean(outcome.weight)),
                      outcome.refracted, outcome.scattered});
  }
  while (drawn++ < GrainTable::outcomes) kept.push_back(kept.back());
}

/// 0.5, 0.25, 0.75, ...: the bits of `index` mirrored at the point (van der Corput 1935).
float mirrored_bits(std::uint32_t index) {
  float value = 0.0F;
  for (float digit = 0.5F; index != 0U; index >>= 1U, digit *= 0.5F)
    if ((index & 1U) != 0U) value += digit;
  return value;
}

/// Where light leaves that meets what sends it on evenly: of all that is kept one in each of as many parts of the
/// hemisphere, by Hammersley's points (1960; `turn`: of all about the normal). What directions drawn at random are
/// off makes or loses light in a white heap of many grains, 1 % more of it.
Outcome sent_evenly(const Optics& optics, int walk, int walks, float turn, transport::Random& random) {
  const int part = walk * GrainTable::outcomes / walks;
  const float u = (static_cast<float>(part) + random.uniform()) / GrainTable::outcomes;
  const float v = mirrored_bits(static_cast<std::uint32_t>(part)) + random.uniform() / GrainTable::outcomes + turn;
  const glm::vec3 normal(0.0F, 0.0F, 1.0F);
  return {normal, transport::cosine_lobe(normal, u, v), glm::vec3(optics.reflectance)};
}

/// One channel, as if all were like it.
Optics grey(const Optics& optics, int channel) {
  Optics grey = optics;
  grey.reflectance = glm::dvec3(optics.reflectance[channel]);
  grey.sigma_t = glm::dvec3(optics.sigma_t[channel]);
  grey.albedo = glm::dvec3(optics.albedo[channel]);
  return grey;
}

/// Whether light leaves so near where it came in that what is sent out follows what shines on a place: of ten mean free
/// paths to the radius and albedo .999, order 1 alone is 3 % too bright in all that is seen of a heap, of forty 5.
bool is_thick(const Optics& optics) {
  constexpr double least = 8.0;
  const glm::dvec3 reduced = optics.sigma_t * (1.0 - optics.g * optics.albedo);
  return !optics.opaque() && std::max({reduced.r, reduced.g, reduced.b}) >= least;
}

/// What leaves in each interval of cosines, of light from everywhere, and the mean cosines of the normal and of the
/// direction in which it leaves with the way that it came.
struct Flux {
  std::array<glm::dvec3, GrainTable::lobe_nodes> by_cosine{};
  glm::dvec2 along{0.0};

  void add(const Outcome& outcome, const glm::vec3& travelling) {
    constexpr int nodes = GrainTable::lobe_nodes;
    const float leaves = std::clamp(glm::dot(outcome.normal, outcome.direction), 0.0F, 1.0F);
    by_cosine[static_cast<std::size_t>(std::min(static_cast<int>(leaves * nodes), nodes - 1))] +=
        glm::dvec3(outcome.weight);
    along += static_cast<double>(mean(outcome.weight)) *
             glm::dvec2(glm::dot(outcome.normal, travelling), glm::dot(outcome.direction, travelling));
  }

  void add(const Flux& other) {
    for (std::size_t node = 0; node < by_cosine.size(); ++node) by_cosine[node] += other.by_cosine[node];
    along += other.along;
  }

  glm::dvec3 all() const { return std::accumulate(by_cosine.begin(), by_cosine.end(), glm::dvec3(0.0)); }
};

/// Of a sum p of the normal and the direction the mean square is 1, and its mean cosine with the way that light came is
/// to be greatest: M^-1 along, M their means of products.
glm::vec2 seen_by(const glm::dvec2& along) {
  // Sent out evenly, normal . direction is on average two thirds.
  constexpr double between = 2.0 / 3.0;
  const glm::dvec2 best(along.x - between * along.y, along.y - between * along.x);
  const double square = best.x * best.x + best.y * best.y + 2.0 * between * best.x * best.y;
  if (!(square > 0.0)) return {1.0F, 0.0F};
  // A place that faces the viewer, so that two media's numbers are told by the same.
  const double sign = between * best.x + best.y < 0.0 ? -1.0 : 1.0;
  return {best * (sign / std::sqrt(square))};
}

/// Radiance is flux over 2 mu dmu; between the intervals' middles it is linear, and flat beyond the last ones.
std::array<glm::vec3, GrainTable::lobe_nodes> lobe_of(const Flux& flux) {
  constexpr int nodes = GrainTable::lobe_nodes;
  const glm::dvec3 all = flux.all();
  GrainTable::Leaving leaving;
  for (int channel = 0; channel < 3; ++channel)
    for (int node = 0; node < nodes; ++node) {
      const double share = static_cast<double>(2 * node + 1) / (nodes * nodes);
      const auto index = static_cast<std::size_t>(node);
      leaving.lobe[index][channel] =
          all[channel] > 0.0 ? static_cast<float>(flux.by_cosine[index][channel] / all[channel] / share) : 1.0F;
    }
  constexpr int steps = 64 * nodes;
  glm::vec3 exitance(0.0F);
  for (int step = 0; step < steps; ++step) {
    const float mu = (static_cast<float>(step) + 0.5F) / steps;
    exitance += leaving.lobe_at(mu) * (2.0F * mu / steps);
  }
  for (glm::vec3& node : leaving.lobe) node /= exitance;
  return leaving.lobe;
}

bool is_grey(const Optics& optics) {
  return optics.opaque() || (grey(optics, 0).sigma_t == optics.sigma_t && grey(optics, 0).albedo == optics.albedo);
}

}  // namespace

GrainTable::GrainTable(const Optics& optics, Sense sense, const transport::Effort& effort, int walks)
    : walks_(walks),
      fine_(optics.opaque() || is_thick(optics) || (optics.clear() && optics.lens)),
      transparent_(optics.transparent()),
      clear_(optics.clear()),
      turbid_(optics.turbid()),
      sigma_t_(optics.sigma_t) {
  if (clear_) scattered_ = glm::vec3(scattered_once(optics));
  met_ = glm::vec3(optics.met());
  trace(optics, sense, effort);
  // Walks that are shared by channels are noisier in each than its own.
  for (int channel = 0; channel < 3 && !is_grey(optics); ++channel)
    take_albedo(GrainTable(grey(optics, channel), sense, effort, walks), channel);
  if (turbid_) find_responses();
  if (!clear_) return;
  for (const Outcome& outcome : outcomes_)
    if (outcome.scattered) scattered_out_ += outcome.weight / static_cast<float>(outcomes_.size());
}

void GrainTable::find_responses() {
  responses_.resize(entries);
  for (std::size_t i = 0; i < outcomes_.size(); ++i)
    if (const Outcome& of = outcomes_[i]; of.entered())
      responses_[i / outcomes].add(of.weight / static_cast<float>(outcomes), entered_.place(of.normal, of.direction));
  for (const Response& response : responses_) entered_share_ += response.mean / static_cast<float>(entries);
}

void GrainTable::take_albedo(const GrainTable& grey, int channel) {
  for (int entry = 0; entry < entries; ++entry) {
    const auto index = static_cast<std::size_t>(entry);
    const float had = albedos_[index][channel];
    const float factor = had > 0.0F ? grey.albedos_[index][channel] / had : 0.0F;
    albedos_[index][channel] = grey.albedos_[index][channel];
    for (int outcome = 0; outcome < outcomes; ++outcome)
      outcomes_[index * outcomes + static_cast<std::size_t>(outcome)].weight[channel] *= factor;
  }
  albedo_[channel] = grey.albedo_[channel];
  for (std::size_t node = 0; node < lobe_nodes; ++node) {
    leaving_.lobe[node][channel] = grey.leaving_.lobe[node][channel];
    entered_.lobe[node][channel] = grey.entered_.lobe[node][channel];
  }
}

void GrainTable::trace(const Optics& optics, Sense sense, const transport::Effort& effort) {
  std::vector<std::vector<Outcome>> kept(entries);
  std::vector<Flux> leaving(entries);
  std::vector<Flux> entered(entries);
  std::vector<std::vector<Entries::Passage>> passages(entries);
  transport::run_pieces(effort, entries, [&](std::size_t entry) {
    transport::Random of_all(effort.seed, static_cast<std::size_t>(walks_) * entries + entry);
    const float turn = of_all.uniform();
    std::vector<Outcome> walks;
    glm::dvec3 sum(0.0);
    for (int i = 0; i < walks_; ++i) {
      // Numbers of its own, so that one that a slider makes longer moves no other.
      transport::Random random(effort.seed, entry * static_cast<std::size_t>(walks_) + static_cast<std::size_t>(i));
      // Light from everywhere comes in evenly over the squared cosine.
      const float squared = (static_cast<float>(entry) + (static_cast<float>(i) + random.uniform()) / walks_) / entries;
      const float mu = std::sqrt(squared);
      std::optional<Outcome> outcome = optics.surface == Surface::lambert ? sent_evenly(optics, i, walks_, turn, random)
                                                                          : walk(optics, sense, mu, random);
      if (!outcome) continue;
      passages[entry].push_back({mu, *outcome});
      const glm::vec3 travelling(std::sqrt(std::max(0.0F, 1.0F - squared)), 0.0F, -mu);
      leaving[entry].add(*outcome, travelling);
      if (outcome->entered()) entered[entry].add(*outcome, travelling);
      if (transparent_) outcome->weight /= glm::max(glm::vec3(met_at(sigma_t_, mu)), 1e-30F);
      sum += glm::dvec3(outcome->weight);
      walks.push_back(*outcome);
    }
    albedos_[entry] = glm::vec3(sum / static_cast<double>(walks_));
    resample(walks, walks_, of_all, kept[entry]);
  });
  outcomes_.reserve(static_cast<std::size_t>(entries) * outcomes);
  Flux all;
  Flux all_entered;
  for (int entry = 0; entry < entries; ++entry) {
    const auto index = static_cast<std::size_t>(entry);
    outcomes_.insert(outcomes_.end(), kept[index].begin(), kept[index].end());
    all.add(leaving[index]);
    all_entered.add(entered[index]);
  }
  albedo_ = glm::vec3(all.all() / static_cast<double>(walks_ * entries));
  if (!optics.opaque()) {
    std::vector<Entries::Passage> joined;
    for (const std::vector<Entries::Passage>& of : passages) joined.insert(joined.end(), of.begin(), of.end());
    came_in_ = Entries(joined);
  }
  leaving_.lobe = lobe_of(all);
  entered_.lobe = lobe_of(all_entered);
  if (optics.surface == Surface::dielectric && optics.lens) leaving_.by = seen_by(all.along);
  entered_.by = seen_by(all_entered.along);
  if (!transparent_) return;
  constexpr int steps = 64 * lobe_nodes;
  double square = 0.0;
  double all_seen = 0.0;
  for (int step = 0; step < steps; ++step) {
    const float mu = (static_cast<float>(step) + 0.5F) / steps;
    const double depth = seen_depth(sigma_t_, mu);
    const double share = mean(lobe_at(mu)) * mu;
    square += share * (1.0 - 2.0 * depth * mu + depth * depth);
    all_seen += share;
  }
  seen_place_scale_ = static_cast<float>(std::sqrt(all_seen / square));
}

glm::vec3 GrainTable::seen_place(const glm::vec3& normal, const glm::vec3& towards) const {
  if (!transparent_) return leaving_.place(normal, towards);
  const float mu = std::clamp(glm::dot(normal, towards), 0.0F, 1.0F);
  return seen_place_scale_ * (normal - static_cast<float>(seen_depth(sigma_t_, mu)) * towards);
}

Outcome GrainTable::draw(float mu, float choice) const {
  const int entry = std::min(static_cast<int>(mu * mu * entries), entries - 1);
  const int index = std::min(static_cast<int>(choice * outcomes), outcomes - 1);
  Outcome outcome = outcomes_[static_cast<std::size_t>(entry) * outcomes + static_cast<std::size_t>(index)];
  if (transparent_) outcome.weight *= glm::vec3(met_at(sigma_t_, mu));
  return outcome;
}

glm::vec3 GrainTable::Leaving::lobe_at(float mu) const {
  const float node = std::clamp(mu * lobe_nodes - 0.5F, 0.0F, static_cast<float>(lobe_nodes - 1));
  const auto below = static_cast<std::size_t>(std::min(node, static_cast<float>(lobe_nodes - 2)));
  return glm::mix(lobe[below], lobe[below + 1], node - static_cast<float>(below));
}

glm::vec3 GrainTable::crossing(float mu) const {
  return transparent_ ? glm::vec3(straight_through(sigma_t_, mu)) : glm::vec3(0.0F);
}

std::shared_ptr<const GrainTable> grain_table(const Optics& optics, Sense sense, const transport::Effort& effort,
                                              int walks, std::size_t number) {
  struct Entry {
    Optics optics;
    Sense sense;
    int walks;
    std::size_t number;
    std::shared_ptr<const GrainTable> table;
  };
  constexpr std::uint64_t first_seed = 0x6ab5cdU;  // more than an effort's, whose streams are those of rays
  constexpr std::size_t most_gone = 64;            // of 300 KiB, that nobody has any more
  static std::mutex mutex;
  static std::list<Entry> kept;  // the last used first
  // Only there do the two differ.
  if (optics.surface != Surface::lambert_refracted) sense = Sense::from_light;
  {
    const std::lock_guard lock(mutex);
    for (auto entry = kept.begin(); entry != kept.end(); ++entry)
      if (entry->optics == optics && entry->sense == sense && entry->walks == walks && entry->number == number) {
        kept.splice(kept.begin(), kept, entry);
        return entry->table;
      }
  }
  transport::Effort own = effort;
  own.seed += first_seed + number;
  auto table = std::make_shared<const GrainTable>(optics, sense, own, walks);
  const std::lock_guard lock(mutex);
  kept.push_front({optics, sense, walks, number, table});
  std::size_t gone = 0;
  kept.remove_if([&gone](const Entry& entry) {
    return entry.table.use_count() == 1 && (entry.walks < GrainTable::outcomes || ++gone > most_gone);
  });
  return table;
}

}  // namespace mesograin::heap
