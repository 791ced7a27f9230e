// A sun: parallel light, or from a disc.
#pragma once
#include "lights/draw.glsl"

// rise: 1 - cosine of half the disc's angle. flat_disc: drawn evenly from a disc that stands across, as Cycles did before Blender 4, else from
// the sky's.
pure LightDraw draw_sun(real3 to_middle, real rise, bool flat_disc, real3 irradiance, real2 random) {
  real height;
  if (flat_disc) {
    // Of a circle of radius tangent about the middle, where areas are even in the radius' square.
    real cosine = max(1.0 - rise, 1e-6);
    real squared = random.x * rise * (2.0 - rise) / (cosine * cosine);
    height = squared / (1.0 + squared + sqrt(1.0 + squared));  // 1 - 1 / sqrt(1 + squared), of no digit lost
    real3 to_light = draw_from_cone(to_middle, height, real2(1.0, random.y), height);
    return light_from(to_light, irradiance, LIGHT_INFINITELY_FAR);
  }
  real3 to_light = draw_from_cone(to_middle, rise, random, height);
  return light_from(to_light, irradiance, LIGHT_INFINITELY_FAR);
}
