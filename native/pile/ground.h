// What a pile rests on and what holds it: heights over a rectangle, and walls.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/vec2.hpp>
#include <limits>
#include <vector>

namespace mesograin::pile {

/// Heights above the plane z = 0, row by row along y, the first at `lower`; beyond its edge the ground goes on as high
/// as there. Without heights it is the plane.
struct Ground {
  std::vector<double> heights;
  std::size_t columns = 0;
  glm::dvec2 lower{0.0};
  glm::dvec2 step{1.0};

  std::size_t rows() const { return columns > 0 ? heights.size() / columns : 0; }

  double height(double x, double y) const {
    if (heights.empty()) return 0.0;
    const double u = std::clamp((x - lower.x) / step.x, 0.0, static_cast<double>(columns - 1));
    const double v = std::clamp((y - lower.y) / step.y, 0.0, static_cast<double>(rows() - 1));
    const auto column = std::min(static_cast<std::size_t>(u), columns > 1 ? columns - 2 : 0);
    const auto row = std::min(static_cast<std::size_t>(v), rows() > 1 ? rows() - 2 : 0);
    const double s = u - static_cast<double>(column);
    const double t = v - static_cast<double>(row);
    const std::size_t right = columns > 1 ? 1 : 0;
    const std::size_t above = rows() > 1 ? columns : 0;
    const double* corner = heights.data() + row * columns + column;
    return (1.0 - t) * ((1.0 - s) * corner[0] + s * corner[right]) +
           t * ((1.0 - s) * corner[above] + s * corner[above + right]);
  }
};

/// Upright walls at plus and minus `half` of each axis; without any, the pile runs out as far as friction lets it.
struct Walls {
  glm::dvec2 half{std::numeric_limits<double>::infinity()};

  bool any() const { return std::isfinite(half.x) && std::isfinite(half.y); }
};

}  // namespace mesograin::pile
