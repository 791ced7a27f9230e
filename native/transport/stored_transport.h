// What light does inside one prototype, a mesh with a medium: the source function of scattered light at nodes of a
// grid, for parallel light from anywhere, as a few products of a function of the place and one of the direction.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "transport/body.h"
#include "transport/effort.h"
#include "transport/lamp.h"
#include "transport/octahedron.h"
#include "transport/walks.h"

namespace mesograin::transport {

/// A medium in three channels that scatters isotropically, behind a surface that is smooth or of GGX facets.
struct StoredMedium {
  glm::dvec3 sigma_t{1.0};  ///< per unit of the body
  glm::dvec3 albedo{0.9};
  double eta = 1.0;
  double alpha = 0.0;

  bool operator==(const StoredMedium&) const = default;

  bool grey() const {
    return sigma_t.r == sigma_t.g && sigma_t.r == sigma_t.b && albedo.r == albedo.g && albedo.r == albedo.b;
  }
};

struct StoredTransport {
  glm::ivec3 size{0};            ///< nodes along x, y and z
  glm::vec3 lower{0.0F};         ///< the first node, in the body's space
  glm::vec3 spacing{1.0F};       ///< between nodes
  double unit = 1.0;             ///< scene units a unit of the body
  glm::mat3 axes{1.0F};          ///< the body's axes in the stretched mesh's
  double mean_chord = 1.0;       ///< through the body, in its units
  int terms = 0;                 ///< products that are summed; channels share what these have of the place
  int channels = 3;              ///< 1 for a grey medium
  bool convex = false;           ///< no line leaves the body and enters it again
  bool has_unscattered = true;   ///< sources are also fed by light that nothing has scattered before
  std::vector<float> distances;  ///< from the surface at its own nodes (surface_size), negative inside; x runs fastest
  /// [term][node]: radiance that a mean free path would send out, per irradiance; without what light that
  /// nothing has scattered feeds, if that is apart, over physics::scattered_share_below. In half precision.
  std::vector<float> sources;
  std::vector<float> lobes;  ///< [term][texel of the octahedral map that the light comes from][channel]

  std::size_t nodes() const {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
  }

  /// Where it is among `lobes`.
  std::size_t lobe(std::size_t term, std::size_t texel, std::size_t channel) const {
    return (term * octahedron_texels + texel) * static_cast<std::size_t>(channels) + channel;
  }
};

/// How far the grid's nodes will be from one another, in units of the body: the mean of all three sides.
double node_spacing(const Body& body, const Quality& quality);

/// The sigma_t of the densest medium that is told by nodes so far apart: beyond it the light just below the surface is
/// not resolved. What is denser is told as if it were this.
double densest_told(double spacing);
double densest_told(const glm::vec3& spacing);

/// Traces what `walks`, which have the medium's interface, do not know yet. The answer does not depend on what they
/// know.
StoredTransport compute_transport(Walks& walks, const StoredMedium& medium, const Effort& effort = {});

/// The same of one lamp, which all of the light is: a product for each channel, whose lobe is the same number
/// everywhere, and 0 in the others. It has the nodes of what compute_transport() tells of parallel light.
StoredTransport compute_transport(Walks& walks, const StoredMedium& medium, const Lamp& lamp,
                                  const Effort& effort = {});

/// Whether `walks` were traced for the medium, or for another that is near enough for an answer that is nearly right.
bool known(const Walks& walks, const StoredMedium& medium);
bool nearly_known(const Walks& walks, const StoredMedium& medium);

/// From what `walks` know already: nearly it must be known.
StoredTransport recalled_transport(const Walks& walks, const StoredMedium& medium, const Effort& effort = {});

/// With walks of its own.
StoredTransport compute_transport(const Body& body, const StoredMedium& medium, const Quality& quality = {},
                                  const Effort& effort = {});

}  // namespace mesograin::transport
