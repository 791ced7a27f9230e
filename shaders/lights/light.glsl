// A light of any kind as the device has it, and what it gives at a place.
#pragma once
#include "lights/ball.glsl"
#include "lights/cone.glsl"
#include "lights/draw.glsl"
#include "lights/panel.glsl"
#include "lights/sun.glsl"

const int LIGHT_SUN = 0;
const int LIGHT_POINT = 1;
const int LIGHT_SPOT = 2;
const int LIGHT_AREA = 3;

// What a kind has no use for is 0. Positions are relative to the origin that places are told from (native/lights/device_light.h packs it).
struct DeviceLight {
  real4 place;  // xyz: the middle, of a sun the direction to it, unit length; w: the kind
  // rgb: irradiance of a sun, radiance of an area light, else radiant intensity; w: sun 1 - cos(half its angle), area 1 / tan(half the
  // spread), else radius
  real4 emission;
  real4 axis;  // xyz: the direction in which it shines, unit length; w: spot cosine of the cone's edge, area normalisation of the spread
  real4 x;     // xyz: half axis of an area, or as cone_share's narrow_x; w: area the surface, spot sharpness
  real4 y;     // xyz: the other one; w: 1 for an ellipse, a disc, a flat sun, 0 for a rectangle, a sphere; 2 more for a spot that
  // weakens with the cosine
};

pure real3 first_three(real4 v) { return real3(v.x, v.y, v.z); }

pure LightDraw draw_light(DeviceLight light, real3 place, real2 random) {
  int kind = int(light.place.w);
  real3 middle = first_three(light.place);
  real3 emission = first_three(light.emission);
  if (kind == LIGHT_SUN) return draw_sun(middle, light.emission.w, light.y.w == 1.0, emission, random);
  real3 axis = first_three(light.axis);
  bool weakens = light.y.w >= 2.0;
  bool disc = light.y.w == 1.0 || light.y.w == 3.0;
  if (kind == LIGHT_AREA) {
    Panel panel;
    panel.half_x = first_three(light.x);
    panel.half_y = first_three(light.y);
    panel.axis = axis;
    panel.ellipse = disc;
    panel.area = light.x.w;
    panel.radiance = emission;
    panel.inverse_tangent = light.emission.w;
    panel.normalisation = light.axis.w;
    return draw_panel(panel, middle - place, random);
  }
  LightDraw drawn = draw_ball(middle - place, light.emission.w, disc, emission, random);
  if (kind == LIGHT_SPOT)
    drawn.irradiance *= cone_share(-drawn.to_light, first_three(light.x), first_three(light.y), axis, light.axis.w, light.x.w, weakens);
  return drawn;
}

// The angle, edge to edge and about, under which the light is seen from as far as it reaches.
pure real light_angle(DeviceLight light, real reach) {
  int kind = int(light.place.w);
  if (kind == LIGHT_SUN) return 4.0 * sqrt(0.5 * light.emission.w);  // 1 - cos(a/2) = 2 sin^2(a/4)
  real radius = kind == LIGHT_AREA ? sqrt(light.x.w / PI) : light.emission.w;
  return 2.0 * radius / max(reach, radius);
}
