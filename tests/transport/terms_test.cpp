// Terms that channels share.
#include "transport/terms.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "transport/octahedron.h"
#include "transport/random.h"

namespace mesograin::transport {
namespace {

constexpr Eigen::Index nodes = 200;
constexpr Eigen::Index functions = 30;

Lights some_numbers(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
  Random random(seed, 0);
  Lights numbers(rows, columns);
  for (Eigen::Index i = 0; i < numbers.size(); ++i) numbers.data()[i] = random.uniform() - 0.5F;
  return numbers;
}

/// Ever less of ever more functions of the place, which are the same for all seeds.
Lights some_light(std::uint64_t seed) {
  Lights amounts = some_numbers(nodes, functions, 1);
  for (Eigen::Index i = 0; i < functions; ++i) amounts.col(i) *= std::pow(0.7F, static_cast<float>(i));
  return amounts * some_numbers(functions, octahedron_texels, seed);
}

Sights all_nodes() {
  Sights sights(nodes, nodes);
  sights.setIdentity();
  return sights;
}

Terms own_terms(const Lights& light, int count) { return principal_terms(all_nodes(), light, {}, count, {}); }

Lights told(const SharedTerms& terms, Eigen::Index channel) {
  return terms.amounts * terms.lobes.middleCols(channel * octahedron_texels, octahedron_texels);
}

double off(const Lights& told, const Lights& right) { return (told - right).norm() / right.norm(); }

TEST(SharedTerms, OfOneChannelAreItsOwn) {
  const Terms own = own_terms(some_light(2), 6);
  const SharedTerms terms = shared_terms(all_nodes(), {own});
  EXPECT_EQ(terms.amounts, own.amounts);
  EXPECT_EQ(terms.lobes, own.told_by.lobes);
}

TEST(SharedTerms, TellChannelsThatAreAlikeAsTheirOwnDo) {
  const Lights light = some_light(2);
  const Terms own = own_terms(light, 6);
  const SharedTerms terms = shared_terms(all_nodes(), {own, own, own});
  for (Eigen::Index channel = 0; channel < 3; ++channel)
    EXPECT_LT(off(told(terms, channel), own.amounts * own.told_by.lobes), 1e-3) << channel;
}

// One that is a thousandth as bright as the others is not drowned by them; one that is dark is told as dark.
TEST(SharedTerms, TellFaintChannelsToo) {
  const std::vector<Lights> lights = {some_light(2), 1e-3F * some_light(3), Lights::Zero(nodes, octahedron_texels)};
  std::vector<Terms> own;
  own.reserve(lights.size());
  for (const Lights& light : lights) own.push_back(own_terms(light, 12));
  const SharedTerms terms = shared_terms(all_nodes(), own);
  EXPECT_EQ(terms.amounts.cols(), 12);
  for (std::size_t channel = 0; channel < 2; ++channel)
    EXPECT_LT(off(told(terms, static_cast<Eigen::Index>(channel)), lights[channel]),
              3.0 * off(own[channel].amounts * own[channel].told_by.lobes, lights[channel]))
        << channel;
  EXPECT_EQ(told(terms, 2).cwiseAbs().maxCoeff(), 0.0F);
}

}  // namespace
}  // namespace mesograin::transport
