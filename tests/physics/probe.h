// Evaluates an expression of the physics text on the GPU, in float, and in C++, in double, for the same inputs.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "physics/physics.h"

namespace mesograin::physics {

/// What an expression may call x[0] ... x[7].
using ProbeInput = std::array<float, 8>;

struct Expression {
  std::string glsl;
  std::function<double(const double* x)> in_double;
};

/// The expression for each input, by a compute shader. `declarations` is GLSL that precedes it.
std::vector<float> evaluate_on_gpu(const std::string& expression, const std::vector<ProbeInput>& inputs,
                                   const std::string& declarations = "");

/// The expression for each input as rounded to float, in double.
std::vector<double> evaluate_in_double(const Expression& expression, const std::vector<ProbeInput>& inputs);

/// The largest |gpu - exact| / max(|exact|, floor), and where it is.
struct Deviation {
  double relative = 0.0;
  ProbeInput where{};
  double gpu = 0.0;
  double exact = 0.0;
};

Deviation largest_deviation(const std::vector<float>& gpu, const std::vector<double>& exact,
                            const std::vector<ProbeInput>& inputs, double floor);

}  // namespace mesograin::physics

/// The same tokens as GLSL text and as C++.
#define MESOGRAIN_EXPRESSION(...)                                            \
  ::mesograin::physics::Expression {                                         \
#__VA_ARGS__, [](const double* x) -> double { (void)x; return __VA_ARGS__; } \
  }
