// Draws each triangle at its UVs, adding one.
#include "render/passes/uv_count.h"

#include <glm/common.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/vector_relational.hpp>

namespace mesograin::render {

UvUse count_uv_use(const Sample& sample) {
  const gl::Framebuffer& target = sample.targets.shade;
  target.bind();
  target.clear();
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  const gl::Program& program = sample.cache.count_program();
  program.use();
  program.set("jitter", glm::vec2(0.0F));
  UvUse use;
  const auto outside = [](const glm::vec2& uv) { return glm::any(glm::notEqual(uv, glm::clamp(uv, 0.0F, 1.0F))); };
  for (const std::size_t baked : sample.unwrapping->draws) {
    const Draw& draw = sample.content.draws()[baked];
    draw.mesh->draw();
    const std::vector<glm::vec2>& uvs = draw.source->uvs();
    for (const glm::uvec3& triangle : draw.source->triangles())
      if (outside(uvs[triangle.x]) || outside(uvs[triangle.y]) || outside(uvs[triangle.z])) ++use.triangles_outside;
  }
  std::vector<glm::vec4> counts(static_cast<std::size_t>(sample.size.x) * static_cast<std::size_t>(sample.size.y));
  target.read(glm::value_ptr(counts.front()));
  for (const glm::vec4& count : counts) {
    if (count.x > 0.0F) ++use.texels;
    if (count.x > 1.0F) ++use.overlapping;
  }
  return use;
}

}  // namespace mesograin::render
