// Stored transport: energy, one answer for a seed, and what a sphere's symmetry demands.
#include "transport/stored_transport.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <numeric>

#include "scene/sphere.h"
#include "shapes.h"
#include "transport/between_nodes.h"
#include "transport/exchange.h"
#include "transport/grid.h"
#include "transport/interface.h"
#include "transport/multiple.h"
#include "transport/near_extinctions.h"
#include "transport/octahedron.h"
#include "transport/walks.h"

namespace mesograin::transport {
namespace {

constexpr Quality coarse{.nodes = 2500, .light_across = 16, .way_across = 12};

/// A channel's source function under radiance 1 from everywhere, at nodes inside the body. What albedo 1
/// scatters of light that comes straight is added where it is not stored: as much as each node sees of the outside.
std::vector<float> under_even_light(const StoredTransport& stored, const Walks& walks, double sigma_t,
                                    std::size_t channel) {
  const Grid& grid = walks.grid();
  const Exchange exchange = walks.exchange(sigma_t);
  const std::vector<float> angles = octahedron_solid_angles();
  std::vector<float> sources;
  for (std::size_t node = 0; node < stored.nodes(); ++node) {
    if (grid.used()[node] < 0) continue;
    const auto used = static_cast<std::size_t>(grid.used()[node]);
    const auto place = static_cast<int>(node);
    const glm::vec3 own = stored.lower + glm::vec3(place % stored.size.x, place / stored.size.x % stored.size.y,
                                                   place / (stored.size.x * stored.size.y)) *
                                             stored.spacing;
    if (glm::distance(own, grid.places()[used]) > 0.0F) continue;
    double source = stored.has_unscattered ? 0.0 : exchange.escape[used];
    // What was scattered before is stored over 1 - E_2/2 of the depth (Abramowitz & Stegun 5.1.14).
    const double depth = std::max(sigma_t * static_cast<double>(grid.depths()[used]), 1e-9);
    const double share = stored.has_unscattered ? 1.0 : 1.0 - 0.5 * (std::exp(-depth) + depth * std::expint(-depth));
    for (std::size_t term = 0; term < static_cast<std::size_t>(stored.terms); ++term) {
      double lobe = 0.0;
      for (std::size_t texel = 0; texel < octahedron_texels; ++texel)
        lobe += angles[texel] * stored.lobes[stored.lobe(term, texel, channel)];
      source += share * lobe * stored.sources[term * stored.nodes() + node];
    }
    sources.push_back(static_cast<float>(source));
  }
  return sources;
}

// Light from everywhere that nothing absorbs is inside as it is outside, but for eta^2 (the furnace).
TEST(StoredTransport, KeepsItsEnergy) {
  for (const double eta : {1.0, 1.5})
    for (const double mean_free_paths : {0.1, 3.0, 10.0}) {
      const auto body = std::make_shared<const Body>(cube());
      Walks walks(body, Interface(eta), coarse, {});
      const double sigma_t = mean_free_paths * body->unit();
      const StoredTransport stored = compute_transport(walks, {glm::dvec3(sigma_t), glm::dvec3(1.0), eta});
      EXPECT_EQ(stored.has_unscattered, eta != 1.0);
      for (const float source : under_even_light(stored, walks, sigma_t, 0))
        EXPECT_NEAR(source / (eta * eta), 1.0, 0.015) << "eta " << eta << ", " << mean_free_paths << " to the middle";
    }
}

TEST(StoredTransport, KeepsTheEnergyOfEachChannel) {
  for (const double eta : {1.0, 1.5}) {
    const auto body = std::make_shared<const Body>(cube());
    Walks walks(body, Interface(eta), coarse, {});
    const glm::dvec3 sigma_t = body->unit() * glm::dvec3(1.0, 1.5, 3.0);
    const StoredTransport stored = compute_transport(walks, {sigma_t, glm::dvec3(1.0), eta});
    for (int channel = 0; channel < 3; ++channel)
      for (const float source : under_even_light(stored, walks, sigma_t[channel], static_cast<std::size_t>(channel)))
        EXPECT_NEAR(source / (eta * eta), 1.0, 0.015) << "eta " << eta << ", channel " << channel;
  }
}

TEST(StoredTransport, DependsOnTheSeedAloneNotOnThreads) {
  const Body body(cube());
  const StoredMedium medium{{2.0, 3.0, 4.0}, {0.9, 0.5, 0.99}, 1.3};
  constexpr Quality quick{.nodes = 400, .light_across = 4, .way_across = 4};
  const StoredTransport one = compute_transport(body, medium, quick, {.threads = 1});
  const StoredTransport three = compute_transport(body, medium, quick, {.threads = 3});
  EXPECT_EQ(one.sources, three.sources);
  EXPECT_EQ(one.lobes, three.lobes);
  EXPECT_EQ(one.channels, 3);
}

// A channel is the same whatever the two beside it are.
TEST(StoredTransport, KeepsItsChannelsApart) {
  const Body body(scene::unit_sphere(32, 16));
  const auto green = [&](const glm::dvec3& sigma_t, const glm::dvec3& albedo) {
    const StoredTransport stored = compute_transport(body, {sigma_t, albedo, 1.3}, coarse);
    const std::size_t channel = stored.channels == 1 ? 0 : 1;
    double sum = 0.0;
    for (std::size_t node = 0; node < stored.nodes(); ++node)
      for (std::size_t term = 0; term < static_cast<std::size_t>(stored.terms); ++term)
        sum += stored.lobes[stored.lobe(term, 5, channel)] * stored.sources[term * stored.nodes() + node];
    return sum;
  };
  const double grey = green(glm::dvec3(3.0), glm::dvec3(0.9));
  EXPECT_NEAR(green({1.0, 3.0, 6.0}, {0.5, 0.9, 0.99}) / grey, 1.0, 0.015);  // the rays' noise
}

// Another colour traces nothing: walks that were traced for one extinction and albedo answer for others nearby as
// walks that were traced for these.
TEST(StoredTransport, ReusesItsWalksForOtherColours) {
  const auto body = std::make_shared<const Body>(cube());
  Walks walks(body, Interface(1.3), coarse, {});
  const double step = nearest_step(3.0);
  walks.trace({step}, {});
  const std::size_t known = walks.bytes();
  for (const double change : {0.83, 1.0, 1.2}) {
    const StoredMedium medium{glm::dvec3(step * change), glm::dvec3(0.95), 1.3};
    compute_transport(walks, medium);
    EXPECT_EQ(walks.bytes(), known) << "nothing was traced";
    const TracedExchange fresh = trace_exchange(*body, walks.grid(), Interface(1.3), {step * change}, coarse.way_across,
                                                walks.surface(), Effort{.seed = 7})[0];
    const Exchange near = walks.exchange(step * change);
    double difference = 0.0, sum = 0.0;
    for (std::size_t row = 0; row < near.rows(); ++row) {
      difference += std::abs(near.escape[row] - fresh.traced.escape[row]);
      sum += fresh.traced.escape[row];
    }
    EXPECT_LT(difference / sum, 0.07) << change;  // two seeds at one extinction: 0.05
    const BetweenNodes between = between_nodes(walks.grid());
    Lights one(static_cast<Eigen::Index>(near.rows()), 1);
    one.col(0) = walks.unscattered(step * change).col(octahedron_texels / 2 + 5);
    const Lights ours = solve_multiple(near, between, 0.95, one, {}),
                 theirs = solve_multiple(fresh.traced, between, 0.95, one, {});
    EXPECT_NEAR(ours.sum() / theirs.sum(), 1.0, 0.01) << change;
    EXPECT_LT((ours - theirs).cwiseAbs().sum() / theirs.sum(), 0.05) << change;
  }
  // The same medium, whatever was asked for before.
  const StoredMedium medium{glm::dvec3(1.1 * step), glm::dvec3(0.95), 1.3};
  EXPECT_EQ(compute_transport(walks, medium).sources, compute_transport(*body, medium, coarse).sources);
}

// The same of what is scattered again where nothing refracts, with its share below the surface.
TEST(StoredTransport, ReusesItsSharesForOtherColours) {
  const auto body = std::make_shared<const Body>(cube());
  Walks walks(body, Interface(1.0), coarse, {});
  const double step = nearest_step(5.0);
  walks.trace({step}, {});
  for (const double change : {0.83, 1.0, 1.2}) {
    const TracedExchange fresh = trace_exchange(*body, walks.grid(), Interface(1.0), {step * change}, coarse.way_across,
                                                walks.surface(), Effort{.seed = 7})[0];
    const Exchange ours = walks.exchange_of_scattered(step * change);
    const Exchange theirs = fresh.of_scattered(step * change);
    double difference = 0.0, sum = 0.0;
    for (std::size_t row = 0; row < ours.rows(); ++row) {
      const auto of_row = [row](const Exchange& exchange) {
        return std::accumulate(exchange.values.begin() + static_cast<std::ptrdiff_t>(exchange.first[row]),
                               exchange.values.begin() + static_cast<std::ptrdiff_t>(exchange.first[row + 1]), 0.0);
      };
      difference += std::abs(of_row(ours) - of_row(theirs));
      sum += of_row(theirs);
      // All but what comes straight, and what was scattered once of that.
      EXPECT_LT(of_row(theirs), 1.0F - theirs.escape[row]);
    }
    EXPECT_LT(difference / sum, 0.02) << change;
  }
}

// While a slider is dragged, walks that were traced a step of the ladder from there tell what is seen about as well as
// other random numbers do, and trace nothing; two steps away they do not.
TEST(StoredTransport, NearlyTellsWhatWalksWereTracedBeside) {
  const auto body = std::make_shared<const Body>(cube());
  Walks walks(body, Interface(1.3), coarse, {});
  const double step = nearest_step(3.0);
  const auto grey = [](double sigma_t) { return StoredMedium{glm::dvec3(sigma_t), glm::dvec3(0.93), 1.3}; };
  EXPECT_FALSE(nearly_known(walks, grey(step)));
  walks.trace({step}, {});
  EXPECT_TRUE(known(walks, grey(step)));
  EXPECT_FALSE(nearly_known(walks, grey(step * extinction_step * extinction_step)));
  const std::vector<int>& used = walks.grid().used();
  for (const double sigma_t : {step * extinction_step, step / extinction_step}) {
    ASSERT_TRUE(nearly_known(walks, grey(sigma_t)));
    EXPECT_FALSE(known(walks, grey(sigma_t)));
    Walks own(body, Interface(1.3), coarse, {});
    own.trace({sigma_t}, {});
    // In pictures from all sides, in light from some.
    const auto seen = [&](const StoredTransport& stored) -> Lights {
      constexpr int apart = 61;
      Lights sources = Lights::Zero(own.sights(sigma_t).cols(), octahedron_texels / apart);
      for (std::size_t term = 0; term < static_cast<std::size_t>(stored.terms); ++term)
        for (std::size_t node = 0; node < stored.nodes(); ++node)
          for (Eigen::Index light = 0; light < sources.cols() && used[node] >= 0; ++light)
            sources(used[node], light) +=
                stored.sources[term * stored.nodes() + node] *
                stored.lobes[term * octahedron_texels + static_cast<std::size_t>(apart * light)];
      return own.sights(sigma_t) * sources;
    };
    const Lights right = seen(compute_transport(own, grey(sigma_t)));
    const Lights of_other_seed = seen(compute_transport(*body, grey(sigma_t), coarse, Effort{.seed = 7}));
    const Lights recalled = seen(recalled_transport(walks, grey(sigma_t)));
    EXPECT_LT((recalled - right).cwiseAbs().sum(), 1.5F * (of_other_seed - right).cwiseAbs().sum()) << sigma_t / step;
  }
}

// Light that is absorbed falls off as fast whether nodes lie a mean free path from one another or half of one: five
// mean free paths below a surface that is lit evenly, straight lines between nodes far apart would have it 1.074 times
// as bright as those between near ones.
// So what is stored of a body never takes more memory than it may.
TEST(StoredTransport, HasNoMoreNodesThanItMay) {
  constexpr int most_nodes = 8120;
  for (const glm::dvec3& sides : {glm::dvec3(1.0), glm::dvec3(1.0, 0.3, 0.3), glm::dvec3(1.0, 0.01, 0.01),
                                  glm::dvec3(1.0, 1.0, 0.2), glm::dvec3(1.0, 1.0, 0.03), glm::dvec3(1.0, 0.9, 0.01)})
    for (const Spacing spacing : {Spacing::even, Spacing::nearer_across}) {
      const Body body(cube(), glm::dmat3(sides.x, 0.0, 0.0, 0.0, sides.y, 0.0, 0.0, 0.0, sides.z));
      const glm::ivec3 size = Grid(body, 6600, spacing, most_nodes).size();
      EXPECT_LE(size.x * size.y * size.z, most_nodes) << sides.x << " " << sides.y << " " << sides.z;
      EXPECT_GT(size.x * size.y * size.z, most_nodes / 4) << sides.x << " " << sides.y << " " << sides.z;
    }
}

TEST(StoredTransport, FallsOffAsFastBetweenNodesFarApart) {
  constexpr double sigma_t = 5.0;
  const Body body(scene::unit_sphere(32, 16));
  const auto in_the_middle = [&](int nodes) {
    const Grid grid(body, nodes);
    const Exchange exchange = trace_exchange(body, grid, Interface(1.3), {sigma_t}, 16, {}, {})[0].traced;
    Lights lit(static_cast<Eigen::Index>(exchange.rows()), 1);
    for (std::size_t node = 0; node < exchange.rows(); ++node)
      lit(static_cast<Eigen::Index>(node), 0) = exchange.escape[node];
    const Lights light = solve_multiple(exchange, between_nodes(grid), 0.9, lit, {});
    std::size_t middle = 0;
    for (std::size_t node = 0; node < exchange.rows(); ++node)
      if (glm::length(grid.places()[node]) < glm::length(grid.places()[middle])) middle = node;
    return light(static_cast<Eigen::Index>(middle), 0);
  };
  EXPECT_NEAR(in_the_middle(1000) / in_the_middle(8000), 1.0, 0.04);
}

TEST(StoredTransport, IsBrighterWhereTheLightComesFrom) {
  const Body body(scene::unit_sphere(32, 16));
  const StoredTransport stored = compute_transport(body, {glm::dvec3(3.0), glm::dvec3(0.9), 1.3}, coarse);
  // Light from the texel nearest to +z, and the nodes nearest to both poles.
  constexpr int up = octahedron_side / 2 * octahedron_side + octahedron_side / 2;
  const auto source = [&](int z) {
    const int place = (z * stored.size.y + stored.size.y / 2) * stored.size.x + stored.size.x / 2;
    const auto node = static_cast<std::size_t>(place);
    double sum = 0.0;
    for (int term = 0; term < stored.terms; ++term)
      sum += stored.lobes[term * octahedron_texels + up] * stored.sources[term * stored.nodes() + node];
    return sum;
  };
  EXPECT_GT(source(stored.size.z - 2), 3.0 * source(1));
  EXPECT_GT(source(1), 0.0);
}

}  // namespace
}  // namespace mesograin::transport
