// The Henyey-Greenstein phase function in a form that holds for |g| -> 1.
#pragma once

// The peak is (1 - g^2)/(4 pi (1 - |g|)^3): beyond this |g| it is too narrow for anything that is not an integral.
const real HENYEY_GREENSTEIN_LARGEST_G = 0.999;

// p, per steradian (Henyey & Greenstein 1941). 1 + g^2 - 2 g cos = (1 - |g|)^2 + 2 |g| v with v = 1 - cos for g >= 0 and 1 + cos for
// g < 0: both are half a squared length of a vector sum, so the caller has them without cancellation. 1 - |g| comes in by itself.
pure real henyey_greenstein(real versine, real absolute_g, real one_minus_absolute_g) {
  real q = one_minus_absolute_g * one_minus_absolute_g + 2.0 * absolute_g * versine;
  return one_minus_absolute_g * (1.0 + absolute_g) / (4.0 * PI * q * sqrt(q));
}
