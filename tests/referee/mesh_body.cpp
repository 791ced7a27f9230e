// Builds the tree by halving, and asks it by Moeller and Trumbore's test.
#include "mesh_body.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "box.h"

namespace mesograin::referee {
namespace {

glm::dvec3 centre(const std::array<glm::dvec3, 3>& corners) { return (corners[0] + corners[1] + corners[2]) / 3.0; }

/// Distance along a ray to a triangle (Moeller and Trumbore, "Fast, minimum storage ray/triangle intersection", 1997).
double meet(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& origin, const glm::dvec3& direction) {
  constexpr double nowhere = std::numeric_limits<double>::infinity(), slack = 1e-12;
  const glm::dvec3 first = corners[1] - corners[0], second = corners[2] - corners[0];
  const glm::dvec3 across = glm::cross(direction, second);
  const double determinant = glm::dot(first, across);
  if (determinant == 0) return nowhere;
  const glm::dvec3 from = origin - corners[0];
  const double u = glm::dot(from, across) / determinant;
  const glm::dvec3 along = glm::cross(from, first);
  const double v = glm::dot(direction, along) / determinant;
  if (u < -slack || v < -slack || u + v > 1 + slack) return nowhere;
  return glm::dot(second, along) / determinant;
}

}  // namespace

MeshBody::MeshBody(const scene::Mesh& mesh, const glm::dmat4& to_world, double sigma_t) {
  double volume = 0;
  for (const glm::uvec3& indices : mesh.triangles()) {
    std::array<glm::dvec3, 3> corners;
    for (int i = 0; i < 3; ++i)
      corners[static_cast<std::size_t>(i)] =
          sigma_t * glm::dvec3(to_world * glm::dvec4(mesh.positions()[indices[i]], 1));
    triangles_.push_back(corners);
    volume += glm::dot(corners[0], glm::cross(corners[1], corners[2]));
  }
  if (volume < 0)
    for (std::array<glm::dvec3, 3>& corners : triangles_) std::swap(corners[1], corners[2]);
  build(0, triangles_.size());
  lower_ = nodes_.front().lower;
  upper_ = nodes_.front().upper;
  shortest_ = 1e-10 * glm::distance(lower_, upper_);
  measure_clearance();
}

void MeshBody::build(std::size_t first, std::size_t last) {
  constexpr std::size_t most_in_a_leaf = 3;
  const std::size_t self = nodes_.size();
  glm::dvec3 lower = triangles_[first][0], upper = lower, least = centre(triangles_[first]), most = least;
  for (std::size_t i = first; i < last; ++i) {
    for (const glm::dvec3& corner : triangles_[i]) lower = glm::min(lower, corner), upper = glm::max(upper, corner);
    least = glm::min(least, centre(triangles_[i]));
    most = glm::max(most, centre(triangles_[i]));
  }
  nodes_.push_back({lower, upper, first, last - first});
  if (last - first <= most_in_a_leaf) return;
  const glm::dvec3 extent = most - least;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::size_t middle = (first + last) / 2;
  const auto at = [&](std::size_t index) { return triangles_.begin() + static_cast<std::ptrdiff_t>(index); };
  std::nth_element(at(first), at(middle), at(last),
                   [axis](const auto& a, const auto& b) { return centre(a)[axis] < centre(b)[axis]; });
  build(first, middle);
  nodes_[self].first = nodes_.size();
  nodes_[self].count = 0;
  build(middle, last);
}

std::optional<MeshHit> MeshBody::first_hit(const glm::dvec3& origin, const glm::dvec3& direction) const {
  const glm::dvec3 inverse = 1.0 / direction;
  constexpr double nowhere = std::numeric_limits<double>::infinity();
  struct Task {
    std::size_t node;
    double begin;
  };
  std::array<Task, 64> tasks;
  std::size_t waiting = 0;
  double nearest = nowhere;
  std::size_t met = 0;
  tasks[waiting++] = {0, 0};
  while (waiting > 0) {
    const Task task = tasks[--waiting];
    if (task.begin > nearest) continue;
    const Node& node = nodes_[task.node];
    if (node.count > 0) {
      for (std::size_t i = node.first; i < node.first + node.count; ++i) {
        const double distance = meet(triangles_[i], origin, direction);
        if (distance > shortest_ && distance < nearest) nearest = distance, met = i;
      }
      continue;
    }
    const std::size_t children[] = {task.node + 1, node.first};
    double begins[2];
    for (int i = 0; i < 2; ++i)
      begins[i] = Box{nodes_[children[i]].lower, nodes_[children[i]].upper}.entry(origin, inverse, nearest);
    const int nearer = begins[1] < begins[0] ? 1 : 0;
    for (const int child : {1 - nearer, nearer})
      if (begins[child] < nowhere) tasks[waiting++] = {children[child], begins[child]};
  }
  if (nearest == nowhere) return std::nullopt;
  const std::array<glm::dvec3, 3>& corners = triangles_[met];
  return MeshHit{nearest, glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]))};
}

std::size_t MeshBody::cell(const glm::dvec3& place) const {
  const glm::ivec3 at = glm::clamp(glm::ivec3(glm::floor((place - lower_) / cell_size_)), 0, cells_ - 1);
  const int number = (at.z * cells_ + at.y) * cells_ + at.x;
  return static_cast<std::size_t>(number);
}

double MeshBody::clearance(const glm::dvec3& place) const { return clearances_[cell(place)]; }

// Cells that a triangle's box reaches into have none; those k cells beyond have that many less one.
void MeshBody::measure_clearance() {
  cell_size_ = glm::max((upper_ - lower_) / static_cast<double>(cells_), glm::dvec3(1e-12));
  constexpr int count = cells_ * cells_ * cells_;
  std::vector<int> steps(count, -1);
  std::deque<glm::ivec3> border;
  const auto index = [](const glm::ivec3& at) {
    const int number = (at.z * cells_ + at.y) * cells_ + at.x;
    return static_cast<std::size_t>(number);
  };
  const auto each = [](const glm::ivec3& first, const glm::ivec3& last, const auto& visit) {
    for (int z = std::max(first.z, 0); z <= std::min(last.z, cells_ - 1); ++z)
      for (int y = std::max(first.y, 0); y <= std::min(last.y, cells_ - 1); ++y)
        for (int x = std::max(first.x, 0); x <= std::min(last.x, cells_ - 1); ++x) visit(glm::ivec3(x, y, z));
  };
  for (const std::array<glm::dvec3, 3>& corners : triangles_) {
    const glm::dvec3 least = glm::min(corners[0], glm::min(corners[1], corners[2]));
    const glm::dvec3 most = glm::max(corners[0], glm::max(corners[1], corners[2]));
    each(glm::ivec3(glm::floor((least - lower_) / cell_size_ - 1e-6)),
         glm::ivec3(glm::floor((most - lower_) / cell_size_ + 1e-6)), [&](const glm::ivec3& at) {
           if (steps[index(at)] == 0) return;
           steps[index(at)] = 0;
           border.push_back(at);
         });
  }
  while (!border.empty()) {
    const glm::ivec3 from = border.front();
    border.pop_front();
    each(from - 1, from + 1, [&](const glm::ivec3& at) {
      if (steps[index(at)] >= 0) return;
      steps[index(at)] = steps[index(from)] + 1;
      border.push_back(at);
    });
  }
  const double side = std::min({cell_size_.x, cell_size_.y, cell_size_.z});
  for (const int away : steps) clearances_.push_back(static_cast<float>(0.999 * side * std::max(away - 1, 0)));
}

}  // namespace mesograin::referee
