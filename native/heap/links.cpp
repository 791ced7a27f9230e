// Rays start where a viewer would look at a grain or a wall, from all sides, go through a grain's table backwards and
// on to what the light came from. Points are those of an additive recurrence, shifted for each grain, so that each
// grain's rays are spread evenly.
#include "heap/links.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "heap/spread.h"
#include "transport/directions.h"

namespace mesograin::heap {
namespace {

constexpr std::size_t grains_a_piece = 64;
// Of what is seen places may be a half longer than normals.
constexpr float whole = 16383.0F;

void pack(const glm::vec3& normal, std::int16_t (&packed)[3]) {
  for (int axis = 0; axis < 3; ++axis)
    packed[axis] = static_cast<std::int16_t>(std::lround(whole * std::clamp(normal[axis], -2.0F, 2.0F)));
}

glm::vec3 unpacked(const std::int16_t (&packed)[3]) {
  return glm::vec3(packed[0], packed[1], packed[2]) * (1.0F / whole);
}

struct Found {
  std::vector<Link> links;
  Coefficients direct;
  Coefficients crossed;
};

struct Departing {
  glm::vec3 weight;
  glm::vec3 normal;
};

/// Scales the weights so that a grain in even light sends out just what its table says, as much at every normal: which
/// outcomes were drawn and where neither wins light nor turns it.
void balance(std::vector<Departing>& departing, const glm::vec3& albedo) {
  for (int channel = 0; channel < 3; ++channel) {
    glm::dmat4 moments(0.0);
    for (const Departing& from : departing) {
      const glm::dvec4 basis(glm::dvec3(from.normal), 1.0);
      moments += glm::outerProduct(basis, static_cast<double>(from.weight[channel]) * basis);
    }
    const double sum = moments[3][3];
    if (!(sum > 0.0)) continue;
    // factor . (n, 1) for a ray that leaves at n.
    const glm::dvec4 even(0.0, 0.0, 0.0, static_cast<double>(albedo[channel]) / sum);
    glm::dvec4 factor = glm::inverse(moments / sum) * even;
    const bool sound = glm::length(glm::dvec3(factor)) < 0.8 * factor.w;
    if (!sound) factor = even;
    for (Departing& from : departing)
      from.weight[channel] *= static_cast<float>(glm::dot(factor, glm::dvec4(glm::dvec3(from.normal), 1.0)));
  }
}

// Of a node of walls, whose light is the same whatever the normal.
constexpr glm::vec3 nowhere(0.0F);

Link link_to(const Source& source, const glm::vec3& weight, const glm::vec3& leaves_at) {
  Link link{source.number, {}, {}, {}};
  const glm::vec3 sent = weight / source.met;
  pack(source.normal, link.sent_at);
  pack(leaves_at, link.leaves_at);
  for (int channel = 0; channel < 3; ++channel) link.weight[channel] = sent[channel];
  return link;
}

struct Ending {
  std::optional<Source> source;
  glm::vec3 left{0.0F};
  bool crossed = false;
};

Found look_from(const Space& space, std::uint32_t number, int rays, const glm::vec3& radiance,
                transport::Random& random) {
  const Grain& grain = space.grains()[number];
  const GrainTable& table = *space.kind(number).from_viewer;
  Found found;
  const Spread spread(random);
  std::vector<Departing> departing(static_cast<std::size_t>(rays));
  std::vector<Ending> endings(departing.size());
  for (std::size_t i = 0; i < departing.size(); ++i) {
    const std::array<float, 5> point = spread.point(static_cast<int>(i));
    const glm::vec3 normal = transport::isotropic(point[0], point[1]);
    const float mu = std::sqrt(point[2]);
    const Outcome outcome = table.draw(mu, point[3]);
    departing[i] = {outcome.weight, normal};
    const TurnedFrame frame(normal, point[4]);
    departing[i].normal = table.seen_place(normal, frame * glm::vec3(-std::sqrt(1.0F - point[2]), 0.0F, mu));
    Ray ray{space.place(grain, frame * outcome.normal), frame * outcome.direction, outcome.weight};
    endings[i].source = space.follow(ray, random);
    endings[i].crossed = ray.crossed;
    // What the way has left of the weight.
    for (int channel = 0; channel < 3; ++channel)
      endings[i].left[channel] = outcome.weight[channel] > 0.0F ? ray.weight[channel] / outcome.weight[channel] : 0.0F;
  }
  balance(departing, table.albedo());
  for (std::size_t i = 0; i < departing.size(); ++i) {
    const Departing& from = departing[i];
    const glm::vec3 weight = from.weight * endings[i].left;
    if (endings[i].source)
      found.links.push_back(link_to(*endings[i].source, weight, from.normal));
    else
      (endings[i].crossed ? found.crossed : found.direct).add(weight * radiance, from.normal);
  }
  return found;
}

Found look_from(const Space& space, const Patches::Node& node, int rays, const glm::vec3& radiance,
                transport::Random& random) {
  Found found;
  const Spread spread(random);
  for (int i = 0; i < rays; ++i) {
    const std::array<float, 5> point = spread.point(i);
    const WallPlace from = space.place(node, point[0], point[1]);
    const float cosine = std::sqrt(1.0F - point[2]);
    const glm::vec3 direction = TurnedFrame(from.normal, point[3]) * glm::vec3(std::sqrt(point[2]), 0.0F, cosine);
    Ray ray{from.place, direction, space.kind(node).from_viewer->albedo() / static_cast<float>(rays)};
    if (const std::optional<Source> source = space.follow(ray, random))
      found.links.push_back(link_to(*source, ray.weight, nowhere));
    else
      (ray.crossed ? found.crossed : found.direct).add(ray.weight * radiance, nowhere);
  }
  return found;
}

Links joined(std::vector<std::vector<Link>> found) {
  Links links;
  links.first.reserve(found.size() + 1);
  links.first.push_back(0);
  std::size_t all = 0;
  for (const std::vector<Link>& of : found) links.first.push_back(all += of.size());
  links.links.reserve(all);
  for (std::vector<Link>& of : found) {
    links.links.insert(links.links.end(), of.begin(), of.end());
    of = {};
  }
  return links;
}

}  // namespace

Links find_links(const Space& space, const Rays& rays, const glm::vec3& radiance, WorldLit& lit,
                 const transport::Effort& effort) {
  const std::size_t count = space.size();
  const std::size_t grains = space.grains().size();
  std::vector<std::vector<Link>> found(count);
  lit.direct.assign(count, {});
  lit.crossed.assign(count, {});
  transport::run_pieces(effort, (count + grains_a_piece - 1) / grains_a_piece, [&](std::size_t piece) {
    for (std::size_t i = piece * grains_a_piece; i < std::min(count, (piece + 1) * grains_a_piece); ++i) {
      transport::Random random(effort.seed, i);
      Found of = i < grains ? look_from(space, static_cast<std::uint32_t>(i), rays.of_grain, radiance, random)
                            : look_from(space, space.patches().nodes()[i - grains], rays.of_node, radiance, random);
      found[i] = std::move(of.links);
      lit.direct[i] = of.direct;
      lit.crossed[i] = of.crossed;
    }
  });
  return joined(std::move(found));
}

void Links::gather(const Field& sent, Field& answer, const transport::Effort& effort) const {
  answer.resize(sent.size());
  constexpr std::size_t at_once = 512;
  transport::run_pieces(effort, (sent.size() + at_once - 1) / at_once, [&](std::size_t piece) {
    for (std::size_t i = piece * at_once; i < std::min(sent.size(), (piece + 1) * at_once); ++i) {
      Coefficients sum;
      for (std::size_t l = first[i]; l < first[i + 1]; ++l) {
        const Link& link = links[l];
        const glm::vec3 weight(link.weight[0], link.weight[1], link.weight[2]);
        sum.add(weight * sent[link.from].at(unpacked(link.sent_at)), unpacked(link.leaves_at));
      }
      answer[i] = sum;
    }
  });
}

glm::vec3 look_through(const glm::vec3& normal, const glm::vec3& towards) {
  const float mu = std::max(glm::dot(normal, towards), 0.0F);
  return glm::normalize((2.0F * mu + 1.0F) * towards - normal);
}

Links find_behind(const Space& space, int rays, const transport::Effort& effort) {
  const std::size_t count = space.grains().size();
  std::vector<std::vector<Link>> found(space.size());
  transport::run_pieces(effort, (count + grains_a_piece - 1) / grains_a_piece, [&](std::size_t piece) {
    for (std::size_t i = piece * grains_a_piece; i < std::min(count, (piece + 1) * grains_a_piece); ++i) {
      const auto number = static_cast<std::uint32_t>(i);
      const GrainTable& table = *space.kind(number).from_viewer;
      if (table.crossing(0.0F) == glm::vec3(0.0F)) continue;
      transport::Random random(effort.seed + 2, i);
      const Spread spread(random);
      const Grain& grain = space.grains()[i];
      glm::vec3 all(0.0F);
      for (int r = 0; r < rays; ++r) {
        const std::array<float, 5> point = spread.point(r);
        const glm::vec3 normal = transport::isotropic(point[0], point[1]);
        const float mu = std::sqrt(point[2]);
        const glm::vec3 inwards = TurnedFrame(normal, point[4]) * glm::vec3(std::sqrt(1.0F - point[2]), 0.0F, -mu);
        Ray ray{space.place(grain, normal + 2.0F * mu * inwards), inwards, table.crossing(mu)};
        all += ray.weight;
        if (const std::optional<Source> source = space.follow(ray, random))
          found[i].push_back(link_to(*source, ray.weight, look_through(normal, -inwards)));
      }
      for (Link& link : found[i])
        for (int channel = 0; channel < 3; ++channel)
          link.weight[channel] *= all[channel] > 0.0F ? 1.0F / all[channel] : 0.0F;
    }
  });
  return joined(std::move(found));
}

}  // namespace mesograin::heap
