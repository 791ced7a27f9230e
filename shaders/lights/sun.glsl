// A sun: parallel light, or evenly from a disc.
#pragma once
#include "lights/draw.glsl"

// rise: 1 - cosine of half the disc's angle.
pure LightDraw draw_sun(real3 to_middle, real rise, real3 irradiance, real2 random) {
  real height;
  real3 to_light = draw_from_cone(to_middle, rise, random, height);
  return light_from(to_light, irradiance, LIGHT_INFINITELY_FAR);
}
