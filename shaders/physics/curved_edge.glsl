// How far a curved surface stands from the flat triangles that stand for it.
#pragma once

// Above the middle of the edge between two corners, up to the normals' length: half of Phong tessellation's way (Boubekeur and Alexa 2008,
// equation 3, with alpha = 1/2) at b = (1/2, 1/2).
pure real edge_rise(real3 position_a, real3 normal_a, real3 position_b, real3 normal_b) {
  return 0.125 * abs(dot(normal_b - normal_a, position_b - position_a));
}
