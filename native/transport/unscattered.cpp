// Follows rays of light through the body and leaves at the nodes what they pass.
#include "transport/unscattered.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "transport/incidence.h"
#include "transport/octahedron.h"
#include "transport/random.h"
#include "transport/tracks.h"

namespace mesograin::transport {
namespace {

// A ray is given up at its next reflection when so little of it is left.
constexpr float least_flux = 3e-3F;
constexpr int most_reflections = 64;
// And one that leaves and enters again for ever, after so many entries.
constexpr int most_beams = 64;

// That a lamp's rays are followed in, each by itself.
constexpr std::size_t lamp_pieces = 32;
// No two points of a body are farther apart.
constexpr double beyond_body = 2.5;
// A ray that meets the surface so much before a point of it meets that point, in units of the body.
constexpr float near_enough = 1e-4F;

// Light on its way into the body, and what of it is left for each extinction.
struct Beam {
  glm::vec3 place;
  glm::vec3 direction;
  float flux;
  std::vector<float> left;
};

/// Where light that comes from `place` outside, reflected or refracted out, enters a body that is not convex (again).
void enter(const Body& body, const Interface& interface, const glm::vec3& place, const glm::vec3& direction, float flux,
           const std::vector<float>& left, Random& random, std::vector<Beam>& beams) {
  if (body.convex() || flux * *std::max_element(left.begin(), left.end()) < least_flux) return;
  const std::optional<Hit> hit = body.first_hit(place, direction);
  if (!hit || glm::dot(hit->normal, direction) >= 0.0F) return;
  const Interface::Entry entry = interface.enter(direction, hit->normal, random);
  beams.push_back({place + hit->distance * direction, entry.inwards, flux * entry.passed, left});
}

void follow(const Body& body, const Interface& interface, Beam beam, Tracks& tracks, Random& random,
            std::vector<Beam>& beams) {
  for (int reflections = 0; reflections <= most_reflections; ++reflections) {
    const std::optional<Hit> hit = body.first_hit(beam.place, beam.direction);
    if (!hit || glm::dot(hit->normal, beam.direction) <= 0.0F) return;
    tracks.add(beam.place, beam.direction, hit->distance, beam.flux, beam.left, random);
    beam.place += hit->distance * beam.direction;
    if (interface.matched()) {
      const std::optional<glm::vec3> entry = body.next_entry(beam.place, beam.direction);
      if (!entry) return;
      beam.place = *entry;
      continue;
    }
    const Interface::Reflection reflection = interface.reflect(beam.direction, hit->normal, random);
    if (reflection.reflected < 1.0F)
      enter(body, interface, beam.place, reflection.beyond, beam.flux * (1.0F - reflection.reflected), beam.left,
            random, beams);
    beam.flux *= reflection.reflected;
    if (beam.flux * *std::max_element(beam.left.begin(), beam.left.end()) < least_flux) return;
    beam.direction = reflection.inwards;
  }
}

/// Light on its way to a point of the surface, followed for as long as it is worth it.
void come_in(const Body& body, const Interface& interface, const glm::vec3& place, const glm::vec3& direction,
             const glm::vec3& normal, float flux, std::size_t extinctions, Tracks& tracks, Random& random) {
  const Interface::Entry entry = interface.enter(direction, normal, random);
  const std::vector<float> whole(extinctions, 1.0F);
  std::vector<Beam> beams = {{place, entry.inwards, flux * entry.passed, whole}};
  if (!interface.matched())
    enter(body, interface, place, entry.mirrored, flux * (1.0F - entry.passed), whole, random, beams);
  for (int turn = 0; turn < most_beams && !beams.empty(); ++turn) {
    Beam beam = std::move(beams.back());
    beams.pop_back();
    follow(body, interface, std::move(beam), tracks, random, beams);
  }
}

/// Of tracks that rays of so much flux left at the nodes.
void make_mean_radiance(const Grid& grid, float flux, std::size_t extinctions, std::vector<float>& tracks) {
  for (std::size_t node = 0; node < grid.places().size(); ++node)
    for (std::size_t e = 0; e < extinctions; ++e)
      tracks[node * extinctions + e] *=
          flux / (4.0F * std::numbers::pi_v<float> * std::max(grid.volumes()[node], 1e-12F));
}

struct SurfacePoint {
  glm::vec3 place;
  glm::vec3 normal;  // of the triangle, outwards
};

/// Points that lie evenly over a surface.
class SurfacePoints {
 public:
  explicit SurfacePoints(const Body& body) : body_(body) {
    double sum = 0.0;
    for (const glm::uvec3& corners : body.triangles()) {
      const glm::dvec3 a(body.positions()[corners.x]);
      sum += glm::length(
          glm::cross(glm::dvec3(body.positions()[corners.y]) - a, glm::dvec3(body.positions()[corners.z]) - a));
      areas_.push_back(sum);
    }
  }

  /// For u and v evenly in [0, 1): the nearer u, the likelier on the same triangle.
  SurfacePoint at(double u, float v) const {
    const double wanted = u * areas_.back();
    const auto found = std::min(std::upper_bound(areas_.begin(), areas_.end(), wanted), areas_.end() - 1);
    const auto triangle = static_cast<std::size_t>(found - areas_.begin());
    const double before = triangle == 0 ? 0.0 : areas_[triangle - 1];
    const auto root = static_cast<float>(std::sqrt(std::clamp((wanted - before) / (*found - before), 0.0, 1.0)));
    const glm::uvec3& corners = body_.triangles()[triangle];
    const glm::vec3& a = body_.positions()[corners.x];
    return {a + root * (1.0F - v) * (body_.positions()[corners.y] - a) + root * v * (body_.positions()[corners.z] - a),
            body_.normals()[triangle]};
  }

 private:
  const Body& body_;
  std::vector<double> areas_;  // of the triangles so far, twice
};

LampRay lamp_at(const Body& body, const Lamp& lamp, const glm::vec3& place, Random& random) {
  const double first = random.uniform();
  return lamp.at(body.unit() * (glm::dvec3(place) * body.axes()), {first, random.uniform()});
}

/// What rays of the lamp count as: beside it what is next to nothing is not followed.
double usual_irradiance(const SurfacePoints& points, const Body& body, const Lamp& lamp, std::uint64_t seed) {
  constexpr int asked = 512;
  Random random(seed, lamp_pieces);
  double sum = 0.0;
  for (int i = 0; i < asked; ++i) {
    const SurfacePoint point = points.at((i + 0.5) / asked, random.uniform());
    const LampRay ray = lamp_at(body, lamp, point.place, random);
    sum += ray.irradiance * std::max(glm::dot(point.normal, glm::vec3(body.axes() * ray.to_lamp)), 0.0F);
  }
  return sum / asked;
}

}  // namespace

void unscattered_light(const Body& body, const Grid& grid, const Interface& interface,
                       const std::vector<double>& extinctions, int side, int across, const KeepLight& keep,
                       const Effort& effort) {
  run_pieces(effort, static_cast<std::size_t>(side) * static_cast<std::size_t>(side), [&](std::size_t texel) {
    const Incidence incidence(body, octahedron_direction(static_cast<int>(texel), side));
    const glm::vec3 towards = -incidence.to_light();
    Random random(effort.seed, texel);
    Tracks tracks(grid, extinctions);
    const auto count = static_cast<float>(across);
    for (int i = 0; i < across * across; ++i) {
      const int row = i / across;
      const glm::vec3 start = incidence.start((static_cast<float>(i % across) + random.uniform()) / count,
                                              (static_cast<float>(row) + random.uniform()) / count);
      const std::optional<Hit> hit = body.first_hit(start, towards);
      if (!hit) continue;
      come_in(body, interface, start + hit->distance * towards, towards, hit->normal, 1.0F, extinctions.size(), tracks,
              random);
    }
    std::vector<float> radiance = tracks.at_nodes();
    make_mean_radiance(grid, incidence.area() / (count * count), extinctions.size(), radiance);
    keep(texel, radiance);
  });
}

// Light comes in evenly over the surface, whose points then count for what the lamp gives there.
std::vector<float> unscattered_light(const Body& body, const Grid& grid, const Interface& interface,
                                     const std::vector<double>& extinctions, int rays, const Lamp& lamp,
                                     const Effort& effort) {
  const SurfacePoints points(body);
  const double usual = usual_irradiance(points, body, lamp, effort.seed);
  std::vector<float> sum(grid.places().size() * extinctions.size(), 0.0F);
  if (!(usual > 0.0)) return sum;
  std::vector<std::vector<float>> found(lamp_pieces);
  run_pieces(effort, lamp_pieces, [&](std::size_t piece) {
    Random random(effort.seed, piece);
    Tracks tracks(grid, extinctions);
    const auto first = static_cast<std::size_t>(rays) * piece / lamp_pieces;
    const auto end = static_cast<std::size_t>(rays) * (piece + 1) / lamp_pieces;
    for (std::size_t i = first; i < end; ++i) {
      const SurfacePoint point = points.at((static_cast<double>(i) + random.uniform()) / rays, random.uniform());
      const LampRay ray = lamp_at(body, lamp, point.place, random);
      const glm::vec3 to_lamp(body.axes() * ray.to_lamp);
      const float cosine = glm::dot(point.normal, to_lamp);
      if (cosine <= 0.0F || !(ray.irradiance > 0.0)) continue;
      // From as far as the lamp is, or from beyond all of the body.
      const float away = static_cast<float>(std::min(ray.reach / body.unit(), beyond_body));
      const std::optional<Hit> hit = body.first_hit(point.place + away * to_lamp, -to_lamp);
      if (!hit || hit->distance < (1.0F - near_enough) * away - near_enough) continue;  // in the body's own shade
      come_in(body, interface, point.place, -to_lamp, point.normal, cosine * static_cast<float>(ray.irradiance / usual),
              extinctions.size(), tracks, random);
    }
    found[piece] = tracks.at_nodes();
  });
  for (const std::vector<float>& piece : found)
    std::transform(piece.begin(), piece.end(), sum.begin(), sum.begin(), std::plus());
  make_mean_radiance(grid, static_cast<float>(usual * body.area() / rays), extinctions.size(), sum);
  return sum;
}

}  // namespace mesograin::transport
