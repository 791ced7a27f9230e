// Cumulative sums over an image of all directions, and their inverse.
#include "lights/world_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>

namespace mesograin::lights {
namespace {

/// Rec. 709's, of linear RGB.
double luminance(const glm::dvec3& rgb) { return glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722)); }

int texel(double share, int count) { return std::clamp(static_cast<int>(share * count), 0, count - 1); }

/// The first whose sum lies above `random` times the whole, and how far between its neighbours' sums that is.
template <typename Number>
std::pair<std::size_t, double> invert(const Number* sums, std::size_t count, double random) {
  const double wanted = random * static_cast<double>(sums[count - 1]);
  const Number* found = std::upper_bound(sums, sums + count, wanted);
  const auto index = std::min(static_cast<std::size_t>(found - sums), count - 1);
  const double before = index == 0 ? 0.0 : static_cast<double>(sums[index - 1]);
  const double width = static_cast<double>(sums[index]) - before;
  return {index, width > 0.0 ? std::clamp((wanted - before) / width, 0.0, 1.0) : 0.5};
}

// around: a scene::World or scene::Backdrop.
template <typename Around>
glm::dvec3 radiance_around(const Around& around, const glm::dvec3& direction) {
  if (!around.image) return around.radiance;
  const scene::Surroundings& image = *around.image;
  const glm::dvec2 place = equirectangular(glm::normalize(around.world_to_image * direction));
  const auto row = static_cast<std::size_t>(texel(place.y, image.height()));
  const auto column = static_cast<std::size_t>(texel(place.x, image.width()));
  return around.radiance * glm::dvec3(image.texels()[row * static_cast<std::size_t>(image.width()) + column]);
}

}  // namespace

glm::dvec3 radiance(const scene::World& world, const glm::dvec3& direction) {
  return radiance_around(world, direction);
}

glm::dvec3 radiance(const scene::Backdrop& backdrop, const glm::dvec3& direction) {
  return radiance_around(backdrop, direction);
}

WorldLight::WorldLight(scene::World world) : world_(std::move(world)) {
  if (!world_.image) return;
  const scene::Surroundings& image = *world_.image;
  const auto width = static_cast<std::size_t>(image.width());
  const auto height = static_cast<std::size_t>(image.height());
  columns_.resize(width * height);
  rows_.resize(height);
  double all = 0.0;
  for (std::size_t row = 0; row < height; ++row) {
    // Of a texel, its solid angle is this times 2 pi / width.
    const double top = std::cos(PI * static_cast<double>(row) / image.height());
    const double bottom = std::cos(PI * static_cast<double>(row + 1) / image.height());
    double sum = 0.0;
    for (std::size_t column = 0; column < width; ++column) {
      sum += luminance(glm::dvec3(image.texels()[row * width + column]) * world_.radiance);
      columns_[row * width + column] = static_cast<float>(sum);
    }
    all += sum * (top - bottom);
    rows_[row] = all;
  }
}

LightDraw WorldLight::draw(const glm::dvec2& random) const {
  if (!world_.image) {
    double height = 0.0;
    const glm::dvec3 direction = draw_from_cone(glm::dvec3(0.0, 0.0, 1.0), 2.0, random, height);
    return from(direction);
  }
  if (rows_.back() <= 0.0) return no_light();
  const scene::Surroundings& image = *world_.image;
  const auto width = static_cast<std::size_t>(image.width());
  const auto [row, within_row] = invert(rows_.data(), rows_.size(), random.y);
  const auto [column, within_column] = invert(columns_.data() + row * width, width, random.x);
  const double top = std::cos(PI * static_cast<double>(row) / image.height());
  const double bottom = std::cos(PI * static_cast<double>(row + 1) / image.height());
  const double up = top + within_row * (bottom - top);
  const double across = std::sqrt(std::max(1.0 - up * up, 0.0));
  const double azimuth = 2.0 * PI * (0.5 - (static_cast<double>(column) + within_column) / image.width());
  const glm::dvec3 direction(across * std::cos(azimuth), across * std::sin(azimuth), up);
  const glm::dvec3 seen = world_.radiance * glm::dvec3(image.texels()[row * width + column]);
  if (luminance(seen) <= 0.0) return no_light();
  return light_from(glm::normalize(glm::inverse(world_.world_to_image) * direction),
                    seen / (density() * luminance(seen)), LIGHT_INFINITELY_FAR);
}

LightDraw WorldLight::from(const glm::dvec3& direction) const {
  return light_from(direction, world_.radiance / density(), LIGHT_INFINITELY_FAR);
}

double WorldLight::density() const {
  if (!world_.image) return 1.0 / (4.0 * PI);
  // Luminance over the sum of luminance times solid angle.
  const double whole = rows_.back() * 2.0 * PI / world_.image->width();
  return whole > 0.0 ? 1.0 / whole : 0.0;
}

double WorldLight::density(const glm::dvec3& direction) const {
  return world_.image ? density() * luminance(radiance(world_, direction)) : density();
}

double WorldLight::glare(const glm::dvec3& direction, double times) const {
  if (!world_.image || !(density() > 0.0)) return 0.0;
  const double mean = 1.0 / (4.0 * PI * density());
  return 1.0 - std::min(times * mean / std::max(luminance(radiance(world_, direction)), 1e-300), 1.0);
}

}  // namespace mesograin::lights
