// Rays go where the table sends what comes from the viewer, to what sends light from there.
#include "heap/gather.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "heap/spread.h"
#include "lights/device_light.h"
#include "lights/world_light.h"
#include "physics/physics.h"

namespace mesograin::heap {
namespace {

// Light that comes from a lamp or a sun through several grains is found by no look along one line, or seldom: it is
// told as if each of them spread it over a cone of this half angle, narrower with each sample (Kaplanyan and
// Dachsbacher, "Path space regularization for holistic and robust light transport", 2013, section 4).
const float least_spread = 20.0F * std::numbers::pi_v<float> / 180.0F;

// The same through flat facets, behind which looks go one way: there is less noise to be bought off, and a glint of
// another facet's would be an error that can be seen.
const float spread_of_facets = 5.0F * std::numbers::pi_v<float> / 180.0F;

// The same of light that is scattered on its way, which tells less yet of where it came in.
const float spread_of_scattered = 40.0F * std::numbers::pi_v<float> / 180.0F;

// What is so many times as bright as the world's image is on average is such a light, too.
constexpr double glaring = 16.0;

// Facets this rough, GGX alpha, show a glaring place as a highlight; smoother ones as it is.
constexpr float rough = 0.05F;

// The same through rough facets of a grain alone, over their alpha: about what two of them spread it by.
constexpr float spread_of_alpha = 0.6F;

// What rough facets have reflected inside meets a light beyond another one by chance, the more seldom the smoother they
// are: that one is taken to be rougher by so many times more, less with each sample, up to this alpha.
constexpr float wider = 3.0F;
constexpr float roughest = 0.5F;

// What is less of a light is not asked whether it is in the way of others.
constexpr float least_shown = 1e-4F;

/// Whether a rough surface spreads what crosses it wider than looks would find a light by chance alone.
bool spreads(float roughness, double eta) {
  constexpr double least = 0.02;
  return roughness * std::abs(eta - 1.0) >= least;
}

/// Of a cone, by the cosine of its half angle.
float solid_angle(float edge) { return 2.0F * std::numbers::pi_v<float> * (1.0F - edge); }

/// But for what it scatters and absorbs.
Optics glass(Optics optics) {
  optics.sigma_t = glm::dvec3(0.0);
  return optics;
}

}  // namespace

/// What takes time to find.
struct Gather::Found {
  Found(std::shared_ptr<const Heap> of, std::shared_ptr<const HeapLight> its_light)
      : heap(std::move(of)),
        light(std::move(its_light)),
        space(heap->grains, light->kinds, light->seats, light->patches, light->neighbourhood) {
    space.answer_as(seen_kinds(*light));
  }

  std::shared_ptr<const Heap> heap;
  std::shared_ptr<const HeapLight> light;
  Space space;
};

Gather::Gather(std::shared_ptr<const Heap> heap, std::shared_ptr<const Found> found, Ways ways)
    : held_(std::move(heap)),
      heap_(*held_),
      found_(std::move(found)),
      light_(found_->light),
      space_(found_->space),
      image_(image_of(heap_)),
      draws_(draws_of(heap_, image_)),
      seen_by_camera_(heap_.world.seen_by_camera()),
      ways_(ways) {
  lights_.reserve(heap_.lights.size());
  for (const scene::Light& light : heap_.lights) lights_.push_back(lights::pack(light, heap_.anchor));
  // Those that walks tell of take no other medium for their own.
  const bool similar = heap_.exchanges && ways_ == Ways::short_ones;
  of_others_ = similar ? of_others(heap_.grains.kinds) : heap_.grains.kinds;
}

Gather::Gather(const std::shared_ptr<const Heap>& heap, std::shared_ptr<const HeapLight> light, Ways ways)
    : Gather(heap, std::make_shared<const Found>(heap, std::move(light)), ways) {}

std::unique_ptr<const Gather> Gather::among(std::shared_ptr<const Heap> heap) const {
  return std::unique_ptr<const Gather>(new Gather(std::move(heap), found_, ways_));
}

glm::vec3 Gather::told_by(const Source& source, const Ray& ray) const {
  return ray.weight / source.met * light_->seats->light_at(light_->sent, source.number, source.normal, true);
}

std::optional<glm::vec3> Gather::sent_along(Ray& ray, transport::Random& random) const {
  const std::optional<Source> source = space_.follow(ray, random);
  if (!source) return std::nullopt;
  return told_by(*source, ray);
}

std::optional<glm::vec3> Gather::seen_of_others(Ray& ray, int further, transport::Random& random) const {
  const std::optional<Source> source = space_.follow(ray, random);
  if (!source) return std::nullopt;
  return looked_at(*source, ray, further, random);
}

glm::vec3 Gather::looked_at(const Source& source, const Ray& ray, int further, transport::Random& random) const {
  if (further == 0) return told_by(source, ray);
  if (is_lambert(source.number)) return ray.weight * sent_by_lambert(source.number, source.facing, further - 1, random);
  return is_walked_once_more(source.number) ? walked_in(source, ray, further - 1, random) : told_by(source, ray);
}

bool Gather::is_lambert(std::uint32_t number) const {
  if (number >= space_.grains().size()) return false;
  const Optics& optics = heap_.grains.kinds[space_.grains()[number].kind];
  return optics.surface == Surface::lambert || optics.veiled();
}

glm::vec3 Gather::sent_by_lambert(std::uint32_t grain, const glm::vec3& normal, int further,
                                  transport::Random& random) const {
  const Grain& of = space_.grains()[grain];
  const glm::vec3 from = space_.place(of, normal);
  const glm::vec3 reflectance(heap_.grains.kinds[of.kind].reflectance);
  glm::vec3 irradiance(0.0F);
  for (const Draw& draw : draws_) {
    const lights::LightDraw light = draw(heap_.anchor + glm::dvec3(from), {random.uniform(), random.uniform()});
    const glm::vec3 to_light(light.to_light);
    const float cosine = glm::dot(to_light, normal);
    if (!(cosine > 0.0F)) continue;
    Ray ray{from, to_light, glm::vec3(1.0F)};
    irradiance +=
        cosine * glm::vec3(light.irradiance) * space_.passed(ray, static_cast<float>(std::min(light.reach, 1e30)));
  }
  const float height = random.uniform();
  const glm::vec3 direction =
      TurnedFrame(normal, random.uniform()) * glm::vec3(std::sqrt(height), 0.0F, std::sqrt(1.0F - height));
  Ray ray{from, direction, reflectance};
  const std::optional<glm::vec3> sent = seen_of_others(ray, further, random);
  return reflectance * irradiance / std::numbers::pi_v<float> + (sent ? *sent : even_world(ray));
}

glm::vec3 Gather::even_world(const Ray& ray) const {
  return heap_.world.image ? glm::vec3(0.0F) : ray.weight * glm::vec3(heap_.world.radiance);
}

glm::vec3 Gather::look(std::uint32_t grain, const glm::vec3& normal, const glm::vec3& towards, int rays,
                       transport::Random& random) const {
  const Kind& kind = space_.answering(grain);
  const float mu = std::clamp(glm::dot(normal, towards), 0.0F, 1.0F);
  const TurnedFrame frame(normal, -towards);
  glm::vec3 sum(0.0F);
  for (int i = 0; i < rays; ++i) {
    const Outcome outcome = kind.from_viewer->draw(mu, random.uniform());
    Ray ray{space_.place(space_.grains()[grain], frame * outcome.normal), frame * outcome.direction, outcome.weight};
    if (const std::optional<glm::vec3> sent = seen_of_others(ray, walks(1, true).further, random))
      sum += *sent;
    else if (ray.crossed)
      sum += even_world(ray);
  }
  sum /= static_cast<float>(rays);
  sum += kind.from_light->lobe_at(mu) *
         light_->seats->of(light_->crossed, grain).at(kind.from_light->seen_place(normal, towards));
  Ray through = ray_through(grain, normal, towards);
  sum += space_.seen_along(through, light_->sent, random);
  return glm::max(sum, 0.0F);
}

bool Gather::sees_into(std::uint32_t grain) const {
  return sees_into_any() && space_.kind(grain).from_light->is_clear();
}

Gather::Through Gather::look_into(const SeenFacet& seen, const Facets& facets, const Look& how,
                                  transport::Random& random) const {
  Through sum;
  follow_look(seen, facets, how, random, sum);
  // What a pane lets through is not what a ball in its middle does.
  if (how.whole || pane(seen.grain) != nullptr) return sum;
  const float mu = std::clamp(glm::dot(seen.normal, seen.towards), 0.0F, 1.0F);
  const GrainTable& table = *space_.kind(seen.grain).from_light;
  sum.others += table.lobe_at(mu) *
                light_->seats->of(light_->crossed, seen.grain).at(table.seen_place(seen.normal, seen.towards));
  sum.others = glm::max(sum.others, 0.0F);
  return sum;
}

Gather::ScatteredLight Gather::scattered_in(const SeenFacet& seen) const {
  const glm::vec3 place = space_.kind(seen.grain).from_light->seen_place(seen.normal, seen.towards);
  const glm::vec3 all = glm::max(light_->seats->light_at(light_->scattered, seen.grain, place, true), 0.0F);
  const glm::vec3 answer = light_->seats->light_at(light_->scattered_answer, seen.grain, place, true);
  return {all, glm::clamp(answer, glm::vec3(0.0F), all)};
}

void Gather::follow_look(SeenFacet seen, const Facets& facets, const Look& how, transport::Random& random,
                         Through& sum) const {
  bool wandered = false;  // through others
  glm::vec3 weight(1.0F);
  bool crosses = false;  // the grain that is seen, and its model tells how much does
  for (int through = 0; through < most_looked_into; ++through) {
    const bool first = through == 0;
    const Grain& grain = space_.grains()[seen.grain];
    const Optics& optics = heap_.grains.kinds[grain.kind];
    const bool asks_how_much = first && how.alone;
    const Scatterings scatterings = first ? how.scatterings : Scatterings::end;
    const glm::vec3 absorbed(optics.sigma_t * (1.0 - optics.albedo) / static_cast<double>(grain.radius_of_kind()));
    // Of what a sun sends through rough facets a look that leaves at random finds little, seldom, in bright specks.
    const bool asks_lights = asks_how_much && spreads(facets.finish(seen.grain).roughness, optics.eta);
    AtFacet at_facet;
    if (asks_lights)
      at_facet = [&](const Passage& arriving, const glm::vec3& inwards) {
        sum.lights +=
            weight * glm::exp(-arriving.length * absorbed) *
            lights_through(seen.grain, arriving, inwards, 1.0F + wider * how.narrowed * how.narrowed, facets, random);
      };
    const std::optional<Passage> passage = walk_facets(asks_how_much ? glass(optics) : optics, grain.radius_of_kind(),
                                                       seen, facets, scatterings, random, at_facet);
    if (!passage) return;
    if (asks_how_much) crosses = passage->entered;
    glm::vec3& behind = crosses ? sum.lights : sum.others;
    weight *= passage->weight;
    if (passage->scattered && scatterings == Scatterings::end) {
      const ScatteredLight scattered = scattered_in(seen);
      behind += weight * (first ? scattered.of_others : scattered.all);
      return;
    }
    if (asks_how_much && crosses) {
      const float way = passage->length / grain.radius_of_kind();
      const glm::vec3 passed = glm::exp(-way * glm::vec3(optics.sigma_t));
      sum.others += glm::vec3(optics.albedo) * (1.0F - passed) * scattered_in(seen).of_others;
      weight *= glm::exp(-passage->length * absorbed);
    }
    // What else the grain that is seen makes of the lights is its model's, or highlights().
    const bool straight = passage->entered && !passage->scattered;
    bool sees_surfaces = passage->wall.has_value();  // that shine, though lights stand for them
    if (!passage->wall && (!first || (straight && !asks_lights) || (passage->scattered && how.whole))) {
      // What one of many shows of a sun through another is specks, however it is seen.
      const bool undisturbed = how.alone && !wandered;
      const float spread =
          undisturbed ? spread_of_alpha * facets.finish(seen.grain).roughness : spread_of(*passage, how.narrowed);
      sees_surfaces = undisturbed && facets.finish(seen.grain).roughness < rough;
      glm::vec3 found = lights_along(seen.grain, *passage, spread, sees_surfaces, facets, random);
      if (!how.alone) found += glare_along(seen.grain, *passage, spread, facets, random);
      (passage->scattered ? sum.scattered : undisturbed ? sum.lights : sum.chance) += weight * found;
    }
    const std::optional<Meeting> meeting =
        passage->wall ? passage->wall : facets.beyond(seen.grain, passage->place, passage->direction);
    const auto see_world = [&](const glm::vec3& left) {
      const bool shown = !first || straight || (how.whole && (passage->scattered || facets.finish(seen.grain).shown));
      if (!shown) return;
      const bool mirrors = first && !passage->entered;
      const bool as_it_is =
          (how.alone && !(asks_lights && straight)) || (mirrors && facets.finish(seen.grain).roughness < rough);
      const glm::vec3 world = world_along(passage->direction, as_it_is);
      (passage->scattered ? sum.scattered : mirrors ? sum.mirrored : sum.lights) += left * world;
    };
    if (!meeting) {
      see_world(weight);
      return;
    }
    // What is scattered shows no longer where others are clear.
    const bool ends = passage->scattered || through + 1 == most_looked_into;
    if (meeting->wall || !sees_into(meeting->number) || ends) {
      if (meeting->wall && (sees_surfaces || !heap_.grains.walls[meeting->number].has_lights))
        behind += weight * heap_.grains.walls[meeting->number].radiance;
      Ray ray{passage->place, passage->direction, weight};
      if (!meeting->wall && heap_.grains.kinds[space_.grains()[meeting->number].kind].followed()) {
        const SeenFacet there{meeting->number, meeting->place, meeting->normal, -passage->direction};
        if (const std::optional<All> all = look_at_all_but_world(there, facets, walks(1, false), random, ray)) {
          behind += weight * (all->others + all->scattered);
          see_world(weight * ray.weight);
          return;
        }
      }
      if (const std::optional<Source> source = space_.source(*meeting, ray, random))
        behind += glm::max(told_by(*source, ray), 0.0F);
      return;
    }
    wandered = wandered || meeting->number != seen.grain;
    seen = {meeting->number, meeting->place, meeting->normal, -passage->direction};
  }
}

float Gather::spread_of(const Passage& passage, float narrowed) {
  return narrowed * (passage.scattered ? spread_of_scattered : passage.flat ? spread_of_facets : least_spread);
}

// Kaplanyan and Dachsbacher 2013, section 4.3 and their supplement: of a mollifier in two dimensions.
float Gather::narrowed(std::uint32_t sample) { return std::pow(static_cast<float>(sample) + 1.0F, -1.0F / 6.0F); }

float Gather::smallest_cone() const {
  float angle = image_ ? spread_of_facets : 0.5F * std::numbers::pi_v<float>;
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    const bool sun = std::holds_alternative<scene::DirectionalLight>(heap_.lights[i]);
    const double away = sun ? 1.0 : glm::length(glm::dvec3(lights_[i].place));
    const auto wide = static_cast<float>(0.5 * lights::light_angle(lights_[i], away));
    angle = std::min(angle, std::max(wide, spread_of_facets));
  }
  return solid_angle(std::cos(angle));
}

glm::vec3 Gather::world_along(const glm::vec3& direction, bool as_it_is) const {
  const glm::dvec3 along(direction);
  const double seen = as_it_is || !image_ ? 1.0 : 1.0 - image_->glare(along, glaring);
  return glm::vec3(seen * lights::radiance(heap_.world, along));
}

lights::LightDraw Gather::glare(transport::Random& random) const {
  lights::LightDraw light = image_->draw({random.uniform(), random.uniform()});
  light.irradiance *= image_->glare(light.to_light, glaring);
  return light;
}

glm::vec3 Gather::highlights(const SeenFacet& seen, const Facets& facets, transport::Random& random) const {
  glm::vec3 sum(0.0F);
  if (!facets.finish(seen.grain).shown) return sum;
  for (std::size_t i = 0; i < heap_.lights.size(); ++i) {
    const lights::LightDraw light =
        draws_[i](heap_.anchor + glm::dvec3(seen.place), {random.uniform(), random.uniform()});
    const double angle = lights::light_angle(lights_[i], light.reach);
    const bool sun = std::holds_alternative<scene::DirectionalLight>(heap_.lights[i]);
    // A lobe that stands for the disc has tails: facets would shine that it is not seen in.
    const float roughness = facets.finish(seen.grain).roughness;
    sum += sun && roughness < physics::dielectric_alpha(roughness, angle)
               ? mirrored_disc(seen, facets, i, glm::vec3(light.irradiance))
               : highlight(seen, facets, light, angle);
  }
  if (image_ && facets.finish(seen.grain).roughness >= rough) sum += highlight(seen, facets, glare(random), 0.0);
  return sum;
}

glm::vec3 Gather::mirrored_disc(const SeenFacet& seen, const Facets& facets, std::size_t sun,
                                const glm::vec3& irradiance) const {
  const glm::vec3 middle(lights_[sun].place);
  const auto wide = static_cast<float>(0.5 * lights::light_angle(lights_[sun], 1.0));
  const float mu = glm::dot(seen.normal, seen.towards);
  const glm::vec3 mirrored = 2.0F * mu * seen.normal - seen.towards;
  const float edge = std::cos(wide);
  if (!(mu > 0.0F) || glm::dot(mirrored, glm::normalize(middle)) < edge) return glm::vec3(0.0F);
  const Optics& optics = heap_.grains.kinds[space_.grains()[seen.grain].kind];
  const auto reflected = static_cast<float>(physics::fresnel_reflectance(mu, optics.eta));
  return reflected / solid_angle(edge) * irradiance * passed_towards(seen.grain, seen.place, mirrored, 1e30F, facets);
}

glm::vec3 Gather::highlight(const SeenFacet& seen, const Facets& facets, const lights::LightDraw& light,
                            double angle) const {
  const Finish finish = facets.finish(seen.grain);
  const Optics& optics = heap_.grains.kinds[space_.grains()[seen.grain].kind];
  const double mu_o = std::max(glm::dot(seen.normal, seen.towards), 1e-4F);
  const glm::vec3 to_light(light.to_light);
  const double mu_i = glm::dot(seen.normal, to_light);
  // As shaders/models/dielectric.glsl has it.
  const double alpha = physics::dielectric_alpha(finish.roughness, angle);
  if (!(mu_i > 0.0) || !(alpha > 0.0)) return glm::vec3(0.0F);
  constexpr double smallest_alpha = 1e-3;
  const double reflected =
      physics::dielectric_reflection(glm::dvec3(seen.normal), glm::dvec3(to_light), mu_i, glm::dvec3(seen.towards),
                                     mu_o, optics.eta, std::max(alpha, smallest_alpha), finish.correlated);
  const glm::vec3 shown(mu_i * reflected * light.irradiance);
  if (!(std::max({shown.r, shown.g, shown.b}) >= least_shown)) return glm::vec3(0.0F);
  return shown *
         passed_towards(seen.grain, seen.place, to_light, static_cast<float>(std::min(light.reach, 1e30)), facets);
}

glm::vec3 Gather::passed_towards(std::uint32_t grain, const glm::vec3& place, const glm::vec3& to_light, float reach,
                                 const Facets& facets) const {
  glm::vec3 left(1.0F);
  const std::optional<Meeting> meeting = beyond_panes(grain, place, to_light, false, facets, left);
  if (!meeting || glm::distance(meeting->place, place) >= reach) return left;
  if (meeting->wall || !heap_.grains.kinds[space_.grains()[meeting->number].kind].transparent()) return glm::vec3(0.0F);
  Ray ray{place, to_light, glm::vec3(1.0F), false, grain};
  return space_.passed(ray, reach);
}

const Pane* Gather::pane(std::uint32_t grain) const {
  const std::vector<Pane>& panes = heap_.grains.panes;
  const auto found = std::lower_bound(panes.begin(), panes.end(), grain,
                                      [](const Pane& one, std::uint32_t of) { return one.grain < of; });
  return found != panes.end() && found->grain == grain ? &*found : nullptr;
}

std::optional<Meeting> Gather::beyond_panes(std::uint32_t grain, glm::vec3 place, const glm::vec3& direction,
                                            bool mirrored, const Facets& facets, glm::vec3& left) const {
  for (int crossed = 0;; ++crossed) {
    std::optional<Meeting> meeting = facets.beyond(grain, place, direction);
    if (!meeting || meeting->wall || crossed == most_crossed) return meeting;
    const Pane* of = pane(meeting->number);
    if (of == nullptr) return meeting;
    const std::optional<End> end = facets.end(meeting->number, meeting->place, direction);
    const float way = end ? end->distance : 0.0F;
    const Sheet glass = sheet(of->glass, std::max(-glm::dot(meeting->normal, direction), 0.0F), way);
    left *= mirrored ? glass.left() : glass.passed;
    grain = meeting->number;
    place = meeting->place + way * direction;
  }
}

glm::vec3 Gather::lights_along(std::uint32_t grain, const Passage& passage, float spread, bool but_drawn,
                               const Facets& facets, transport::Random& random) const {
  glm::vec3 sum(0.0F);
  for (std::size_t i = 0; i < heap_.lights.size(); ++i) {
    const auto* area = std::get_if<scene::AreaLight>(&heap_.lights[i]);
    if (but_drawn && area && area->drawn) continue;
    // A disc that is found as it is; the cone is around its middle.
    const lights::DeviceLight& of = lights_[i];
    const bool sun = std::holds_alternative<scene::DirectionalLight>(heap_.lights[i]);
    const glm::vec3 middle = glm::vec3(of.place) - (sun ? glm::vec3(0.0F) : passage.place);
    const auto wide = static_cast<float>(0.5 * lights::light_angle(of, glm::length(glm::dvec3(middle))));
    const float cosine = glm::dot(glm::normalize(middle), passage.direction);
    const float edge = std::cos(std::min(std::max(spread, wide), 0.5F * std::numbers::pi_v<float>));
    if (!(edge < 1.0F) || cosine < edge) continue;
    const lights::LightDraw light =
        draws_[i](heap_.anchor + glm::dvec3(passage.place), {random.uniform(), random.uniform()});
    const glm::vec3 to_light = sun && cosine >= std::cos(wide) ? passage.direction : glm::vec3(light.to_light);
    const auto reach = static_cast<float>(std::min(light.reach, 1e30));
    const glm::vec3 passed = passed_towards(grain, passage.place, to_light, reach, facets);
    sum += passed * glm::vec3(light.irradiance) / solid_angle(edge);
  }
  return sum;
}

glm::vec3 Gather::lights_through(std::uint32_t grain, const Passage& arriving, const glm::vec3& inwards, float rougher,
                                 const Facets& facets, transport::Random& random) const {
  const float finish = facets.finish(grain).roughness;
  const float roughness = arriving.reflected == 0 ? finish : std::max(finish, std::min(rougher * finish, roughest));
  const double eta = heap_.grains.kinds[space_.grains()[grain].kind].eta;
  const auto through = [&](const lights::LightDraw& light) {
    const double density =
        leaving_density(glm::dvec3(inwards), roughness, 1.0 / eta, glm::dvec3(arriving.direction), light.to_light);
    const glm::vec3 shown(density * light.irradiance);
    if (!(std::max({shown.r, shown.g, shown.b}) >= least_shown)) return glm::vec3(0.0F);
    const auto reach = static_cast<float>(std::min(light.reach, 1e30));
    return shown * passed_towards(grain, arriving.place, glm::vec3(light.to_light), reach, facets);
  };
  glm::vec3 sum(0.0F);
  for (std::size_t i = 0; i < heap_.lights.size(); ++i)
    sum += through(draws_[i](heap_.anchor + glm::dvec3(arriving.place), {random.uniform(), random.uniform()}));
  if (image_) sum += through(glare(random));
  return sum;
}

glm::vec3 Gather::glare_along(std::uint32_t grain, const Passage& passage, float spread, const Facets& facets,
                              transport::Random& random) const {
  if (!image_) return glm::vec3(0.0F);
  const lights::LightDraw light = glare(random);
  const glm::vec3 to_light(light.to_light);
  const float edge = std::cos(spread);
  if (!(light.irradiance != glm::dvec3(0.0)) || glm::dot(to_light, passage.direction) < edge) return glm::vec3(0.0F);
  return glm::vec3(light.irradiance) * passed_towards(grain, passage.place, to_light, 1e30F, facets) /
         solid_angle(edge);
}

Ray Gather::ray_through(std::uint32_t grain, const glm::vec3& normal, const glm::vec3& towards) const {
  const float mu = std::clamp(glm::dot(normal, towards), 0.0F, 1.0F);
  // Its table may be that of another medium (of_others).
  const Optics& optics = heap_.grains.kinds[space_.grains()[grain].kind];
  const glm::vec3 left = optics.transparent() ? glm::exp(-2.0F * mu * glm::vec3(optics.sigma_t))
                                              : space_.kind(grain).from_viewer->crossing(mu);
  return {space_.place(space_.grains()[grain], normal - 2.0F * mu * towards), -towards, left};
}

}  // namespace mesograin::heap
