// Instances a level of detail at a time, then the draws.
#include "render/surfaces.h"

#include <epoxy/gl.h>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "render/device_layout.h"

namespace mesograin::render {
namespace {

// So many triangles are drawn before it is asked whether to go on.
constexpr std::size_t instances_between_questions = 20000;

glm::vec3 middle(const scene::Mesh& mesh) {
  return glm::vec3(0.5 * (glm::dvec3(mesh.lower()) + glm::dvec3(mesh.upper())));
}

// `before` is told of each part before it is drawn.
template <typename Before>
bool draw_parts(const gl::Program& program, const Content& content, const DeviceSelection& selection, const GoOn& go_on,
                const Before& before) {
  const Instances& instances = *content.instances();
  instances.bind();
  selection.instances.bind_storage(layout::SELECTED_BINDING);
  std::size_t since = 0;
  for (const Selection::Part& part : selection.selection.parts) {
    const Prototype& prototype = instances.prototypes()[instances.groups()[part.group].prototype];
    before(part);
    program.set("first_selected", static_cast<int>(part.first));
    program.set("middle", middle(*prototype.mesh));
    prototype.details->mesh(part.level).draw_instances(part.count);
    since += part.count;
    if (since < instances_between_questions) continue;
    since = 0;
    glFinish();
    if (!go_on()) return false;
  }
  return true;
}

}  // namespace

glm::dmat4 anchor_to_clip(const Content& content, const scene::Camera& camera) {
  return camera.camera_to_clip * glm::translate(camera.world_to_camera, content.anchor());
}

bool draw_surfaces(DeviceCache& cache, const Content& content, const DeviceSelection* selection,
                   const scene::Camera& camera, const glm::vec2& jitter, std::size_t first, const GoOn& go_on) {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glEnable(GL_STENCIL_TEST);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  const auto mark = [first](std::size_t unit) { glStencilFunc(GL_ALWAYS, stencil_mark(unit, first), most_in_stencil); };
  bool whole = true;
  const std::size_t groups = content.instances() != nullptr ? content.instances()->groups().size() : 0;
  if (selection != nullptr) {
    const gl::Program& program = cache.surface_program(true, content.textured());
    program.use();
    program.set("jitter", jitter);
    program.set("anchor_to_clip", glm::mat4(anchor_to_clip(content, camera)));
    glFrontFace(GL_CCW);
    whole = draw_parts(program, content, *selection, go_on, [&](const Selection::Part& part) { mark(part.group); });
  }
  const gl::Program& program = cache.surface_program(false, content.textured());
  program.use();
  program.set("jitter", jitter);
  for (std::size_t i = 0; i < content.draws().size() && whole; ++i) {
    const Draw& draw = content.draws()[i];
    mark(groups + i);
    const glm::dmat4 object_to_grain = draw.object_to_grain();
    const glm::dmat3 linear(object_to_grain);
    program.set("instance", static_cast<int>(content.number(i)));
    program.set("object_to_clip", glm::mat4(camera.camera_to_clip * (camera.world_to_camera * draw.object_to_world)));
    program.set("object_to_grain", glm::mat4(object_to_grain));
    program.set("normal_to_grain", glm::mat3(glm::transpose(glm::inverse(linear))));
    const glm::dmat3 to_camera = glm::dmat3(camera.world_to_camera) * linear;
    glFrontFace(glm::determinant(to_camera) < 0.0 ? GL_CW : GL_CCW);
    draw.mesh->draw();
    whole = go_on();
  }
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_DEPTH_TEST);
  glFrontFace(GL_CCW);
  return whole;
}

bool draw_casters(DeviceCache& cache, const Content& content, const DeviceSelection* selection,
                  const glm::dmat4& anchor_to_clip, const ShadowEye& eye, const gl::Framebuffer& target,
                  const GoOn& go_on) {
  target.bind();
  constexpr float nothing[4] = {-3e38F, 0.0F, 0.0F, 0.0F};
  target.clear(nothing);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_BLEND);
  const auto begin = [&](const gl::Program& program) {
    program.use();
    program.set("anchor_to_clip", glm::mat4(anchor_to_clip));
    program.set("eye", glm::vec4(eye));
  };
  if (selection != nullptr) {
    const gl::Program& program = cache.shadow_program(true);
    begin(program);
    if (!draw_parts(program, content, *selection, go_on, [](const Selection::Part& /*part*/) {})) return false;
  }
  const gl::Program& program = cache.shadow_program(false);
  begin(program);
  for (std::size_t i = 0; i < content.draws().size(); ++i) {
    const Draw& draw = content.draws()[i];
    program.set("instance", static_cast<int>(content.object_number(i)));
    program.set("object_to_anchor",
                glm::mat4(glm::translate(glm::dmat4(1.0), -content.anchor()) * draw.object_to_world));
    draw.mesh->draw();
    if (!go_on()) return false;
  }
  glDisable(GL_DEPTH_TEST);
  return true;
}

}  // namespace mesograin::render
