// How near a lamp is to a grain: whether it is another lamp for each place that light comes in.
#pragma once
#include "lights/light.glsl"

// Radii from the middle of a grain: from the farther on a lamp is the same for all of it, up to the nearer it is looked at place by place, and
// in between it goes from one to the other.
const real NEAR_RADII = 5.0;
const real FAR_RADII = 6.75;
// The same for a spot: how much of its soft edge crosses the grain.
const real SAME_FALL = 0.1;
const real OTHER_FALL = 0.2;

// 0 to 1. Of grains as large as `radius` at most, whose middles are as far as `within` from `middle` at most, for the nearest one.
pure real nearness(DeviceLight light, real3 middle, real within, real radius) {
  real3 away = middle - first_three(light.place);
  real apart = length(away);
  int kind = int(light.place.w);
  if (kind == LIGHT_SUN) return 0.0;
  real3 x = first_three(light.x);
  real3 y = first_three(light.y);
  real extent = kind == LIGHT_AREA ? length(x) + length(y) : light.emission.w;
  real near = clamp((FAR_RADII - (apart - extent - within) / radius) / (FAR_RADII - NEAR_RADII), 0.0, 1.0);
  if (kind != LIGHT_SPOT) return near;
  // As cone_share: between which heights of its soft edge the grain lies.
  real3 local = real3(dot(away, x), dot(away, y), dot(away, first_three(light.axis)));
  real cosine = local.z / max(length(local), 1e-18);
  real seen = (radius + within) / max(apart, 1e-18) * max(1.0, max(length(x), length(y)));
  real turn = sqrt(max(1.0 - cosine * cosine, 0.0)) * seen + 0.5 * seen * seen;
  real low = clamp((cosine - turn - light.axis.w) * light.x.w, 0.0, 1.0);
  real high = clamp((cosine + turn - light.axis.w) * light.x.w, 0.0, 1.0);
  return max(near, clamp((high - low - SAME_FALL) / (OTHER_FALL - SAME_FALL), 0.0, 1.0));
}
