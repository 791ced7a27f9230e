// Traces the ladder's steps that are asked for, and reads between them.
#include "transport/walks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "transport/near_extinctions.h"
#include "transport/unscattered.h"

namespace mesograin::transport {
namespace {

// Terms that the light is solved for, for each that is stored.
constexpr int solved_a_stored = 2;

// Steps of the ladder from one that was traced to the farthest that it nearly tells, and a little for rounding.
constexpr double farthest_told = 1.01;

// Where nothing refracts, as deep are places of nodes on the surface and beyond it, in spaces between nodes: what was
// scattered before rises steeply right below the surface, or falls where light grazes it, and a line from there through
// the next node is about right in the mean over the way to it, for both.
constexpr float matched_depth = 0.2F;

// All of a lamp's light is one column, in which nothing else smooths noise.
constexpr int lamp_rays = 1 << 17;

/// Calls work(node) for every used node.
template <typename Work>
void of_nodes(const Grid& grid, const Effort& effort, const Work& work) {
  Effort quiet = effort;
  quiet.progress = {};
  constexpr std::size_t nodes_a_piece = 64;
  const std::size_t nodes = grid.places().size();
  run_pieces(quiet, (nodes + nodes_a_piece - 1) / nodes_a_piece, [&](std::size_t piece) {
    for (std::size_t node = piece * nodes_a_piece; node < std::min(nodes, (piece + 1) * nodes_a_piece); ++node)
      work(node);
  });
}

}  // namespace

Walks::Walks(std::shared_ptr<const Body> body, const Interface& interface, const Quality& quality, const Effort& effort)
    : body_(std::move(body)),
      interface_(interface),
      quality_(quality),
      grid_(*body_, quality.nodes, quality.spacing, quality.most_nodes, part_of(effort, 0.0, 0.5),
            interface.matched() ? matched_depth : 0.0F),
      surface_(surface_distances(*body_, grid_, part_of(effort, 0.5, 1.0))),
      solid_angles_(octahedron_solid_angles(quality.directions)) {}

void Walks::trace(const std::vector<double>& extinctions, const Effort& effort) {
  std::vector<double> missing;
  for (const double sigma_t : extinctions) {
    const double wanted = nearest_step(sigma_t);
    if (!steps_.contains(wanted) && std::find(missing.begin(), missing.end(), wanted) == missing.end())
      missing.push_back(wanted);
  }
  if (missing.empty()) return;
  std::vector<double> all;
  for (const double wanted : missing)
    for (const float sigma_t : extinctions_near(wanted)) all.push_back(sigma_t);
  const std::size_t nodes = grid_.places().size();
  const std::size_t texels = solid_angles_.size();
  std::vector<Step> steps(missing.size());
  for (Step& step : steps) step.light.resize(nodes * texels * near_extinctions);
  const KeepLight keep = [&](std::size_t texel, const std::vector<float>& radiance) {
    for (std::size_t i = 0; i < steps.size(); ++i)
      for (std::size_t node = 0; node < nodes; ++node) {
        const auto deputy = static_cast<std::size_t>(grid_.deputies()[node]);
        for (std::size_t e = 0; e < near_extinctions; ++e)
          steps[i].light[(node * texels + texel) * near_extinctions + e] =
              known_logarithm(radiance[deputy * all.size() + i * near_extinctions + e]);
      }
  };
  unscattered_light(*body_, grid_, interface_, all, quality_.directions, quality_.light_across, keep,
                    part_of(effort, 0.0, 0.7));
  std::vector<TracedExchange> exchanges =
      trace_exchange(*body_, grid_, interface_, missing, quality_.way_across, surface_, part_of(effort, 0.7, 1.0));
  for (std::size_t i = 0; i < missing.size(); ++i) {
    Step& step = steps[i];
    step.exchange = std::move(exchanges[i]);
    step.sights = transport::sights(*body_, grid_, interface_.eta(), missing[i], effort);
    step.lobes = principal_terms(step.sights, unscattered(step, missing[i], effort), {},
                                 solved_a_stored * quality_.terms, effort)
                     .told_by;
    steps_.emplace(missing[i], std::move(steps[i]));
  }
}

bool Walks::know(const std::vector<double>& extinctions) const {
  return std::all_of(extinctions.begin(), extinctions.end(),
                     [this](double sigma_t) { return steps_.contains(nearest_step(sigma_t)); });
}

bool Walks::nearly_know(const std::vector<double>& extinctions) const {
  return std::all_of(extinctions.begin(), extinctions.end(), [this](double sigma_t) {
    const double wanted = nearest_step(sigma_t);
    return std::any_of(steps_.begin(), steps_.end(), [wanted](const auto& known) {
      return std::abs(std::log(known.first / wanted)) < farthest_told * std::log(extinction_step);
    });
  });
}

const Walks::Step& Walks::step(double sigma_t) const {
  const double wanted = nearest_step(sigma_t);
  const auto apart = [wanted](const auto& known) { return std::abs(std::log(known.first / wanted)); };
  return std::min_element(steps_.begin(), steps_.end(),
                          [&](const auto& a, const auto& b) { return apart(a) < apart(b); })
      ->second;
}

// Unscattered light from everywhere is known: what a place sees of the outside, in which radiance is eta^2 less. It
// takes out what nodes at the surface have wrong by standing for more than themselves.
template <typename Row>
float Walks::correction(const Step& step, const NearWeights& weights, std::size_t node, const Row& row) const {
  const Eigen::Map<const Eigen::RowVectorXf> solid_angles(solid_angles_.data(), row.size());
  const auto square = static_cast<float>(interface_.eta() * interface_.eta());
  const float right = square * weights.decayed(&step.exchange.escapes[node * near_extinctions]);
  return std::clamp(right / std::max(row.dot(solid_angles), 1e-9F), 0.1F, 10.0F);
}

Lights Walks::unscattered(const Step& step, double sigma_t, const Effort& effort) const {
  const NearWeights weights(step.exchange.sigma_t, sigma_t);
  const std::size_t texels = solid_angles_.size();
  Lights light(static_cast<Eigen::Index>(grid_.places().size()), static_cast<Eigen::Index>(texels));
  of_nodes(grid_, effort, [&](std::size_t node) {
    auto row = light.row(static_cast<Eigen::Index>(node));
    weights.decayed(&step.light[node * texels * near_extinctions], row);
    row *= correction(step, weights, node, row);
  });
  return light;
}

Lights Walks::unscattered(const std::vector<double>& extinctions, const Lamp& lamp, const Effort& effort) const {
  const std::size_t count = extinctions.size();
  const std::size_t texels = solid_angles_.size();
  const std::vector<float> found = unscattered_light(*body_, grid_, interface_, extinctions, lamp_rays, lamp, effort);
  Lights light(static_cast<Eigen::Index>(grid_.places().size()), static_cast<Eigen::Index>(count));
  for (std::size_t e = 0; e < count; ++e) {
    const Step& near = step(extinctions[e]);
    const NearWeights weights(near.exchange.sigma_t, extinctions[e]);
    of_nodes(grid_, effort, [&](std::size_t node) {
      Eigen::RowVectorXf row(static_cast<Eigen::Index>(texels));
      weights.decayed(&near.light[node * texels * near_extinctions], row);
      const auto deputy = static_cast<std::size_t>(grid_.deputies()[node]);
      light(static_cast<Eigen::Index>(node), static_cast<Eigen::Index>(e)) =
          found[deputy * count + e] * correction(near, weights, node, row);
    });
  }
  return light;
}

Lights Walks::unscattered(double sigma_t, const Effort& effort) const {
  return unscattered(step(sigma_t), sigma_t, effort);
}

Exchange Walks::exchange(double sigma_t) const { return step(sigma_t).exchange.at(sigma_t); }

Exchange Walks::exchange_of_scattered(double sigma_t) const { return step(sigma_t).exchange.of_scattered(sigma_t); }

std::size_t Walks::bytes() const {
  std::size_t sum = surface_.size() * sizeof(float);
  for (const auto& [sigma_t, step] : steps_) {
    const Exchange& traced = step.exchange.traced;
    const auto of_lobes = static_cast<std::size_t>(step.lobes.readers.size() + step.lobes.lobes.size());
    const auto of_sights = static_cast<std::size_t>(step.sights.nonZeros());
    sum += of_lobes * sizeof(float) + of_sights * (sizeof(float) + sizeof(int));
    sum += (step.exchange.distances.size() + traced.values.size() + traced.columns.size()) * sizeof(float) +
           (step.light.size() + step.exchange.escapes.size()) * sizeof(Logarithm) +
           step.exchange.shares.size() * sizeof(Share) + traced.first.size() * sizeof(std::size_t);
  }
  return sum;
}

}  // namespace mesograin::transport
