// The physics text in float on the GPU against the same text in double, over grids that reach every extreme; and, row
// by row, the forms that single precision breaks beside the ones that hold.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "gl/context_thread.h"
#include "probe.h"

namespace mesograin::physics {

std::ostream& operator<<(std::ostream& stream, const Deviation& deviation) {
  stream << "relative " << deviation.relative << ": GPU " << deviation.gpu << ", double " << deviation.exact << " at";
  for (const float value : deviation.where) stream << " " << value;
  return stream;
}

namespace {

// Every combination of the values given for each x.
std::vector<ProbeInput> grid(const std::vector<std::vector<double>>& axes) {
  std::vector<ProbeInput> inputs{ProbeInput{}};
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    std::vector<ProbeInput> extended;
    for (const ProbeInput& input : inputs)
      for (const double value : axes[axis]) {
        extended.push_back(input);
        extended.back()[axis] = static_cast<float>(value);
      }
    inputs = std::move(extended);
  }
  return inputs;
}

std::vector<double> geometric(double low, double high, int count) {
  std::vector<double> values;
  values.reserve(count);
  for (int i = 0; i < count; ++i) values.push_back(low * std::pow(high / low, static_cast<double>(i) / (count - 1)));
  return values;
}

std::vector<double> even(double low, double high, int count) {
  std::vector<double> values;
  values.reserve(count);
  for (int i = 0; i < count; ++i) values.push_back(low + (high - low) * i / (count - 1));
  return values;
}

std::vector<double> operator+(std::vector<double> a, const std::vector<double>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::vector<double> map(std::vector<double> values, double (*function)(double)) {
  for (double& value : values) value = function(value);
  return values;
}

double negated(double x) { return -x; }
double from_one(double x) { return 1.0 - x; }

void expect_close(const Expression& expression, const std::vector<ProbeInput>& inputs, double tolerance,
                  double floor = 1e-30) {
  const Deviation deviation = largest_deviation(evaluate_on_gpu(expression.glsl, inputs),
                                                evaluate_in_double(expression, inputs), inputs, floor);
  EXPECT_LE(deviation.relative, tolerance) << expression.glsl << ": " << deviation;
  EXPECT_EQ(gl::ContextThread::instance().take_gl_errors(), std::vector<std::string>());
}

const std::vector<double> cosines =
    geometric(1e-12, 1.0, 60) + even(0.01, 1.0, 100) + map(geometric(1e-7, 0.1, 30), from_one);
const std::vector<double> indices =
    even(1.0, 4.0, 31) + map(geometric(1e-7, 1e-2, 6), [](double x) { return 1.0 + x; });
const std::vector<double> absorbed = std::vector<double>{0.0, 1.0} + geometric(1e-12, 1.0, 120);

TEST(FloatElementary, Expm1) {
  const std::vector<double> x =
      geometric(1e-20, 80.0, 2000) + map(geometric(1e-20, 100.0, 2000), negated) + std::vector<double>{0.0};
  expect_close(MESOGRAIN_EXPRESSION(expm1(x[0])), grid({x}), 1e-5);
}

TEST(FloatElementary, MeanAttenuation) {
  expect_close(MESOGRAIN_EXPRESSION(mean_attenuation(x[0])),
               grid({geometric(1e-20, 1e6, 2000) + std::vector<double>{0.0}}), 1e-5);
}

TEST(FloatElementary, MeanCrossing) {
  expect_close(MESOGRAIN_EXPRESSION(mean_crossing(x[0])),
               grid({geometric(1e-20, 1e6, 2000) + std::vector<double>{0.0, 0.2}}), 1e-5);
}

// What the largest random numbers and thicknesses round to must stay a distance: the logarithm of nothing is none.
TEST(FloatElementary, AttenuatedDistanceEndsWithinTheWay) {
  const std::vector<double> random = even(0.0, 1.0, 101) + map(geometric(0x1p-24, 0.1, 200), from_one);
  std::vector<ProbeInput> inputs = grid({random, geometric(1e-6, 1e6, 500), {0.3, 1.0, 1.7}});
  std::erase_if(inputs, [](const ProbeInput& input) { return input[0] >= 1.0F; });
  const std::vector<float> distances =
      evaluate_on_gpu("attenuated_distance(x[0], x[1], x[2], x[2] * mean_attenuation(x[1] * x[2]))", inputs);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    ASSERT_GE(distances[i], 0.0F) << inputs[i][0] << " " << inputs[i][1];
    ASSERT_LE(distances[i], 1.01F * inputs[i][2]) << inputs[i][0] << " " << inputs[i][1];
  }
}

TEST(FloatElementary, SineOfCosine) {
  expect_close(MESOGRAIN_EXPRESSION(sine_of_cosine(x[0])), grid({cosines + std::vector<double>{1.0000001, -1.0000001}}),
               1e-6);
}

TEST(FloatFresnel, Refraction) {
  expect_close(MESOGRAIN_EXPRESSION(refracted_cosine(x[0], x[1])), grid({cosines, indices}), 1e-6);
}

// A rarer grain has a critical angle outside, where the square of the cosine inside is a difference of the inputs
// themselves.
TEST(FloatFresnel, RefractionIntoARarerGrain) {
  expect_close(MESOGRAIN_EXPRESSION(refracted_cosine(x[0], x[1]) * refracted_cosine(x[0], x[1])),
               grid({cosines, even(0.5, 0.999, 40)}), 1e-6, 1.0);
}

TEST(FloatFresnel, Transmittance) {
  expect_close(MESOGRAIN_EXPRESSION(fresnel_transmittance(x[0], refracted_cosine(x[0], x[1]), x[1])),
               grid({cosines, indices}), 1e-5);
  expect_close(MESOGRAIN_EXPRESSION(fresnel_transmittance(x[0], x[2], x[1])),
               grid({cosines, even(0.5, 0.999, 20), geometric(1e-6, 1.0, 20)}), 1e-5);
}

TEST(FloatFresnel, Reflectance) {
  // Relative to 1: near equal indices what is reflected is itself a difference of the inputs.
  expect_close(MESOGRAIN_EXPRESSION(fresnel_reflectance(x[0], x[1])), grid({cosines, indices + even(0.5, 0.999, 20)}),
               2e-5, 1.0);
}

TEST(FloatGgx, Distribution) {
  // Half vectors tilted by x[0] radians (rounded to float like any other input).
  std::vector<ProbeInput> inputs;
  for (const double tilt : geometric(1e-9, 1.5, 200) + std::vector<double>{0.0})
    for (const double alpha : geometric(1e-4, 1.0, 40))
      inputs.push_back(
          {static_cast<float>(std::sin(tilt)), static_cast<float>(std::cos(tilt)), static_cast<float>(alpha)});
  expect_close(MESOGRAIN_EXPRESSION(ggx_distribution(real3(0.0, 0.0, 1.0), real3(x[0], 0.0, x[1]), x[2])), inputs,
               1e-5);
  // a tilted frame: the cross product of two rounded unit vectors carries their rounding, 6e-8 of a radian
  expect_close(
      MESOGRAIN_EXPRESSION(
          ggx_distribution(real3(0.6, 0.0, 0.8), real3(0.6 * x[1] + 0.8 * x[0], 0.0, 0.8 * x[1] - 0.6 * x[0]), x[2])),
      [&] {
        std::vector<ProbeInput> resolvable;
        for (const ProbeInput& input : inputs)
          if (input[2] >= GGX_SMALLEST_ALPHA) resolvable.push_back(input);
        return resolvable;
      }(),
      3e-4);
}

TEST(FloatGgx, Visibility) {
  const auto inputs = grid({cosines, cosines, geometric(1e-4, 1.0, 12)});
  expect_close(MESOGRAIN_EXPRESSION(ggx_visibility_correlated(x[0], x[1], x[2])), inputs, 1e-5);
  expect_close(MESOGRAIN_EXPRESSION(ggx_visibility_separable(x[0], x[1], x[2])), inputs, 1e-5);
}

TEST(FloatDielectric, Reflection) {
  // Directions in a plane at angles x[0] and x[1] either side of the normal, at roughnesses that float half vectors
  // resolve.
  const auto expression = MESOGRAIN_EXPRESSION(dielectric_reflection(
      real3(0.0, 0.0, 1.0), real3(x[0], 0.0, x[1]), x[1], real3(x[2], 0.0, x[3]), x[3], x[4], x[5], x[6] > 0.5));
  std::vector<ProbeInput> inputs;
  for (const double a : even(0.0, 1.57, 20))
    for (const double b : even(-1.57, 1.57, 41))
      for (const double eta : {0.6, 1.1, 1.3, 4.0})
        for (const double alpha : {0.01, 0.1, 0.5, 1.0})
          for (const double correlated : {0.0, 1.0})
            inputs.push_back({static_cast<float>(std::sin(a)), static_cast<float>(std::cos(a)),
                              static_cast<float>(std::sin(b)), static_cast<float>(std::cos(b)), static_cast<float>(eta),
                              static_cast<float>(alpha), static_cast<float>(correlated)});
  // The half vector is a sum of rounded directions: 6e-8 of a radian, over the highlight's width.
  expect_close(expression, inputs, 1e-4, 1e-6);
}

TEST(FloatHenyeyGreenstein, PhaseFunction) {
  std::vector<ProbeInput> inputs;
  for (const double g : std::vector<double>{0.0, 1e-6, 0.3, 0.9, 0.99, 0.999, 0.9999})
    for (const double versine : geometric(1e-12, 2.0, 300) + std::vector<double>{0.0})
      inputs.push_back({static_cast<float>(versine), static_cast<float>(g), static_cast<float>(1.0 - g)});
  expect_close(MESOGRAIN_EXPRESSION(henyey_greenstein(x[0], x[1], x[2])), inputs, 1e-5);
}

TEST(FloatHalfSpace, VersineOfRefractedRays) {
  // Directions in a plane at angles x[0] and x[1]; relative to 1e-3, since a smaller versine is the rounding of the
  // directions themselves.
  const auto expression = MESOGRAIN_EXPRESSION(
      refracted_versine(real3(x[0], 0.0, x[1]), x[1], refracted_cosine(x[1], x[4]), real3(x[2], 0.0, x[3]), x[3],
                        refracted_cosine(x[3], x[4]), real3(0.0, 0.0, 1.0), 1.0 / (x[4] * x[4]), x[5]));
  std::vector<ProbeInput> inputs;
  for (const double a : even(-1.57, 1.57, 60))
    for (const double b : even(-1.57, 1.57, 61))
      for (const double eta : {1.0, 1.3, 4.0})
        for (const double sign : {-1.0, 1.0})
          inputs.push_back({static_cast<float>(std::sin(a)), static_cast<float>(std::cos(a)),
                            static_cast<float>(std::sin(b)), static_cast<float>(std::cos(b)), static_cast<float>(eta),
                            static_cast<float>(sign)});
  expect_close(expression, inputs, 1e-5, 1e-2);
}

TEST(FloatHalfSpace, Factor) {
  expect_close(MESOGRAIN_EXPRESSION(half_space_factor(x[0], x[1], 0.9, 0.5)), grid({cosines, cosines}), 1e-6);
  expect_close(MESOGRAIN_EXPRESSION(half_space_coordinate(x[0], x[1])), grid({cosines, cosines}), 1e-6);
}

// One row: over `inputs`, the form as printed errs by at least `at_least` somewhere, or is not a number, and ours by no
// more than `tolerance`.
void expect_row(const std::string& naive_glsl, const Expression& stable, const std::vector<ProbeInput>& inputs,
                double at_least, double tolerance) {
  const std::vector<double> exact = evaluate_in_double(stable, inputs);
  const Deviation naive = largest_deviation(evaluate_on_gpu(naive_glsl, inputs), exact, inputs, 1e-30);
  const Deviation ours = largest_deviation(evaluate_on_gpu(stable.glsl, inputs), exact, inputs, 1e-30);
  EXPECT_FALSE(naive.relative < at_least) << naive_glsl << " holds after all: " << naive;
  EXPECT_LE(ours.relative, tolerance) << stable.glsl << ": " << ours;
}

TEST(NaiveForm, DriverElementaryFunctions) {
  expect_row("exp(x[0]) - 1.0", MESOGRAIN_EXPRESSION(expm1(x[0])), grid({geometric(1e-9, 0.1, 200)}), 1e-2, 1e-6);
}

TEST(NaiveForm, HenyeyGreensteinNearOne) {
  // x[0] = 1 - g, x[1] = 1 - cosine.
  const auto inputs = grid({geometric(1e-4, 1e-2, 20), geometric(1e-9, 1e-2, 30)});
  const std::string naive =
      "(1.0 - (1.0 - x[0]) * (1.0 - x[0])) / (4.0 * PI * pow(1.0 + (1.0 - x[0]) * (1.0 - x[0]) - 2.0 * (1.0 - x[0]) * "
      "(1.0 - x[1]), 1.5))";
  expect_row(naive, MESOGRAIN_EXPRESSION(henyey_greenstein(x[1], 1.0 - x[0], x[0])), inputs, 0.1, 1e-5);
}

TEST(NaiveForm, GgxDistributionAtSmallAlpha) {
  std::vector<ProbeInput> inputs;
  for (const double alpha : geometric(1e-4, 1e-2, 20))
    for (const double tilt : geometric(1e-5, 1e-2, 20))
      inputs.push_back(
          {static_cast<float>(std::sin(tilt)), static_cast<float>(std::cos(tilt)), static_cast<float>(alpha)});
  const std::string naive = "x[2] * x[2] / (PI * pow(x[1] * x[1] * (x[2] * x[2] - 1.0) + 1.0, 2.0))";
  expect_row(naive, MESOGRAIN_EXPRESSION(ggx_distribution(real3(0.0, 0.0, 1.0), real3(x[0], 0.0, x[1]), x[2])), inputs,
             0.4, 1e-5);
}

TEST(NaiveForm, GgxDistributionOfASmoothSurface) {
  // x[0] = tilt of the half vector, x[1] = alpha: what is smoother than single precision resolves is drawn as the
  // least.
  expect_row("x[1] * x[1] / (PI * pow((1.0 - x[0] * x[0]) * (x[1] * x[1] - 1.0) + 1.0, 2.0))",
             MESOGRAIN_EXPRESSION(ggx_distribution(real3(0.0, 0.0, 1.0), real3(x[0], 0.0, sqrt(1.0 - x[0] * x[0])),
                                                   max(x[1], GGX_SMALLEST_ALPHA))),
             grid({{0.0, 1e-4, 1e-3}, {0.0, 1e-30, 1e-5}}), 0.9, 1e-5);
}

TEST(NaiveForm, SmithAtGrazing) {
  const auto inputs = grid({std::vector<double>{0.0, 1e-25, 1e-20, 1e-3}, {0.3, 1.0}, {0.1, 1.0}});
  const std::string naive =
      "(1.0 / (1.0 + 0.5 * (sqrt(1.0 + x[2] * x[2] * (1.0 / (x[0] * x[0]) - 1.0)) - 1.0) + 0.5 * (sqrt(1.0 + x[2] * "
      "x[2] * (1.0 / (x[1] * "
      "x[1]) - 1.0)) - 1.0))) / (4.0 * x[0] * x[1])";
  expect_row(naive, MESOGRAIN_EXPRESSION(ggx_visibility_correlated(x[0], x[1], x[2])), inputs, 0.5, 1e-6);
}

TEST(NaiveForm, SineOfACosineBeyondOne) {
  expect_row("sqrt(1.0 - x[0] * x[0])", MESOGRAIN_EXPRESSION(sine_of_cosine(x[0])),
             grid({{1.0000001, 0.99999994, 0.9999}}), 1e-3, 1e-6);
}

TEST(NaiveForm, TotalInternalReflection) {
  expect_row("sqrt(1.0 - (1.0 - x[0] * x[0]) / (x[1] * x[1]))", MESOGRAIN_EXPRESSION(refracted_cosine(x[0], x[1])),
             grid({{0.1, 0.5}, {0.6, 0.8}}), 0.5, 1e-6);
}

TEST(NaiveForm, TransmittanceAsADifferenceAtGrazing) {
  expect_row("1.0 - fresnel_reflectance(x[0], x[1])",
             MESOGRAIN_EXPRESSION(fresnel_transmittance(x[0], refracted_cosine(x[0], x[1]), x[1])),
             grid({geometric(1e-9, 1e-2, 20), {1.3, 2.0}}), 0.5, 1e-5);
}

TEST(NaiveForm, AttenuationOverAThinLayer) {
  expect_row("1.0 - exp(-x[0])", MESOGRAIN_EXPRESSION(-expm1(-x[0])), grid({geometric(1e-9, 1e-2, 60)}), 1e-2, 1e-6);
}

}  // namespace
}  // namespace mesograin::physics
