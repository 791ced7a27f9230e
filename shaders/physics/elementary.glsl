// Elementary functions that hold where the drivers' do not: exp near its zero, means of it without a difference.
// Every series below is long enough for double.
#pragma once

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

// The exponential integral E_2(x) (Abramowitz & Stegun 5.1.4), x >= 0, within 2 %: exp(-x) / (1 + x times what falls from -log x to 1).
pure real second_exponential_integral(real x) { return exp(-x) / (1.0 + x * (1.0 + 0.59 * log(1.0 + 1.2 / max(x, 1e-6)))); }

// Of the light that is everywhere in and beyond a plane's surface the same, how much reaches a point `depth` mean free paths below it that was
// scattered on the way: all but what comes straight from beyond, E_2/2 (Chandrasekhar 1960, section 13).
pure real scattered_share_below(real depth) { return 1.0 - 0.5 * second_exponential_integral(depth); }

// A division or a product may round up to 1, whose exponential distance is none.
const real LARGEST_BELOW_ONE = 1.0 - 1.0 / 16777216.0;

// Distance within `longest` whose density falls as exp(-rate distance), by inversion; `random` in [0, 1), `mean_way` is
// longest mean_attenuation(rate longest), the integral of exp(-rate distance).
pure real attenuated_distance(real random, real rate, real longest, real mean_way) {
  real kept = rate * mean_way;
  if (kept < 1e-2) return random * longest;
  return -log(1.0 - min(random * kept, LARGEST_BELOW_ONE)) / rate;
}

// sqrt(1 - c^2): rounding takes a cosine past 1, where the plain form is not a number.
pure real sine_of_cosine(real c) { return sqrt(max(0.0, (1.0 - c) * (1.0 + c))); }
