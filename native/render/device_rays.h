// A view's content as rays meet it that the device follows itself: the tree of the instances, and the meshes of all.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"
#include "render/content.h"

namespace mesograin::render {

class DeviceRays {
 public:
  /// Throws Error if it is more than the device's trees hold. `content` must outlive it.
  DeviceRays(DeviceCache& cache, Content& content);

  /// Whether its rays are worth it: there are arrays, and so little else that each ray can ask all of it.
  static bool suit(const Content& content);

  /// Has them all met in full from now on, or as coarse as what shows them allows.
  void meet_in_full(bool full) { in_full_ = full; }

  /// Makes them what shaders/scene/rays.glsl reads, as coarse as a picture of this size may show them through this
  /// projection.
  void bind(const gl::Program& program, const glm::dmat4& anchor_to_clip, const glm::ivec2& size) const;

 private:
  struct Meshes {
    std::vector<casting::FlatNode> nodes;
    std::vector<glm::uvec3> corners;
    std::vector<glm::vec4> vertices;
    std::vector<glm::vec4> placed;

    Meshes(DeviceCache& cache, const Content& content);

   private:
    /// Which number its tree's root has.
    float add(const casting::FlatMesh& mesh);
    void add_levels(std::size_t of, const Details& details);
  };

  DeviceRays(const Meshes& meshes, Content& content);

  const Instances& instances_;
  const gl::Buffer& tree_;
  gl::Buffer mesh_trees_;
  gl::Buffer corners_;
  gl::Buffer vertices_;
  gl::Buffer placed_;
  gl::Buffer lone_;
  int lone_count_;
  bool in_full_ = false;
};

}  // namespace mesograin::render
