// Fits an orthographic picture around the grain and draws it.
#include "render/light_map_drawing.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "gl/framebuffer.h"
#include "physics/physics.h"

namespace mesograin::render {

struct LightMapDrawing::LightSpace {
  glm::dmat4 object_to_light;
  glm::dmat4 light_to_clip;
  glm::dvec3 x_axis;
  glm::dvec3 y_axis;
  glm::dvec3 z_axis;
  glm::dvec2 centre;
  double half_width;
};

namespace {

// Of a texel's width: what the curved surface may rise above what is drawn.
constexpr double rise_in_texels = 0.125;

double largest_edge_rise(const scene::Mesh& mesh, const glm::dmat4& object_to_grain) {
  const glm::dmat3 linear(object_to_grain);
  const glm::dmat3 normal_to_grain = glm::transpose(glm::inverse(linear));
  double largest = 0.0;
  for (const glm::uvec3& triangle : mesh.triangles()) {
    glm::dvec3 positions[3];
    glm::dvec3 normals[3];
    for (int corner = 0; corner < 3; ++corner) {
      positions[corner] = linear * glm::dvec3(mesh.positions()[triangle[corner]]);
      normals[corner] = glm::normalize(normal_to_grain * glm::dvec3(mesh.normals()[triangle[corner]]));
    }
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3;
      largest = std::max(largest, physics::edge_rise(positions[a], normals[a], positions[b], normals[b]));
    }
  }
  return largest;
}

}  // namespace

LightMapDrawing::LightMapDrawing(scene::MeshPointer mesh, const glm::dmat4& object_to_grain)
    : mesh_(std::move(mesh)), object_to_grain_(object_to_grain), rise_(largest_edge_rise(*mesh_, object_to_grain)) {}

LightMapDrawing::LightSpace LightMapDrawing::fit(const glm::dvec3& to_light, int resolution) const {
  LightSpace space;
  space.z_axis = to_light;
  const glm::dvec3 helper = std::abs(to_light.x) < 0.5 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
  space.x_axis = glm::normalize(glm::cross(helper, to_light));
  space.y_axis = glm::cross(to_light, space.x_axis);
  const glm::dmat3 to_axes = glm::transpose(glm::dmat3(space.x_axis, space.y_axis, space.z_axis));
  space.object_to_light = glm::dmat4(to_axes) * object_to_grain_;

  const glm::dmat4& transform = space.object_to_light;
  const auto place = [&](const glm::vec3& position) { return glm::dvec3(transform * glm::dvec4(position, 1.0)); };
  glm::dvec3 lower = place(mesh_->positions().front());
  glm::dvec3 upper = lower;
  for (const glm::vec3& position : mesh_->positions()) {
    const glm::dvec3 placed = place(position);
    lower = glm::min(lower, placed);
    upper = glm::max(upper, placed);
  }
  const glm::dvec3 middle = 0.5 * (lower + upper);
  const glm::dvec3 half = 0.5 * (upper - lower) + rise_;
  // A texel of margin keeps the silhouette inside.
  constexpr double smallest = 1e-300;
  space.half_width = std::max({half.x, half.y, smallest}) * (1.0 + 2.0 / resolution);
  space.centre = glm::dvec2(middle);
  const double half_depth = std::max(half.z, smallest) * 1.01;

  glm::dmat4 scale(1.0);
  scale[0][0] = 1.0 / space.half_width;
  scale[1][1] = 1.0 / space.half_width;
  scale[2][2] = -1.0 / half_depth;
  glm::dmat4 move(1.0);
  move[3] = glm::dvec4(-middle, 1.0);
  space.light_to_clip = scale * move;
  return space;
}

layout::StoredLightFrame LightMapDrawing::draw(const gl::VertexArray& device_mesh,
                                               const LightMapProgram& program_source, const glm::dvec3& to_light,
                                               const gl::TextureArray& maps, int layer,
                                               const gl::Texture& depth) const {
  const int resolution = maps.width();
  const LightSpace space = fit(to_light, resolution);
  const gl::Framebuffer target(maps, layer, depth);
  target.bind();
  constexpr float nothing[4] = {-3e38F, 0.0F, 0.0F, -3e38F};
  target.clear(nothing);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_BLEND);
  glEnable(GL_CULL_FACE);
  const glm::dmat3 linear(space.object_to_light);
  glFrontFace(glm::determinant(linear) < 0.0 ? GL_CW : GL_CCW);
  // Whether flat triangles would show where the normals tell of a curve.
  const double largest_rise = rise_in_texels * 2.0 * space.half_width / resolution;
  const bool tessellated = rise_ > largest_rise;
  const gl::Program& program = program_source(tessellated);
  const auto draw_mesh = [&] { tessellated ? device_mesh.draw_patches() : device_mesh.draw(); };
  program.use();
  program.offer("largest_rise", static_cast<float>(largest_rise));
  program.set("light_to_clip", glm::mat4(space.light_to_clip));
  program.set("object_to_light", glm::mat4(space.object_to_light));
  program.set("normal_to_light", glm::mat3(glm::transpose(glm::inverse(linear))));

  glCullFace(GL_BACK);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);
  draw_mesh();

  target.clear_depth();
  glCullFace(GL_FRONT);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_TRUE);
  draw_mesh();

  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDisable(GL_CULL_FACE);
  return {glm::vec4(space.x_axis, 2.0 * space.half_width / resolution), glm::vec4(space.centre, resolution, 0.0),
          glm::vec4(to_light, 0.0)};
}

}  // namespace mesograin::render
