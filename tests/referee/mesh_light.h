// A sun's light in a mesh that nothing has scattered yet, in small cells: refracted as it entered, reflected inside,
// and what comes back from outside.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "mesh_body.h"
#include "mesh_cells.h"
#include "rng.h"
#include "rough_interface.h"
#include "scene/light.h"

namespace mesograin::referee {

class MeshLight {
 public:
  /// For irradiance 1 on a plane that faces the sun. `directions`: they are to be known too.
  MeshLight(const MeshBody& body, const RoughInterface& interface, const scene::DirectionalLight& sun, bool directions,
            std::uint64_t seed, unsigned threads);

  /// Mean over the part of the place's cell that is inside.
  double fluence(const glm::dvec3& place) const;

  /// Of the light in the place's cell, at random.
  glm::dvec3 direction(const glm::dvec3& place, Rng& rng) const;

 private:
  static constexpr int batches_ = 4;
  static constexpr int kept_ = 2;  // directions of each cell and batch

  struct Batch {
    std::vector<float> tracks;          // power times length
    std::vector<glm::vec3> directions;  // kept_ a cell
  };

  void trace(const MeshBody& body, const RoughInterface& interface, const scene::DirectionalLight& sun, Rng& rng,
             Batch& batch) const;

  MeshCells cells_;
  std::vector<Batch> parts_;
  std::vector<float> fluence_;
};

}  // namespace mesograin::referee
