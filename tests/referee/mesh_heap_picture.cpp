// A channel's path scatters in media, is reflected or refracted at surfaces, and ends by leaving the scene. Channels
// that are alike share one.
#include "mesh_heap_picture.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <optional>
#include <variant>
#include <vector>

#include "base/error.h"
#include "directions.h"
#include "heap_matter.h"
#include "light_source.h"
#include "mesh_heap.h"
#include "pixels.h"
#include "roulette.h"
#include "unscattered_light.h"
#include "view.h"

namespace mesograin::referee {
namespace {

constexpr double pi = std::numbers::pi;

double square(double of) { return of * of; }

/// Wider suns are found by paths that leave.
constexpr double widest_stored = 0.3;

/// Of each sun that is stored: its noise falls as that of the paths does.
constexpr double rays_a_path = 1.0, fewest_rays = 3e5, most_rays = 3e7;

/// How a path has come from the camera: by surfaces that bent it, or scattered at least once.
enum class Way { straight, bent, scattered };

struct Sun {
  glm::dvec3 direction;
  double cosine;  // of half its disc
  glm::dvec3 radiance;
  bool stored;  // where it was scattered
};

/// What a ray finds that leaves the scene.
class Around {
 public:
  /// `stores`: lamps, and suns that are narrow.
  Around(const scene::Scene& scene, bool stores) : world_(scene.world) {
    for (const scene::Light& light : scene.lights) {
      check_source(light);
      const auto* sun = std::get_if<scene::DirectionalLight>(&light);
      const bool stored = stores && (sun == nullptr || sun->angle <= widest_stored);
      if (stored) stored_.push_back(light);
      if (!stored && (sun == nullptr || sun->angle <= 0.0))
        throw Error(
            "Of several objects one of which has a g that is not 0 no path finds a sun without extent, nor a "
            "lamp: a sun's angle must be above 0, and every type 'distant'.");
      if (sun == nullptr || sun->angle <= 0.0) continue;
      const double half = std::cos(0.5 * sun->angle);
      // A disc's irradiance on a plane that faces each of its points is the radiance times 2 pi (1 - cosine).
      suns_.push_back(
          {glm::normalize(sun->direction_to_light), half, sun->irradiance / (2.0 * pi * (1.0 - half)), stored});
    }
  }

  /// No camera sees suns, nor the world where the film is transparent; and stored suns were found where light was
  /// scattered, and `by_facet` where a rough surface has reflected the ray.
  double radiance(const glm::dvec3& direction, int channel, Way way, bool by_facet) const {
    if (way == Way::straight && world_.film_transparent) return 0.0;
    double sum = world_.radiance[channel];
    if (world_.image) sum *= image(world_.world_to_image * direction, channel);
    if (way == Way::straight) return sum;
    for (const Sun& sun : suns_)
      if (!(sun.stored && (way == Way::scattered || by_facet)) && glm::dot(direction, sun.direction) > sun.cosine)
        sum += sun.radiance[channel];
    return sum;
  }

  /// Of lamps, on a ray that surfaces alone have bent, so far.
  double lamps(const glm::dvec3& origin, const glm::dvec3& direction, double reach, int channel) const {
    double sum = 0.0;
    for (const scene::Light& light : stored_) sum += radiance_along(light, origin, direction, reach)[channel];
    return sum;
  }

  const std::vector<scene::Light>& stored() const { return stored_; }

  bool grey() const {
    const auto is = [](const glm::dvec3& of) { return of.r == of.g && of.g == of.b; };
    return !world_.image && is(world_.radiance) &&
           std::all_of(suns_.begin(), suns_.end(), [&](const Sun& sun) { return is(sun.radiance); }) &&
           std::all_of(stored_.begin(), stored_.end(), [&](const scene::Light& light) { return is(colour_of(light)); });
  }

 private:
  /// The texel that is there (docs/scene-json.md has where which is).
  double image(const glm::dvec3& direction, int channel) const {
    const scene::Surroundings& of = *world_.image;
    const double across = 0.5 - std::atan2(direction.y, direction.x) / (2.0 * pi);
    const double down = std::acos(std::clamp(direction.z / glm::length(direction), -1.0, 1.0)) / pi;
    const int column = std::clamp(static_cast<int>(across * of.width()), 0, of.width() - 1);
    const int row = std::clamp(static_cast<int>(down * of.height()), 0, of.height() - 1);
    const int texel = row * of.width() + column;
    return of.texels()[static_cast<std::size_t>(texel)][channel];
  }

  const scene::World& world_;
  std::vector<Sun> suns_;
  std::vector<scene::Light> stored_;
};

void check(const scene::Material& material) {
  if (material.model == scene::Model::lambert) return;
  if (material.model == scene::Model::conductor) throw Error("The referee traces media and Lambertian surfaces.");
  if (material.boundary != scene::Boundary::dielectric && material.boundary != scene::Boundary::index_matched)
    throw Error("On a mesh the referee's boundary must be dielectric or index_matched.");
  if (!(std::abs(material.g) < 1)) throw Error("The referee needs g inside (-1, 1); got {}.", material.g);
}

class Path {
 public:
  /// `at`: the channel's index. `stored`: or null.
  Path(const MeshHeap& heap, const Around& around, const UnscatteredLight* stored, const Channel& channel,
       std::size_t at, bool scattered, Rng& rng)
      : heap_(heap),
        around_(around),
        stored_(stored),
        channel_(channel),
        at_(at),
        unscattered_(scattered ? 0.0 : 1.0),
        rng_(rng) {}

  /// Nothing, if it meets nothing.
  std::optional<double> follow(glm::dvec3 origin, glm::dvec3 direction) {
    std::optional<MeshHeap::Hit> hit = heap_.first(origin, direction);
    if (!hit) return std::nullopt;
    while (hit) {
      see_lamps(origin, direction, hit->distance);
      origin += hit->distance * direction;
      const Matter& of = channel_.matter[hit->number];
      if (!(of.diffuse ? bounces(of, *hit, origin, direction) : crosses(of, *hit, origin, direction))) return found_;
      hit = heap_.first(origin, direction);
    }
    return found_ + (way_ == Way::scattered ? 1.0 : unscattered_) * weight_ *
                        around_.radiance(direction, channel_.number, way_, seen_by_facet_);
  }

 private:
  void see_lamps(const glm::dvec3& origin, const glm::dvec3& direction, double reach) {
    if (way_ == Way::bent && !seen_by_facet_)
      found_ += unscattered_ * weight_ * around_.lamps(origin, direction, reach, channel_.number);
  }

  bool bounces(const Matter& of, const MeshHeap::Hit& hit, const glm::dvec3& place, glm::dvec3& direction) {
    weight_ *= of.reflectance;
    const glm::dvec3 normal = glm::dot(hit.normal, direction) < 0.0 ? hit.normal : -hit.normal;
    if (stored_) found_ += weight_ / pi * stored_->irradiance(hit.number, place, normal, at_, rng_);
    way_ = Way::scattered;
    direction = sample_cosine(normal, rng_);
    return survives(weight_, rng_);
  }

  /// Until it leaves the body that it has come to, or is reflected by it; false where it ends.
  bool crosses(const Matter& of, const MeshHeap::Hit& hit, glm::dvec3& place, glm::dvec3& direction) {
    if (!of.surface.matched() && way_ == Way::straight) way_ = Way::bent;
    const glm::dvec3 to_viewer = -direction;
    int facets;
    direction = glm::normalize(of.surface.beyond(direction, hit.normal, rng_, &facets));
    const bool is_reflected = glm::dot(direction, hit.normal) > 0.0;
    seen_by_facet_ = stored_ != nullptr && is_reflected && facets == 1;
    if (stored_ != nullptr && of.surface.rough() && way_ == Way::bent)
      found_ += unscattered_ * weight_ *
                stored_->straight(place, hit.normal, at_, rng_, [&](const glm::dvec3& to_light, double comes) {
                  return comes * of.surface.reflected_once(to_light, to_viewer, hit.normal);
                });
    if (is_reflected) return true;
    constexpr int most_steps = 1 << 20;
    for (int step = 0; step < most_steps; ++step) {
      const std::optional<MeshHeap::Hit> own = heap_.inside(hit.number, place, direction);
      if (!own) return false;
      const double flight = of.sigma_t > 0 ? -std::log(rng_.uniform_positive()) / of.sigma_t : own->distance;
      if (flight < own->distance) {
        place += flight * direction;
        weight_ *= of.sigma_s / of.sigma_t;
        // Only where g is 0 is there anything stored. Radiance that leaves has lost the square of the index (Nicodemus,
        // "Radiance", 1963).
        if (stored_)
          found_ +=
              weight_ * phase(0.0, 0.0) * stored_->fluence(hit.number, place, at_) / square(of.surface.smooth.eta);
        way_ = Way::scattered;
        if (!survives(weight_, rng_)) return false;
        direction = sample_phase(direction, of.g, rng_);
        continue;
      }
      place += own->distance * direction;
      direction = glm::normalize(of.surface.beyond(direction, own->normal, rng_));
      if (glm::dot(direction, own->normal) > 0.0) return true;
    }
    return false;
  }

  const MeshHeap& heap_;
  const Around& around_;
  const UnscatteredLight* stored_;
  const Channel& channel_;
  std::size_t at_;
  double unscattered_;  // how much of light that nothing has scattered counts
  Rng& rng_;
  double weight_ = 1, found_ = 0;
  Way way_ = Way::straight;
  bool seen_by_facet_ = false;  // on what follows: stored lights, by a rough surface
};

std::vector<Channel> channels_of(const MeshHeap& heap, const Around& around) {
  std::vector<Channel> channels;
  for (int number = 0; number < 3; ++number) {
    Channel channel{number, {}};
    for (std::uint32_t i = 0; i < heap.size(); ++i) channel.matter.emplace_back(heap.material(i), number);
    channels.push_back(std::move(channel));
  }
  const bool alike = channels[0].matter == channels[1].matter && channels[0].matter == channels[2].matter;
  if (alike && around.grey()) channels.resize(1);
  return channels;
}

}  // namespace

Picture trace_mesh_heap(const MeshHeapCase& setup, const std::function<void()>& row_done) {
  for (const scene::Material& material : scene::materials_of(setup.scene)) check(material);
  const MeshHeap heap(setup.scene);
  bool even = true;
  for (const scene::Material& material : scene::materials_of(setup.scene))
    even = even && (material.model == scene::Model::lambert || material.g == 0.0);
  const Around around(setup.scene, even);
  const std::vector<Channel> channels = channels_of(heap, around);
  std::optional<UnscatteredLight> stored;
  if (!around.stored().empty()) {
    const double wanted = rays_a_path * setup.width * setup.height * setup.samples;
    stored.emplace(heap, channels, around.stored(),
                   static_cast<std::uint64_t>(std::clamp(wanted, fewest_rays, most_rays)), setup.seed, setup.threads);
  }
  PictureCase size;
  size.width = setup.width;
  size.height = setup.height;
  size.samples = setup.samples;
  size.seed = setup.seed;
  size.threads = setup.threads;
  const auto trace = [&](double x, double y, Rng& rng) -> std::optional<glm::dvec3> {
    const Ray ray = view_ray(setup.clip_to_world, x, y);
    glm::dvec3 radiance(0);
    for (std::size_t i = 0; i < channels.size(); ++i) {
      Path path(heap, around, stored ? &*stored : nullptr, channels[i], i, setup.scattered, rng);
      const std::optional<double> found = path.follow(ray.origin, ray.direction);
      if (!found) return std::nullopt;
      if (channels.size() == 1) return glm::dvec3(*found);
      radiance[channels[i].number] = *found;
    }
    return radiance;
  };
  return trace_pixels(
      size, [&] { return trace; }, row_done);
}

}  // namespace mesograin::referee
