// What a pinhole camera sees of a sphere in sunlight: radiance by backward walks, light of at least one scattering.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace mesograin::referee {

/// What happens at the surface; names as in the product's scenes.
enum class Boundary {
  dielectric,         ///< smooth interface of index eta, both ways
  index_matched,      ///< no interface
  lambert_lambert,    ///< no interface; light enters into a cosine lobe, the view's walk starts in a cosine lobe
  lambert_refracted,  ///< no interface; light enters into a cosine lobe, the view's walk starts along the refracted
                      ///< view ray
};

struct Sun {
  glm::dvec3 to_light{0, 0, 1};
  glm::dvec3 irradiance{1};  ///< on a plane that faces the light
  double angle = 0;          ///< of the disc, edge to edge, radians
};

/// Lengths in scene units, coefficients per scene unit.
struct PictureCase {
  glm::dvec3 camera{0, 0, 6.5}, look_at{0}, up{0, 1, 0};
  double fov_degrees = 45;  ///< across the image's shorter side
  int width = 128, height = 128;
  glm::dvec3 centre{0};
  double radius = 2.4;
  glm::dvec3 sigma_a{0.1}, sigma_s{0.9};
  double g = 0, eta = 1.3, scale = 1;
  Boundary boundary = Boundary::dielectric;
  std::vector<Sun> suns;
  int samples = 256;  ///< paths a pixel, over its whole area
  std::uint64_t seed = 1;
  unsigned threads = 0;
};

/// Row 0 at the top. The sun's mirror image and the light that crosses the sphere unscattered are not in it: neither
/// can be seen by a pinhole (except that with lambert entry all light is diffuse, so that everything is in it).
struct Picture {
  std::vector<glm::dvec3> radiance;
  std::vector<glm::dvec3> noise;  ///< standard error of each pixel
};

/// Throws std::invalid_argument, in one sentence, for a camera inside the sphere, a sphere without any medium, and the
/// like.
Picture trace_picture(const PictureCase& setup);

}  // namespace mesograin::referee
