// Tries a few turns.
#include "transport/axes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

namespace mesograin::transport {
namespace {

double box_volume(const std::vector<glm::dvec3>& positions, const glm::dmat3& turn) {
  glm::dvec3 lower(std::numeric_limits<double>::infinity());
  glm::dvec3 upper(-lower);
  for (const glm::dvec3& position : positions) {
    const glm::dvec3 turned = turn * position;
    lower = glm::min(lower, turned);
    upper = glm::max(upper, turned);
  }
  const glm::dvec3 extent = upper - lower;
  return extent.x * extent.y * extent.z;
}

glm::dmat3 principal_axes(const std::vector<glm::dvec3>& positions, const std::vector<glm::dvec3>& normals,
                          const std::vector<glm::uvec3>& triangles) {
  glm::dvec3 mean(0.0);
  double area = 0.0;
  const auto middle = [&](std::size_t i) {
    return (positions[triangles[i].x] + positions[triangles[i].y] + positions[triangles[i].z]) / 3.0;
  };
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    mean += glm::length(normals[i]) * middle(i);
    area += glm::length(normals[i]);
  }
  mean /= std::max(area, 1e-300);
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const glm::dvec3 from_mean = middle(i) - mean;
    const Eigen::Vector3d place(from_mean.x, from_mean.y, from_mean.z);
    moments += glm::length(normals[i]) * place * place.transpose();
  }
  const Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors();
  glm::dmat3 turn;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) turn[column][row] = axes(column, row);
  return turn;
}

// Directions of the largest faces, triangles that face the same way together.
std::vector<glm::dvec3> largest_faces(const std::vector<glm::dvec3>& normals) {
  constexpr double same_way = 0.9995;
  constexpr std::size_t most = 64;
  std::vector<glm::dvec3> sums;
  for (const glm::dvec3& normal : normals) {
    if (!(glm::length(normal) > 0.0)) continue;
    const auto same = std::find_if(sums.begin(), sums.end(), [&](const glm::dvec3& sum) {
      return glm::dot(sum, normal) > same_way * glm::length(sum) * glm::length(normal);
    });
    if (same != sums.end())
      *same += normal;
    else if (sums.size() < most)
      sums.push_back(normal);
  }
  std::sort(sums.begin(), sums.end(),
            [](const glm::dvec3& a, const glm::dvec3& b) { return glm::dot(a, a) > glm::dot(b, b); });
  constexpr std::size_t kept = 6;
  if (sums.size() > kept) sums.resize(kept);
  return sums;
}

}  // namespace

glm::dmat3 tight_axes(const std::vector<glm::dvec3>& positions, const std::vector<glm::dvec3>& normals,
                      const std::vector<glm::uvec3>& triangles) {
  std::vector<glm::dmat3> turns = {principal_axes(positions, normals, triangles)};
  const std::vector<glm::dvec3> faces = largest_faces(normals);
  for (const glm::dvec3& first : faces)
    for (const glm::dvec3& second : faces) {
      const glm::dvec3 x = glm::normalize(first);
      const glm::dvec3 across = second - glm::dot(second, x) * x;
      if (glm::length(across) < 0.1 * glm::length(second)) continue;
      const glm::dvec3 y = glm::normalize(across);
      turns.push_back(glm::transpose(glm::dmat3(x, y, glm::cross(x, y))));
    }
  glm::dmat3 best(1.0);
  // What gains nothing is left as it stands.
  double smallest = 0.99 * box_volume(positions, best);
  for (const glm::dmat3& turn : turns) {
    const double volume = box_volume(positions, turn);
    if (volume >= smallest) continue;
    smallest = volume;
    best = turn;
  }
  return best;
}

}  // namespace mesograin::transport
