// Where a direction lies in a picture of all directions.
#pragma once

// (column, row) in [0, 1], from the upper left corner: z is up, the middle column looks along +x and +y lies left of it, as Blender has it.
pure real2 equirectangular(real3 direction) {
  real across = sqrt(direction.x * direction.x + direction.y * direction.y);
  return real2(0.5 - atan(direction.y, direction.x) / (2.0 * PI), 0.5 - atan(direction.z, across) / PI);
}
