// Balls are chosen as a greedy cover chooses: each time the largest ball inside that touches the surface where it
// stands out most of those before. It is found by shrinking (Ma, Bae and Choi, "3D medial axis point approximation
// using nearest neighbors and the normal field", 2012, section 3).
#include "pile/shape.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "base/error.h"

namespace mesograin::pile {
namespace {

constexpr double tolerance = 0.025;  // how far the surface may stand out of the balls
constexpr std::size_t most_balls = 220;
constexpr std::size_t most_samples = 700;

struct Sample {
  glm::dvec3 place;
  glm::dvec3 outwards;
};

struct Inner {
  glm::dvec3 middle;
  double radius;
};

std::vector<Sample> samples_of(const Mesh& mesh) {
  std::vector<Sample> samples(mesh.vertices.size());
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = {mesh.vertices[i], glm::dvec3(0.0)};
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::dvec3 across = glm::cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
    for (const std::uint32_t corner : {a, b, c}) samples[corner].outwards += across;
  }
  std::erase_if(samples, [](const Sample& sample) { return !(glm::length(sample.outwards) > 0.0); });
  const std::size_t stride = 1 + samples.size() / most_samples;
  std::vector<Sample> some;
  for (std::size_t i = 0; i < samples.size(); i += stride)
    some.push_back({samples[i].place, glm::normalize(samples[i].outwards)});
  return some;
}

Inner largest_inside(const Triangles& triangles, const Sample& sample, double reach) {
  double radius = reach;
  for (int i = 0; i < 30; ++i) {
    const glm::dvec3 middle = sample.place - radius * sample.outwards;
    const glm::dvec3 nearest = triangles.nearest(middle);
    if (glm::distance(nearest, middle) > radius - 1e-3) break;
    const glm::dvec3 chord = sample.place - nearest;
    const double along = glm::dot(sample.outwards, chord);
    if (!(along > 1e-9)) break;
    radius = std::min(radius, glm::dot(chord, chord) / (2.0 * along));
  }
  const glm::dvec3 middle = sample.place - radius * sample.outwards;
  return {middle, std::min(radius, triangles.distance(middle))};
}

std::vector<Ball> cover(const Triangles& triangles, const std::vector<Sample>& samples, double reach) {
  std::vector<Inner> candidates;
  candidates.reserve(samples.size());
  for (const Sample& sample : samples) candidates.push_back(largest_inside(triangles, sample, reach));
  std::vector<double> standing_out(samples.size(), std::numeric_limits<double>::infinity());
  std::vector<Ball> chosen;
  auto next =
      static_cast<std::size_t>(std::max_element(candidates.begin(), candidates.end(),
                                                [](const Inner& a, const Inner& b) { return a.radius < b.radius; }) -
                               candidates.begin());
  while (chosen.size() < most_balls) {
    const Inner& ball = candidates[next];
    chosen.push_back({glm::vec3(ball.middle), static_cast<float>(ball.radius)});
    for (std::size_t i = 0; i < samples.size(); ++i)
      standing_out[i] = std::min(standing_out[i], glm::distance(samples[i].place, ball.middle) - ball.radius);
    standing_out[next] = 0.0;
    next = static_cast<std::size_t>(std::max_element(standing_out.begin(), standing_out.end()) - standing_out.begin());
    if (standing_out[next] < tolerance) break;
  }
  return chosen;
}

// Second moments of a solid: tetrahedra from the origin to its triangles (Blow and Binstock, "How to find the inertia
// tensor of a 3D solid body", 2004).
glm::dmat3 second_moments(const Mesh& mesh) {
  glm::dmat3 sum(0.0);
  double volume = 0.0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const glm::dvec3& a = mesh.vertices[i];
    const glm::dvec3& b = mesh.vertices[j];
    const glm::dvec3& c = mesh.vertices[k];
    const double six = glm::dot(a, glm::cross(b, c));
    const glm::dvec3 all = a + b + c;
    sum += six / 120.0 *
           (glm::outerProduct(a, a) + glm::outerProduct(b, b) + glm::outerProduct(c, c) + glm::outerProduct(all, all));
    volume += six / 6.0;
  }
  return sum / volume;
}

}  // namespace

Shape ball_shape(double radius) {
  Shape shape;
  shape.balls = {{glm::vec3(0.0F), static_cast<float>(radius)}};
  shape.support = Support(radius);
  shape.half = glm::dvec3(radius);
  shape.reach = shape.thickness = radius;
  return shape;
}

Shape shape_of(const Mesh& mesh) {
  const Triangles triangles(mesh);
  if (triangles.empty()) throw Error("A grain's mesh needs at least one triangle.");
  Shape shape;
  shape.reach = 0.0;
  for (const glm::dvec3& vertex : mesh.vertices) shape.reach = std::max(shape.reach, glm::length(vertex));
  if (shape.reach - triangles.distance(glm::dvec3(0.0)) < tolerance) return ball_shape(shape.reach);
  shape.balls = cover(triangles, samples_of(mesh), shape.reach);
  shape.thickness = 0.0;
  for (const Ball& ball : shape.balls) shape.thickness = std::max(shape.thickness, static_cast<double>(ball.radius));
  shape.support = Support(mesh.vertices);
  shape.field.emplace_back(triangles, shape.thickness + 0.3);

  const glm::dmat3 moments = second_moments(mesh);
  shape.inertia = glm::dmat3(moments[0][0] + moments[1][1] + moments[2][2]) - moments;
  Eigen::Matrix3d matrix;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) matrix(i, j) = moments[j][i];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) shape.axes[i][j] = solver.eigenvectors()(j, 2 - i);
  shape.axes[2] = glm::cross(shape.axes[0], shape.axes[1]);
  shape.half = glm::dvec3(0.0);
  for (const glm::dvec3& vertex : mesh.vertices)
    for (int i = 0; i < 3; ++i) shape.half[i] = std::max(shape.half[i], std::abs(glm::dot(vertex, shape.axes[i])));
  return shape;
}

}  // namespace mesograin::pile
