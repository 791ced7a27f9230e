// The distribution is integrated and inverted row by row, in double.
#include "physics/kernel_tables.h"

#include <algorithm>
#include <cmath>

#include "physics/physics.h"

namespace mesograin::physics {
namespace {

constexpr int distance_count = 256;
constexpr int share_count = 256;

// What is farther than this share of the light is below single precision's smallest number.
constexpr double deepest = 80.0;

// 2 pi int s f ds over [a, b] for f linear from fa to fb.
double ring_integral(double a, double b, double fa, double fb) {
  return PI * (b - a) * ((a + b) * 0.5 * (fa + fb) + (b - a) * (fb - fa) / 6.0);
}

struct Row {
  std::array<std::vector<double>, 3> values;
  std::vector<double> density;  // the channels' mean, each over its own integral
  std::vector<double> beyond;   // share of its light that goes farther
};

Row make_row(const std::array<const SurfaceKernel*, 3>& kernels, const std::vector<double>& distances, double mu) {
  Row row;
  row.density.assign(distances.size(), 0.0);
  for (int channel = 0; channel < 3; ++channel) {
    row.values[channel] = channel > 0 && kernels[channel] == kernels[channel - 1]
                              ? row.values[channel - 1]
                              : kernels[channel]->evaluate(distances, mu);
    const std::vector<double>& values = row.values[channel];
    double total = 0.0;
    for (std::size_t j = 0; j + 1 < distances.size(); ++j)
      total += ring_integral(distances[j], distances[j + 1], values[j], values[j + 1]);
    if (total > 0.0)
      for (std::size_t j = 0; j < distances.size(); ++j) row.density[j] += values[j] / total;
  }
  // Summed from the far end, so that the tail keeps its digits.
  row.beyond.assign(distances.size(), 0.0);
  for (std::size_t j = distances.size() - 1; j > 0; --j)
    row.beyond[j - 1] =
        row.beyond[j] + ring_integral(distances[j - 1], distances[j], row.density[j - 1], row.density[j]);
  const double total = row.beyond[0];
  if (total > 0.0)
    for (std::size_t j = 0; j < distances.size(); ++j) {
      row.density[j] /= total;
      row.beyond[j] /= total;
    }
  return row;
}

double depth_of(double beyond) { return beyond > 0.0 ? std::min(deepest, -std::log(beyond)) : deepest; }

}  // namespace

KernelTables kernel_tables(const std::array<const SurfaceKernel*, 3>& kernels, double resolution, double largest,
                           double least_mu, int rows) {
  KernelTables tables;
  tables.shortest = resolution;
  tables.step = std::log1p(largest / resolution) / (distance_count - 1);
  tables.least_mu = least_mu;
  tables.largest_depth = deepest;
  tables.profile = {distance_count, rows, {}};
  tables.inverse = {share_count, rows, {}};

  std::vector<double> distances;
  distances.reserve(static_cast<std::size_t>(distance_count));
  for (int j = 0; j < distance_count; ++j) distances.push_back(resolution * std::expm1(j * tables.step));

  for (int i = 0; i < rows; ++i) {
    const double mu = rows > 1 ? least_mu + (1.0 - least_mu) * i / (rows - 1) : 1.0;
    const Row row = make_row(kernels, distances, mu);
    for (int j = 0; j < distance_count; ++j)
      tables.profile.texels.emplace_back(
          glm::dvec4(row.values[0][j], row.values[1][j], row.values[2][j], depth_of(row.beyond[j])));

    int cell = 0;
    for (int k = 0; k < share_count; ++k) {
      const double share = static_cast<double>(k) / (share_count - 1);
      const double depth = deepest * share * share;
      while (cell + 2 < distance_count && depth_of(row.beyond[cell + 1]) <= depth) ++cell;
      const double low = depth_of(row.beyond[cell]);
      const double high = depth_of(row.beyond[cell + 1]);
      // Between two distances the depth rises with the square near no distance and linearly far away: interpolate in
      // s^2.
      const double t = high > low ? std::clamp((depth - low) / (high - low), 0.0, 1.0) : 0.0;
      const double a = distances[cell];
      const double b = distances[cell + 1];
      const double distance = std::sqrt(a * a + t * (b * b - a * a));
      const double density = row.density[cell] + (row.density[cell + 1] - row.density[cell]) * (distance - a) / (b - a);
      tables.inverse.texels.emplace_back(glm::dvec4(distance, density, 0.0, 1.0));
    }
  }
  return tables;
}

}  // namespace mesograin::physics
