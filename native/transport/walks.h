// What rays found inside one body: it serves every albedo and every extinction between the ladder's steps that were
// traced, so that a change of colour traces nothing.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "transport/body.h"
#include "transport/effort.h"
#include "transport/exchange.h"
#include "transport/grid.h"
#include "transport/interface.h"
#include "transport/lamp.h"
#include "transport/multiple.h"
#include "transport/octahedron.h"
#include "transport/sights.h"
#include "transport/surface.h"
#include "transport/terms.h"

namespace mesograin::transport {

/// How much work goes into it.
struct Quality {
  int nodes = 6600;                  ///< of the grid in the body's box
  int directions = octahedron_side;  ///< of light that are told apart: texels along a side of their map
  int light_across = 32;             ///< rays for each of them, squared
  int way_across = 16;               ///< rays from each node, squared
  int terms = 24;         ///< that are stored of a grey medium: 16, 24 or 48 (shaders/models/stored_products.glsl)
  int shared_terms = 32;  ///< that all channels of another share: 20, 32 or 44
  Spacing spacing = Spacing::even;
  int most_nodes = 10500;  ///< whatever the body's sides are like
};

class Walks {
 public:
  /// Of the effort the seed stays.
  Walks(std::shared_ptr<const Body> body, const Interface& interface, const Quality& quality, const Effort& effort);

  const Body& body() const { return *body_; }
  const std::shared_ptr<const Body>& shared_body() const { return body_; }
  const Grid& grid() const { return grid_; }
  const std::vector<float>& surface() const { return surface_; }  ///< surface_distances
  const Quality& quality() const { return quality_; }

  /// Traces what is not known yet for `extinctions`, sigma_t per unit of the body.
  void trace(const std::vector<double>& extinctions, const Effort& effort);

  /// Whether all of them were traced, or are within a step of some that were: what is told of these is nearly right.
  bool know(const std::vector<double>& extinctions) const;
  bool nearly_know(const std::vector<double>& extinctions) const;

  /// Mean radiance of unscattered light at every node, a column for each texel of the octahedral map that it comes
  /// from, per irradiance on a plane that faces it. As all below, what was traced, or of the nearest that was.
  Lights unscattered(double sigma_t, const Effort& effort = {}) const;

  /// The same of a lamp, per its strength, found anew by rays: a column for each of these extinctions.
  Lights unscattered(const std::vector<double>& extinctions, const Lamp& lamp, const Effort& effort = {}) const;

  Exchange exchange(double sigma_t) const;
  Exchange exchange_of_scattered(double sigma_t) const;  ///< TracedExchange::of_scattered

  /// What is seen, and by which lobes light that is scattered once is told: of the ladder's step, for they say but what
  /// matters.
  const Sights& sights(double sigma_t) const { return step(sigma_t).sights; }
  const Lobes& lobes(double sigma_t) const { return step(sigma_t).lobes; }

  std::size_t bytes() const;

 private:
  struct Step {
    std::vector<Logarithm> light;  // [node][texel][extinction of `near_extinctions`]
    TracedExchange exchange;
    Sights sights;
    Lobes lobes;
  };

  /// Of `step`, as unscattered() has it.
  Lights unscattered(const Step& step, double sigma_t, const Effort& effort) const;

  /// What light at a node is to be multiplied by, of which those from all directions are `row`.
  template <typename Row>
  float correction(const Step& step, const NearWeights& weights, std::size_t node, const Row& row) const;

  /// That was traced, the nearest to `sigma_t`.
  const Step& step(double sigma_t) const;

  std::shared_ptr<const Body> body_;
  Interface interface_;
  Quality quality_;
  Grid grid_;
  std::vector<float> surface_;
  std::vector<float> solid_angles_;  // of the texels that light comes from
  std::map<double, Step> steps_;
};

}  // namespace mesograin::transport
