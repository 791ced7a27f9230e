// Has the device cut the lines, a group of one light's at a time.
#include "render/passes/light_lines.h"

#include <algorithm>
#include <cmath>

namespace mesograin::render {
namespace {

// Lines stand two pixels apart, a shadow's edge is not told from a straight one; of a small picture they are as many
// as tell how long the ways near the grain's rim are.
constexpr double pixels_a_line = 2.0;
constexpr int fewest_lines = 160;
constexpr int most_lines = 384;
constexpr int lines_step = 32;  // a picture that grows a little has as many

// As shaders/passes/cut_light_lines.comp has it.
constexpr int lines_a_group = 64;

}  // namespace

void LightLines::cut(DeviceCache& cache, const DeviceMaterial& material, const glm::mat3& grain_to_prototype,
                     std::size_t lights, double pixels) {
  const int wanted = static_cast<int>(std::min(std::sqrt(pixels) / pixels_a_line, static_cast<double>(most_lines)));
  const int side = std::max((wanted + lines_step - 1) / lines_step * lines_step, fewest_lines);
  const int count = static_cast<int>(lights);
  if (!lines_ || lines_->width() != side || lines_->depth() != count) lines_.emplace(GL_RGBA32F, side, side, count);
  const gl::Program& program = cache.line_program();
  material.bind(program);
  program.set("grain_to_prototype", grain_to_prototype);
  lines_->bind_image(0, GL_RGBA32F);
  glDispatchCompute(static_cast<GLuint>((side * side + lines_a_group - 1) / lines_a_group), static_cast<GLuint>(count),
                    1);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

}  // namespace mesograin::render
