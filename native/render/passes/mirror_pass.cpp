// A ray a pixel, along the direction that its program drew; what it meets is another surface that is shaded, once more.
#include "render/passes/mirror_pass.h"

#include <chrono>

#include "render/stencil.h"

namespace mesograin::render {

MirrorPass::MirrorPass()
    : program_("mirror", gl::ShaderSource({"passes/full_screen.vert"}, {}),
               gl::ShaderSource({"passes/mirror.frag"}, {})) {}

bool MirrorPass::run(const Sample& sample, const ArrayVisibility& arrays, SurfacePass& surfaces, ShadowPass& shadows,
                     ShadePass& shade) {
  ran_ = sample.mirrors == Mirrors::hindered;
  if (!ran_) return true;
  const auto start = std::chrono::steady_clock::now();
  looks_.resize(static_cast<std::size_t>(sample.size.x) * static_cast<std::size_t>(sample.size.y));
  sample.targets.mirror->shade.read(&looks_.front().x, 2);
  const scene::World& around = sample.lighting.world();
  const bool world = around.shines() || around.backdrop || around.film_transparent;
  if (!cast_.cast(arrays.tree(), sample.content, sample.exchange, sample.lighting, surfaces.seen(sample), looks_,
                  sample.go_on))
    return false;
  FoundSurfaces& found = cast_.found();
  const std::vector<PixelBox> boxes = found.boxes(sample.size, sample.content.units());
  found.upload(sample.targets, 0);
  if (world) add_world(sample);
  if (!boxes.empty()) {
    const SeenSurfaces seen{found.positions(), found.normals(), sample.size, glm::vec4(0.0F), &looks_};
    if (!shadows.run_mirrored(sample, arrays, seen)) return false;
    for (std::size_t first = 0; first < boxes.size(); first += most_in_stencil) {
      if (first > 0) found.upload(sample.targets, first);
      shade.shade_mirrored(sample, shadows, boxes, first);
    }
  }
  glFinish();
  milliseconds_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return true;
}

void MirrorPass::add_world(const Sample& sample) {
  sample.targets.shade.bind();
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  program_.use();
  program_.set("mirrored_radiance", sample.targets.mirror->radiance);
  program_.set("surface_normal", sample.targets.normal);
  full_screen_.draw();
}

}  // namespace mesograin::render
