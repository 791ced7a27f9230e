// Light maps of a prototype, from directions all around it: its instances, however they are turned, share them.
#pragma once

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/texture_array.h"
#include "gl/vertex_array.h"
#include "render/details.h"
#include "render/light_map_drawing.h"
#include "scene/mesh.h"

namespace mesograin::render {

/// Which of the directions of an atlas are asked for: the nodes of a grid over the octahedral map of the sphere (Meyer
/// et al., "On Floating-Point Normal Vectors", 2010), whose lines follow the octahedron's edges. A direction asks for
/// the three nodes around it on its face, of which each sample takes one.
class LightMapDirections {
 public:
  static constexpr int half = 8;
  static constexpr int side = 2 * half + 1;
  static constexpr int count = side * side;

  /// `to_light`: unit length, in the prototype's own axes.
  void ask_for(const glm::dvec3& to_light);

  void ask_for_all() {
    asked_.assign(count, true);
    left_ = 0;
  }

  bool is_asked_for(int node) const { return asked_[static_cast<std::size_t>(node)]; }
  bool all() const { return left_ == 0; }
  int asked() const { return count - left_; }

  static glm::dvec3 direction(int node);

  /// Those of a coarser grid next to them.
  LightMapDirections coarse() const;

  /// The node of the coarser grid next to this one.
  static int coarse(int node);

 private:
  std::vector<bool> asked_ = std::vector<bool>(count, false);
  int left_ = count;
};

class LightMapAtlas {
 public:
  explicit LightMapAtlas(const scene::MeshPointer& mesh);

  /// Draws the maps of all directions asked for that are not at hand, `resolution` texels wide or as many as memory
  /// allows, of this level of the mesh's details or a finer one; returns how many. `go_on` is asked between maps; where
  /// it says no, the rest is missing. `roughly`: those of a coarser grid serve for what is not at hand.
  template <typename GoOn>
  int update(const Details& details, std::size_t level, const LightMapProgram& program,
             const LightMapDirections& directions, int resolution, bool roughly, const GoOn& go_on) {
    const LightMapDirections needed = roughly ? directions.coarse() : directions;
    make_room(needed, resolution, level);
    int drawn = 0;
    for (int node = 0; node < LightMapDirections::count; ++node) {
      if (!needed.is_asked_for(node) || layers_[static_cast<std::size_t>(node)] >= 0) continue;
      if (!go_on()) break;
      draw(details.mesh(level_), program, node);
      ++drawn;
    }
    if (drawn > 0) send_frames();
    return drawn;
  }

  /// Makes them what shaders/models/light_map.glsl reads of instances.
  void bind(const gl::Program& program) const;

 private:
  void make_room(const LightMapDirections& directions, int resolution, std::size_t level);
  void draw(const gl::VertexArray& device_mesh, const LightMapProgram& program, int node);
  void send_frames();

  LightMapDrawing drawing_;
  std::optional<gl::TextureArray> maps_;
  std::optional<gl::Texture> depth_;
  std::size_t level_ = 0;                                                      // of the details, of which the maps are
  std::vector<int> layers_ = std::vector<int>(LightMapDirections::count, -1);  // by node
  std::vector<layout::StoredLightFrame> frames_;                               // by layer
  std::optional<gl::Buffer> device_frames_;
  std::optional<gl::Buffer> device_layers_;
};

}  // namespace mesograin::render
