// The distribution is integrated and inverted row by row, in double.
#include "physics/kernels/kernel_tables.h"

#include <algorithm>
#include <cmath>

#include "physics/physics.h"

namespace mesograin::physics {
namespace {

constexpr int distance_count = 256;
constexpr int share_count = 1024;
constexpr int cosine_count = 32;

// Cosines inside at which a kernel that depends on them is evaluated; the table's are interpolated.
constexpr int evaluated_cosines = 8;

// This much of the samples is spread evenly.
constexpr double least_share = 1e-9;

// Light that enters nearer to grazing is taken as this: it is little, and its kernel vanishes with its chord.
constexpr double least_cosine = 0.1;

// What is farther than this share of the light is below single precision's smallest number.
constexpr double deepest = 80.0;

// 2 pi int s f ds over [a, b] for f linear from fa to fb.
double ring_integral(double a, double b, double fa, double fb) {
  return PI * (b - a) * ((a + b) * 0.5 * (fa + fb) + (b - a) * (fb - fa) / 6.0);
}

using Channels = std::array<std::vector<double>, 3>;

Channels evaluate(const std::array<const SurfaceKernel*, 3>& kernels, const std::vector<double>& distances, double mu) {
  Channels values;
  for (int channel = 0; channel < 3; ++channel)
    values[channel] = channel > 0 && kernels[channel] == kernels[channel - 1]
                          ? values[channel - 1]
                          : kernels[channel]->evaluate(distances, mu);
  return values;
}

struct Distribution {
  std::vector<double> density;  // the channels' mean, each over its own integral
  std::vector<double> beyond;   // share of its light that goes farther
};

Distribution distribution(const Channels& channels, const std::vector<double>& distances) {
  Distribution result;
  result.density.assign(distances.size(), 0.0);
  for (const std::vector<double>& values : channels) {
    double total = 0.0;
    for (std::size_t j = 0; j + 1 < distances.size(); ++j)
      total += ring_integral(distances[j], distances[j + 1], values[j], values[j + 1]);
    if (total > 0.0)
      for (std::size_t j = 0; j < distances.size(); ++j) result.density[j] += values[j] / total;
  }
  // What is met is never much nearer than what was drawn, often farther. A kernel that falls towards no distance, as
  // without its first orders, would be met there far more often than it is drawn.
  for (std::size_t j = distances.size() - 1; j > 0; --j)
    result.density[j - 1] = std::max(result.density[j - 1], result.density[j]);
  // Where a kernel has rounded to nothing it must still be sampled, or the least light there would weigh without
  // bounds.
  for (double& density : result.density) density += least_share / (PI * distances.back() * distances.back());
  // Summed from the far end, so that the tail keeps its digits.
  result.beyond.assign(distances.size(), 0.0);
  for (std::size_t j = distances.size() - 1; j > 0; --j)
    result.beyond[j - 1] =
        result.beyond[j] + ring_integral(distances[j - 1], distances[j], result.density[j - 1], result.density[j]);
  const double total = result.beyond[0];
  if (total > 0.0)
    for (std::size_t j = 0; j < distances.size(); ++j) {
      result.density[j] /= total;
      result.beyond[j] /= total;
    }
  return result;
}

double depth_of(double beyond) { return beyond > 0.0 ? std::min(deepest, -std::log(beyond)) : deepest; }

}  // namespace

KernelTables kernel_tables(const std::array<const SurfaceKernel*, 3>& kernels, const BodySurface& surface,
                           double resolution, double largest, bool by_cosine) {
  KernelTables tables;
  tables.shortest = resolution;
  tables.step = std::log1p(largest / resolution) / (distance_count - 1);
  tables.largest_depth = deepest;
  tables.profile = {distance_count, cosine_count, {}};
  tables.inverse = {share_count, 1, {}};

  std::vector<double> distances;
  distances.reserve(static_cast<std::size_t>(distance_count));
  for (int j = 0; j < distance_count; ++j)
    distances.push_back(kernel_distance(j, resolution, tables.columns_per_octave()));

  const double least =
      by_cosine && surface.eta > 1.0 ? std::max(refracted_cosine(0.0, surface.eta), least_cosine) : least_cosine;
  const int rows = by_cosine ? evaluated_cosines : 1;
  std::vector<Channels> evaluated;
  evaluated.reserve(static_cast<std::size_t>(rows));
  for (int i = 0; i < rows; ++i)
    evaluated.push_back(evaluate(kernels, distances, rows > 1 ? least + (1.0 - least) * i / (rows - 1) : 1.0));
  const Distribution sampled = distribution(evaluated.back(), distances);

  for (int i = 0; i < cosine_count; ++i) {
    const double mu = i / (cosine_count - 1.0);
    const double mu_refracted = refracted_cosine(mu, surface.eta);
    const double transmittance = surface.eta == 1.0 ? 1.0 : fresnel_transmittance(mu, mu_refracted, surface.eta);
    const double row =
        by_cosine ? std::clamp((mu_refracted - least) / (1.0 - least), 0.0, 1.0) * (evaluated_cosines - 1) : 0.0;
    const auto lower = std::min(static_cast<std::size_t>(row), evaluated.size() - 1);
    const auto upper = std::min(lower + 1, evaluated.size() - 1);
    const double t = row - static_cast<double>(lower);
    for (int j = 0; j < distance_count; ++j) {
      glm::dvec4 texel(0.0, 0.0, 0.0, depth_of(sampled.beyond[j]));
      for (int channel = 0; channel < 3; ++channel)
        texel[channel] = transmittance * ((1.0 - t) * evaluated[lower][channel][j] + t * evaluated[upper][channel][j]);
      tables.profile.texels.emplace_back(texel);
    }
  }

  int cell = 0;
  for (int k = 0; k < share_count; ++k) {
    const double share = static_cast<double>(k) / (share_count - 1);
    const double depth = deepest * share * share;
    while (cell + 2 < distance_count && depth_of(sampled.beyond[cell + 1]) <= depth) ++cell;
    const double low = depth_of(sampled.beyond[cell]);
    const double high = depth_of(sampled.beyond[cell + 1]);
    // Between two distances the depth rises with the square near no distance and linearly far away: interpolate in s^2.
    const double t = high > low ? std::clamp((depth - low) / (high - low), 0.0, 1.0) : 0.0;
    const double a = distances[cell];
    const double b = distances[cell + 1];
    const double distance = std::sqrt(a * a + t * (b * b - a * a));
    const double density =
        sampled.density[cell] + (sampled.density[cell + 1] - sampled.density[cell]) * (distance - a) / (b - a);
    tables.inverse.texels.emplace_back(glm::dvec4(distance, density, 0.0, 1.0));
  }
  return tables;
}

}  // namespace mesograin::physics
