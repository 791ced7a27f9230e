// What a light gives at a place: one direction, drawn from all those it shines from.
#pragma once

struct LightDraw {
  real3 to_light;    // unit length
  real3 irradiance;  // on a plane that faces to_light; its mean times the cosine with any normal is the irradiance there
  real reach;        // how far away the light is in that direction; LIGHT_INFINITELY_FAR for a sun
};

const real LIGHT_INFINITELY_FAR = 1e30;

pure LightDraw light_from(real3 to_light, real3 irradiance, real reach) {
  LightDraw drawn;
  drawn.to_light = to_light;
  drawn.irradiance = irradiance;
  drawn.reach = reach;
  return drawn;
}

pure LightDraw no_light() { return light_from(real3(0.0, 0.0, 1.0), real3(0.0), LIGHT_INFINITELY_FAR); }

// A direction evenly distributed over the cone around `axis` whose half angle's cosine is 1 - rise: the sphere's area is even in height
// (Archimedes). height: 1 - the cosine that was drawn. Written so that a cone of no width loses no digit.
pure real3 draw_from_cone(real3 axis, real rise, real2 random, OUT(real) height) {
  height = rise * random.x;
  real sine = sqrt(max(height * (2.0 - height), 0.0));
  real3 helper = abs(axis.x) < 0.5 ? real3(1.0, 0.0, 0.0) : real3(0.0, 1.0, 0.0);
  real3 tangent = normalize(cross(axis, helper));
  real3 bitangent = cross(axis, tangent);
  real azimuth = 2.0 * PI * random.y;
  return (1.0 - height) * axis + sine * (cos(azimuth) * tangent + sin(azimuth) * bitangent);
}
