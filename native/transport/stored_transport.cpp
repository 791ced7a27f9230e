// Light that enters, its exchange within the body, and the few terms that tell both.
#include "transport/stored_transport.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <memory>

#include "physics/physics.h"
#include "transport/octahedron.h"
#include "transport/random.h"
#include "transport/sights.h"

namespace mesograin::transport {
namespace {

// Directions that are looked at beside those that are to be found.
constexpr int surplus = 8;

// Terms that the light is solved for, for each that is stored.
constexpr int solved_a_stored = 2;

/// A few functions of the direction, and how much of each is in every row.
struct Terms {
  Lights amounts;  ///< a column a term
  Lights lobes;    ///< a row a term, a column a texel of the octahedral map

  /// Half precision takes lobes of at most 1.
  void make_lobes_at_most_one() {
    for (Eigen::Index term = 0; term < lobes.rows(); ++term) {
      const float most = lobes.row(term).cwiseAbs().maxCoeff();
      if (most <= 0.0F) continue;
      lobes.row(term) /= most;
      amounts.col(term) *= most;
    }
  }
};

/// What is found of the row space of some lights: directions of it, a column each, and how much of each is in every
/// row.
struct Leading {
  Eigen::MatrixXf directions;
  Lights amounts;
};

/// The directions of the row space that most of sights * rows is in: subspace iteration (Halko, Martinsson and Tropp,
/// "Finding structure with randomness", 2011, algorithm 4.4) from those of `guess`, orthonormal, and random ones beside
/// them.
Leading leading_directions(const Sights& sights, const Lights& rows, const Eigen::MatrixXf& guess, int count) {
  const auto orthonormal = [](const Eigen::MatrixXf& columns) -> Eigen::MatrixXf {
    return Eigen::HouseholderQR<Eigen::MatrixXf>(columns).householderQ() *
           Eigen::MatrixXf::Identity(columns.rows(), columns.cols());
  };
  Random random(1, 0);
  Eigen::MatrixXf basis(rows.cols(), std::max<Eigen::Index>(guess.cols(), count) + surplus);
  for (Eigen::Index i = 0; i < basis.size(); ++i) basis.data()[i] = random.uniform() - 0.5F;
  basis.leftCols(guess.cols()) = guess;
  const int turns = guess.cols() > 0 ? 1 : 2;
  for (int turn = 0; turn < turns; ++turn) {
    const Lights seen = sights * Lights(rows * basis);
    basis = orthonormal(rows.transpose() * Lights(sights.transpose() * seen));
  }
  const Lights amounts = rows * basis;
  const Lights seen = sights * amounts;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXf> solver(seen.transpose() * seen);
  const Eigen::MatrixXf leading = solver.eigenvectors().rightCols(count);
  return {basis * leading, amounts * leading};
}

/// The root of what each direction counts: by its solid angle, and, so that light which hardly enters, for it grazes a
/// flat grain, is told well too, by the root of what it lets in.
Eigen::RowVectorXf direction_weights(const Lights& light) {
  const std::array<float, octahedron_texels> angles = octahedron_solid_angles();
  const Eigen::ArrayXf entered = light.colwise().norm().transpose().array();
  return (Eigen::Map<const Eigen::ArrayXf>(angles.data(), octahedron_texels) / entered.max(1e-3F * entered.mean()))
      .sqrt()
      .matrix()
      .transpose();
}

/// The terms that leave least out of what is seen of `light`: principal components of pictures, from all sides and
/// in light from everywhere. What is noise at single nodes, hidden or far below the surface counts little there.
/// The last ones have most. `guess`: terms of some other light in the same body, or none.
Terms principal_terms(const Sights& sights, const Lights& light, const Terms& guess, int terms) {
  const Eigen::RowVectorXf weights = direction_weights(light);
  const Lights weighed = light.array().rowwise() * weights.array();
  const Lights likely = guess.lobes.bottomRows(std::min<Eigen::Index>(guess.lobes.rows(), terms + surplus));
  const Eigen::MatrixXf guessed = (likely.array().rowwise() * weights.array()).matrix().transpose();
  const Leading leading = leading_directions(sights, weighed, guessed, terms);
  return {leading.amounts, (leading.directions.array().colwise() / weights.transpose().array()).matrix().transpose()};
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

// Light that was scattered before falls off towards the surface within less than a thick grain's cell, more steeply the
// nearer; what is left of it beside that of light that is even everywhere hardly does, and is linear between nodes.
void divide_by_share_below(Lights& sources, const Grid& grid, double sigma_t) {
  for (Eigen::Index row = 0; row < sources.rows(); ++row)
    sources.row(row) /= static_cast<float>(
        physics::scattered_share_below(sigma_t * static_cast<double>(grid.depths()[static_cast<std::size_t>(row)])));
}

}  // namespace

double node_spacing(const Body& body, const Quality& quality) {
  const glm::dvec3 extent(body.upper() - body.lower());
  return std::cbrt(extent.x * extent.y * extent.z / quality.nodes);
}

double densest_told(double spacing) {
  constexpr double widest_spacing = 1.6;  // mean free paths
  return widest_spacing / spacing;
}

double densest_told(const glm::vec3& spacing) {
  return densest_told(std::cbrt(static_cast<double>(spacing.x) * spacing.y * spacing.z));
}

StoredTransport compute_transport(Walks& walks, const StoredMedium& asked, const Effort& effort) {
  const Body& body = walks.body();
  const Grid& grid = walks.grid();
  StoredMedium medium = asked;
  medium.sigma_t = glm::min(asked.sigma_t, glm::dvec3(densest_told(grid.spacing())));
  StoredTransport stored{.size = grid.size(),
                         .lower = grid.lower(),
                         .spacing = grid.spacing(),
                         .unit = body.unit(),
                         .axes = glm::mat3(glm::transpose(body.axes())),
                         .mean_chord = 4.0 * body.volume() / body.area(),  // Cauchy
                         .terms = walks.quality().terms,
                         .channels = medium.grey() ? 1 : 3,
                         .convex = body.convex(),
                         .has_unscattered = medium.eta != 1.0,
                         .distances = walks.surface(),
                         .sources = {},
                         .lobes = {}};
  const int kept = stored.terms;
  const int channels = stored.channels;
  stored.sources.resize(static_cast<std::size_t>(kept * channels) * stored.nodes(), 0.0F);
  if (medium.albedo == glm::dvec3(0.0)) {  // clear: nothing is scattered
    stored.lobes.resize(static_cast<std::size_t>(kept * channels) * octahedron_texels, 0.0F);
    return stored;
  }
  std::vector<double> extinctions;
  std::array<std::size_t, 3> extinction_of{};
  for (int channel = 0; channel < channels; ++channel) {
    const auto found = std::find(extinctions.begin(), extinctions.end(), medium.sigma_t[channel]);
    extinction_of[static_cast<std::size_t>(channel)] = static_cast<std::size_t>(found - extinctions.begin());
    if (found == extinctions.end()) extinctions.push_back(medium.sigma_t[channel]);
  }
  walks.trace(extinctions, part_of(effort, 0.0, 0.8));
  std::vector<Exchange> exchanges;
  exchanges.reserve(extinctions.size());
  for (const double sigma_t : extinctions) exchanges.push_back(walks.exchange(sigma_t));

  const BetweenNodes between = between_nodes(grid);
  const BetweenNodes beyond = beyond_surface(grid);
  // Channels have lobes of their own: light in a thick one is sharper in its direction than in a thin one.
  stored.lobes.resize(static_cast<std::size_t>(kept * channels) * octahedron_texels);
  for (int channel = 0; channel < channels; ++channel) {
    const std::size_t e = extinction_of[static_cast<std::size_t>(channel)];
    Lights light = walks.unscattered(extinctions[e]);
    calibrate(light, exchanges[e], medium.eta);
    const Sights seen = sights(body, grid, medium.eta, extinctions[e], effort);
    const Terms first = principal_terms(seen, light, {}, solved_a_stored * kept);
    const Lights solved =
        solve_multiple(exchanges[e], between, medium.albedo[channel], first.amounts,
                       part_of(effort, 0.8 + 0.2 * channel / channels, 0.8 + 0.2 * (channel + 1) / channels));
    // What is scattered again is told by these terms well enough, and all that is not is known.
    const Lights scattered = (solved - first.amounts) * first.lobes;
    // What view rays see just below the surface lies between nodes beyond it and those below. Even light stays even.
    // Where light that was scattered before is told beside it (below), its fall towards the surface is in that.
    if (stored.has_unscattered)
      light = Lights(beyond * (light + scattered));
    else
      light = scattered;
    Terms terms = principal_terms(seen, light, first, kept);
    terms.make_lobes_at_most_one();
    terms.amounts *= static_cast<float>(medium.albedo[channel]);
    if (!stored.has_unscattered) divide_by_share_below(terms.amounts, grid, extinctions[e]);
    const auto index = [&](std::size_t count, int term, std::size_t of) {
      return (static_cast<std::size_t>(term) * count + of) * static_cast<std::size_t>(channels) +
             static_cast<std::size_t>(channel);
    };
    for (int term = 0; term < kept; ++term) {
      for (std::size_t node = 0; node < stored.nodes(); ++node)
        if (grid.used()[node] >= 0)
          stored.sources[index(stored.nodes(), term, node)] = terms.amounts(grid.used()[node], term);
      for (std::size_t texel = 0; texel < octahedron_texels; ++texel)
        stored.lobes[index(octahedron_texels, term, texel)] = terms.lobes(term, static_cast<Eigen::Index>(texel));
    }
  }
  return stored;
}

StoredTransport compute_transport(const Body& body, const StoredMedium& medium, const Quality& quality,
                                  const Effort& effort) {
  Walks walks(std::make_shared<Body>(body), Interface(medium.eta, medium.alpha), quality, part_of(effort, 0.0, 0.1));
  return compute_transport(walks, medium, part_of(effort, 0.1, 1.0));
}

}  // namespace mesograin::transport
