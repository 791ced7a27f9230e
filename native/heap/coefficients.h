// Light that depends on the direction of a surface's normal: spherical harmonics to order 1, written as mean + slope .
// n, or to order 2.
#pragma once

#include <array>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <utility>
#include <vector>

namespace mesograin::heap {

/// The harmonics of order 2 at a place p, such that a . b = P2 of the angle between, times their squared lengths.
using SecondOrder = std::array<float, 5>;

inline SecondOrder second_order(const glm::vec3& p) {
  constexpr float root = 1.7320508F;
  return {root * p.x * p.y, root * p.y * p.z, root * p.z * p.x, 0.5F * root * (p.x * p.x - p.y * p.y),
          p.z * p.z - 0.5F * (p.x * p.x + p.y * p.y)};
}

/// The numbers of order 2 of three channels, where there are any: few grains of many have them, and then only are they
/// in memory.
class SecondOrders {
 public:
  using Numbers = std::array<SecondOrder, 3>;

  SecondOrders() = default;
  SecondOrders(const SecondOrders& other) : numbers_(copied(other)) {}
  SecondOrders(SecondOrders&&) = default;
  SecondOrders& operator=(SecondOrders&&) = default;
  SecondOrders& operator=(const SecondOrders& other) {
    if (this == &other) return *this;
    if (numbers_ && other.numbers_)
      *numbers_ = *other.numbers_;
    else
      numbers_ = copied(other);
    return *this;
  }
  ~SecondOrders() = default;

  /// Null: all are 0.
  const Numbers* get() const { return numbers_.get(); }

  Numbers& made() {
    if (!numbers_) numbers_ = std::make_unique<Numbers>();
    return *numbers_;
  }

 private:
  static std::unique_ptr<Numbers> copied(const SecondOrders& other) {
    return other.numbers_ ? std::make_unique<Numbers>(*other.numbers_) : nullptr;
  }

  std::unique_ptr<Numbers> numbers_;
};

/// For red, green and blue.
struct Coefficients {
  /// xyz the slope, w the mean over all normals.
  std::array<glm::vec4, 3> channels{glm::vec4(0.0F), glm::vec4(0.0F), glm::vec4(0.0F)};
  SecondOrders second{};  ///< of what is told so finely

  glm::vec3 at(const glm::vec3& normal) const {
    glm::vec3 light = first_at(normal);
    if (second.get() == nullptr) return light;
    const SecondOrder basis = second_order(normal);
    for (std::size_t channel = 0; channel < 3; ++channel)
      for (std::size_t i = 0; i < basis.size(); ++i)
        light[static_cast<int>(channel)] += (*second.get())[channel][i] * basis[i];
    return light;
  }

  /// The same where there is no second order.
  glm::vec3 first_at(const glm::vec3& normal) const {
    const glm::vec4 basis(normal, 1.0F);
    return {glm::dot(channels[0], basis), glm::dot(channels[1], basis), glm::dot(channels[2], basis)};
  }

  /// Adds the projection of `light` that is found at one of many normals which are spread evenly; its share of them is
  /// in it. `fine`: to order 2.
  void add(const glm::vec3& light, const glm::vec3& normal, bool fine) {
    const glm::vec4 basis(3.0F * normal, 1.0F);
    for (int channel = 0; channel < 3; ++channel) channels[static_cast<std::size_t>(channel)] += light[channel] * basis;
    if (fine) add_second(light, normal);
  }

  /// Adds so much of another's.
  void add(const Coefficients& other, const glm::vec3& by) {
    for (std::size_t channel = 0; channel < 3; ++channel)
      channels[channel] += by[static_cast<int>(channel)] * other.channels[channel];
    if (other.second.get() != nullptr) add_second(*other.second.get(), by);
  }

  void scale(const glm::vec3& by) {
    for (std::size_t channel = 0; channel < 3; ++channel) channels[channel] *= by[static_cast<int>(channel)];
    if (second.get() == nullptr) return;
    for (std::size_t channel = 0; channel < 3; ++channel)
      for (float& number : second.made()[channel]) number *= by[static_cast<int>(channel)];
  }

 private:
  void add_second(const glm::vec3& light, const glm::vec3& normal) {
    const SecondOrder more = second_order(normal);
    SecondOrders::Numbers& numbers = second.made();
    for (std::size_t channel = 0; channel < 3; ++channel)
      for (std::size_t i = 0; i < more.size(); ++i)
        numbers[channel][i] += 5.0F * light[static_cast<int>(channel)] * more[i];
  }

  void add_second(const SecondOrders::Numbers& other, const glm::vec3& by) {
    SecondOrders::Numbers& numbers = second.made();
    for (std::size_t channel = 0; channel < 3; ++channel)
      for (std::size_t i = 0; i < numbers[channel].size(); ++i)
        numbers[channel][i] += by[static_cast<int>(channel)] * other[channel][i];
  }
};

inline Coefficients operator*(Coefficients coefficients, const glm::vec3& by) {
  coefficients.scale(by);
  return coefficients;
}

inline Coefficients operator+(Coefficients a, const Coefficients& b) {
  a.add(b, glm::vec3(1.0F));
  return a;
}

inline Coefficients operator-(Coefficients a, const Coefficients& b) {
  a.add(b, glm::vec3(-1.0F));
  return a;
}

/// Of each channel the sum of products.
inline glm::vec3 product(const Coefficients& a, const Coefficients& b) {
  glm::vec3 sum(0.0F);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    float& of_channel = sum[static_cast<int>(channel)];
    of_channel = glm::dot(a.channels[channel], b.channels[channel]);
    if (a.second.get() == nullptr || b.second.get() == nullptr) continue;
    const SecondOrder& of_a = (*a.second.get())[channel];
    for (std::size_t i = 0; i < of_a.size(); ++i) of_channel += of_a[i] * (*b.second.get())[channel][i];
  }
  return sum;
}

/// A share, of all colours together, that depends on a place as light does.
struct Share {
  glm::vec4 first{0.0F};  ///< xyz the slope, w the mean
  SecondOrder second{};

  float at(const glm::vec3& place) const {
    const SecondOrder basis = second_order(place);
    float sum = glm::dot(first, glm::vec4(place, 1.0F));
    for (std::size_t i = 0; i < basis.size(); ++i) sum += second[i] * basis[i];
    return sum;
  }
};

/// One for each grain.
using Field = std::vector<Coefficients>;

/// One that does not change, of which all copies are the same.
class SharedField {
 public:
  SharedField() : SharedField(Field()) {}
  explicit SharedField(Field field) : field_(std::make_shared<const Field>(std::move(field))) {}

  operator const Field&() const { return *field_; }  // NOLINT(google-explicit-constructor): it is one

  const Coefficients& operator[](std::size_t i) const { return (*field_)[i]; }
  std::size_t size() const { return field_->size(); }
  Field::const_iterator begin() const { return field_->begin(); }
  Field::const_iterator end() const { return field_->end(); }

 private:
  std::shared_ptr<const Field> field_;
};

}  // namespace mesograin::heap
