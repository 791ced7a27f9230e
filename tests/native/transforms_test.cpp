// Transforms of arrays come back as they were given, in single precision and in double.
#include "scene/transforms.h"

#include <gtest/gtest.h>

#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <vector>

#include "expect_error.h"

namespace mesograin::scene {
namespace {

using test::expect_error;

std::vector<glm::dmat4> turned(double far) {
  std::vector<glm::dmat4> matrices;
  matrices.reserve(5);
  for (int i = 0; i < 5; ++i)
    matrices.push_back(glm::rotate(glm::translate(glm::dmat4(1.0), glm::dvec3(far, i, -i)), 0.3 * i, {1.0, 2.0, 3.0}));
  return matrices;
}

std::vector<glm::dmat4> all_of(const Transforms& transforms) {
  std::vector<glm::dmat4> matrices;
  matrices.reserve(transforms.size());
  for (const glm::dmat4 matrix : transforms) matrices.push_back(matrix);
  return matrices;
}

TEST(Transforms, NothingIsLostOfDoublePrecision) {
  const std::vector<glm::dmat4> matrices = turned(1e9 + 0.125);
  EXPECT_EQ(all_of(Transforms(matrices)), matrices);
  const std::vector<std::uint32_t> numbers{3, 0};
  EXPECT_EQ(all_of(Transforms(matrices).chosen(numbers)), (std::vector<glm::dmat4>{matrices[3], matrices[0]}));
}

TEST(Transforms, NothingIsLostOfSinglePrecision) {
  std::vector<glm::dmat4> matrices = turned(0.25);
  std::vector<float> rows;
  for (glm::dmat4& matrix : matrices) {
    matrix = glm::dmat4(glm::mat4(matrix));
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) rows.push_back(static_cast<float>(matrix[column][row]));
  }
  EXPECT_EQ(all_of(Transforms(matrices)), matrices);
  EXPECT_EQ(all_of(Transforms::of_rows(rows)), matrices);
  EXPECT_EQ(all_of(Transforms::of_rows(std::vector<double>(rows.begin(), rows.end()))), matrices);
  EXPECT_EQ(all_of(Transforms(matrices).chosen(std::vector<std::uint32_t>{4})), std::vector<glm::dmat4>{matrices[4]});
  EXPECT_TRUE(Transforms().empty());
}

TEST(Transforms, ThatProjectAreRefused) {
  for (const double number : {0.5, std::numeric_limits<double>::quiet_NaN()}) {
    glm::dmat4 matrix(1.0);
    matrix[1].w = number;
    expect_error([&] { Transforms(std::span(&matrix, 1)); }, "last row");
    std::array<float, 16> rows{};
    rows[14] = static_cast<float>(number);
    expect_error([&] { Transforms::of_rows(rows); }, "last row");
  }
}

}  // namespace
}  // namespace mesograin::scene
