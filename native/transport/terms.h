// The few functions of the direction that tell what is seen of some light, and how much of each is at every node.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "transport/effort.h"
#include "transport/multiple.h"
#include "transport/sights.h"

namespace mesograin::transport {

struct Lobes {
  Eigen::MatrixXf readers;  ///< a column each: what a node's light is multiplied by to know how much of each is in it
  Lights lobes;             ///< a row each, a column a texel of the octahedral map

  Eigen::Index count() const { return lobes.rows(); }
};

struct Terms {
  Lights amounts;  ///< a row a node, a column a lobe
  Lobes told_by;
};

/// The terms that leave least out of what is seen of `light`: principal components of pictures, from all sides and
/// in light from everywhere. What is noise at single nodes, hidden or far below the surface counts little there.
/// The last ones have most. `guess`: of some other light in the same body, or none.
Terms principal_terms(const Sights& sights, const Lights& light, const Lobes& guess, int count, const Effort& effort);

/// The same of all channels' light in one body.
struct SharedTerms {
  Lights amounts;  ///< a row a node, a column a lobe
  Lights lobes;    ///< a row each, a column a texel, channel by channel
};

/// The terms, as many as each channel has of its own, that leave least out of what is seen of all channels, each beside
/// what is seen of it: at a node all have the same amounts, and each has lobes of its own. Of one they are its own.
SharedTerms shared_terms(const Sights& sights, const std::vector<Terms>& channels);

/// left * right
Lights product(const Lights& left, const Eigen::MatrixXf& right, const Effort& effort);

/// sum + left * right
void add_product(Lights& sum, const Lights& left, const Lights& right, const Effort& effort);

}  // namespace mesograin::transport
