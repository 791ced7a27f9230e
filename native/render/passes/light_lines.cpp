// Has the device cut the lines, a group of one light's at a time.
#include "render/passes/light_lines.h"

#include <algorithm>
#include <cmath>

namespace mesograin::render {
namespace {

// Lines stand a pixel apart, and never as few as would show as bands where light grazes a surface.
constexpr double pixels_a_line = 1.0;
constexpr int fewest_lines = 384;
constexpr int most_lines = 768;
constexpr int lines_step = 32;  // a picture that grows a little has as many

// Looks at the surface for a line, and for a light at a pixel: at six places along its ray, a few for each in a convex
// grain, where a line leaves it soon.
constexpr double looks_a_line = 40.0;
constexpr double looks_a_pixel_of_convex = 30.0;
constexpr double looks_a_pixel = 300.0;

// Of lights that lie where they lay in the sample before: as many share the lines, and more where a picture is to be
// rid of its noise.
constexpr double samples_of_steady = 2.0;

// As shaders/passes/cut_light_lines.comp has it.
constexpr int lines_a_group = 64;

}  // namespace

int LightLines::across(const DeviceMaterial& material, const std::vector<LightDirection>& lights, double pixels) {
  if (material.has("REFRACTION")) return 0;
  const int wanted = static_cast<int>(std::min(std::sqrt(pixels) / pixels_a_line, static_cast<double>(most_lines)));
  const int side = std::max((wanted + lines_step - 1) / lines_step * lines_step, fewest_lines);
  const bool steady = std::all_of(lights.begin(), lights.end(), [](const LightDirection& light) {
    return light.angle == 0.0 && light.density == 0.0;
  });
  const double spared =
      pixels * (material.has("CONVEX") ? looks_a_pixel_of_convex : looks_a_pixel) * (steady ? samples_of_steady : 1.0);
  return looks_a_line * side * side < spared ? side : 0;
}

void LightLines::cut(DeviceCache& cache, const DeviceMaterial& material, const glm::mat3& grain_to_prototype,
                     std::size_t lights, int across) {
  const int count = static_cast<int>(lights);
  if (!lines_ || lines_->width() != across || lines_->depth() != count)
    lines_.emplace(GL_RGBA32F, across, across, count);
  const gl::Program& program = cache.line_program();
  material.bind(program);
  program.set("grain_to_prototype", grain_to_prototype);
  lines_->bind_image(0, GL_RGBA32F);
  glDispatchCompute(static_cast<GLuint>((across * across + lines_a_group - 1) / lines_a_group),
                    static_cast<GLuint>(count), 1);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

}  // namespace mesograin::render
