// Shades a sample: what the surface pass found, each pixel once, or what a bake unwraps; and the world behind it.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/vertex_array.h"
#include "render/hit_surface.h"
#include "render/passes/gather_pass.h"
#include "render/passes/product_sums.h"
#include "render/passes/sample.h"
#include "render/passes/shadow_pass.h"

namespace mesograin::render {

/// What is seen in which other surfaces, and where it puts what is seen through itself; null: it shows the world.
struct MirroredBy {
  const MirrorTargets& through;
  const MirrorTargets* onwards;
};

class ShadePass {
 public:
  ShadePass();

  /// Light map samples that model 3 takes for one pixel and sample, over all lights.
  void set_taps(int taps) { taps_ = taps; }

  /// Begins a picture: the world where it is seen, else nothing.
  void clear(const Sample& sample);

  /// Those groups and draws that the stencil tells apart, after run() of SurfacePass for the same `first`. False if it
  /// was not to go on.
  bool shade_seen(const Sample& sample, const ShadowPass& shadows, const GatherPass& gathered, std::size_t first);

  /// What other surfaces mirror of those units that the stencil tells apart, each within its box, after run_mirrored()
  /// of ShadowPass: it is added. False if it was not to go on.
  bool shade_mirrored(const Sample& sample, const ShadowPass& shadows, const MirroredBy& by,
                      const std::vector<PixelBox>& boxes, std::size_t first);

  /// The instances that are baked, where their UVs lie.
  void shade_unwrapped(const Sample& sample, const ShadowPass& shadows);

 private:
  void draw_background(const Sample& sample);

  bool shade_seen_units(const Sample& sample, const ShadowPass& shadows, const GatherPass& gathered, std::size_t first);
  bool shade_mirrored_units(const Sample& sample, const ShadowPass& shadows, const MirroredBy& by,
                            const std::vector<PixelBox>& boxes, std::size_t first);

  /// One unit's pixels, all of whose light was gathered.
  void show_gathered(const Sample& sample, const GatherPass& gathered, std::size_t unit, int mark);

  /// The material's program, with everything that depends on neither shadows nor what is shaded.
  const gl::Program& prepare(const Sample& sample, std::size_t unit, Shading shading);

  /// Draws one unit's pixels, of those in the box. False if it was not to go on.
  bool shade_unit(const Sample& sample, const gl::Program& program, std::size_t unit, int mark, const PixelBox& box);

  /// The program that is in use, on the box's pixels.
  bool draw_in_strips(const Sample& sample, const PixelBox& box);
  void set_draw(const Sample& sample, const gl::Program& program, const Draw& draw);
  void set_group(const Sample& sample, const gl::Program& program, std::size_t unit);

  /// Sends the directions of light; places of lights are from `origin`.
  void set_lights(const Sample& sample, const gl::Program& program, const std::vector<LightDirection>& directions,
                  const glm::dvec3& origin);

  gl::Program background_program_;
  gl::FullScreenTriangle full_screen_;
  ProductSums sums_;
  std::optional<gl::Buffer> directions_;
  std::optional<gl::Buffer> lights_;
  std::optional<gl::Buffer> randoms_;
  int taps_ = 0;
  double unfinished_ = 0.0;  // pixels that the device was told to shade since it was waited for
};

}  // namespace mesograin::render
