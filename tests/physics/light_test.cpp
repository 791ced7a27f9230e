// What lights give, against irradiance that is known otherwise: Lambert's formula for polygons, closed forms of discs
// and spheres; and the same text in float on the GPU.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "gl/context_thread.h"
#include "lights/device_light.h"
#include "probe.h"

namespace mesograin::lights {
namespace {

using glm::dvec3;

/// The mean over a fine grid of random numbers of what arrives on a surface with this normal.
double irradiance(const scene::Light& light, const dvec3& place, const dvec3& normal, int side = 512) {
  double sum = 0.0;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const LightDraw drawn = sample(light, place, {(i + 0.5) / side, (j + 0.5) / side});
      EXPECT_NEAR(glm::length(drawn.to_light), 1.0, 1e-12);
      sum += drawn.irradiance.x * std::max(glm::dot(drawn.to_light, normal), 0.0);
    }
  return sum / side / side;
}

/// Of a polygon of radiance 1 that lies above the horizon, seen from the origin (Lambert 1760): half the sum of its
/// edges' angles times the cosines between the planes that they span and the normal.
double lambert_formula(const std::vector<dvec3>& corners, const dvec3& normal) {
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const dvec3 a = glm::normalize(corners[i]);
    const dvec3 b = glm::normalize(corners[(i + 1) % corners.size()]);
    const dvec3 across = glm::cross(a, b);
    sum += std::atan2(glm::length(across), glm::dot(a, b)) * glm::dot(glm::normalize(across), normal);
  }
  return 0.5 * std::abs(sum);
}

const std::vector<dvec3> normals{{0.0, 0.0, 1.0}, glm::normalize(dvec3(0.3, -0.2, 1.0))};

TEST(Lights, APointFallsOffWithTheSquareOfItsDistance) {
  const scene::PointLight point{{1.0, 2.0, 2.0}, dvec3(5.0)};
  for (const dvec3& normal : normals)
    EXPECT_NEAR(irradiance(point, {0.0, 0.0, 0.0}, normal, 1), 5.0 / 9.0 * glm::dot(normal, dvec3(1, 2, 2) / 3.0),
                1e-12);
}

// A disc of radius r that faces the place at distance d: pi L r^2 / (d^2 + r^2) cos.
TEST(Lights, ADiscFacesWhateverItLights) {
  for (const double radius : {1e-9, 0.5, 0.95}) {
    const scene::PointLight point{{0.0, 0.0, 1.0}, dvec3(5.0), radius, scene::LightShape::disc};
    for (const dvec3& normal : normals)
      EXPECT_NEAR(irradiance(point, dvec3(0.0), normal), 5.0 / (1.0 + radius * radius) * normal.z, 2e-5) << radius;
  }
}

// A sphere wholly above the horizon acts as a point in its middle; from inside, light comes from everywhere.
TEST(Lights, ASphereActsAsItsMiddleAndIsAllAroundInside) {
  for (const double distance : {1.1, 2.0, 1000.0}) {
    const scene::PointLight ball{{0.0, 0.0, distance}, dvec3(5.0), 1.0, scene::LightShape::sphere};
    EXPECT_NEAR(irradiance(ball, dvec3(0.0), {0, 0, 1}) * distance * distance, 5.0, 1e-4) << distance;
  }
  const scene::PointLight around{{0.1, 0.2, -0.3}, dvec3(5.0), 1.0, scene::LightShape::sphere};
  for (const dvec3& normal : normals) EXPECT_NEAR(irradiance(around, dvec3(0.0), normal), 5.0, 1e-3);
}

TEST(Lights, ReachEndsOnTheLight) {
  const dvec3 place(0.2, -0.1, 0.3);
  for (const double height : {0.5, 3.0})
    for (const glm::dvec2 random : {glm::dvec2(0.1, 0.7), glm::dvec2(0.9, 0.2)}) {
      const scene::PointLight ball{{0.0, 0.0, height}, dvec3(1.0), 1.0, scene::LightShape::sphere};
      const LightDraw drawn = sample(ball, place, random);
      EXPECT_NEAR(glm::length(place + drawn.reach * drawn.to_light - ball.position), 1.0, 1e-12);
      const scene::AreaLight panel{{0.0, 0.0, height}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, dvec3(1.0)};
      EXPECT_NEAR((place + sample(panel, place, random).reach * sample(panel, place, random).to_light).z, height,
                  1e-12);
    }
}

TEST(Lights, ASpotHasASoftEdge) {
  const double half = 0.4;
  scene::SpotLight spot{{0.0, 0.0, 2.0}, {0.0, 0.0, -3.0}, dvec3(4.0)};
  spot.angle = 2.0 * half;
  spot.blend = 0.5;
  for (const double angle : {0.0, 0.2, 0.3, 0.39, 0.41}) {
    const double d = 2.0 / std::cos(angle);
    const double t = std::clamp((std::cos(angle) - std::cos(half)) / (0.5 * (1.0 - std::cos(half))), 0.0, 1.0);
    const double expected = 4.0 / d / d * std::cos(angle) * t * t * (3.0 - 2.0 * t);
    const dvec3 place(2.0 * std::tan(angle), 0.0, 0.0);
    spot.cosine = false;
    EXPECT_NEAR(irradiance(spot, place, {0, 0, 1}, 1), expected, 1e-9) << angle;
    spot.cosine = true;
    EXPECT_NEAR(irradiance(spot, place, {0, 0, 1}, 1), expected * std::cos(angle), 1e-9) << angle;
  }
}

// Twice as wide along x: what lies at twice the tangent there gets the share of once the tangent.
TEST(Lights, ASpotMayBeAnEllipse) {
  scene::SpotLight round{{0.0, 0.0, 1.0}, {0.0, 0.0, -1.0}, dvec3(1.0)};
  round.blend = 1.0;
  scene::SpotLight wide = round;
  wide.wide_x = {2.0, 0.0, 0.0};
  wide.wide_y = {0.0, 1.0, 0.0};
  const auto share = [](const scene::SpotLight& spot, double x, double y) {
    return sample(spot, {x, y, 0.0}, {0.5, 0.5}).irradiance.x * (1.0 + x * x + y * y);
  };
  EXPECT_NEAR(share(wide, 0.4, 0.1), share(round, 0.2, 0.1), 1e-12);
  EXPECT_LT(share(round, 0.4, 0.1), share(round, 0.2, 0.1));
}

TEST(Lights, AnAreaIsLambertsPolygonNearAndFar) {
  for (const double distance : {0.5, 4.0, 1000.0})
    for (const dvec3& normal : normals)
      for (const dvec3 middle : {dvec3(0.0), dvec3(0.7, 0.2, 0.0)}) {
        scene::AreaLight panel{middle + dvec3(0, 0, distance), {0.6, 0.0, 0.0}, {0.0, 0.4, 0.0}, dvec3(3.0)};
        const auto corner = [&](double x, double y) { return panel.position + x * panel.half_x + y * panel.half_y; };
        std::vector<dvec3> corners{corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)};
        double exact = 3.0 * lambert_formula(corners, normal);
        EXPECT_NEAR(irradiance(panel, dvec3(0.0), normal) / exact, 1.0, 1e-4) << distance;
        panel.ellipse = true;
        corners.clear();
        for (int i = 0; i < 2000; ++i) corners.push_back(corner(std::cos(PI * i / 1000), std::sin(PI * i / 1000)));
        exact = 3.0 * lambert_formula(corners, normal);
        EXPECT_NEAR(irradiance(panel, dvec3(0.0), normal) / exact, 1.0, 1e-4) << distance;
        EXPECT_EQ(irradiance(panel, dvec3(0, 0, 2.0 * distance), -normal, 8), 0.0) << "its back is dark";
      }
}

// Slats leave the power as it was: the integral of cos sin over the hemisphere is a half.
TEST(Lights, SlatsKeepThePowerTogether) {
  for (const double half_spread : {0.1, 0.7, 1.5}) {
    const DeviceLight packed =
        pack(scene::AreaLight{{}, {1, 0, 0}, {0, 1, 0}, dvec3(1.0), false, 2.0 * half_spread}, dvec3(0.0));
    double sum = 0.0;
    const int steps = 100000;
    for (int i = 0; i < steps; ++i) {
      const double angle = half_spread * (i + 0.5) / steps;
      sum += std::cos(angle) * std::sin(angle) * slats_share(std::cos(angle), packed.emission.w, packed.axis.w);
    }
    EXPECT_NEAR(sum * half_spread / steps, 0.5, 1e-6) << half_spread;
  }
}

TEST(Lights, AWideSunGivesTheMeanCosineOverItsDisc) {
  for (const double angle : {0.0, 0.5, 3.0}) {
    const scene::DirectionalLight sun{{0.0, 0.0, 2.0}, dvec3(7.0), angle};
    EXPECT_NEAR(irradiance(sun, dvec3(1.0, 2.0, 3.0), {0, 0, 1}, 64), 3.5 * (1.0 + std::cos(0.5 * angle)), 1e-3)
        << angle;
  }
}

// In float on the GPU: from a light's own size to a million of them away, the origin a thousand sizes off.
TEST(FloatLights, EveryKindHoldsInSinglePrecision) {
  struct Kind {
    const char* name;
    scene::Light light;
  };
  const std::vector<Kind> kinds{
      {"sun", scene::DirectionalLight{{1.0, 0.2, 0.5}, dvec3(2.0), 0.01}},
      {"point", scene::PointLight{{1.0, 2.0, 3.0}, dvec3(2.0)}},
      {"disc", scene::PointLight{{1.0, 2.0, 3.0}, dvec3(2.0), 0.3}},
      {"sphere", scene::PointLight{{1.0, 2.0, 3.0}, dvec3(2.0), 0.3, scene::LightShape::sphere}},
      {"spot", scene::SpotLight{{1.0, 2.0, 3.0}, {0, 0, -1}, dvec3(2.0), 0.1, scene::LightShape::disc, 3.0, 0.7, true}},
      {"rectangle", scene::AreaLight{{1.0, 2.0, 3.0}, {0.3, 0, 0}, {0, 0.2, 0}, dvec3(2.0), false, 2.0}},
      {"ellipse", scene::AreaLight{{1.0, 2.0, 3.0}, {0.3, 0, 0}, {0, 0.2, 0}, dvec3(2.0), true}}};
  std::vector<physics::ProbeInput> inputs;
  for (const float away : {0.4F, 3.0F, 100.0F, 1e6F})
    for (int i = 0; i < 64; ++i) {
      const int row = i / 8;
      const float u = static_cast<float>(i % 8) / 8.0F;
      const float v = static_cast<float>(row) / 8.0F;
      inputs.push_back({1.0F + away * (u - 0.4F), 2.0F + away * (v - 0.6F), 3.0F - away, u, v});
    }
  for (const Kind& kind : kinds) {
    const DeviceLight packed = pack(kind.light, dvec3(0.0));
    std::string built = "#include \"lights/light.glsl\"\nDeviceLight probed() {\n  DeviceLight light;\n";
    const char* members[] = {"place", "emission", "axis", "x", "y"};
    for (std::size_t i = 0; i < 5; ++i) {
      const glm::vec4 v = to_device(packed)[i];
      char line[256];
      std::snprintf(line, sizeof line, "  light.%s = vec4(%.9g, %.9g, %.9g, %.9g);\n", members[i], v.x, v.y, v.z, v.w);
      built += line;
    }
    built +=
        "  return light;\n}\nLightDraw drawn(float x[8]) {\n"
        "  return draw_light(probed(), vec3(x[0], x[1], x[2]), vec2(x[3], x[4]));\n}\n";
    const auto in_double = [&](const double* x) { return draw_light(packed, {x[0], x[1], x[2]}, {x[3], x[4]}); };
    const auto check = [&](const char* what, const std::function<double(const LightDraw&)>& part, double tolerance,
                           double floor) {
      const physics::Expression expression{std::string("drawn(x).") + what,
                                           [&](const double* x) { return part(in_double(x)); }};
      const physics::Deviation worst =
          physics::largest_deviation(physics::evaluate_on_gpu(expression.glsl, inputs, built),
                                     physics::evaluate_in_double(expression, inputs), inputs, floor);
      EXPECT_LE(worst.relative, tolerance)
          << kind.name << " " << what << ": " << worst.gpu << ", " << worst.exact << " at " << worst.where[0] << " "
          << worst.where[1] << " " << worst.where[2] << " " << worst.where[3] << " " << worst.where[4];
    };
    check(
        "irradiance.x", [](const LightDraw& drawn) { return drawn.irradiance.x; }, 1e-4, 1e-20);
    check(
        "to_light.x", [](const LightDraw& drawn) { return drawn.to_light.x; }, 1e-5, 1.0);
    check(
        "to_light.z", [](const LightDraw& drawn) { return drawn.to_light.z; }, 1e-5, 1.0);
  }
  EXPECT_EQ(gl::ContextThread::instance().take_gl_errors(), std::vector<std::string>());
}

}  // namespace
}  // namespace mesograin::lights
