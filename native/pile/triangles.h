// Triangles in a tree: which of them is nearest to a place, which are near one, and what a line from above meets.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <vector>

namespace mesograin::pile {

struct Mesh {
  std::vector<glm::dvec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

struct Triangle {
  std::array<glm::dvec3, 3> corners;
  glm::dvec3 normal;  ///< of length 1
};

/// The place on the triangle that is nearest to `place`.
glm::dvec3 nearest_on(const Triangle& triangle, const glm::dvec3& place);

/// How far along from `from` to `to`, 0 to 1, they cross the triangle, if they do.
std::optional<double> crossing(const Triangle& triangle, const glm::dvec3& from, const glm::dvec3& to);

class Triangles {
 public:
  Triangles() = default;

  /// Those without area are left out. Throws Error if a triangle has a vertex that is not there.
  explicit Triangles(const Mesh& mesh);

  bool empty() const { return triangles_.empty(); }
  std::size_t size() const { return triangles_.size(); }
  const Triangle& operator[](std::size_t i) const { return triangles_[i]; }
  const glm::dvec3& lower() const { return nodes_.front().lower; }
  const glm::dvec3& upper() const { return nodes_.front().upper; }

  /// The distance of the nearest triangle, if it is less than `least`, else `least`.
  double distance(const glm::dvec3& place, double least = std::numeric_limits<double>::infinity()) const;

  /// The nearest place of all. There must be a triangle.
  glm::dvec3 nearest(const glm::dvec3& place) const;

  /// Adds the numbers of those nearer to `place` than `reach`, the lower ones of the tree first.
  void near(const glm::dvec3& place, double reach, std::vector<std::uint32_t>& found) const;

  /// Whether the line between two places meets a triangle.
  bool between(const glm::dvec3& from, const glm::dvec3& to) const;

  /// The height where a line straight down meets the first of them.
  std::optional<double> height(double x, double y) const;

 private:
  struct Node {
    glm::dvec3 lower, upper;
    std::uint32_t first = 0;  ///< of its triangles, or of its two nodes
    std::uint32_t count = 0;  ///< of triangles; 0: it has nodes
  };

  void build(std::uint32_t node, std::uint32_t first, std::uint32_t count);
  static double distance_of_box(const Node& node, const glm::dvec3& place);
  template <typename Reaches, typename Visit>
  void walk(const Reaches& reaches, const Visit& visit) const;
  double look(const glm::dvec3& place, double least, glm::dvec3* nearest) const;

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace mesograin::pile
