// A ray a pixel, along the direction that its program drew.
#include "render/passes/mirror_pass.h"

#include <chrono>

namespace mesograin::render {

MirrorPass::MirrorPass()
    : program_("mirror", gl::ShaderSource({"passes/full_screen.vert"}, {}),
               gl::ShaderSource({"passes/mirror.frag"}, {"CAST_SHADOWS"})) {}

bool MirrorPass::run(const Sample& sample, const ArrayVisibility& arrays, SurfacePass& surfaces) {
  ran_ = sample.mirrors == Mirrors::hindered;
  if (!ran_) return true;
  const auto start = std::chrono::steady_clock::now();
  const MirrorTargets& mirror = *sample.targets.mirror;
  from_.resize(static_cast<std::size_t>(sample.size.x) * static_cast<std::size_t>(sample.size.y));
  mirror.shade.read(&from_.front().x, 2);
  if (!cast_.cast(arrays.tree(), sample.content, surfaces.seen(sample), from_, sample.go_on)) return false;
  sample.targets.shade.bind();
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  program_.use();
  program_.set("mirrored_radiance", mirror.radiance);
  cast_.bind(program_);
  full_screen_.draw();
  milliseconds_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return true;
}

}  // namespace mesograin::render
