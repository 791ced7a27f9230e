// A tree of boxes, halved at the median of its longest side.
#include "pile/triangles.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "base/error.h"

namespace mesograin::pile {
namespace {

constexpr std::uint32_t most_in_leaf = 4;
constexpr std::size_t most_waiting = 64;  // of nodes; a halved tree of 2^32 triangles is not deeper

glm::dvec3 middle(const Triangle& triangle) {
  return (triangle.corners[0] + triangle.corners[1] + triangle.corners[2]) / 3.0;
}

}  // namespace

// Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
glm::dvec3 nearest_on(const Triangle& triangle, const glm::dvec3& place) {
  const auto& [a, b, c] = triangle.corners;
  const glm::dvec3 ab = b - a;
  const glm::dvec3 ac = c - a;
  const double d1 = glm::dot(ab, place - a);
  const double d2 = glm::dot(ac, place - a);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const double d3 = glm::dot(ab, place - b);
  const double d4 = glm::dot(ac, place - b);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + d1 / (d1 - d3) * ab;
  const double d5 = glm::dot(ab, place - c);
  const double d6 = glm::dot(ac, place - c);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  return a + (vb * ab + vc * ac) / (va + vb + vc);
}

std::optional<double> crossing(const Triangle& triangle, const glm::dvec3& from, const glm::dvec3& to) {
  const double before = glm::dot(from - triangle.corners[0], triangle.normal);
  const double after = glm::dot(to - triangle.corners[0], triangle.normal);
  if ((before < 0.0) == (after < 0.0)) return std::nullopt;
  const double along = before / (before - after);
  const glm::dvec3 place = from + along * (to - from);
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3& corner = triangle.corners[i];
    const glm::dvec3 edge = triangle.corners[(i + 1) % 3] - corner;
    if (glm::dot(glm::cross(edge, place - corner), triangle.normal) < 0.0) return std::nullopt;
  }
  return along;
}

Triangles::Triangles(const Mesh& mesh) {
  for (const auto& corners : mesh.triangles) {
    Triangle triangle;
    for (int i = 0; i < 3; ++i) {
      if (corners[i] >= mesh.vertices.size())
        throw Error("A triangle's vertices must be below {}; got {}.", mesh.vertices.size(), corners[i]);
      triangle.corners[i] = mesh.vertices[corners[i]];
    }
    const glm::dvec3 across =
        glm::cross(triangle.corners[1] - triangle.corners[0], triangle.corners[2] - triangle.corners[0]);
    const double length = glm::length(across);
    if (!(length > 0.0 && std::isfinite(length))) continue;
    triangle.normal = across / length;
    triangles_.push_back(triangle);
  }
  if (triangles_.empty()) return;
  nodes_.reserve(triangles_.size());
  nodes_.emplace_back();
  build(0, 0, static_cast<std::uint32_t>(triangles_.size()));
}

void Triangles::build(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  glm::dvec3 lower(std::numeric_limits<double>::infinity());
  glm::dvec3 upper = -lower;
  for (std::uint32_t i = first; i < first + count; ++i)
    for (const glm::dvec3& corner : triangles_[i].corners) {
      lower = glm::min(lower, corner);
      upper = glm::max(upper, corner);
    }
  nodes_[node] = {lower, upper, first, count};
  if (count <= most_in_leaf) return;
  const glm::dvec3 span = upper - lower;
  const int axis = span.x >= span.y ? (span.x >= span.z ? 0 : 2) : (span.y >= span.z ? 1 : 2);
  const std::uint32_t half = count / 2;
  std::nth_element(triangles_.begin() + first, triangles_.begin() + first + half, triangles_.begin() + first + count,
                   [axis](const Triangle& a, const Triangle& b) { return middle(a)[axis] < middle(b)[axis]; });
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first = children;
  nodes_[node].count = 0;
  nodes_.resize(nodes_.size() + 2);
  build(children, first, half);
  build(children + 1, first + half, count - half);
}

double Triangles::distance_of_box(const Node& node, const glm::dvec3& place) {
  return glm::length(glm::max(glm::max(node.lower - place, place - node.upper), glm::dvec3(0.0)));
}

template <typename Reaches, typename Visit>
void Triangles::walk(const Reaches& reaches, const Visit& visit) const {
  if (nodes_.empty()) return;
  std::array<std::uint32_t, most_waiting> waiting{};
  std::size_t count = 1;
  while (count > 0) {
    const Node& node = nodes_[waiting[--count]];
    if (!reaches(node)) continue;
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) visit(i);
    if (node.count > 0) continue;
    waiting[count++] = node.first + 1;
    waiting[count++] = node.first;
  }
}

double Triangles::look(const glm::dvec3& place, double least, glm::dvec3* nearest) const {
  if (nodes_.empty()) return least;
  std::array<std::pair<double, std::uint32_t>, most_waiting> waiting{};
  std::size_t count = 1;
  waiting[0] = {distance_of_box(nodes_[0], place), 0};
  while (count > 0) {
    const auto [away, number] = waiting[--count];
    if (away >= least) continue;
    const Node& node = nodes_[number];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const glm::dvec3 on = nearest_on(triangles_[i], place);
      const double distance = glm::length(place - on);
      if (distance >= least) continue;
      least = distance;
      if (nearest != nullptr) *nearest = on;
    }
    if (node.count > 0) continue;
    std::pair<double, std::uint32_t> first{distance_of_box(nodes_[node.first], place), node.first};
    std::pair<double, std::uint32_t> second{distance_of_box(nodes_[node.first + 1], place), node.first + 1};
    if (first.first < second.first) std::swap(first, second);
    waiting[count++] = first;
    waiting[count++] = second;
  }
  return least;
}

double Triangles::distance(const glm::dvec3& place, double least) const { return look(place, least, nullptr); }

glm::dvec3 Triangles::nearest(const glm::dvec3& place) const {
  glm::dvec3 found(0.0);
  look(place, std::numeric_limits<double>::infinity(), &found);
  return found;
}

void Triangles::near(const glm::dvec3& place, double reach, std::vector<std::uint32_t>& found) const {
  walk([&](const Node& node) { return distance_of_box(node, place) < reach; },
       [&](std::uint32_t i) {
         if (glm::length(nearest_on(triangles_[i], place) - place) < reach) found.push_back(i);
       });
}

bool Triangles::between(const glm::dvec3& from, const glm::dvec3& to) const {
  const glm::dvec3 least = glm::min(from, to);
  const glm::dvec3 most = glm::max(from, to);
  bool met = false;
  const auto reaches = [&](const Node& node) {
    return !met && glm::all(glm::lessThanEqual(node.lower, most)) && glm::all(glm::lessThanEqual(least, node.upper));
  };
  walk(reaches, [&](std::uint32_t i) { met = met || crossing(triangles_[i], from, to).has_value(); });
  return met;
}

std::optional<double> Triangles::height(double x, double y) const {
  std::optional<double> highest;
  const auto reaches = [&](const Node& node) {
    return x >= node.lower.x && x <= node.upper.x && y >= node.lower.y && y <= node.upper.y &&
           !(highest && *highest >= node.upper.z);
  };
  walk(reaches, [&](std::uint32_t i) {
    const double above = upper().z + 1.0;
    const double below = lower().z - 1.0;
    const auto along = crossing(triangles_[i], {x, y, above}, {x, y, below});
    if (along) highest = std::max(highest.value_or(below), above + *along * (below - above));
  });
  return highest;
}

}  // namespace mesograin::pile
