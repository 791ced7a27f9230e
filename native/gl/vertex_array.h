// A mesh on the device, ready to draw: position, normal and UV at locations 0, 1 and 2.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "gl/buffer.h"
#include "gl/handle.h"

namespace mesograin::gl {

class VertexArray {
 public:
  /// `uvs` may be empty; every vertex then reads (0, 0).
  VertexArray(const std::vector<glm::vec3>& positions, const std::vector<glm::vec3>& normals,
              const std::vector<glm::vec2>& uvs, const std::vector<glm::uvec3>& triangles);

  void draw() const;

  /// Draws it `count` times, which shaders tell apart by gl_InstanceID.
  void draw_instances(std::uint32_t count) const;

  /// Draws each triangle as a patch, for programs with a tessellation stage.
  void draw_patches() const;

  /// Bytes sent to the device.
  std::size_t bytes() const;

 private:
  struct Traits {
    static GLuint create();
    static void destroy(GLuint name);
  };
  Handle<Traits> handle_;
  Buffer positions_;
  Buffer normals_;
  Buffer uvs_;
  Buffer indices_;
  GLsizei index_count_;
};

/// Draws three vertices that cover the target, for passes over every pixel; the vertex shader makes the positions.
class FullScreenTriangle {
 public:
  void draw() const;

 private:
  struct Traits {
    static GLuint create();
    static void destroy(GLuint name);
  };
  Handle<Traits> handle_;
};

}  // namespace mesograin::gl
