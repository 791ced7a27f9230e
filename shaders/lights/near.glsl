// How near a lamp is to a grain: whether it is another lamp for each place that light comes in.
#pragma once
#include "lights/light.glsl"

// Radii from the middle of a grain: from the farther on a lamp is the same for all of it, up to the nearer it is looked at place by place, and
// in between it goes from one to the other.
const real NEAR_RADII = 5.0;
const real FAR_RADII = 6.75;
// The same of models that know the grain inside, or where light enters it, whose own error is no larger than what a lamp farther away is off.
const real INSIDE_NEAR_RADII = 14.0;
const real INSIDE_FAR_RADII = 20.0;
// The same for a spot: how much of its soft edge crosses the grain.
const real SAME_FALL = 0.1;
const real OTHER_FALL = 0.2;

// How much less there is to tell of a lamp that is farther away: from a few radii on, fewer walks are as good.
const real ALL_WALKS_RADII = 5.0;
const real FEWEST_WALKS = 0.25;

// Radii from the nearest point of a lamp to the middle of a grain as large as `radius` at most, `within` as far from `middle` at most.
pure real radii_away(DeviceLight light, real3 middle, real within, real radius) {
  bool area = int(light.place.w) == LIGHT_AREA;
  real extent = area ? length(first_three(light.x)) + length(first_three(light.y)) : light.emission.w;
  return (length(middle - first_three(light.place)) - extent - within) / radius;
}

// How much of a spot's soft edge crosses such a grain, 0 to 1, in steps that count; 0 of other lamps.
pure real edge_across(DeviceLight light, real3 middle, real within, real radius) {
  if (int(light.place.w) != LIGHT_SPOT) return 0.0;
  real3 away = middle - first_three(light.place);
  real3 x = first_three(light.x);
  real3 y = first_three(light.y);
  // As cone_share: between which heights of its soft edge the grain lies.
  real3 local = real3(dot(away, x), dot(away, y), dot(away, first_three(light.axis)));
  real cosine = local.z / max(length(local), 1e-18);
  real seen = (radius + within) / max(length(away), 1e-18) * max(1.0, max(length(x), length(y)));
  real turn = sqrt(max(1.0 - cosine * cosine, 0.0)) * seen + 0.5 * seen * seen;
  real low = clamp((cosine - turn - light.axis.w) * light.x.w, 0.0, 1.0);
  real high = clamp((cosine + turn - light.axis.w) * light.x.w, 0.0, 1.0);
  return clamp((high - low - SAME_FALL) / (OTHER_FALL - SAME_FALL), 0.0, 1.0);
}

// 0 to 1. Of grains as large as `radius` at most, whose middles are as far as `within` from `middle` at most, for the nearest one.
pure real nearness(DeviceLight light, real3 middle, real within, real radius, bool inside) {
  if (int(light.place.w) == LIGHT_SUN) return 0.0;
  real from = inside ? INSIDE_FAR_RADII : FAR_RADII;
  real until = inside ? INSIDE_NEAR_RADII : NEAR_RADII;
  real near = clamp((from - radii_away(light, middle, within, radius)) / (from - until), 0.0, 1.0);
  return max(near, edge_across(light, middle, within, radius));
}

// The share of the walks that a grain there asks for.
pure real walks_worth(DeviceLight light, real3 middle, real radius) {
  real radii = max(radii_away(light, middle, 0.0, radius) / ALL_WALKS_RADII, 1.0);
  return max(max(1.0 / (radii * radii), FEWEST_WALKS), edge_across(light, middle, 0.0, radius));
}
