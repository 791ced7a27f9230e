// Light that enters, its exchange within the body, and the few terms that tell both.
#include "transport/stored_transport.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

#include "transport/exchange.h"
#include "transport/grid.h"
#include "transport/multiple.h"
#include "transport/octahedron.h"
#include "transport/unscattered.h"

namespace mesograin::transport {
namespace {

// Terms that the light is solved for; fewer of them are stored.
constexpr int solved_terms = 32;
constexpr int grey_terms = 16;
constexpr int coloured_terms = 8;

/// A few functions of the direction, and how much of each is in every row.
struct Terms {
  Lights amounts;  ///< a column a term
  Lights lobes;    ///< a row a term, a column a texel of the octahedral map
};

/// The terms that leave least out, `weights` of rows and solid angles of texels considered (principal components).
Terms principal_terms(const Lights& light, int terms) {
  const std::array<float, octahedron_texels> angles = octahedron_solid_angles();
  const Eigen::RowVectorXf roots = Eigen::Map<const Eigen::RowVectorXf>(angles.data(), octahedron_texels).cwiseSqrt();
  const Eigen::MatrixXf weighed = light.array().rowwise() * roots.array();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXf> solver(weighed.transpose() * weighed);
  const Eigen::MatrixXf vectors = solver.eigenvectors().rightCols(terms);
  return {weighed * vectors, (vectors.array().colwise() / roots.transpose().array()).matrix().transpose()};
}

/// Takes the terms apart anew, so that the first of them say most of what leaves the body.
Terms fewer_terms(const Terms& all, const Eigen::VectorXf& row_weights, int terms) {
  const Eigen::MatrixXf weighed = all.amounts.array().colwise() * row_weights.array();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXf> solver(weighed.transpose() * weighed);
  const Eigen::MatrixXf vectors = solver.eigenvectors().rightCols(terms);
  return {all.amounts * vectors, vectors.transpose() * all.lobes};
}

// Unscattered light from everywhere is known: what a place sees of the outside, in which radiance is eta^2 less. It
// takes out what nodes at the surface have wrong by standing for more than themselves.
void calibrate(Lights& light, const Exchange& exchange, double eta) {
  const std::array<float, octahedron_texels> angles = octahedron_solid_angles();
  const Eigen::VectorXf from_everywhere = light * Eigen::Map<const Eigen::VectorXf>(angles.data(), octahedron_texels);
  for (Eigen::Index row = 0; row < light.rows(); ++row) {
    const float right = static_cast<float>(eta * eta) * exchange.escape[static_cast<std::size_t>(row)];
    light.row(row) *= std::clamp(right / std::max(from_everywhere[row], 1e-9F), 0.1F, 10.0F);
  }
}

}  // namespace

double node_spacing(const Body& body, const Quality& quality) {
  const glm::dvec3 extent(body.upper() - body.lower());
  return std::cbrt(extent.x * extent.y * extent.z / quality.nodes);
}

StoredTransport compute_transport(const Body& body, const StoredMedium& medium, const Quality& quality,
                                  const Effort& effort) {
  const Grid grid(body, quality.nodes, part_of(effort, 0.0, 0.1));
  StoredTransport stored{.size = grid.size(),
                         .lower = grid.lower(),
                         .spacing = grid.spacing(),
                         .unit = body.unit(),
                         .axes = glm::mat3(glm::transpose(body.axes())),
                         .mean_chord = 4.0 * body.volume() / body.area(),  // Cauchy
                         .terms = medium.grey() ? grey_terms : coloured_terms,
                         .channels = medium.grey() ? 1 : 3,
                         .distances = grid.distances(),
                         .sources = {},
                         .lobes = {}};
  const int kept = stored.terms;
  const int channels = stored.channels;
  stored.sources.resize(static_cast<std::size_t>(kept * channels) * stored.nodes(), 0.0F);
  if (medium.albedo == glm::dvec3(0.0)) {  // clear: nothing is scattered
    stored.lobes.resize(static_cast<std::size_t>(kept) * octahedron_texels, 0.0F);
    return stored;
  }
  std::vector<double> extinctions;
  std::array<std::size_t, 3> extinction_of{};
  for (int channel = 0; channel < channels; ++channel) {
    const auto found = std::find(extinctions.begin(), extinctions.end(), medium.sigma_t[channel]);
    extinction_of[static_cast<std::size_t>(channel)] = static_cast<std::size_t>(found - extinctions.begin());
    if (found == extinctions.end()) extinctions.push_back(medium.sigma_t[channel]);
  }
  const auto entered =
      unscattered_light(body, grid, medium.eta, extinctions, quality.light_across, part_of(effort, 0.1, 0.4));
  const std::vector<Exchange> exchanges =
      trace_exchange(body, grid, medium.eta, extinctions, quality.way_across, part_of(effort, 0.4, 0.8));

  // One set of lobes for all channels.
  const auto nodes = static_cast<Eigen::Index>(grid.places().size());
  Lights all(nodes * channels, octahedron_texels);
  for (int channel = 0; channel < channels; ++channel) {
    const std::size_t e = extinction_of[static_cast<std::size_t>(channel)];
    Lights light(nodes, octahedron_texels);
    for (Eigen::Index texel = 0; texel < octahedron_texels; ++texel)
      for (Eigen::Index node = 0; node < nodes; ++node)
        light(node, texel) =
            entered[static_cast<std::size_t>(texel)]
                   [static_cast<std::size_t>(grid.deputies()[static_cast<std::size_t>(node)]) * extinctions.size() + e];
    calibrate(light, exchanges[e], medium.eta);
    all.middleRows(channel * nodes, nodes) = light;
  }
  Terms terms = principal_terms(all, solved_terms);

  Eigen::VectorXf weights(nodes * channels);
  for (int channel = 0; channel < channels; ++channel) {
    const std::size_t e = extinction_of[static_cast<std::size_t>(channel)];
    const Lights unscattered = terms.amounts.middleRows(channel * nodes, nodes);
    const Lights light =
        solve_multiple(exchanges[e], medium.albedo[channel], unscattered,
                       part_of(effort, 0.8 + 0.2 * channel / channels, 0.8 + 0.2 * (channel + 1) / channels));
    terms.amounts.middleRows(channel * nodes, nodes) = static_cast<float>(medium.albedo[channel]) * light;
    for (Eigen::Index node = 0; node < nodes; ++node) {
      // What is deep is seen little.
      const float depth = grid.depths()[static_cast<std::size_t>(node)] * static_cast<float>(extinctions[e]);
      weights[channel * nodes + node] = 0.05F + std::exp(-0.5F * depth);
    }
  }
  terms = fewer_terms(terms, weights, kept);

  for (int term = 0; term < kept; ++term)
    for (std::size_t node = 0; node < stored.nodes(); ++node) {
      const int used = grid.used()[node];
      if (used < 0) continue;
      for (int channel = 0; channel < channels; ++channel)
        stored.sources[(static_cast<std::size_t>(term) * stored.nodes() + node) * static_cast<std::size_t>(channels) +
                       static_cast<std::size_t>(channel)] = terms.amounts(channel * nodes + used, term);
    }
  for (int term = 0; term < kept; ++term)
    for (Eigen::Index texel = 0; texel < octahedron_texels; ++texel) stored.lobes.push_back(terms.lobes(term, texel));
  return stored;
}

}  // namespace mesograin::transport
