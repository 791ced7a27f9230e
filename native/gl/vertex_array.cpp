// Vertex layouts and draw calls.
#include "gl/vertex_array.h"

namespace mesograin::gl {
namespace {

GLuint create_vertex_array() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return name;
}

void attach(GLuint array, GLuint location, const Buffer& buffer, GLint components) {
  glVertexArrayVertexBuffer(array, location, buffer.name(), 0, static_cast<GLsizei>(components * sizeof(float)));
  glVertexArrayAttribFormat(array, location, components, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(array, location, location);
  glEnableVertexArrayAttrib(array, location);
}

}  // namespace

GLuint VertexArray::Traits::create() { return create_vertex_array(); }
void VertexArray::Traits::destroy(GLuint name) { glDeleteVertexArrays(1, &name); }
GLuint FullScreenTriangle::Traits::create() { return create_vertex_array(); }
void FullScreenTriangle::Traits::destroy(GLuint name) { glDeleteVertexArrays(1, &name); }

VertexArray::VertexArray(const std::vector<glm::vec3>& positions, const std::vector<glm::vec3>& normals,
                         const std::vector<glm::vec2>& uvs, const std::vector<glm::uvec3>& triangles)
    : positions_(positions),
      normals_(normals),
      uvs_(uvs),
      indices_(triangles),
      index_count_(static_cast<GLsizei>(triangles.size() * 3)) {
  attach(handle_.name(), 0, positions_, 3);
  attach(handle_.name(), 1, normals_, 3);
  if (!uvs.empty()) attach(handle_.name(), 2, uvs_, 2);
  glVertexArrayElementBuffer(handle_.name(), indices_.name());
}

void VertexArray::draw() const {
  glBindVertexArray(handle_.name());
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
}

void VertexArray::draw_instances(std::uint32_t count) const {
  glBindVertexArray(handle_.name());
  glDrawElementsInstanced(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(count));
}

void VertexArray::draw_patches() const {
  glBindVertexArray(handle_.name());
  glPatchParameteri(GL_PATCH_VERTICES, 3);
  glDrawElements(GL_PATCHES, index_count_, GL_UNSIGNED_INT, nullptr);
}

std::size_t VertexArray::bytes() const {
  return positions_.bytes() + normals_.bytes() + uvs_.bytes() + indices_.bytes();
}

void FullScreenTriangle::draw() const {
  glBindVertexArray(handle_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace mesograin::gl
