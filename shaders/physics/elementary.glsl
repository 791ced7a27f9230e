// Elementary functions that hold where the drivers' do not: log and exp near their zeros, arc cosine near +-1, arc tangent near 0.
// Mesa's log errs by 1e-3 near 1, its acos by 2.7e-4 and its atan by 2e-5 (relative). Every series below is long enough for double.
#pragma once

// 1 + t/3 + t^2/5 + ...: atanh(z)/z at t = z^2 (Abramowitz & Stegun 4.6.33), atan(y)/y at t = -y^2 (4.4.42); |t| <= 0.04.
pure real odd_series(real t) {
  real sum = 1.0 / 21.0;
  sum = sum * t + 1.0 / 19.0;
  sum = sum * t + 1.0 / 17.0;
  sum = sum * t + 1.0 / 15.0;
  sum = sum * t + 1.0 / 13.0;
  sum = sum * t + 1.0 / 11.0;
  sum = sum * t + 1.0 / 9.0;
  sum = sum * t + 1.0 / 7.0;
  sum = sum * t + 1.0 / 5.0;
  sum = sum * t + 1.0 / 3.0;
  return 1.0 + t * sum;
}

// log(1 + x), by log((1+z)/(1-z)) = 2 atanh(z), z = x/(2+x) (Abramowitz & Stegun 4.1.27); |z| <= 0.2 where the series is used.
pure real log1p(real x) {
  if (x < -0.333333 || x > 0.5) return log(1.0 + x);
  real z = x / (2.0 + x);
  return 2.0 * z * odd_series(z * z);
}

// exp(x) - 1, by its Taylor series where the difference would cancel (Abramowitz & Stegun 4.2.1).
pure real expm1(real x) {
  if (abs(x) > 0.5) return exp(x) - 1.0;
  real sum = 1.0 + x / 14.0;
  sum = 1.0 + x / 13.0 * sum;
  sum = 1.0 + x / 12.0 * sum;
  sum = 1.0 + x / 11.0 * sum;
  sum = 1.0 + x / 10.0 * sum;
  sum = 1.0 + x / 9.0 * sum;
  sum = 1.0 + x / 8.0 * sum;
  sum = 1.0 + x / 7.0 * sum;
  sum = 1.0 + x / 6.0 * sum;
  sum = 1.0 + x / 5.0 * sum;
  sum = 1.0 + x / 4.0 * sum;
  sum = 1.0 + x / 3.0 * sum;
  sum = 1.0 + x / 2.0 * sum;
  return x * sum;
}

// (1 - exp(-x)) / x for x >= 0, with its limit 1 at 0.
pure real mean_attenuation(real x) {
  if (x < 1e-12) return 1.0;
  return -expm1(-x) / x;
}

// Integral of 2 mu exp(-x mu) over mu from 0 to 1: what a sphere x mean free paths across lets through of diffuse light.
pure real mean_crossing(real x) {
  if (x < 0.2) return 1.0 - x * (2.0 / 3.0 - x * (1.0 / 4.0 - x * (1.0 / 15.0 - x * (1.0 / 72.0 - x / 420.0))));
  return 2.0 * (1.0 - (1.0 + x) * exp(-x)) / (x * x);
}

// A division or a product may round up to 1, whose exponential distance is none.
const real LARGEST_BELOW_ONE = 1.0 - 1.0 / 16777216.0;

// Distance within `longest` whose density falls as exp(-rate distance), by inversion; `random` in [0, 1), `mean_way` is
// longest mean_attenuation(rate longest), the integral of exp(-rate distance).
pure real attenuated_distance(real random, real rate, real longest, real mean_way) {
  real kept = rate * mean_way;
  if (kept < 1e-2) return random * longest;
  return -log(1.0 - min(random * kept, LARGEST_BELOW_ONE)) / rate;
}

// Arc tangent: reflected to |x| <= 1, halved twice to |x| <= tan(pi/16), then its series (Abramowitz & Stegun 4.4.42).
pure real arc_tangent(real x) {
  real y = abs(x);
  bool beyond_one = y > 1.0;
  if (beyond_one) y = 1.0 / y;
  y = y / (1.0 + sqrt(1.0 + y * y));
  y = y / (1.0 + sqrt(1.0 + y * y));
  real angle = 4.0 * y * odd_series(-y * y);
  if (beyond_one) angle = 0.5 * PI - angle;
  return x < 0.0 ? -angle : angle;
}

// Arc cosine of a value clamped to [-1, 1], by the half-angle formula (Abramowitz & Stegun 4.4.33 with the tangent of the half angle).
pure real arc_cosine(real x) {
  real c = clamp(x, -1.0, 1.0);
  if (c <= -1.0) return PI;
  return 2.0 * arc_tangent(sqrt((1.0 - c) / (1.0 + c)));
}

// sqrt(1 - c^2): rounding takes a cosine past 1, where the plain form is not a number.
pure real sine_of_cosine(real c) { return sqrt(max(0.0, (1.0 - c) * (1.0 + c))); }
