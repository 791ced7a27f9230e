// Rays of neighbouring pixels go together.
#include "render/cast_mirrors.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <optional>

#include "render/cast_work.h"
#include "render/lit_place.h"

namespace mesograin::render {
namespace {

// Of what a ray has crossed, of its radius: how far from there it may be met again.
constexpr float clear_of_crossed = 1e-4F;

constexpr int across = 4, high = 2;  // as many have one mind whether a ray follows (shaders/models/mirrored_world.glsl)
static_assert(across * high == static_cast<int>(casting::rays_in_packet));

bool has_part(const RoleInHeap& role) { return role.grain || role.wall; }

// What light goes on between grains and walls, what a dielectric grain's surface reflects of it among it, is told by
// the exchange: such a grain mirrors none of them.
class Told {
 public:
  Told(const Content& content, const Exchange& exchange) : content_(content), exchange_(exchange) {
    const std::vector<RoleInHeap>& roles = exchange.roles();
    all_ = exchange.any() && std::all_of(roles.begin(), roles.end(), has_part);
  }

  /// Whether all that this object may mirror is.
  bool all(std::size_t mirror) const { return all_ && told_of(mirror); }

  bool operator()(std::size_t mirror, std::size_t met) const {
    return exchange_.any() && told_of(mirror) && has_part(exchange_.roles()[met]);
  }

 private:
  bool told_of(std::size_t number) const {
    if (!exchange_.roles()[number].grain) return false;
    const Instances* instances = content_.instances();
    const std::size_t count = instances != nullptr ? instances->count() : 0;
    const scene::Material& material =
        number < count ? instances->group_of(number).source : content_.draws()[number - count].look;
    return material.model != scene::Model::lambert && material.model != scene::Model::conductor;
  }

  const Content& content_;
  const Exchange& exchange_;
  bool all_;
};

std::vector<bool> units_that_are_lights(const Content& content, const Lighting& lighting) {
  std::vector<bool> lights(content.units(), false);
  for (std::size_t unit = 0; unit < lights.size(); ++unit) {
    const Draw* draw = content.draw(unit);
    lights[unit] = draw != nullptr && draw->look.finish && draw->look.finish->radiance != glm::dvec3(0.0) &&
                   lighting.is_light(draw->centre, draw->radius, draw->look.finish->radiance);
  }
  return lights;
}

std::size_t number_of(const glm::vec4& facing) { return static_cast<std::size_t>(std::abs(facing.w)) - 1; }

// Others that share a draw's number by which rays know it are met as it is: they are parts of one object.
bool is_part(const Content& content, std::size_t number) {
  const std::size_t instances = content.instances() != nullptr ? content.instances()->count() : 0;
  return number >= instances && content.draws()[number - instances].part;
}

// What stands behind a draw, all of which, as of those that were crossed before it, lies before what it shows.
std::optional<HitSurface> behind(const CastContent& cast, const Content& content, const LitPlace& from,
                                 const glm::vec3& look, std::size_t number,
                                 const std::function<bool(std::size_t)>& crossed) {
  casting::SingleRay ray{from.place, look};
  if (!is_part(content, number)) ray.from = from.object;
  // A ray enters and leaves what is no more folded than that.
  constexpr int most_passed = 16;
  for (int passed = 0; passed < most_passed; ++passed) {
    const std::optional<casting::Hit> hit = cast.first_hit(ray);
    if (!hit) return std::nullopt;
    const HitSurface surface = hit_surface(cast, content, look, *hit);
    const std::size_t met = number_of(surface.normal);
    if (met != number && !crossed(met)) return surface;
    ray.origin += hit->distance * look;
    ray.from = hit->number;
    ray.own = clear_of_crossed * content.receiver(met).ball.w;
  }
  return std::nullopt;
}

}  // namespace

bool CastMirrors::cast(const CastContent& cast, const Content& content, const Exchange& exchange,
                       const Lighting& lighting, const SeenSurfaces& seen, const std::vector<glm::vec4>& looks,
                       std::size_t layer, const GoOn& go_on) {
  const glm::ivec2 size = seen.size;
  layer_ = layer;
  FoundSurfaces& found = this->found();
  found.resize(size, content.textured());
  if (crossed_.size() <= layer) crossed_.resize(layer + 1);
  crossed_[layer].assign(looks.size(), crossed_none);
  const Told told(content, exchange);
  const bool world = lighting.world().shines();
  const std::vector<bool> lights = units_that_are_lights(content, lighting);
  const auto cast_packet = [&](const glm::ivec2& corner, int end_row) {
    casting::Packet packet;
    casting::Hits hits;
    std::size_t places[casting::rays_in_packet];
    bool inside[casting::rays_in_packet] = {};  // the picture, and not yet found
    bool any = false;
    for (unsigned ray = 0; ray < casting::rays_in_packet; ++ray) {
      const glm::ivec2 pixel = corner + glm::ivec2(static_cast<int>(ray) % across, static_cast<int>(ray) / across);
      if (pixel.x >= size.x || pixel.y >= end_row) continue;
      const std::size_t place = places[ray] =
          static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(pixel.x);
      inside[ray] = true;
      const glm::vec4& facing = seen.normals[place];
      if (looks[place].w == 0.0F || facing.w == 0.0F) continue;
      const LitPlace from = lit_place(content, seen.positions[place], facing, seen.viewer_of(place));
      const glm::vec3 look(looks[place]);
      if (glm::dot(look, from.normal) >= 0.0F) {
        if (world || !told.all(number_of(facing))) any = set_off(packet, ray, from, look) || any;
      } else {
        const std::size_t number = number_of(facing);
        crossed_[layer][place] = static_cast<std::uint32_t>(number);
        const auto crossed = [&](std::size_t met) {
          for (std::size_t before = 0; before < layer; ++before)
            if (crossed_[before][place] == met) return true;
          return false;
        };
        if (const std::optional<HitSurface> surface = behind(cast, content, from, look, number, crossed)) {
          found.put(place, *surface, 0.0F);
          inside[ray] = false;
        }
      }
    }
    if (any) cast.first_hits(packet, hits);
    for (unsigned ray = 0; ray < casting::rays_in_packet; ++ray) {
      if (!inside[ray]) continue;
      if (!hits.met[ray]) {
        found.put_nothing(places[ray]);
        continue;
      }
      HitSurface surface = hit_surface(cast, content, packet, hits, ray);
      if (lights[surface.unit] || told(number_of(seen.normals[places[ray]]), number_of(surface.normal)))
        surface.unit = HitSurface::unshaded;
      found.put(places[ray], surface, 0.0F);
    }
  };
  return cast_rows(size.y, go_on, [&](int first, int end) {
    for (int y = first; y < end; y += high)
      for (int x = 0; x < size.x; x += across) cast_packet({x, y}, end);
  });
}

}  // namespace mesograin::render
