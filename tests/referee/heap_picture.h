// Path tracing of whole heaps of balls: diffuse ones, and media with or without a smooth surface.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "ball_grid.h"

namespace mesograin::referee {

/// Lengths are in scene units.
struct HeapMaterial {
  bool diffuse = false;
  double reflectance = 0;
  double sigma_s = 0;
  double sigma_a = 0;
  double g = 0;
  double eta = 1;
};

/// A sun, whose irradiance on a plane that faces it is pi, or an even sky of radiance 1 above the horizon.
struct HeapLight {
  bool sky = false;
  glm::dvec3 direction{0, 0, 1};  ///< towards the sun
  double cosine = 1;              ///< of half the sun's disc; 1 is a point, whose light no refracting surface shows
};

/// Orthographic.
struct HeapCamera {
  glm::dvec3 centre;
  glm::dvec3 direction;
  glm::dvec3 right;
  glm::dvec3 up;
  double half_width;
  double half_height;
};

struct HeapCase {
  std::vector<Ball> balls;
  HeapMaterial material;
  HeapLight light;
  HeapCamera camera;
  int width = 0;
  int height = 0;
  int samples = 64;
  std::uint64_t seed = 1;
  unsigned threads = 0;
};

/// Radiance of light that was scattered at least once, or that a surface has reflected or refracted; what is seen of
/// the light itself is black.
struct HeapRadiance {
  double all = 0;
  double direct = 0;   ///< met the ball that is seen and no other
  double crossed = 0;  ///< scattered in the ball that is seen alone, after it has gone through others unscattered
  double behind = 0;   ///< seen through that ball unscattered, and scattered in one other alone
  double alone = 0;    ///< of the ball that is seen, were the others not there
};

struct HeapPicture {
  std::vector<HeapRadiance> radiance;
  std::vector<double> noise;  ///< standard error of all
};

HeapPicture trace_heap(const HeapCase& setup);

}  // namespace mesograin::referee
