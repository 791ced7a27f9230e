// One light map: how it is fitted around a grain, and drawn into a layer of a texture array.
#pragma once

#include <functional>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "gl/program.h"
#include "gl/texture.h"
#include "gl/texture_array.h"
#include "gl/vertex_array.h"
#include "render/device_layout.h"
#include "scene/mesh.h"

namespace mesograin::render {

/// The program that draws a map, of triangles or tessellated.
using LightMapProgram = std::function<const gl::Program&(bool tessellated)>;

class LightMapDrawing {
 public:
  /// `object_to_grain` is the instance's transform with the middle of its bounds moved to the origin.
  LightMapDrawing(scene::MeshPointer mesh, const glm::dmat4& object_to_grain);

  const scene::MeshPointer& mesh() const { return mesh_; }
  const glm::dmat4& object_to_grain() const { return object_to_grain_; }

  /// Draws what a light in the direction `to_light` (unit length, grain space) sees. `depth` has the maps' size.
  layout::StoredLightFrame draw(const gl::VertexArray& device_mesh, const LightMapProgram& program,
                                const glm::dvec3& to_light, const gl::TextureArray& maps, int layer,
                                const gl::Texture& depth) const;

 private:
  struct LightSpace;
  LightSpace fit(const glm::dvec3& to_light, int resolution) const;

  scene::MeshPointer mesh_;
  glm::dmat4 object_to_grain_;
  double rise_;  // the most that the curved surface rises above the middle of an edge, in scene units
};

}  // namespace mesograin::render
