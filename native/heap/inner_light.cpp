// Least squares, each channel for itself: walks weigh as much as that channel's light does on them.
#include "heap/inner_light.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace mesograin::heap {
namespace {

// What one walk finds is off by about as much as there is, and terms beyond the mean are a fraction of that: so many
// scatterings tell as much of each term as is known beforehand.
constexpr float known_before = 4.0F;

}  // namespace

std::array<float, InnerLight::terms> InnerLight::basis(const glm::vec3& p) {
  const float xx = p.x * p.x;
  const float yy = p.y * p.y;
  const float zz = p.z * p.z;
  return {1.0F,     p.x,      p.y,      p.z,      p.x * p.y, p.y * p.z, p.z * p.x, xx,       yy,       zz,
          xx * p.x, xx * p.y, xx * p.z, yy * p.x, yy * p.y,  yy * p.z,  zz * p.x,  zz * p.y, zz * p.z, p.x * p.y * p.z};
}

void InnerLight::add(const glm::vec3& place, const glm::vec3& weight, const glm::vec3& found) {
  const std::array<float, terms> at = basis(place);
  ++scatterings_;
  std::array<float, products> product;
  float* row = product.data();
  for (std::size_t i = 0; i < terms; ++i) {
    for (std::size_t j = 0; j <= i; ++j) row[j] = at[i] * at[j];
    row += i + 1;
  }
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const float weighs = weight[static_cast<int>(channel)];
    const float light = found[static_cast<int>(channel)];
    for (std::size_t i = 0; i < products; ++i) weights_[channel][i] += weighs * product[i];
    for (std::size_t i = 0; i < terms; ++i) found_[channel][i] += light * at[i];
  }
}

// Cholesky's decomposition.
void InnerLight::fit() {
  for (std::size_t channel = 0; channel < 3; ++channel) {
    std::array<float, products> lower = weights_[channel];
    std::array<float, terms> solution = found_[channel];
    const float least = known_before * lower[0] / static_cast<float>(std::max(scatterings_, 1));
    if (!(least > 0.0F)) continue;
    const auto row = [&](std::size_t i) { return lower.data() + i * (i + 1) / 2; };
    for (std::size_t i = 0; i < terms; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        float sum = row(i)[j] + (i == j && i > 0 ? least : 0.0F);
        for (std::size_t k = 0; k < j; ++k) sum -= row(i)[k] * row(j)[k];
        row(i)[j] = i == j ? std::sqrt(std::max(sum, 1e-6F * least)) : sum / row(j)[j];
      }
      for (std::size_t k = 0; k < i; ++k) solution[i] -= row(i)[k] * solution[k];
      solution[i] /= row(i)[i];
    }
    for (std::size_t i = terms; i-- > 0;) {
      for (std::size_t k = i + 1; k < terms; ++k) solution[i] -= row(k)[i] * solution[k];
      solution[i] /= row(i)[i];
    }
    for (std::size_t i = 0; i < terms; ++i) fitted_[i][static_cast<int>(channel)] = solution[i];
  }
}

glm::vec3 InnerLight::sum_at(const glm::vec3& place) const {
  const std::array<float, terms> there = basis(place);
  glm::vec3 light(0.0F);
  for (std::size_t i = 0; i < terms; ++i) light += there[i] * fitted_[i];
  return light;
}

glm::vec3 InnerLight::at(const glm::vec3& place) const { return glm::max(sum_at(place), 0.0F); }

// A polynomial of order 3 is, on a line, the one through four of its places (Newton's forward differences).
InnerLight::Line InnerLight::along(const glm::vec3& from, const glm::vec3& to) const {
  const glm::vec3 step = (to - from) / 3.0F;
  const glm::vec3 first = sum_at(from);
  const glm::vec3 second = sum_at(from + step);
  const glm::vec3 third = sum_at(from + 2.0F * step);
  const glm::vec3 once = second - first;
  const glm::vec3 twice = third - 2.0F * second + first;
  const glm::vec3 thrice = sum_at(to) - 3.0F * third + 3.0F * second - first;
  Line line;
  for (int channel = 0; channel < 3; ++channel) {
    const float a = once[channel];
    const float b = 0.5F * twice[channel];
    const float c = thrice[channel] / 6.0F;
    // In steps a s + b s (s - 1) + c s (s - 1) (s - 2), three to the way.
    line.terms_[static_cast<std::size_t>(channel)] = {first[channel], 3.0F * (a - b + 2.0F * c), 9.0F * (b - 3.0F * c),
                                                      27.0F * c};
  }
  return line;
}

}  // namespace mesograin::heap
