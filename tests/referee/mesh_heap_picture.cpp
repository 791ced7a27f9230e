// A channel's path scatters in media, is reflected or refracted at surfaces, and ends by leaving the scene. Channels
// that are alike share one.
#include "mesh_heap_picture.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <variant>
#include <vector>

#include "base/error.h"
#include "directions.h"
#include "interface.h"
#include "mesh_heap.h"
#include "pixels.h"
#include "roulette.h"
#include "view.h"

namespace mesograin::referee {
namespace {

constexpr double pi = std::numbers::pi;

struct Sun {
  glm::dvec3 direction;
  double cosine;  // of half its disc
  glm::dvec3 radiance;
};

/// What a ray finds that leaves the scene.
class Around {
 public:
  explicit Around(const scene::Scene& scene) : world_(scene.world) {
    for (const scene::Light& light : scene.lights) {
      const auto* sun = std::get_if<scene::DirectionalLight>(&light);
      if (sun == nullptr) throw Error("Of lights the referee knows suns and the world: every type must be 'distant'.");
      if (!(sun->angle > 0.0))
        throw Error("In a scene of several objects no path finds a sun without extent: its angle must be above 0.");
      const double half = std::cos(0.5 * sun->angle);
      // A disc's irradiance on a plane that faces each of its points is the radiance times 2 pi (1 - cosine).
      suns_.push_back({glm::normalize(sun->direction_to_light), half, sun->irradiance / (2.0 * pi * (1.0 - half))});
    }
  }

  double radiance(const glm::dvec3& direction, int channel) const {
    double sum = world_.radiance[channel];
    if (world_.image) sum *= image(world_.world_to_image * direction, channel);
    for (const Sun& sun : suns_)
      if (glm::dot(direction, sun.direction) > sun.cosine) sum += sun.radiance[channel];
    return sum;
  }

  bool grey() const {
    const auto is = [](const glm::dvec3& of) { return of.r == of.g && of.g == of.b; };
    return !world_.image && is(world_.radiance) &&
           std::all_of(suns_.begin(), suns_.end(), [&](const Sun& sun) { return is(sun.radiance); });
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
};

/// A material in one channel, per scene unit.
struct Matter {
  bool diffuse;
  double reflectance;
  double sigma_s, sigma_t, g;
  Interface surface;

  Matter(const scene::Material& of, int channel)
      : diffuse(of.model == scene::Model::lambert),
        reflectance(of.reflectance[channel]),
        sigma_s(of.scale * of.sigma_s[channel]),
        sigma_t(sigma_s + of.scale * of.sigma_a[channel]),
        g(of.g),
        surface{of.boundary == scene::Boundary::dielectric ? of.eta : 1.0} {}

  bool operator==(const Matter& other) const {
    return diffuse == other.diffuse && reflectance == other.reflectance && sigma_s == other.sigma_s &&
           sigma_t == other.sigma_t;
  }
};

void check(const scene::Material& material) {
  if (material.model == scene::Model::lambert) return;
  if (material.model == scene::Model::conductor) throw Error("The referee traces media and Lambertian surfaces.");
  if (material.boundary != scene::Boundary::dielectric && material.boundary != scene::Boundary::index_matched)
    throw Error("On a mesh the referee's boundary must be dielectric or index_matched.");
  if (material.boundary == scene::Boundary::dielectric && material.roughness > 0)
    throw Error("The referee's interface is smooth: roughness must be 0; got {}.", material.roughness);
  if (!(std::abs(material.g) < 1)) throw Error("The referee needs g inside (-1, 1); got {}.", material.g);
}

/// One channel of all that stands there.
struct Channel {
  int number;
  std::vector<Matter> matter;  // by instance
};

class Path {
 public:
  Path(const MeshHeap& heap, const Around& around, const Channel& channel, Rng& rng)
      : heap_(heap), around_(around), channel_(channel), rng_(rng) {}

  /// Nothing, if it meets nothing.
  std::optional<double> follow(glm::dvec3 origin, glm::dvec3 direction) {
    std::optional<MeshHeap::Hit> hit = heap_.first(origin, direction);
    if (!hit) return std::nullopt;
    while (hit) {
      origin += hit->distance * direction;
      const Matter& of = channel_.matter[hit->number];
      if (!(of.diffuse ? bounces(of, *hit, direction) : crosses(of, *hit, origin, direction))) return 0.0;
      hit = heap_.first(origin, direction);
    }
    return weight_ * around_.radiance(direction, channel_.number);
  }

 private:
  bool bounces(const Matter& of, const MeshHeap::Hit& hit, glm::dvec3& direction) {
    weight_ *= of.reflectance;
    direction = sample_cosine(glm::dot(hit.normal, direction) < 0.0 ? hit.normal : -hit.normal, rng_);
    return survives(weight_, rng_);
  }

  /// Until it leaves the body that it has come to, or is reflected by it; false where it ends.
  bool crosses(const Matter& of, const MeshHeap::Hit& hit, glm::dvec3& place, glm::dvec3& direction) {
    if (!of.surface.matched()) {
      const double cosine = std::min(-glm::dot(hit.normal, direction), 1.0);
      if (rng_.uniform() < of.surface.reflectance_from_outside(cosine)) {
        direction = glm::normalize(direction + 2 * cosine * hit.normal);
        return true;
      }
      direction = glm::normalize(refract(direction, hit.normal, of.surface.eta));
    }
    constexpr int most_steps = 1 << 20;
    for (int step = 0; step < most_steps; ++step) {
      const std::optional<MeshHeap::Hit> own = heap_.inside(hit.number, place, direction);
      if (!own) return false;
      const double flight = of.sigma_t > 0 ? -std::log(rng_.uniform_positive()) / of.sigma_t : own->distance;
      if (flight < own->distance) {
        place += flight * direction;
        weight_ *= of.sigma_s / of.sigma_t;
        if (!survives(weight_, rng_)) return false;
        direction = sample_phase(direction, of.g, rng_);
        continue;
      }
      place += own->distance * direction;
      const double cosine = std::min(glm::dot(own->normal, direction), 1.0);
      if (of.surface.matched()) return true;
      if (!(rng_.uniform() < of.surface.reflectance_from_inside(cosine))) {
        direction = glm::normalize(refract(direction, -own->normal, 1 / of.surface.eta));
        return true;
      }
      direction = glm::normalize(direction - 2 * cosine * own->normal);
    }
    return false;
  }

  const MeshHeap& heap_;
  const Around& around_;
  const Channel& channel_;
  Rng& rng_;
  double weight_ = 1;
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
  const Around around(setup.scene);
  const std::vector<Channel> channels = channels_of(heap, around);
  PictureCase size;
  size.width = setup.width;
  size.height = setup.height;
  size.samples = setup.samples;
  size.seed = setup.seed;
  size.threads = setup.threads;
  const auto trace = [&](double x, double y, Rng& rng) -> std::optional<glm::dvec3> {
    const Ray ray = view_ray(setup.clip_to_world, x, y);
    glm::dvec3 radiance(0);
    for (const Channel& channel : channels) {
      const std::optional<double> found = Path(heap, around, channel, rng).follow(ray.origin, ray.direction);
      if (!found) return std::nullopt;
      if (channels.size() == 1) return glm::dvec3(*found);
      radiance[channel.number] = *found;
    }
    return radiance;
  };
  return trace_pixels(
      size, [&] { return trace; }, row_done);
}

}  // namespace mesograin::referee
