// Glass that is thin all over: jars, bottles, panes. It stands between grains as no ball does: what it lets through
// goes straight on, and what it reflects is mirrored.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "scene/material.h"
#include "scene/mesh.h"

namespace mesograin::heap {

struct Glass {
  glm::vec3 sigma_a{0.0F};  ///< per scene unit
  float eta = 1.5F;

  bool operator==(const Glass&) const = default;
};

Glass glass_of(const scene::Material& material);

struct Pane {
  scene::MeshPointer mesh;  ///< closed, its triangles facing outwards
  glm::dmat4 to_heap;       ///< from the mesh's own space to where grains have their places
  std::uint32_t grain;      ///< which of Grains::grains stands for it where it is looked at
  Glass glass;

  bool operator==(const Pane&) const = default;
};

/// Of light that meets a sheet of glass, all that its two surfaces throw to and fro summed up.
struct Sheet {
  glm::vec3 passed;
  glm::vec3 reflected;

  glm::vec3 left() const { return passed + reflected; }
};

/// `cosine`: at which light meets it; `straight`: how far it is to the other surface, if nothing were refracted.
Sheet sheet(const Glass& glass, float cosine, float straight);

}  // namespace mesograin::heap
