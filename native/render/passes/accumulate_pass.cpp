// Sums in float, on the device.
#include "render/passes/accumulate_pass.h"

namespace mesograin::render {

AccumulatePass::AccumulatePass()
    : accumulate_program_("accumulate", gl::ShaderSource({"passes/full_screen.vert"}, {}),
                          gl::ShaderSource({"passes/accumulate.frag"}, {})),
      resolve_program_("resolve", gl::ShaderSource({"passes/full_screen.vert"}, {}),
                       gl::ShaderSource({"passes/resolve.frag"}, {})) {}

void AccumulatePass::run(const Targets& targets, const Sum& sum, bool first) {
  sum.accumulate.bind();
  glDisable(GL_DEPTH_TEST);
  if (first) {
    glDisable(GL_BLEND);  // it covers all of what was there
  } else {
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
  }
  accumulate_program_.use();
  accumulate_program_.set("image", targets.sample);
  full_screen_.draw();
}

void AccumulatePass::read(const Targets& targets, const Sum& sum, int samples, float* pixels) {
  // The sample's texture has the right size and format.
  targets.shade.bind();
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  resolve_program_.use();
  resolve_program_.set("sum", sum.texture);
  resolve_program_.set("samples", static_cast<float>(samples));
  full_screen_.draw();
  targets.shade.read(pixels);
}

}  // namespace mesograin::render
