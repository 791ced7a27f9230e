// One thread for each input; storage buffers in and out.
#include "probe.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

#include "gl/buffer.h"
#include "gl/context_thread.h"
#include "gl/program.h"
#include "gl/shader_source.h"

namespace mesograin::physics {

std::vector<float> evaluate_on_gpu(const std::string& expression, const std::vector<ProbeInput>& inputs,
                                   const std::string& declarations) {
  const std::string text =
      "#include \"physics/prelude.glsl\"\n#include \"physics/elementary.glsl\"\n"
      "#include \"physics/dielectric.glsl\"\n#include \"physics/half_space.glsl\"\n"
      "#include \"physics/henyey_greenstein.glsl\"\n"
      "layout(local_size_x = 64) in;\n"
      "layout(std430, binding = 0) readonly buffer Inputs { float inputs[]; };\n"
      "layout(std430, binding = 1) writeonly buffer Outputs { float outputs[]; };\n" +
      declarations +
      "\nvoid main() {\n"
      "  uint index = gl_GlobalInvocationID.x;\n"
      "  if (index >= outputs.length()) return;\n"
      "  float x[8];\n"
      "  for (int i = 0; i < 8; ++i) x[i] = inputs[index * 8u + uint(i)];\n"
      "  outputs[index] = " +
      expression + ";\n}\n";
  return gl::ContextThread::instance().run([&] {
    const gl::Program program("probe", gl::ShaderSource::from_text("probe.comp", text, {}));
    const gl::Buffer input(inputs);
    std::vector<float> results(inputs.size());
    const gl::Buffer output(results);
    program.use();
    input.bind_storage(0);
    output.bind_storage(1);
    glDispatchCompute(static_cast<GLuint>((inputs.size() + 63) / 64), 1, 1);
    output.read(results.data(), results.size() * sizeof(float));
    return results;
  });
}

std::vector<double> evaluate_in_double(const Expression& expression, const std::vector<ProbeInput>& inputs) {
  std::vector<double> results;
  results.reserve(inputs.size());
  for (const ProbeInput& input : inputs) {
    std::array<double, 8> widened{};
    std::copy(input.begin(), input.end(), widened.begin());
    results.push_back(expression.in_double(widened.data()));
  }
  return results;
}

Deviation largest_deviation(const std::vector<float>& gpu, const std::vector<double>& exact,
                            const std::vector<ProbeInput>& inputs, double floor) {
  Deviation largest;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const double relative = std::abs(gpu[i] - exact[i]) / std::max(std::abs(exact[i]), floor);
    // Written so that a result that is not a number counts as the largest.
    if (!(relative <= largest.relative)) largest = {relative, inputs[i], gpu[i], exact[i]};
    if (std::isnan(relative)) break;
  }
  return largest;
}

}  // namespace mesograin::physics
