// A thread of the device for each ray.
#include "render/device_casting.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <bit>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "render/stencil.h"

namespace mesograin::render {
namespace {

// As the shaders have it, on both sides.
constexpr int group = 8;

void dispatch(const glm::ivec2& size) {
  glDispatchCompute(static_cast<GLuint>((size.x + group - 1) / group),
                    static_cast<GLuint>((size.y + group - 1) / group), 1);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT |
                  GL_TEXTURE_UPDATE_BARRIER_BIT);
}

// What shaders/passes/seen_along.glsl reads. Sums are taken in double precision: a far plane's would cancel.
void set_seen_along(const gl::Program& program, const glm::dmat4& anchor_to_clip, const glm::ivec2& size,
                    const glm::dvec2& jitter, const Bounds& bounds) {
  const glm::dmat4 clip_to_anchor = glm::inverse(anchor_to_clip);
  program.set("along_x", glm::vec4(clip_to_anchor[0]));
  program.set("along_y", glm::vec4(clip_to_anchor[1]));
  program.set("near_of_all", glm::vec4(clip_to_anchor[3] - clip_to_anchor[2]));
  program.set("far_of_all", glm::vec4(clip_to_anchor[3] + clip_to_anchor[2]));
  const glm::dvec2 across(size);
  program.set("pixel_scale", glm::vec2(2.0 / across));
  program.set("pixel_offset", glm::vec2(1.0 / across - 1.0 - jitter));
  const glm::dvec3 middle = bounds.empty() ? glm::dvec3(0.0) : 0.5 * (bounds.lower + bounds.upper);
  program.set("cast_ball", glm::vec4(middle, bounds.empty() ? 0.0 : 0.5 * glm::distance(bounds.lower, bounds.upper)));
}

}  // namespace

void DeviceSurfaces::cast(DeviceCache& cache, const DeviceRays& rays, const Content& content,
                          const glm::dmat4& anchor_to_clip, const glm::vec2& jitter, const Targets& targets) {
  const glm::ivec2 size(targets.position.width(), targets.position.height());
  if (!marks_ || marks_->width() != size.x || marks_->height() != size.y) marks_.emplace(GL_RG32F, size.x, size.y);
  const gl::Program& program = cache.ray_program("cast_surfaces", content.textured());
  rays.bind(program, anchor_to_clip, size);
  set_seen_along(program, anchor_to_clip, size, jitter, content.instances()->bounds());
  const glm::dmat4 rows = glm::transpose(anchor_to_clip);
  program.set("clip_depth", glm::vec4(rows[2]));
  program.set("clip_width", glm::vec4(rows[3]));
  targets.position.bind_image(0, GL_RGBA32F);
  targets.normal.bind_image(1, GL_RGBA32F);
  marks_->bind_image(2, GL_RG32F);
  if (targets.coordinates) targets.coordinates->bind_image(3, GL_RGBA32F);
  dispatch(size);
}

void DeviceSurfaces::mark(DeviceCache& cache, const Content& content, const Targets& targets, std::size_t first) const {
  const std::size_t groups = content.units() - content.draws().size();
  const std::size_t marked = first < groups ? std::min(groups - first, most_in_stencil) : 0;
  targets.surfaces.bind();
  targets.surfaces.clear_depth();
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  const gl::Program& program = cache.mark_program();
  program.use();
  program.set("surface_mark", *marks_);
  program.set("first_marked", static_cast<int>(first));
  program.set("most_marked", static_cast<int>(marked));
  // A mark tells the depth too, but not every group has one.
  if (marked < groups) {
    program.set("bit", -1);
    full_screen_.draw();
  }
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_ALWAYS, static_cast<GLint>(most_in_stencil), most_in_stencil);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  for (int bit = 0; bit < static_cast<int>(std::bit_width(marked)); ++bit) {
    glStencilMask(1U << static_cast<unsigned>(bit));
    program.set("bit", bit);
    full_screen_.draw();
  }
  glStencilMask(~0U);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void cast_shadows(DeviceCache& cache, const DeviceRays& rays, const glm::dmat4& anchor_to_clip, const Targets& targets,
                  const DeviceSurfaces& surfaces, const glm::vec4& viewer, int light, const ShadowEye& eye,
                  const gl::Texture& reached) {
  const glm::ivec2 size(reached.width(), reached.height());
  const gl::Program& program = cache.ray_program("cast_shadows", false);
  rays.bind(program, anchor_to_clip, size);
  program.set("surface_position", targets.position);
  program.set("surface_normal", targets.normal);
  program.set("surface_mark", surfaces.marks());
  program.set("viewer", viewer);
  program.set("light", light);
  program.set("eye", glm::vec4(eye));
  reached.bind_image(0, GL_R32UI);
  dispatch(size);
}

void cast_shadow_map(DeviceCache& cache, const DeviceRays& rays, const Content& content,
                     const glm::dmat4& anchor_to_clip, const ShadowEye& eye, const gl::TextureArray& maps, int layer) {
  const glm::ivec2 size(maps.width(), maps.height());
  const gl::Program& program = cache.ray_program("cast_shadow_map", false);
  rays.bind(program, anchor_to_clip, size);
  set_seen_along(program, anchor_to_clip, size, glm::dvec2(0.0), content.bounds());
  program.set("eye", glm::vec4(eye));
  maps.bind_image(0, layer, GL_RG32F);
  dispatch(size);
}

}  // namespace mesograin::render
