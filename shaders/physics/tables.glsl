// Where the tables that are filled in double and read on the GPU have their rows and columns: each way beside the way back.
#pragma once

// A body's radius over the grain's, from 0 at an eighth to 1 at the double, evenly in the logarithm.
pure real body_row(real radius) { return (log2(radius) + 3.0) * 0.25; }
pure real body_radius(real row) { return exp2(4.0 * row - 3.0); }

// A cosine from -1 to 1 as 0 to 1, dense at the terminator, where light changes fastest.
pure real body_column(real cosine) { return 0.5 + 0.5 * sign(cosine) * sqrt(min(abs(cosine), 1.0)); }
pure real body_cosine(real column) {
  real u = 2.0 * column - 1.0;
  return u * abs(u);
}

// The column of a kernel's distance: distances grow geometrically, and evenly below the shortest.
pure real kernel_column(real distance, real inverse_shortest, real columns_per_octave) {
  return log2(1.0 + distance * inverse_shortest) * columns_per_octave;
}
pure real kernel_distance(real column, real shortest, real columns_per_octave) { return shortest * (exp2(column / columns_per_octave) - 1.0); }
