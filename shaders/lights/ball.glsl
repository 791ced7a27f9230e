// A ball of light at a place: point lights and spots.
#pragma once
#include "lights/draw.glsl"

// A ball of radius r and radiant intensity I has the radiance L = I / (pi r^2). Seen from outside it fills a cone of sin(theta) = r / d; a
// disc that faces the place fills one of tan(theta) = r / d, from wherever. Directions are drawn evenly from the cone, so each carries
// L 2 pi (1 - cos theta) = 2 I s, where s = (1 - cos theta) / r^2 is finite for a point too. From inside, a ball is all around.
pure LightDraw draw_ball(real3 to_middle, real radius, bool disc, real3 intensity, real2 random) {
  real d2 = dot(to_middle, to_middle);
  real r2 = radius * radius;
  if (d2 + r2 == 0.0) return no_light();
  real d = sqrt(d2);
  real3 axis = d > 0.0 ? to_middle / d : real3(0.0, 0.0, 1.0);
  bool inside = !disc && d2 < r2;
  // Of the cone's edge: its length, and that times the cosine.
  real edge = disc ? sqrt(d2 + r2) : d;
  real along = disc ? d : sqrt(max(d2 - r2, 0.0));
  real rise_per_area = inside ? 2.0 / r2 : 1.0 / (edge * (edge + along));
  real height;
  real3 to_light = draw_from_cone(axis, r2 * rise_per_area, random, height);
  real cosine = 1.0 - height;
  real half_chord = sqrt(max(r2 - d2 * height * (2.0 - height), 0.0));
  real reach = disc ? d / max(cosine, 1e-18) : d * cosine + (inside ? half_chord : -half_chord);
  return light_from(to_light, 2.0 * rise_per_area * intensity, reach);
}
