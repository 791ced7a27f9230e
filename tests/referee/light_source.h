// Lights that are stored in a scene of many meshes: suns and lamps, as rays leave them and as a place sees
// them.
#pragma once

#include <glm/vec3.hpp>

#include "rng.h"
#include "scene/light.h"

namespace mesograin::referee {

/// About what light is sent to.
struct Target {
  glm::dvec3 middle;
  double radius;
};

/// A ray of light towards a ball: of many, the mean of `power` is what comes to it, linear RGB.
struct SentRay {
  glm::dvec3 place;
  glm::dvec3 direction;
  glm::dvec3 power;
};

/// `away`: from how far off suns send it, beyond all that could be in the way.
SentRay send_ray(const scene::Light& light, const Target& to, double away, Rng& rng);

/// A point of a light, drawn at random, as a place sees it.
struct SeenPoint {
  glm::dvec3 direction;   ///< towards it, unit length
  double distance;        ///< infinity for a sun
  glm::dvec3 irradiance;  ///< on a plane that faces it: of many, the mean is the light's
};

SeenPoint see_point(const scene::Light& light, const glm::dvec3& place, Rng& rng);

/// What a ray meets of a light that is not a sun, before it has gone so far.
glm::dvec3 radiance_along(const scene::Light& light, const glm::dvec3& origin, const glm::dvec3& direction,
                          double reach);

/// Linear RGB, in whatever unit.
glm::dvec3 colour_of(const scene::Light& light);

/// Throws Error for a light that it does not know: a stretched spot, an area with a spread.
void check_source(const scene::Light& light);

}  // namespace mesograin::referee
