// What each light sees of one grain, kept until the grain or the lights change.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/texture_array.h"
#include "gl/vertex_array.h"
#include "render/light_map_drawing.h"
#include "scene/mesh.h"

namespace mesograin::render {

class LightMaps {
 public:
  /// `object_to_grain` is the instance's transform with the middle of its bounds moved to the origin.
  LightMaps(scene::MeshPointer mesh, const glm::dmat4& object_to_grain);

  /// Whether they were made for this mesh, turned and scaled like this; where it stands in the world plays no part.
  bool are_of(const scene::MeshPointer& mesh, const glm::dmat4& object_to_grain) const;

  /// Draws the maps of all lights (unit vectors towards them) unless those at hand serve: same directions, and a
  /// resolution of at least `resolution`. Returns how many maps were drawn.
  int update(const gl::VertexArray& device_mesh, const LightMapProgram& program,
             const std::vector<glm::dvec3>& to_light, int resolution);

  /// Makes them what shaders/models/light_map.glsl reads.
  void bind(const gl::Program& program) const;

  int resolution() const { return resolution_; }

  /// The map of one light, (resolution, resolution, 4) floats as light_map.glsl documents them; for tests and reports.
  std::vector<float> read(int light) const;

 private:
  LightMapDrawing drawing_;
  std::vector<glm::dvec3> to_light_;
  int resolution_ = 0;
  std::optional<gl::TextureArray> maps_;
  std::optional<gl::Buffer> frames_;
};

/// The resolution that a grain deserves: a texel for every pixel across it and four for every reduced mean free path
/// across it, whichever is finer, as a power of two between 256 and 1024.
int light_map_resolution(double pixels_across, double mean_free_paths_across);

}  // namespace mesograin::render
