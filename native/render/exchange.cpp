// Gathers a view's grains and walls, has the exchange between them solved, and packs the answer.
#include "render/exchange.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "heap/changed_light.h"
#include "heap/moved_light.h"
#include "heap/scaled_light.h"

namespace mesograin::render {
namespace {

/// What the exchange takes of a mesh for a grain.
struct Shape {
  bool grain;
  double radius_over_reach;  // of the sphere of its area
  double roundness;

  double thickness_over_reach() const { return radius_over_reach * std::sqrt(roundness); }
};

// A ground, a wall or a bowl encloses little for its area (the isoperimetric quotient; a sphere's is 1, a cube's .52).
constexpr double least_roundness = 0.02;

// What such a one of glass is among grains, over its reach: a jar holds others, and no ball of its area stands where it
// does. It is looked into as a grain, and is a pane to what they send each other.
constexpr float pane_over_reach = 1e-6F;

// Of a mesh that stands for a ball.
constexpr double roundness_of_balls = 0.95;

// Of one that refracts as a ball does; what is less round is a crystal.
constexpr double roundness_of_lenses = 0.7;

/// `linear`: from the mesh's own space to one in which no point is farther from the middle than `reach`.
Shape shape_of(const scene::Mesh& mesh, const glm::dmat3& linear, double reach) {
  double area = 0.0;
  double volume = 0.0;
  for (const glm::uvec3& triangle : mesh.triangles()) {
    const glm::dvec3 a = linear * glm::dvec3(mesh.positions()[triangle.x]);
    const glm::dvec3 b = linear * glm::dvec3(mesh.positions()[triangle.y]);
    const glm::dvec3 c = linear * glm::dvec3(mesh.positions()[triangle.z]);
    const glm::dvec3 doubled = glm::cross(b - a, c - a);
    area += 0.5 * glm::length(doubled);
    volume += glm::dot(a, doubled) / 6.0;
  }
  const double roundness = 36.0 * std::numbers::pi * volume * volume / std::max(area * area * area, 1e-300);
  const double radius = std::sqrt(area / (4.0 * std::numbers::pi));
  return {roundness > least_roundness && reach > 0.0, radius / std::max(reach, 1e-300), roundness};
}

/// Whether a draw is as its mesh is, if larger or smaller.
bool keeps_shape(const Draw& draw) {
  constexpr double noticed = 1e-3;
  const glm::dmat3 linear(draw.object_to_world);
  const glm::dmat3 squares = glm::transpose(linear) * linear;
  const double mean = (squares[0][0] + squares[1][1] + squares[2][2]) / 3.0;
  const glm::dmat3 odd = squares - glm::dmat3(mean);
  return std::max({glm::length(odd[0]), glm::length(odd[1]), glm::length(odd[2])}) <= noticed * mean;
}

// Grains within such a step of the radius are of one kind, whose radius is their mean: of sizes that are all alike it
// is theirs, and of others each is at most 9 % thicker or thinner and all together are neither.
constexpr double radii_an_octave = 8.0;

// Of that mean, half a percent from one to the next: grains that come and go do not make another kind of all others.
constexpr double mean_radii_an_octave = 64.0;

double rounded(double radius, double an_octave) {
  return std::exp2(std::round(std::log2(std::max(radius, 1e-300)) * an_octave) / an_octave);
}

// A plain object that is so many times as large as most grains sends out another light at each place: a ground that is
// thick, a spoon.
constexpr float wall_over_grain = 6.0F;

// Mean free paths to its radius from which on light that leaves a part of a grain and enters another leaves it about
// where it has entered.
constexpr double least_thick = 10.0;

// Below it stored transport can be had of any shape.
constexpr double least_not_stored = 13.0;

/// Whether parts of a draw send others light that its model knows nothing of, as a surface does. Of stored transport,
/// which knows it, that is so where a grain is too thick to have any.
bool is_hollow(DeviceCache& cache, const Content& content, const Draw& draw) {
  const scene::ModelTraits& traits = scene::traits_of(draw.look.model);
  return content.instances() == nullptr && (!traits.mesh || content.alone()) && traits.translucent &&
         draw.thickness() >= (traits.mesh ? least_not_stored : least_thick) && cache.hollow(draw.source);
}

glm::dmat4 to_heap_of(const Draw& draw, const glm::dvec3& anchor) {
  glm::dmat4 to_heap = draw.object_to_world;
  to_heap[3] -= glm::dvec4(anchor, 0.0);
  return to_heap;
}

bool is_plain(const scene::Material& material) {
  return material.model == scene::Model::lambert || material.model == scene::Model::conductor;
}

class Gatherer {
 public:
  explicit Gatherer(DeviceCache& cache) : cache_(&cache) {}

  void add(const Content& content) {
    if (const Instances* instances = content.instances())
      for (const InstanceGroup& group : instances->groups())
        for (std::uint32_t i = group.first; i < group.first + group.count; ++i)
          add(shape(*instances->prototypes()[group.prototype].mesh), group.source, instances->ball(i));
    std::vector<float> radii;
    for (const heap::Grain& grain : grains.grains) radii.push_back(grain.radius);
    for (const Draw& draw : content.draws())
      if (may_be_grain(draw)) radii.push_back(radius_of(draw));
    const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
    std::nth_element(radii.begin(), middle, radii.end());
    const float usual = radii.empty() ? std::numeric_limits<float>::infinity() : *middle;
    for (const Draw& draw : content.draws()) {
      const bool large = is_plain(draw.look) && radius_of(draw) > wall_over_grain * usual;
      const glm::vec4 ball(glm::vec3(draw.centre - content.anchor()), static_cast<float>(draw.reach));
      if (is_hollow(*cache_, content, draw))
        add_wall(draw, content.anchor(), true);
      else if (may_be_grain(draw) && !large)
        add(shape(draw), draw.look, ball);
      else if (is_pane(draw))
        add_pane(draw, ball, content.anchor());
      else
        add_wall(draw, content.anchor());
    }
    tell_kinds();
  }

  heap::Grains grains;
  std::vector<RoleInHeap> roles;
  bool balls = true;

 private:
  const Shape& shape(const scene::Mesh& mesh) {
    const auto [shape, added] = shapes_.try_emplace(&mesh);
    if (added) shape->second = shape_of(mesh, glm::dmat3(1.0), mesh.reach());
    return shape->second;
  }

  const Shape& shape(const Draw& draw) {
    if (keeps_shape(draw)) return shape(*draw.source);
    const auto [shape, added] = stretched_.try_emplace(&draw);
    if (added) shape->second = shape_of(*draw.source, glm::dmat3(draw.object_to_world), draw.reach);
    return shape->second;
  }

  static glm::dvec3 radiance_of(const Draw& draw) {
    return draw.look.finish ? draw.look.finish->radiance : glm::dvec3(0.0);
  }

  // What a plain surface that is open encloses depends on where its origin is: a bowl is no ball. What shines is seen
  // to do so where it is a wall.
  bool may_be_grain(const Draw& draw) {
    if (!shape(draw).grain || radiance_of(draw) != glm::dvec3(0.0)) return false;
    return !is_plain(draw.look) || cache_->closed(draw.source);
  }

  // A jar, a bottle, a pane.
  bool is_pane(const Draw& draw) {
    const Shape& of = shape(draw);
    if (of.grain || !(of.roundness > 0.0) || !(draw.reach > 0.0) || !cache_->closed(draw.source)) return false;
    const heap::Optics optics = heap::optics_of(draw.look, draw.reach * of.thickness_over_reach());
    return optics.clear() && optics.scatters_little();
  }

  float radius_of(const Draw& draw) { return static_cast<float>(draw.reach * shape(draw).radius_over_reach); }

  void add(const Shape& shape, const scene::Material& material, const glm::vec4& ball) {
    roles.emplace_back();
    const double radius = ball.w * shape.radius_over_reach;
    if (!shape.grain || !(radius > 0.0)) return;
    roles.back().ball = shape.roundness > roundness_of_balls;
    add_grain(shape, material, ball, static_cast<float>(radius));
  }

  void add_pane(const Draw& draw, const glm::vec4& ball, const glm::dvec3& anchor) {
    roles.emplace_back();
    roles.back().pane = true;
    add_grain(shape(draw), draw.look, ball, pane_over_reach * ball.w);
    grains.panes.push_back({draw.source, to_heap_of(draw, anchor), *roles.back().grain, heap::glass_of(draw.look)});
  }

  /// `radius`: of the sphere that it is to others.
  void add_grain(const Shape& shape, const scene::Material& material, const glm::vec4& ball, float radius) {
    balls = balls && roles.back().ball;
    roles.back().grain = static_cast<std::uint32_t>(grains.grains.size());
    // The mean way of light through a body is 4 V / A, whatever its shape and however it scatters, so that what a grain
    // absorbs is right if the ball's is as long (Blanco and Fournier, "An invariance property of diffusive random
    // walks", 2003, eq. 1). Of balls of one area it goes as the square root of the roundness.
    const double as_thick = ball.w * shape.thickness_over_reach();
    const bool lens = shape.roundness > roundness_of_lenses;
    heap::Optics about = heap::optics_of(material, rounded(as_thick, radii_an_octave));
    about.lens = lens;
    const std::uint32_t of = alike_.kind(about);
    if (of == kinds_.size()) kinds_.push_back({material, lens});
    kinds_[of].logarithms += std::log2(as_thick);
    ++kinds_[of].count;
    grains.grains.push_back({glm::vec3(ball), radius, of, 1.0F});
  }

  /// Grains have been given the number of a Kind each.
  void tell_kinds() {
    std::vector<std::uint32_t> numbers;
    std::vector<double> radii;
    for (const Kind& kind : kinds_) {
      const double mean = std::exp2(kind.logarithms / static_cast<double>(kind.count));
      radii.push_back(rounded(mean, mean_radii_an_octave));
      heap::Optics optics = heap::optics_of(kind.material, radii.back());
      optics.lens = kind.lens;
      numbers.push_back(grains.kind(optics));
    }
    for (heap::Grain& grain : grains.grains) {
      grain.thickness = static_cast<float>(grain.radius / radii[grain.kind]);
      grain.kind = numbers[grain.kind];
    }
  }

  void add_wall(const Draw& draw, const glm::dvec3& anchor, bool hollow = false) {
    roles.emplace_back();
    if (!(draw.reach > 0.0)) return;
    roles.back().wall = static_cast<std::uint32_t>(grains.walls.size());
    roles.back().hollow = hollow;
    const glm::dmat4 to_heap = to_heap_of(draw, anchor);
    const std::uint32_t kind = grains.kind(heap::optics_of(draw.look, rounded(draw.reach, radii_an_octave)));
    const bool has_lights = draw.look.finish && draw.look.finish->faces_are_lights;
    grains.walls.push_back({draw.source, to_heap, kind, glm::vec3(radiance_of(draw)), has_lights, hollow});
  }

  /// Grains that are about as thick.
  struct Kind {
    scene::Material material;
    bool lens;
    double logarithms = 0.0;  ///< the sum of their radii's
    std::size_t count = 0;
  };

  DeviceCache* cache_;
  std::map<const scene::Mesh*, Shape> shapes_;
  std::map<const Draw*, Shape> stretched_;
  heap::Grains alike_;  // whose kinds are those that kinds_ are told by
  std::vector<Kind> kinds_;
};

/// Whether light is followed into any grains of arrays.
bool any_followed(const Content& content) {
  const Instances* instances = content.instances();
  if (instances == nullptr) return false;
  const std::vector<InstanceGroup>& groups = instances->groups();
  return std::any_of(groups.begin(), groups.end(),
                     [](const InstanceGroup& group) { return heap::optics_of(group.source, 1.0).transparent(); });
}

/// Whether any grain that light goes into stands beside something.
bool beside_others(const heap::Grains& grains) {
  return grains.grains.size() + grains.walls.size() > 1 &&
         std::any_of(grains.grains.begin(), grains.grains.end(),
                     [&](const heap::Grain& grain) { return !grains.kinds[grain.kind].opaque(); });
}

/// Whether any single draw may be such a grain.
bool any_translucent(const Content& content) {
  return std::any_of(content.draws().begin(), content.draws().end(),
                     [](const Draw& draw) { return !is_plain(draw.look); });
}

// A lamp so many radii away or nearer lights a spot of an opaque grain, of which few numbers tell nothing.
constexpr float spot_radii = 6.0F;

/// Of grains, which are opaque and have a lamp close by; empty: none has.
std::vector<bool> about_lamps(const heap::Heap& heap) {
  const std::vector<heap::Optics>& kinds = heap.grains.kinds;
  if (std::none_of(kinds.begin(), kinds.end(), std::mem_fn(&heap::Optics::opaque))) return {};
  std::vector<glm::vec3> lamps;
  for (const scene::Light& light : heap.lights)
    if (const std::optional<glm::dvec3> place = scene::place(light)) lamps.emplace_back(*place - heap.anchor);
  std::vector<bool> about;
  const std::vector<heap::Grain>& grains = heap.grains.grains;
  for (const glm::vec3& lamp : lamps)
    for (std::size_t i = 0; i < grains.size(); ++i) {
      if (!kinds[grains[i].kind].opaque()) continue;
      const float reach = spot_radii * grains[i].radius;
      if (glm::dot(grains[i].middle - lamp, grains[i].middle - lamp) > reach * reach) continue;
      about.resize(grains.size(), false);
      about[i] = true;
    }
  return about;
}

/// Whether there is anything that could be seen through a clear grain.
bool shows_through(const heap::Grains& grains, const scene::Scene& scene) {
  if (grains.grains.size() + grains.walls.size() > 1 || scene.world.shines()) return true;
  return std::any_of(scene.lights.begin(), scene.lights.end(), [](const scene::Light& light) {
    const auto* sun = std::get_if<scene::DirectionalLight>(&light);
    return sun == nullptr || sun->angle > 0.0;
  });
}

}  // namespace

void Exchange::set(DeviceCache& cache, const Content& content, const scene::Scene& scene) {
  Gatherer gathered(cache);
  const bool arrays = content.instances() != nullptr;
  const bool heaps = scene.exchange == scene::Exchange::heaps;
  const bool exchanges = scene.exchange != scene::Exchange::off;
  if (exchanges ? !heaps || arrays || any_translucent(content) : any_followed(content)) gathered.add(content);
  const bool clear = exchanges && std::any_of(gathered.grains.kinds.begin(), gathered.grains.kinds.end(),
                                              std::mem_fn(&heap::Optics::clear));
  const bool beside = !arrays && beside_others(gathered.grains);
  const bool hollow =
      std::any_of(gathered.grains.walls.begin(), gathered.grains.walls.end(), std::mem_fn(&heap::Wall::hollow));
  // A grain alone is its model's, but for what is seen through it.
  if (heaps && !arrays && !hollow && !beside && !(clear && shows_through(gathered.grains, scene)))
    gathered = Gatherer(cache);
  alike_.clear();
  if (const Instances* instances = content.instances())
    for (const InstanceGroup& group : instances->groups()) alike_.emplace_back(group.first, group.first + group.count);
  const heap::Grains& grains = gathered.grains;
  const bool heaped = arrays && grains.grains.size() > 1;
  follows_ = (heaps || !exchanges) && arrays;
  const bool transparent = std::any_of(grains.kinds.begin(), grains.kinds.end(), std::mem_fn(&heap::Optics::followed));
  const bool follows = follows_ && transparent;
  const bool lit = exchanges ? heaped || beside || clear || !grains.walls.empty() : heaped && follows;
  if ((grains.grains.empty() && !hollow) || !lit) {
    solving_.reset();
    known_.reset();
    told_.reset();
    gather_.reset();
    return;
  }
  const bool followed_paths = std::exchange(follows_paths_, scene.exchange == scene::Exchange::path_traced);
  if (followed_paths != follows_paths_) gather_.reset();
  gathers_ = follows_paths_ || scene.exchange == scene::Exchange::gathered;
  const bool straight_elsewhere = !arrays && !clear && !gathers_;
  heap::Heap heap{std::move(gathered.grains), content.anchor(), scene.lights, scene.world, exchanges,
                  straight_elsewhere};
  about_lamps_ = heaps && arrays ? about_lamps(heap) : std::vector<bool>();
  looks_straight_ = arrays && transparent && scene.exchange == scene::Exchange::order_1;
  shows_more_ = clear || follows || looks_straight_ || !about_lamps_.empty();
  const bool switched = solving_ && solving_->heap().exchanges != exchanges;
  if (switched) known_.reset();
  const bool regrouped = !solving_ || switched || roles_ != gathered.roles;
  if (!regrouped && solving_->heap() == heap) {
    find_gather();
    find_tells_entered();
    count_means();
    return;
  }
  solving_ = heap::Solvers::instance().ask(std::move(heap), solving_, make_sums(summing_));
  roles_ = std::move(gathered.roles);
  balls_ = gathered.balls;
  if (regrouped) gather_.reset();
  if (regrouped || keep_up()) send();
  if (!regrouped) find_gather();
  find_tells_entered();
  count_means();
}

bool Exchange::gathers_all_of(std::size_t number, bool traced) const {
  const std::optional<std::uint32_t>& grain = roles_[number].grain;
  if (!gather_ || !grain) return false;
  if (gather_->sees_into(*grain)) return traced && whole_[number];
  if (!gather_->sees_all(*grain)) return false;
  const heap::Grains& grains = solving_->heap().grains;
  return gathers_ || (follows_ && grains.kinds[grains.grains[*grain].kind].followed());
}

bool Exchange::take_news() {
  if (!solving_) return false;
  heap::News news = solving_->news();
  if (!news.light || (known_ && known_->number == news.number)) return false;
  known_ = Known{news.heap, std::move(news.light), news.number, news.heap};
  keep_up();
  gather_.reset();
  find_gather();
  count_means();
  send();
  find_tells_entered();
  return true;
}

namespace {

/// But for what they are made of.
bool alike(const heap::Grains& a, const heap::Grains& b) {
  return a.grains == b.grains && a.kinds.size() == b.kinds.size() && a.walls == b.walls;
}

/// By how much more shines on the heap of what was before, in each channel; 1 where nothing did.
glm::vec3 growth(const heap::Heap& before, const heap::Heap& now) {
  if (before.lights == now.lights && before.world.radiance == now.world.radiance) return glm::vec3(1.0F);
  const glm::dvec3 was = heap::strength(before);
  const glm::dvec3 is = heap::strength(now);
  glm::vec3 grown(1.0F);
  for (int channel = 0; channel < 3; ++channel)
    if (was[channel] > 0.0) grown[channel] = static_cast<float>(is[channel] / was[channel]);
  return grown;
}

}  // namespace

// Rays that looked for grains where these are no more would begin in some and miss others, a sun that was turned down
// would go on to glare from all grains, and grains of another colour to shine in the old one. Returns whether what is
// known is of other places, lights or materials now.
bool Exchange::keep_up() {
  if (!known_) return false;
  const heap::Grains& before = known_->grains();
  const heap::Grains& now = solving_->heap().grains;
  const bool stay = heap::same_places(before, now);
  // Of more it would be twice in memory.
  constexpr std::size_t most_changed = 300'000;
  const bool changed = before.kinds != now.kinds && alike(before, now) && now.grains.size() <= most_changed;
  const glm::vec3 grown = growth(*known_->heap, solving_->heap());
  constexpr float noticed = 0.01F;
  const bool shines_alike = glm::all(glm::lessThan(glm::abs(grown - 1.0F), glm::vec3(noticed)));
  if (stay && shines_alike && !changed) return false;
  std::optional<heap::HeapLight> light = heap::moved_light(*known_->light, before, now);
  if (!light) return false;
  if (changed) heap::change(*light, before, now);
  if (!shines_alike) heap::scale(*light, grown);
  known_ = Known{solving_->shared_heap(), std::make_shared<const heap::HeapLight>(std::move(*light)), known_->number,
                 known_->lit_by};
  gather_.reset();
  return true;
}

// Of the same grains what was known before is looked at until more is.
void Exchange::find_gather() {
  const bool wanted =
      (gathers_ || shows_more_) && known_ && heap::same_places(known_->grains(), solving_->heap().grains);
  if (!wanted) gather_.reset();
  if (wanted && !gather_)
    gather_ = std::make_shared<const heap::Gather>(
        known_->heap, known_->light, follows_paths_ ? heap::Gather::Ways::whole : heap::Gather::Ways::short_ones);
  // What grains are made of, and lights, are seen to change at once, in the light that others sent before.
  if (wanted && gather_->heap() != solving_->heap() && alike(gather_->heap().grains, solving_->heap().grains))
    gather_ = gather_->among(solving_->shared_heap());
  find_whole();
}

// Numbers tell nothing of what is seen through a clear grain. In a moment they tell what other lights do.
void Exchange::find_tells_entered() {
  tells_entered_.clear();
  if (!any() || !follows_ || !known_ || !told_.tells_entered()) return;
  const heap::Heap& now = solving_->heap();
  const heap::Heap& known = *known_->heap;
  if (now.lights != known_->lit_by->lights || !(now.world == known_->lit_by->world)) return;
  if (now.grains.kinds.size() != known.grains.kinds.size() || now.grains.grains.size() != known.grains.grains.size())
    return;
  const auto is_turbid = [&](const RoleInHeap& role) {
    if (!role.grain) return false;
    const std::uint32_t kind = now.grains.grains[*role.grain].kind;
    return now.grains.kinds[kind].turbid() && known.grains.kinds[kind].turbid();
  };
  for (const auto& [first, end] : alike_)
    tells_entered_.push_back(std::all_of(roles_.begin() + static_cast<std::ptrdiff_t>(first),
                                         roles_.begin() + static_cast<std::ptrdiff_t>(end), is_turbid));
}

// What a clear grain scatters is told by a few numbers: enough of one among many, and too little of one alone, whose
// model knows more. Of a round one that scatters most of what it lets in the model knows what suns and lamps do, which
// a look that is scattered meets by chance; of a crystal it does not.
void Exchange::find_whole() {
  whole_.assign(roles_.size(), false);
  if (!gather_ || !(gathers_ || follows_)) return;
  const heap::Grains& grains = gather_->heap().grains;
  const bool lit = !gather_->heap().lights.empty();
  const auto is_clear = [&](const RoleInHeap& role) {
    if (!role.grain || !gather_->sees_into(*role.grain)) return false;
    const heap::Optics& optics = grains.kinds[grains.grains[*role.grain].kind];
    return optics.clear() && (!lit || !optics.lens || optics.scatters_little());
  };
  for (const auto& [first, end] : alike_) {
    const auto begins = roles_.begin() + static_cast<std::ptrdiff_t>(first);
    const auto ends = roles_.begin() + static_cast<std::ptrdiff_t>(end);
    if (std::all_of(begins, ends, is_clear))
      std::fill(whole_.begin() + static_cast<std::ptrdiff_t>(first), whole_.begin() + static_cast<std::ptrdiff_t>(end),
                true);
  }
}

void Exchange::count_means() {
  means_ = {};
  const heap::Seats* const seats = known_ ? known_->light->seats.get() : nullptr;
  for (std::size_t number = 0; number < roles_.size(); ++number) {
    const std::optional<std::uint32_t>& grain = roles_[number].grain;
    if (!grain) continue;
    if (!gathers_all_of(number, true))
      ++means_.modelled;
    else
      ++(gather_->sees_into(*grain) ? means_.looked_into : means_.walked);
    if (seats != nullptr && *grain < seats->grains() && seats->shares(*grain)) ++means_.sharing;
  }
}

namespace {

Range range_of(const glm::dvec3& colour) {
  return {std::min({colour.r, colour.g, colour.b}), std::max({colour.r, colour.g, colour.b})};
}

Range both(const Range& one, const Range& other) {
  return {std::min(one.least, other.least), std::max(one.most, other.most)};
}

std::vector<Stuff> stuff_of(const heap::Grains& grains) {
  std::vector<bool> used(grains.kinds.size(), false);
  for (const heap::Grain& grain : grains.grains) used[grain.kind] = true;
  std::map<heap::Surface, Stuff> found;
  for (std::size_t kind = 0; kind < used.size(); ++kind) {
    if (!used[kind]) continue;
    const heap::Optics& optics = grains.kinds[kind];
    const glm::dvec3& albedo = optics.opaque() ? optics.reflectance : optics.albedo;
    const Stuff own{
        optics.surface, range_of(optics.sigma_t), range_of(albedo), {optics.g, optics.g}, {optics.eta, optics.eta}};
    Stuff& stuff = found.try_emplace(optics.surface, own).first->second;
    stuff.thickness = both(stuff.thickness, own.thickness);
    stuff.albedo = both(stuff.albedo, own.albedo);
    stuff.g = both(stuff.g, own.g);
    stuff.eta = both(stuff.eta, own.eta);
  }
  std::vector<Stuff> all;
  all.reserve(found.size());
  for (const auto& [surface, stuff] : found) all.push_back(stuff);
  return all;
}

}  // namespace

ExchangeStatistics Exchange::statistics() const {
  ExchangeStatistics result;
  if (!solving_) return result;
  const heap::Grains& grains = solving_->heap().grains;
  result.grains = grains.grains.size();
  result.others = roles_.size() - result.grains - grains.walls.size();
  result.kinds = grains.kinds.size();
  result.final = solving_->news().final;
  result.balls = balls_;
  result.means = means_;
  result.stuff = stuff_of(grains);
  if (!known_) return result;
  const heap::HeapLight& light = *known_->light;
  result.links = light.links;
  result.steps = light.steps;
  result.residual = light.residual;
  result.summed_on_device = light.summed_on_device;
  result.milliseconds = light.milliseconds;
  result.parts = light.parts;
  return result;
}

void Exchange::send() {
  if (!any()) return;
  if (known_)
    told_.tell(*known_->light, known_->grains(), roles_);
  else
    told_.tell_darkness(roles_.size());
}

}  // namespace mesograin::render
