// Heaps for tests.
#pragma once

#include "heap/heap.h"

namespace mesograin::heap {

inline Optics medium(double sigma_t, double albedo) {
  Optics optics;
  optics.surface = Surface::index_matched;
  optics.sigma_t = glm::dvec3(sigma_t);
  optics.albedo = glm::dvec3(albedo);
  return optics;
}

inline Optics lambert(double reflectance) {
  Optics optics;
  optics.reflectance = glm::dvec3(reflectance);
  return optics;
}

/// Spheres of radius 1 on a cubic lattice, a little apart.
inline Heap lattice(int side, const Optics& optics, double spacing = 2.05) {
  Heap heap;
  heap.grains.kinds = {optics};
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y)
      for (int z = 0; z < side; ++z)
        heap.grains.grains.push_back({glm::vec3(x, y, z) * static_cast<float>(spacing), 1.0F, 0});
  return heap;
}

}  // namespace mesograin::heap
