// Light that enters, its exchange within the body, and the few terms that tell both.
#include "transport/stored_transport.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/matrix.hpp>
#include <memory>
#include <vector>

#include "physics/physics.h"
#include "transport/octahedron.h"
#include "transport/scattered_once.h"
#include "transport/terms.h"

namespace mesograin::transport {
namespace {

/// As files have it: what is drawn does not depend on whether it was computed now or read.
float in_half(float number) { return glm::unpackHalf1x16(glm::packHalf1x16(number)); }

/// Half precision takes lobes of at most 1.
void make_lobes_at_most_one(SharedTerms& terms) {
  Lights& lobes = terms.lobes;
  for (Eigen::Index term = 0; term < lobes.rows(); ++term) {
    const float most = lobes.row(term).cwiseAbs().maxCoeff();
    if (most <= 0.0F) continue;
    lobes.row(term) /= most;
    terms.amounts.col(term) *= most;
  }
}

// Light that was scattered before falls off towards the surface within less than a thick grain's cell, more steeply the
// nearer; what is left of it beside that of light that is even everywhere hardly does. That is what is told, by nodes
// that it is linear between.
float share_below(const Grid& grid, Eigen::Index node, double sigma_t) {
  return static_cast<float>(
      physics::scattered_share_below(sigma_t * static_cast<double>(grid.depths()[static_cast<std::size_t>(node)])));
}

Eigen::DiagonalMatrix<float, Eigen::Dynamic> over_share_below(const Grid& grid, double sigma_t) {
  Eigen::VectorXf over(static_cast<Eigen::Index>(grid.depths().size()));
  for (Eigen::Index row = 0; row < over.size(); ++row) over[row] = 1.0F / share_below(grid, row, sigma_t);
  return Eigen::DiagonalMatrix<float, Eigen::Dynamic>(over);
}

// Beside its own share, of which each channel is told, light has what another channel's fall leaves of it.
void let_fall_as(double other_sigma_t, Lights& sources, const Grid& grid, double sigma_t) {
  if (sigma_t == other_sigma_t) return;
  for (Eigen::Index row = 0; row < sources.rows(); ++row)
    sources.row(row) *= share_below(grid, row, other_sigma_t) / share_below(grid, row, sigma_t);
}

/// No denser than the nodes tell.
StoredMedium told_by(const Walks& walks, const StoredMedium& asked) {
  StoredMedium medium = asked;
  medium.sigma_t = glm::min(asked.sigma_t, glm::dvec3(densest_told(walks.grid().spacing())));
  return medium;
}

/// Those that are to be traced.
std::vector<double> extinctions_of(const StoredMedium& medium) {
  if (medium.albedo == glm::dvec3(0.0)) return {};  // clear: nothing is scattered
  if (medium.grey()) return {medium.sigma_t.r};
  return {medium.sigma_t.r, medium.sigma_t.g, medium.sigma_t.b};
}

/// All of it but light.
StoredTransport without_light(const Walks& walks, const StoredMedium& medium, int terms) {
  const Body& body = walks.body();
  const Grid& grid = walks.grid();
  StoredTransport stored{.size = grid.size(),
                         .lower = grid.lower(),
                         .spacing = grid.spacing(),
                         .unit = body.unit(),
                         .axes = glm::mat3(glm::transpose(body.axes())),
                         .mean_chord = 4.0 * body.volume() / body.area(),  // Cauchy
                         .terms = terms,
                         .channels = medium.grey() ? 1 : 3,
                         .convex = body.convex(),
                         .has_unscattered = medium.eta != 1.0,
                         .distances = walks.surface(),
                         .sources = {},
                         .lobes = {}};
  const auto products = static_cast<std::size_t>(terms);
  stored.sources.resize(products * stored.nodes(), 0.0F);
  stored.lobes.resize(products * octahedron_texels * static_cast<std::size_t>(stored.channels), 0.0F);
  return stored;
}

/// Of a used node a row.
void put_sources(std::size_t term, const Eigen::VectorXf& sources, const Grid& grid, StoredTransport& stored) {
  for (std::size_t node = 0; node < stored.nodes(); ++node)
    if (grid.used()[node] >= 0) stored.sources[term * stored.nodes() + node] = in_half(sources(grid.used()[node]));
}

void put_lobe(std::size_t term, std::size_t channel, const std::vector<float>& lobe, StoredTransport& stored) {
  for (std::size_t texel = 0; texel < octahedron_texels; ++texel)
    stored.lobes[stored.lobe(term, texel, channel)] = lobe[texel];
}

/// Of the three numbers the one between the others.
double middle(const glm::dvec3& of) { return std::max(std::min(of.r, of.g), std::min(std::max(of.r, of.g), of.b)); }

// As walks tell it.
StoredTransport transport_by(const Walks& walks, const StoredMedium& medium, const Effort& effort) {
  const Grid& grid = walks.grid();
  const Quality& quality = walks.quality();
  StoredTransport stored = without_light(walks, medium, medium.grey() ? quality.terms : quality.shared_terms);
  const int channels = stored.channels;
  if (medium.albedo == glm::dvec3(0.0)) return stored;  // clear: nothing is scattered
  const BetweenNodes between = between_nodes(grid);
  // What is seen of the others is nearly what is seen of this one.
  const double shared_sigma_t = middle(medium.sigma_t);
  const double most_albedo = std::max({medium.albedo.r, medium.albedo.g, medium.albedo.b});
  // Channels have lobes of their own: light in a thick one is sharper in its direction than in a thin one.
  std::vector<Terms> of_channels;
  for (int channel = 0; channel < channels; ++channel) {
    const double sigma_t = medium.sigma_t[channel];
    Lights light = walks.unscattered(sigma_t, effort);
    const Lobes& lobes = walks.lobes(sigma_t);
    const Lights first = product(light, lobes.readers, effort);
    Lights scattered = solve_multiple(
        walks.exchange(sigma_t), between, medium.albedo[channel], first,
        part_of(effort, static_cast<double>(channel) / channels, static_cast<double>(channel + 1) / channels));
    // What is scattered again is told by these lobes well enough, and all that is not is known.
    scattered -= first;
    // View rays see what lies between nodes, just below the surface those beyond it and below. Even light stays even.
    // Where light that was scattered before is told beside it (below), its fall towards the surface is in that.
    if (!stored.has_unscattered) light.setZero();
    add_product(light, scattered, lobes.lobes, effort);
    if (stored.has_unscattered) light = Lights(between * light);
    of_channels.push_back(principal_terms(walks.sights(sigma_t), light, lobes, stored.terms, effort));
    Lights& amounts = of_channels.back().amounts;
    amounts *= static_cast<float>(medium.albedo[channel] / most_albedo);
    if (!stored.has_unscattered) let_fall_as(shared_sigma_t, amounts, grid, sigma_t);
  }
  SharedTerms terms = shared_terms(walks.sights(shared_sigma_t), of_channels);
  make_lobes_at_most_one(terms);
  terms.amounts *= static_cast<float>(most_albedo);
  if (!stored.has_unscattered) terms.amounts = Lights(over_share_below(grid, shared_sigma_t) * terms.amounts);
  for (std::size_t term = 0; term < static_cast<std::size_t>(stored.terms); ++term) {
    const auto column = static_cast<Eigen::Index>(term);
    put_sources(term, terms.amounts.col(column), grid, stored);
    const Eigen::Index texels = terms.lobes.cols() / channels;
    for (int channel = 0; channel < channels; ++channel) {
      const float* lobe = terms.lobes.row(column).data() + channel * texels;
      put_lobe(term, static_cast<std::size_t>(channel), octahedron_map({lobe, lobe + texels}, quality.directions),
               stored);
    }
  }
  return stored;
}

/// Where nothing refracts, of a sun: in each channel what it is after any number of scatterings, but the last albedo.
Lights light_of_sun(const Walks& walks, const StoredMedium& medium, const Lamp& sun, const Effort& effort) {
  const std::vector<double> extinctions = extinctions_of(medium);
  Lights light = scattered_once(walks.body(), walks.grid(), extinctions, sun, part_of(effort, 0.0, 0.5));
  for (Eigen::Index channel = 0; channel < light.cols(); ++channel) {
    const double sigma_t = extinctions[static_cast<std::size_t>(channel)];
    const double albedo = medium.albedo[static_cast<int>(channel)];
    // Light is exchanged as it is told, so that none is lost: a little at each scattering would be much in the end.
    const BetweenNodes over_share = between_nodes(walks.grid()) * over_share_below(walks.grid(), sigma_t);
    const Lights first = static_cast<float>(albedo) * light.col(channel);
    light.col(channel) = over_share * solve_multiple(walks.exchange_of_scattered(sigma_t), over_share, albedo, first,
                                                     part_of(effort, 0.5, 1.0));
  }
  return light;
}

/// The same of any lamp.
Lights light_of_lamp(const Walks& walks, const StoredMedium& medium, const Lamp& lamp, const Effort& effort) {
  const Grid& grid = walks.grid();
  const std::vector<double> extinctions = extinctions_of(medium);
  const BetweenNodes between = between_nodes(grid);
  Lights light = walks.unscattered(extinctions, lamp, part_of(effort, 0.0, 0.5));
  for (Eigen::Index channel = 0; channel < light.cols(); ++channel) {
    const double sigma_t = extinctions[static_cast<std::size_t>(channel)];
    const Lights first = light.col(channel);
    const Lights all = solve_multiple(walks.exchange(sigma_t), between, medium.albedo[static_cast<int>(channel)], first,
                                      part_of(effort, 0.5, 1.0));
    if (medium.eta == 1.0)
      light.col(channel) = over_share_below(grid, sigma_t) * (all - first);
    else
      light.col(channel) = between * all;
  }
  return light;
}

// As transport_by has it, of one column for each channel.
StoredTransport lamp_transport(const Walks& walks, const StoredMedium& medium, const Lamp& lamp, const Effort& effort) {
  const Grid& grid = walks.grid();
  StoredTransport stored = without_light(walks, medium, medium.grey() ? 1 : 3);
  if (medium.albedo == glm::dvec3(0.0)) return stored;  // clear: nothing is scattered
  Lights light = medium.eta == 1.0 && lamp.far ? light_of_sun(walks, medium, lamp, effort)
                                               : light_of_lamp(walks, medium, lamp, effort);
  const auto channels = static_cast<std::size_t>(stored.channels);
  for (std::size_t channel = 0; channel < channels; ++channel) {
    auto column = light.col(static_cast<Eigen::Index>(channel));
    column *= static_cast<float>(medium.albedo[static_cast<int>(channel)]);
    const float most = column.cwiseAbs().maxCoeff();
    if (!(most > 0.0F)) continue;
    put_sources(channel, column / most, grid, stored);
    for (std::size_t texel = 0; texel < octahedron_texels; ++texel)
      stored.lobes[stored.lobe(channel, texel, channel)] = most;
  }
  return stored;
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
  const StoredMedium medium = told_by(walks, asked);
  walks.trace(extinctions_of(medium), part_of(effort, 0.0, 0.8));
  return transport_by(walks, medium, part_of(effort, 0.8, 1.0));
}

StoredTransport compute_transport(Walks& walks, const StoredMedium& asked, const Lamp& lamp, const Effort& effort) {
  const StoredMedium medium = told_by(walks, asked);
  walks.trace(extinctions_of(medium), part_of(effort, 0.0, 0.8));
  return lamp_transport(walks, medium, lamp, part_of(effort, 0.8, 1.0));
}

bool known(const Walks& walks, const StoredMedium& medium) {
  return walks.know(extinctions_of(told_by(walks, medium)));
}

bool nearly_known(const Walks& walks, const StoredMedium& medium) {
  return walks.nearly_know(extinctions_of(told_by(walks, medium)));
}

StoredTransport recalled_transport(const Walks& walks, const StoredMedium& medium, const Effort& effort) {
  return transport_by(walks, told_by(walks, medium), effort);
}

StoredTransport compute_transport(const Body& body, const StoredMedium& medium, const Quality& quality,
                                  const Effort& effort) {
  Walks walks(std::make_shared<Body>(body), Interface(medium.eta, medium.alpha), quality, part_of(effort, 0.0, 0.1));
  return compute_transport(walks, medium, part_of(effort, 0.1, 1.0));
}

}  // namespace mesograin::transport
