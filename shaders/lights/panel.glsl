// A flat light of one bright side: area lights.
#pragma once
#include "lights/draw.glsl"

// What slats before the light let through at an angle a from its axis: max(1 - tan a / tan h, 0) / (1 - h / tan h), h half the spread, which
// leaves its power as it was: integral of cos a (1 - tan a / tan h) sin a from 0 to h. inverse_tangent: 1 / tan h, 0 where there are none.
pure real slats_share(real cosine, real inverse_tangent, real normalisation) {
  real tangent = sqrt(max(1.0 - cosine * cosine, 0.0)) / cosine;
  return max(1.0 - tangent * inverse_tangent, 0.0) * normalisation;
}

struct Panel {
  real3 half_x;
  real3 half_y;
  real3 axis;  // the direction in which it shines
  bool ellipse;
  real area;
  real3 radiance;
  real inverse_tangent;  // of slats_share
  real normalisation;
};

// Points evenly from the area A, so that each carries L A cos / t^2.
pure LightDraw draw_panel(Panel panel, real3 to_middle, real2 random) {
  real2 spot = 2.0 * random - 1.0;
  if (panel.ellipse) {
    real radius = sqrt(random.x);
    real azimuth = 2.0 * PI * random.y;
    spot = real2(radius * cos(azimuth), radius * sin(azimuth));
  }
  real3 to_spot = to_middle + spot.x * panel.half_x + spot.y * panel.half_y;
  real t2 = dot(to_spot, to_spot);
  if (t2 == 0.0) return no_light();
  real t = sqrt(t2);
  real3 to_light = to_spot / t;
  real cosine = -dot(to_light, panel.axis);
  if (cosine <= 0.0) return no_light();
  real share = slats_share(cosine, panel.inverse_tangent, panel.normalisation);
  return light_from(to_light, panel.radiance * (panel.area * cosine / t2 * share), t);
}
