// At each height, beams from neighbouring entry points enclose rings: what enters between them passes between them. A
// ray that has left the sphere never meets a node again, for all of these lie inside.
#include "physics/body/sphere_refraction.h"

#include <algorithm>
#include <cmath>

#include "physics/physics.h"

namespace mesograin::physics {
namespace {

constexpr int beam_count = 400;

// Rings thinner than this share of their entry ring's area are part of a caustic, which the sun's disc and the grain's
// roughness blur.
constexpr double least_ring = 0.02;

// Beams nearer to the surface than this count as at it.
constexpr double least_cosine = 1e-2;

struct Crossing {
  double x;  // signed distance from the axis
  double path;
  double sideways;  // component along the entry's radius
  double down;
  double transmittance;
};

Crossing cross_height(double entry, double z, double eta) {
  const double mu = sine_of_cosine(entry);
  const double mu_refracted = refracted_cosine(mu, eta);
  const double bend = mu / eta - mu_refracted;
  Crossing crossing{};
  crossing.sideways = bend * entry;
  crossing.down = 1.0 / eta - bend * mu;
  crossing.transmittance = eta == 1.0 ? 1.0 : fresnel_transmittance(mu, mu_refracted, eta);
  crossing.path = (mu - z) / crossing.down;
  crossing.x = entry + crossing.sideways * crossing.path;
  return crossing;
}

// Rows at the poles would have no width.
double node_height(int row) { return std::clamp(2.0 * row / (SphereRefraction::size - 1.0) - 1.0, -0.9999, 0.9999); }

}  // namespace

SphereRefraction::SphereRefraction(double eta) : nodes_(size * size, RefractedLight{0.0, 1.0, 0.0}) {
  for (int row = 0; row < size; ++row) {
    const double z = node_height(row);
    const double width = sine_of_cosine(z);
    const double largest_entry = z > 0.0 ? width : 1.0;
    for (int k = 0; k < beam_count; ++k) {
      // Entry points crowd towards the rim, where refraction changes fastest.
      const auto entry_at = [&](int index) {
        const double u = 1.0 - static_cast<double>(index) / beam_count;
        return largest_entry * (1.0 - u * u);
      };
      const double entry_a = entry_at(k);
      const double entry_b = entry_at(k + 1);
      const Crossing a = cross_height(entry_a, z, eta);
      const Crossing b = cross_height(entry_b, z, eta);
      const double entered = (entry_b - entry_a) * (entry_b + entry_a);
      const double ring = std::max(std::abs((b.x - a.x) * (b.x + a.x)), least_ring * entered);
      for (const double side : {1.0, -1.0}) {
        const double low = std::min(side * a.x, side * b.x) / width;
        const double high = std::max(side * a.x, side * b.x) / width;
        const int first = std::max(0, static_cast<int>(std::ceil(low * (size - 1) - 1e-9)));
        for (int column = first; column < size && column <= high * (size - 1) + 1e-9; ++column) {
          // A node that two neighbouring rings share belongs to the outer one.
          if (column == 0 && side < 0.0) continue;
          const double share =
              high > low ? std::clamp((static_cast<double>(column) / (size - 1) - low) / (high - low), 0.0, 1.0) : 0.5;
          if (share >= 1.0 - 1e-9 && k + 1 < beam_count) continue;
          const bool forwards = (side * b.x > side * a.x);
          const double t = forwards ? share : 1.0 - share;
          const double irradiance =
              ((1.0 - t) * a.transmittance / a.down + t * b.transmittance / b.down) * entered / ring;
          const double path = (1.0 - t) * a.path + t * b.path;
          RefractedLight& node = nodes_[row * size + column];
          const double x = width * column / (size - 1);
          const double depth = sine_of_cosine(x) - z;
          // Into a rarer grain nothing enters beyond the critical angle.
          if (irradiance <= 0.0) continue;
          const double ratio =
              depth > 1e-6 ? path / depth
                           : sine_of_cosine(x) / std::max(refracted_cosine(sine_of_cosine(x), eta), least_cosine);
          const double total = node.irradiance + irradiance;
          const double sideways = side * ((1.0 - t) * a.sideways + t * b.sideways);
          node.path_ratio = (node.irradiance * node.path_ratio + irradiance * ratio) / total;
          node.sideways = (node.irradiance * node.sideways + irradiance * sideways) / total;
          node.irradiance = total;
        }
      }
    }
  }
}

RefractedLight SphereRefraction::at(double x, double z) const {
  const double q = std::clamp(x / std::max(sine_of_cosine(z), 1e-9), 0.0, 1.0) * (size - 1);
  const double w = std::clamp(0.5 * (1.0 + z), 0.0, 1.0) * (size - 1);
  const int column = std::min(static_cast<int>(q), size - 2);
  const int row = std::min(static_cast<int>(w), size - 2);
  const double s = q - column;
  const double t = w - row;
  const RefractedLight* corner = &nodes_[row * size + column];
  const auto mix = [&](double RefractedLight::*member) {
    return (1.0 - t) * ((1.0 - s) * corner[0].*member + s * corner[1].*member) +
           t * ((1.0 - s) * corner[size].*member + s * corner[size + 1].*member);
  };
  return {mix(&RefractedLight::irradiance), mix(&RefractedLight::path_ratio), mix(&RefractedLight::sideways)};
}

}  // namespace mesograin::physics
