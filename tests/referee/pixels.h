// The paths of every pixel of a picture, and their mean.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "parallel.h"
#include "picture.h"
#include "rng.h"

namespace mesograin::referee {

/// Row by row, each with random numbers and a tracer of its own: `make_tracer()` returns what is called as
/// `trace(x, y, rng)`, x and y in clip space, and answers with one path's radiance, or with nothing where it misses.
template <class MakeTracer>
Picture trace_pixels(const PictureCase& setup, const MakeTracer& make_tracer, const std::function<void()>& row_done) {
  const std::size_t width = static_cast<std::size_t>(setup.width), height = static_cast<std::size_t>(setup.height);
  Picture picture;
  picture.radiance.resize(width * height);
  picture.noise.resize(width * height);
  picture.coverage.resize(width * height);
  const int strata = static_cast<int>(std::sqrt(setup.samples));
  parallel(height, setup.threads, [&](std::size_t row) {
    Rng rng(setup.seed, row);
    auto trace = make_tracer();
    for (int column = 0; column < setup.width; ++column) {
      glm::dvec3 sum(0), squares(0);
      int hits = 0;
      for (int sample = 0; sample < setup.samples; ++sample) {
        // The first strata^2 paths are stratified over the pixel, the rest are anywhere in it.
        const bool stratified = sample < strata * strata;
        const int across = sample % strata, down = sample / strata;
        const double u = stratified ? (across + rng.uniform()) / strata : rng.uniform();
        const double v = stratified ? (down + rng.uniform()) / strata : rng.uniform();
        const std::optional<glm::dvec3> radiance =
            trace(2 * (column + u) / setup.width - 1, 1 - 2 * (static_cast<double>(row) + v) / setup.height, rng);
        if (!radiance) continue;
        ++hits;
        sum += *radiance;
        squares += *radiance * *radiance;
      }
      const double samples = setup.samples;
      const std::size_t pixel = row * width + static_cast<std::size_t>(column);
      const glm::dvec3 mean = sum / samples;
      picture.radiance[pixel] = mean;
      picture.noise[pixel] =
          glm::sqrt(glm::max(squares / samples - mean * mean, glm::dvec3(0)) / std::max(1.0, samples - 1));
      picture.coverage[pixel] = hits / samples;
    }
    if (row_done) row_done();
  });
  return picture;
}

}  // namespace mesograin::referee
