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
#include "transport/multiple.h"
#include "transport/surface.h"

namespace mesograin::transport {

/// How much work goes into it.
struct Quality {
  int nodes = 6600;       ///< of the grid in the body's box
  int light_across = 32;  ///< rays for each direction of light, squared
  int way_across = 16;    ///< rays from each node, squared
  int terms = 24;         ///< that are stored: 16, 24 or 48 (shaders/models/stored_products.glsl)
  Spacing spacing = Spacing::even;
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

  /// Mean radiance of unscattered light at every node, a column for each texel of the octahedral map that it comes
  /// from, per irradiance on a plane that faces it. Was traced.
  Lights unscattered(double sigma_t) const;

  Exchange exchange(double sigma_t) const;

  std::size_t bytes() const;

 private:
  struct Step {
    std::vector<Logarithm> light;  // [node][texel][extinction of `near_extinctions`]
    TracedExchange exchange;
  };

  const Step& step(double sigma_t) const;

  std::shared_ptr<const Body> body_;
  Interface interface_;
  Quality quality_;
  Grid grid_;
  std::vector<float> surface_;
  std::map<double, Step> steps_;
};

}  // namespace mesograin::transport
