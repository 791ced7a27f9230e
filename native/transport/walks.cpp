// Traces the ladder's steps that are asked for, and reads between them.
#include "transport/walks.h"

#include <algorithm>
#include <utility>

#include "transport/near_extinctions.h"
#include "transport/octahedron.h"
#include "transport/unscattered.h"

namespace mesograin::transport {

Walks::Walks(std::shared_ptr<const Body> body, const Interface& interface, const Quality& quality, const Effort& effort)
    : body_(std::move(body)),
      interface_(interface),
      quality_(quality),
      grid_(*body_, quality.nodes, quality.spacing, part_of(effort, 0.0, 0.5)),
      surface_(surface_distances(*body_, grid_, part_of(effort, 0.5, 1.0))) {}

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
  std::vector<Step> steps(missing.size());
  for (Step& step : steps) step.light.resize(nodes * octahedron_texels * near_extinctions);
  const KeepLight keep = [&](std::size_t texel, const std::vector<float>& radiance) {
    for (std::size_t i = 0; i < steps.size(); ++i)
      for (std::size_t node = 0; node < nodes; ++node) {
        const auto deputy = static_cast<std::size_t>(grid_.deputies()[node]);
        for (std::size_t e = 0; e < near_extinctions; ++e)
          steps[i].light[(node * octahedron_texels + texel) * near_extinctions + e] =
              known_logarithm(radiance[deputy * all.size() + i * near_extinctions + e]);
      }
  };
  unscattered_light(*body_, grid_, interface_, all, quality_.light_across, keep, part_of(effort, 0.0, 0.7));
  std::vector<TracedExchange> exchanges =
      trace_exchange(*body_, grid_, interface_, missing, quality_.way_across, part_of(effort, 0.7, 1.0));
  for (std::size_t i = 0; i < missing.size(); ++i) {
    steps[i].exchange = std::move(exchanges[i]);
    steps_.emplace(missing[i], std::move(steps[i]));
  }
}

const Walks::Step& Walks::step(double sigma_t) const { return steps_.at(nearest_step(sigma_t)); }

Lights Walks::unscattered(double sigma_t) const {
  const Step& near = step(sigma_t);
  const NearWeights weights(near.exchange.sigma_t, sigma_t);
  Lights light(static_cast<Eigen::Index>(grid_.places().size()), octahedron_texels);
  for (Eigen::Index i = 0; i < light.size(); ++i)
    light.data()[i] = weights.decayed(&near.light[static_cast<std::size_t>(i) * near_extinctions]);
  return light;
}

Exchange Walks::exchange(double sigma_t) const { return step(sigma_t).exchange.at(sigma_t); }

std::size_t Walks::bytes() const {
  std::size_t sum = surface_.size() * sizeof(float);
  for (const auto& [sigma_t, step] : steps_) {
    const Exchange& traced = step.exchange.traced;
    sum += (step.exchange.distances.size() + traced.values.size() + traced.columns.size()) * sizeof(float) +
           (step.light.size() + step.exchange.escapes.size()) * sizeof(Logarithm) +
           traced.first.size() * sizeof(std::size_t);
  }
  return sum;
}

}  // namespace mesograin::transport
