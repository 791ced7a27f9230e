// Draws the surface's triangles into the rectangle that faces the light, each into the lines that go through it: that
// is many times faster than to trace rays, of which as many would be needed.
#include "transport/light_ways.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

namespace mesograin::transport {
namespace {

/// A line meets the surface.
struct Crossing {
  std::size_t line;
  float along;
  bool enters;
};

struct Rectangle {
  glm::vec3 first;
  glm::vec3 second;
  glm::vec2 lower{std::numeric_limits<float>::max()};
  glm::vec2 upper{std::numeric_limits<float>::lowest()};

  float area() const { return (upper.x - lower.x) * (upper.y - lower.y); }
};

/// What the body fills where an axis of its box is upright.
Rectangle rectangle_beside(const Body& body, const glm::vec3& to_light, int axis) {
  glm::vec3 upright(0.0F);
  upright[axis] = 1.0F;
  Rectangle seen;
  seen.first = glm::normalize(glm::cross(upright, to_light));
  seen.second = glm::cross(to_light, seen.first);
  for (const glm::vec3& position : body.positions()) {
    const glm::vec2 place(glm::dot(position, seen.first), glm::dot(position, seen.second));
    seen.lower = glm::min(seen.lower, place);
    seen.upper = glm::max(seen.upper, place);
  }
  return seen;
}

/// Of an edge between two vertices of a mesh, always from the same one: two triangles that share it have the same
/// rounding, and a point on it belongs to one of them.
double beside_edge(const glm::dvec2& from, const glm::dvec2& to, const glm::dvec2& point) {
  return (to.x - from.x) * (point.y - from.y) - (to.y - from.y) * (point.x - from.x);
}

struct SeenVertex {
  unsigned number;
  glm::dvec2 place;  // in texels, their middles at whole numbers
  double along;
};

class SeenTriangle {
 public:
  explicit SeenTriangle(std::array<SeenVertex, 3> vertices) : vertices_(vertices) {
    std::sort(vertices_.begin(), vertices_.end(),
              [](const SeenVertex& a, const SeenVertex& b) { return a.number < b.number; });
    for (std::size_t i = 0; i < 3; ++i) whole_[i] = beside(i, vertices_[i].place);
  }

  /// Whether it has no area from there.
  bool edge_on() const { return whole_[0] == 0.0 || whole_[1] == 0.0 || whole_[2] == 0.0; }

  bool covers(const glm::dvec2& point) const {
    for (std::size_t i = 0; i < 3; ++i)
      if ((beside(i, point) >= 0.0) != (whole_[i] > 0.0)) return false;
    return true;
  }

  double along(const glm::dvec2& point) const {
    double sum = 0.0, all = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double share = beside(i, point) / whole_[i];
      sum += share * vertices_[i].along;
      all += share;
    }
    return sum / all;
  }

 private:
  // The edge that a vertex is not on.
  double beside(std::size_t vertex, const glm::dvec2& point) const {
    return beside_edge(vertices_[vertex == 0 ? 1 : 0].place, vertices_[vertex == 2 ? 1 : 2].place, point);
  }

  std::array<SeenVertex, 3> vertices_;
  std::array<double, 3> whole_{};
};

/// From where a line enters to where it leaves; crossings by their order along it.
std::vector<glm::vec2> pieces_inside(std::vector<Crossing>::const_iterator crossing,
                                     std::vector<Crossing>::const_iterator end) {
  std::vector<glm::vec2> pieces;
  int around = 0;
  for (float begin = 0.0F; crossing != end; ++crossing) {
    if (crossing->enters) {
      if (around++ == 0) begin = crossing->along;
    } else if (around > 0 && --around == 0) {
      pieces.emplace_back(begin, crossing->along);
    }
  }
  return pieces;
}

/// Of more than two pieces of a line, two.
glm::vec4 two_of(std::vector<glm::vec2> pieces) {
  while (pieces.size() > 2) {
    std::size_t narrowest = 1;
    for (std::size_t i = 2; i < pieces.size(); ++i)
      if (pieces[i].x - pieces[i - 1].y < pieces[narrowest].x - pieces[narrowest - 1].y) narrowest = i;
    pieces[narrowest].x -= pieces[narrowest - 1].y - pieces[narrowest - 1].x;
    pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(narrowest) - 1);
  }
  pieces.resize(2, glm::vec2(0.0F));
  return {pieces[0], pieces[1]};
}

}  // namespace

LightWays::LightWays(const Body& body, const glm::vec3& to_light, int lines) : to_light_(glm::normalize(to_light)) {
  lay_out(body, lines);
  cross(body);
}

void LightWays::lay_out(const Body& body, int lines) {
  Rectangle smallest;
  for (int axis = 0; axis < 3; ++axis) {
    constexpr float along_light = 0.99F;
    if (std::abs(to_light_[axis]) > along_light) continue;
    const Rectangle seen = rectangle_beside(body, to_light_, axis);
    if (!(smallest.upper.x > smallest.lower.x) || seen.area() < smallest.area()) smallest = seen;
  }
  first_ = smallest.first;
  second_ = smallest.second;
  lower_ = smallest.lower;
  const glm::vec2 extent = glm::max(smallest.upper - lower_, glm::vec2(1e-4F));
  const float side = std::sqrt(extent.x * extent.y / static_cast<float>(lines));
  size_ = glm::max(glm::ivec2(glm::round(extent / side)), glm::ivec2(1));
  texel_ = extent / glm::vec2(size_);
}

void LightWays::cross(const Body& body) {
  std::vector<Crossing> found;
  for (std::size_t i = 0; i < body.triangles().size(); ++i) {
    std::array<SeenVertex, 3> vertices{};
    glm::dvec2 lowest(std::numeric_limits<double>::max()), highest(std::numeric_limits<double>::lowest());
    for (int corner = 0; corner < 3; ++corner) {
      const unsigned number = body.triangles()[i][corner];
      const glm::vec3& position = body.positions()[number];
      const glm::vec2 across(glm::dot(position, first_), glm::dot(position, second_));
      const glm::dvec2 place = glm::dvec2((across - lower_) / texel_) - 0.5;
      vertices[static_cast<std::size_t>(corner)] = {number, place, -glm::dot(position, to_light_)};
      lowest = glm::min(lowest, place);
      highest = glm::max(highest, place);
    }
    const SeenTriangle triangle(vertices);
    if (triangle.edge_on()) continue;
    const bool enters = glm::dot(body.normals()[i], to_light_) > 0.0F;
    const glm::ivec2 from = glm::max(glm::ivec2(glm::ceil(lowest)), glm::ivec2(0));
    const glm::ivec2 until = glm::min(glm::ivec2(glm::floor(highest)), size_ - 1);
    for (int y = from.y; y <= until.y; ++y)
      for (int x = from.x; x <= until.x; ++x) {
        if (!triangle.covers({x, y})) continue;
        const int line = y * size_.x + x;
        found.push_back({static_cast<std::size_t>(line), static_cast<float>(triangle.along({x, y})), enters});
      }
  }
  const std::size_t count = static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y);
  std::vector<std::size_t> ends(count + 1, 0);
  for (const Crossing& crossing : found) ++ends[crossing.line + 1];
  for (std::size_t line = 0; line < count; ++line) ends[line + 1] += ends[line];
  std::vector<Crossing> crossings(found.size());
  std::vector<std::size_t> next = ends;
  for (const Crossing& crossing : found) crossings[next[crossing.line]++] = crossing;
  lines_.reserve(count);
  for (std::size_t line = 0; line < count; ++line) {
    const auto begin = crossings.begin() + static_cast<std::ptrdiff_t>(ends[line]);
    const auto end = crossings.begin() + static_cast<std::ptrdiff_t>(ends[line + 1]);
    std::sort(begin, end, [](const Crossing& a, const Crossing& b) { return a.along < b.along; });
    lines_.push_back(two_of(pieces_inside(begin, end)));
  }
}

float LightWays::way(const glm::vec4& inside, float along) {
  return std::max(std::min(along, inside.y) - inside.x, 0.0F) + std::max(std::min(along, inside.w) - inside.z, 0.0F);
}

float LightWays::way(const glm::vec3& place) const {
  const glm::vec2 across(glm::dot(place, first_), glm::dot(place, second_));
  const float along = -glm::dot(place, to_light_);
  const glm::vec2 texel = glm::clamp((across - lower_) / texel_ - 0.5F, glm::vec2(0.0F), glm::vec2(size_ - 1));
  const glm::ivec2 low = glm::min(glm::ivec2(texel), glm::max(size_ - 2, 0));
  const glm::vec2 beyond = texel - glm::vec2(low);
  float sum = 0.0F, all = 0.0F;
  for (int corner = 0; corner < 4; ++corner) {
    const glm::ivec2 step(corner % 2, corner / 2);
    const glm::ivec2 at = glm::min(low + step, size_ - 1);
    const int number = at.y * size_.x + at.x;
    const glm::vec4& inside = lines_[static_cast<std::size_t>(number)];
    if (!(inside.y > inside.x)) continue;
    const float share = (step.x == 1 ? beyond.x : 1.0F - beyond.x) * (step.y == 1 ? beyond.y : 1.0F - beyond.y);
    sum += share * way(inside, along);
    all += share;
  }
  return all > 0.0F ? sum / all : 0.0F;
}

}  // namespace mesograin::transport
