// Double precision is kept if a single number needs it.
#include "scene/transforms.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "base/error.h"

namespace mesograin::scene {
namespace {

// Written so that what is no number fails, too.
void require_affine(const glm::dvec4& last_row) {
  if (!(last_row == glm::dvec4(0.0, 0.0, 0.0, 1.0)))
    throw Error(
        "An instance's transform must be finite and invertible, and its last row 0, 0, 0, 1; got {}, {}, {}, {}.",
        last_row.x, last_row.y, last_row.z, last_row.w);
}

bool fits_single(const glm::dmat4x3& columns) { return glm::dmat4x3(glm::mat4x3(columns)) == columns; }

std::variant<std::vector<glm::mat4x3>, std::vector<glm::dmat4x3>> as_small_as_exact(std::vector<glm::dmat4x3> columns) {
  if (!std::ranges::all_of(columns, fits_single)) return columns;
  return std::vector<glm::mat4x3>(columns.begin(), columns.end());
}

template <typename Number>
using Columns = glm::mat<4, 3, Number>;

template <typename Number>
std::vector<Columns<Number>> columns_of(std::span<const Number> rows) {
  std::vector<Columns<Number>> all(rows.size() / 16);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Number* numbers = rows.data() + 16 * i;
    require_affine({numbers[12], numbers[13], numbers[14], numbers[15]});
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) all[i][column][row] = numbers[4 * row + column];
  }
  return all;
}

}  // namespace

Transforms::Transforms(std::span<const glm::dmat4> matrices) {
  std::vector<glm::dmat4x3> columns;
  columns.reserve(matrices.size());
  for (const glm::dmat4& matrix : matrices) {
    require_affine(glm::dvec4(matrix[0].w, matrix[1].w, matrix[2].w, matrix[3].w));
    columns.emplace_back(matrix);
  }
  columns_ = as_small_as_exact(std::move(columns));
}

Transforms Transforms::of_rows(std::span<const float> numbers) {
  Transforms transforms;
  transforms.columns_ = columns_of(numbers);
  return transforms;
}

Transforms Transforms::of_rows(std::span<const double> numbers) {
  Transforms transforms;
  transforms.columns_ = as_small_as_exact(columns_of(numbers));
  return transforms;
}

std::size_t Transforms::size() const {
  return std::visit([](const auto& columns) { return columns.size(); }, columns_);
}

glm::dmat4 Transforms::operator[](std::size_t number) const {
  return std::visit([number](const auto& columns) { return glm::dmat4(glm::dmat4x3(columns[number])); }, columns_);
}

Transforms Transforms::chosen(std::span<const std::uint32_t> numbers) const {
  Transforms found;
  std::visit(
      [&](const auto& columns) {
        std::remove_cvref_t<decltype(columns)> of_these;
        of_these.reserve(numbers.size());
        for (const std::uint32_t number : numbers) of_these.push_back(columns[number]);
        found.columns_ = std::move(of_these);
      },
      columns_);
  return found;
}

}  // namespace mesograin::scene
