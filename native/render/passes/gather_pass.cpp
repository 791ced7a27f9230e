// Each pixel looks at its grain a few times a sample.
#include "render/passes/gather_pass.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "render/cast_work.h"
#include "render/content_facets.h"
#include "render/pixel_rays.h"
#include "render/surfaces.h"

namespace mesograin::render {
namespace {

// A pixel's noise of so many is a fifth; it falls with every sample.
constexpr int rays_a_sample = 4;

// Into clear grains, where nothing else is gathered: two would cost nearly twice as much for half the noise's square.
constexpr int rays_into_clear = 1;

// Whoever changes something after fewer samples is not likely to look at the same light again.
constexpr std::uint32_t first_learnt_from = 4;

// One of so many pixels in a row is looked at as closely as can be where the others are not: with two thousand of them
// one sample tells within a percent how much more that finds. Where a picture is `awaited` a quarter tells enough.
std::size_t pixels_a_probe(std::size_t pixels, Awaited awaited) {
  constexpr std::size_t wanted = 2048;
  constexpr std::size_t densest = 4;
  constexpr std::size_t sparsest = 32;
  return std::clamp(pixels / wanted, densest, sparsest) * (awaited == Awaited::no ? 1 : 4);
}

// In pixels, of the first sample's filter.
constexpr double deviation = 2.0;

// Of what one look in a hundred finds of a light, a hundred times as bright: wider, the smaller the cone is that it is
// found in, up to this for one of ten degrees.
constexpr double most_deviation = 8.0;
constexpr double cone_of_ten_degrees = 0.0239;

double deviation_by_chance(double cone) {
  return std::clamp(most_deviation * cone_of_ten_degrees / cone, deviation, most_deviation);
}

void resize(std::optional<gl::Texture>& texture, const glm::ivec2& size) {
  if (!texture || texture->width() != size.x || texture->height() != size.y)
    texture.emplace(GL_RGBA32F, size.x, size.y);
}

void upload(std::optional<gl::Texture>& texture, const glm::ivec2& size, const std::vector<glm::vec4>& pixels) {
  resize(texture, size);
  texture->upload(GL_RGBA, GL_FLOAT, pixels.data());
}

void clear(std::optional<gl::Texture>& texture, const glm::ivec2& size) {
  resize(texture, size);
  texture->clear();
}

/// Each look goes through another place of the pixel, as far as the grain is seen there.
heap::Gather::Through into_clear(const heap::SeenFacet& seen, const PixelRays& rays, const glm::dvec2& pixel,
                                 const heap::Gather& gather, const ContentFacets& clear, int looks,
                                 const heap::Gather::Look& how, transport::Random& random) {
  heap::Gather::Through sum;
  for (int look = 0; look < looks; ++look) {
    std::optional<heap::SeenFacet> beside;
    if (look > 0) {
      const PixelRay ray = rays.at(pixel + glm::dvec2(random.uniform(), random.uniform()) - 0.5);
      beside = clear.seen_along(seen.grain, ray.origin, ray.direction);
    }
    sum.add(gather.look_into(beside.value_or(seen), clear, how, random));
  }
  sum.scale(1.0F / static_cast<float>(looks));
  return sum;
}

// Of light that a grain meets, or lets through, on a straight way. Divided by less, noise is all that is left.
constexpr float least_share = 1e-3F;

/// What is scattered in a medium that begins without refraction depends on the place as much as on its bumps: within 45
/// degrees at first, fewer with each sample, as the blur goes. Else on how the surface turns light: 26 degrees.
void set_direction(Likeness& likeness, heap::Surface surface, const glm::vec3& normal, const glm::vec3& from_middle,
                   std::uint32_t index) {
  constexpr float narrow = 0.1F;
  likeness.direction = normal;
  likeness.least_alike = 1.0F - narrow;
  if (surface != heap::Surface::index_matched) return;
  likeness.least_alike = 1.0F - std::max(0.3F / std::sqrt(static_cast<float>(index) + 1.0F), narrow);
  const glm::vec3 between = glm::normalize(from_middle) + normal;
  if (const float length = glm::length(between); length > 1e-3F) likeness.direction = between / length;
}

/// Of what is seen through a clear grain: below 0, where no surface is that is seen itself.
Likeness likeness_of(const heap::Gather::StraightEnd& end) {
  constexpr float narrow = 0.1F;
  const float kind = !end.met ? 0.0F : end.met->wall ? 1.0F : 2.0F;
  const float number = end.met ? static_cast<float>(end.met->number) : 0.0F;
  return {end.direction, -1.0F - kind - 3.0F * number, 1.0F - narrow, glm::max(end.radiance, least_share)};
}

/// Of the object of this number.
std::size_t unit_of(const Content& content, std::size_t number) {
  const Instances* instances = content.instances();
  if (instances == nullptr || number >= instances->count())
    return content.unit(number - (instances == nullptr ? 0 : instances->count()));
  const std::vector<InstanceGroup>& groups = instances->groups();
  const auto after = std::upper_bound(groups.begin(), groups.end(), number,
                                      [](std::size_t of, const InstanceGroup& group) { return of < group.first; });
  return static_cast<std::size_t>(after - groups.begin()) - 1;
}

std::size_t number_of(const glm::vec4& facing) { return static_cast<std::size_t>(std::abs(facing.w)) - 1; }

std::uint64_t seed_of(const Sample& sample) { return (static_cast<std::uint64_t>(sample.seed) << 32U) + sample.index; }

struct Looked {
  glm::vec3 place;    ///< in the heap
  glm::vec3 towards;  ///< the viewer
};

Looked looked_from(const Sample& sample, const SeenSurfaces& seen, std::size_t pixel) {
  const glm::vec3 middle(sample.content.receiver(number_of(seen.normals[pixel])).ball);
  const glm::vec3 place = middle + glm::vec3(seen.positions[pixel]);
  return {place, glm::normalize(glm::vec3(seen.viewer) - seen.viewer.w * place)};
}

}  // namespace

bool GatherPass::run(const Sample& sample, const ArrayVisibility& arrays, SurfacePass& surfaces) {
  ran_ = sample.gathers;
  if (!ran_) return true;
  const auto start = std::chrono::steady_clock::now();
  const SeenSurfaces seen = surfaces.seen(sample);
  const bool whole =
      sample.exchange.looks_straight_alone() ? look_straight(sample, seen) : follow_light(sample, arrays, seen);
  milliseconds_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return whole;
}

bool GatherPass::look_straight(const Sample& sample, const SeenSurfaces& seen) {
  const heap::Gather& gather = *sample.exchange.gather();
  levels_ = {};
  others_.assign(seen.normals.size(), glm::vec4(0.0F));
  const auto width = static_cast<std::size_t>(sample.size.x);
  const std::uint64_t seed = seed_of(sample);
  const bool whole = cast_rows(sample.size.y, sample.go_on, [&](int first, int end) {
    for (std::size_t i = width * static_cast<std::size_t>(first); i < width * static_cast<std::size_t>(end); ++i) {
      if (seen.normals[i].w == 0.0F) continue;
      const std::optional<std::uint32_t>& grain = sample.exchange.roles()[number_of(seen.normals[i])].grain;
      if (!grain || !sample.exchange.looks_straight(*grain)) continue;
      transport::Random random(seed, i);
      const heap::Gather::Straight found =
          gather.look_straight(*grain, glm::vec3(seen.normals[i]), looked_from(sample, seen, i).towards, random);
      others_[i] = glm::vec4(found.told + found.straight, 3.0F + found.open);
    }
  });
  if (!whole) return false;
  upload(device_others_, sample.size, others_);
  clear(device_lights_, sample.size);
  return true;
}

bool GatherPass::follow_light(const Sample& sample, const ArrayVisibility& arrays, const SeenSurfaces& seen) {
  const std::shared_ptr<const heap::Gather>& gather = sample.exchange.gather();
  const bool all = sample.exchange.gathers_all();
  const bool alone = !sample.exchange.any();
  std::optional<ContentFacets> facets;
  if (sample.looks_into_facets()) facets.emplace(arrays.tree(), sample.content, sample.exchange);
  const std::vector<RoleInHeap>& roles = sample.exchange.roles();
  others_.assign(seen.normals.size(), glm::vec4(0.0F));
  lights_.assign(seen.normals.size(), glm::vec4(0.0F));
  scattered_.assign(seen.normals.size(), glm::vec4(0.0F));
  mirrored_.assign(seen.normals.size(), glm::vec4(0.0F));
  straight_.assign(seen.normals.size(), glm::vec4(0.0F));
  steady_.assign(seen.normals.size(), glm::vec4(0.0F));
  behind_.assign(seen.normals.size(), glm::vec4(0.0F));
  likenesses_.assign(seen.normals.size(), Likeness());
  seen_by_.assign(seen.normals.size(), Level::own_shape);
  const std::size_t in_a_row = pixels_a_probe(seen.normals.size(), sample.awaited);
  probes_.assign(seen.normals.size() / in_a_row + 1, std::nullopt);
  if (sample.index == 0) amends_.forget();
  const bool clear = facets && gather->sees_into_any();
  if (clear) {
    highlights_.assign(seen.normals.size(), glm::vec4(0.0F));
    chance_.assign(seen.normals.size(), glm::vec4(0.0F));
  }
  const auto width = static_cast<std::size_t>(sample.size.x);
  const PixelRays pixel_rays(anchor_to_clip(sample.content, sample.camera), sample.size, glm::dvec2(0.0),
                             sample.content.instances() != nullptr ? sample.content.instances()->bounds() : Bounds{});
  const std::size_t instances = sample.content.instances() != nullptr ? sample.content.instances()->count() : 0;
  const auto pixel_at = [&](std::size_t i) { return glm::dvec2(i % width, i / width); };
  const PixelsAcross pixels_across(anchor_to_clip(sample.content, sample.camera), sample.size);
  // A picture's first sample, which a drag shows, costs half as much by balls.
  const bool first_look = sample.index == 0;
  const auto level_at = [&](std::size_t number, Awaited awaited) {
    return sample.levels && number < instances
               ? level_of(roles[number].ball, gather->mean_free_paths(*roles[number].grain),
                          pixels_across.of(sample.content.receiver(number).ball), awaited)
               : Level::own_shape;
  };
  // By what is known of grains' inner light it costs less still, and is nearer.
  if (sample.learns) inner_lights_.keep_to(gather);
  const bool knows = first_look && facets && sample.learns;
  const heap::Gather::Walks walks = gather->walks(rays_a_sample, all);
  const float narrowed = heap::Gather::narrowed(sample.index);
  const std::uint64_t seed = seed_of(sample);
  const bool whole = cast_rows(sample.size.y, sample.go_on, [&](int first, int end) {
    for (std::size_t i = width * static_cast<std::size_t>(first); i < width * static_cast<std::size_t>(end); ++i) {
      const glm::vec4& facing = seen.normals[i];
      if (facing.w == 0.0F) continue;
      const std::size_t number = number_of(facing);
      const std::optional<std::uint32_t>& grain = roles[number].grain;
      if (!grain) continue;
      const Looked looked = looked_from(sample, seen, i);
      const glm::vec3& place = looked.place;
      const glm::vec3& towards = looked.towards;
      transport::Random random(seed, i);
      const glm::vec3 normal(facing);
      if (clear && gather->sees_into(*grain)) {
        const bool all_told = sample.gathers_all_of(number);
        const heap::Gather::Look how{all || all_told ? heap::Scatterings::followed : heap::Scatterings::end, all_told,
                                     !all_told && number >= instances, narrowed};
        const heap::Gather::Through into =
            into_clear({*grain, place, normal, towards}, pixel_rays, pixel_at(i), *gather, *facets,
                       all ? rays_a_sample : rays_into_clear, how, random);
        others_[i] = glm::vec4(into.others, how.alone ? 2.0F : 1.0F);
        lights_[i] = glm::vec4(into.lights, 0.0F);
        scattered_[i] = glm::vec4(into.scattered, 0.0F);
        mirrored_[i] = glm::vec4(into.mirrored, 0.0F);
        chance_[i] = glm::vec4(into.chance, 0.0F);
        if (how.whole)
          highlights_[i] = glm::vec4(gather->highlights({*grain, place, normal, towards}, *facets, random), 0.0F);
      } else if (sample.gathers_all_of(number)) {
        const heap::SeenFacet at{*grain, place, normal, towards};
        const auto in_ball = [&] {
          return gather->look_at_all(*grain, glm::vec3(seen.positions[i]), normal, towards, walks, random);
        };
        const bool shaped = facets && (sample.exchange.follows_paths() || !roles[number].ball);
        const bool by_facets = shaped && (sample.exchange.follows_paths() || !first_look);
        const auto by_walks = [&](bool in_own_shape) {
          const auto found = in_own_shape ? gather->look_at_all(at, *facets, walks, random) : std::nullopt;
          return found ? *found : in_ball();
        };
        Level level = level_at(number, Awaited::no);
        std::optional<heap::Gather::All> found;
        if (const heap::InnerLight* light = knows && level != Level::told ? inner_lights_.of(*grain) : nullptr)
          found = gather->look_at_all(at, *facets, *light, random);
        if (!found) level = level_at(number, sample.awaited);
        if (found || (level == Level::ball && !shaped)) level = Level::own_shape;
        if (level == Level::told)
          found = gather->look_at_told(*grain, glm::vec3(seen.positions[i]), normal, towards, random);
        if (!found) found = by_walks(by_facets && level == Level::own_shape);
        seen_by_[i] = level;
        if (level != Level::own_shape && i % in_a_row == (i / in_a_row + seed) % in_a_row)
          probes_[i / in_a_row] = {unit_of(sample.content, number), level, by_walks(shaped), *found};
        others_[i] = glm::vec4(found->others - found->straight, 1.0F);
        straight_[i] = glm::vec4(found->straight, 0.0F);
        steady_[i] = glm::vec4(found->steady, 0.0F);
        behind_[i] = glm::vec4(found->world, found->film);
        likenesses_[i].share = glm::max(found->met, least_share);
        scattered_[i] = glm::vec4(found->scattered, 0.0F);
        if (alone)
          lights_[i] =
              glm::vec4(by_facets && level == Level::own_shape ? gather->lit_behind(at, *facets, random)
                                                               : gather->lit_behind(*grain, normal, towards, random),
                        0.0F);
      } else if (all || sample.exchange.gathers_for(*grain)) {
        others_[i] = glm::vec4(gather->look(*grain, normal, towards, rays_a_sample, random), 1.0F);
      } else if (sample.exchange.looks_straight(*grain)) {
        const heap::Gather::Straight found = gather->look_straight(*grain, normal, towards, random);
        others_[i] = glm::vec4(found.told, 3.0F + found.open);
        straight_[i] = glm::vec4(found.straight, 0.0F);
        continue;  // it has no noise
      }
      if (others_[i].w == 0.0F || seen_by_[i] == Level::told) continue;
      likenesses_[i].object = std::abs(facing.w);
      if (clear && number >= instances && gather->sees_into(*grain))
        if (const auto end = gather->straight_end({*grain, place, normal, towards}, *facets)) {
          likenesses_[i] = likeness_of(*end);
          continue;
        }
      set_direction(likenesses_[i], gather->optics(*grain).surface, normal, glm::vec3(seen.positions[i]), sample.index);
    }
  });
  if (!whole) return false;
  make_amends(sample, seen.normals);
  if (sample.denoises) {
    std::vector<std::vector<glm::vec4>*> noisy{&others_, &lights_, &scattered_};
    if (clear) noisy.push_back(&mirrored_);
    if (!denoiser_.run(seen.size, sample.index, likenesses_, noisy, deviation, sample.go_on)) return false;
    if (clear && gather->finds_by_chance() &&
        !denoiser_.run(seen.size, sample.index, likenesses_, {&chance_}, deviation_by_chance(gather->smallest_cone()),
                       sample.go_on))
      return false;
  }
  // They have no noise, and edges.
  for (std::size_t i = 0; i < others_.size(); ++i) {
    others_[i] += straight_[i];
    scattered_[i] += steady_[i];
    lights_[i] += behind_[i];
    if (!clear) continue;
    mirrored_[i] += highlights_[i];
    lights_[i] += chance_[i];
  }
  upload(device_others_, sample.size, others_);
  upload(device_lights_, sample.size, lights_);
  upload(device_scattered_, sample.size, scattered_);
  upload(device_mirrored_, sample.size, mirrored_);
  if (facets && sample.learns && sample.index >= first_learnt_from) {
    InnerLights::Pixels pixels;
    for (std::size_t i = 0; i < seen.normals.size(); ++i)
      if (seen.normals[i].w != 0.0F && seen_by_[i] == Level::own_shape)
        if (const auto& grain = roles[number_of(seen.normals[i])].grain) ++pixels[*grain];
    inner_lights_.learn(pixels, *facets, sample.seed, sample.go_on);
  }
  return true;
}

void GatherPass::make_amends(const Sample& sample, const std::vector<glm::vec4>& normals) {
  for (const std::optional<Amends::Probe>& probe : probes_)
    if (probe) amends_.add(*probe);
  levels_ = {};
  const std::vector<RoleInHeap>& roles = sample.exchange.roles();
  std::vector<bool> counted(roles.size(), false);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    if (others_[i].w == 0.0F) continue;
    const std::size_t number = number_of(normals[i]);
    const Level level = seen_by_[i];
    if (!counted[number] && sample.gathers_all_of(number) && !sample.exchange.gather()->sees_into(*roles[number].grain))
      ++levels_.grains[static_cast<std::size_t>(level)];
    counted[number] = true;
    if (level == Level::own_shape) continue;
    if (level == Level::told) levels_.walks_saved += rays_a_sample;
    const Amends::Factors factors = amends_.factors(unit_of(sample.content, number), level);
    others_[i] *= glm::vec4(factors.scattered, 1.0F);
    scattered_[i] *= glm::vec4(factors.scattered, 1.0F);
    straight_[i] *= glm::vec4(factors.straight, 1.0F);
    behind_[i] *= glm::vec4(factors.straight, 1.0F);
  }
}

void GatherPass::bind(const gl::Program& program) const {
  if (!ran_) return;
  program.offer("gathered", *device_others_);
  program.offer("gathered_lights", *device_lights_);
  if (device_scattered_) program.offer("gathered_scattered", *device_scattered_);
  if (device_mirrored_) program.offer("gathered_mirrored", *device_mirrored_);
}

}  // namespace mesograin::render
