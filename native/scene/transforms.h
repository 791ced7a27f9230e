// Where the instances of an array stand: in single precision wherever that holds every number exactly, as Blender's
// always are, so that a grain costs 48 bytes here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat4x3.hpp>
#include <glm/mat4x4.hpp>
#include <span>
#include <variant>
#include <vector>

namespace mesograin::scene {

/// Affine transforms, each from an object's space to the world's.
class Transforms {
 public:
  class Iterator;

  Transforms() = default;

  /// Throws Error if the last row of one is not 0, 0, 0, 1.
  explicit Transforms(std::span<const glm::dmat4> matrices);

  /// Of 16 numbers each, row by row. Throws Error as above.
  static Transforms of_rows(std::span<const float> numbers);
  static Transforms of_rows(std::span<const double> numbers);

  std::size_t size() const;
  bool empty() const { return size() == 0; }
  glm::dmat4 operator[](std::size_t number) const;
  Iterator begin() const;
  Iterator end() const;

  /// Those of these numbers, in their order.
  Transforms chosen(std::span<const std::uint32_t> numbers) const;

  /// Whether single precision holds them.
  bool single_precision() const { return columns_.index() == 0; }

  bool operator==(const Transforms&) const = default;

 private:
  std::variant<std::vector<glm::mat4x3>, std::vector<glm::dmat4x3>> columns_;
};

class Transforms::Iterator {
 public:
  Iterator(const Transforms& of, std::size_t number) : of_(&of), number_(number) {}
  glm::dmat4 operator*() const { return (*of_)[number_]; }
  Iterator& operator++() {
    ++number_;
    return *this;
  }
  bool operator==(const Iterator&) const = default;

 private:
  const Transforms* of_;
  std::size_t number_;
};

inline Transforms::Iterator Transforms::begin() const { return {*this, 0}; }
inline Transforms::Iterator Transforms::end() const { return {*this, size()}; }

}  // namespace mesograin::scene
