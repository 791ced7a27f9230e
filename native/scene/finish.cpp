// Checks pictures and finishes.
#include "scene/finish.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"

namespace mesograin::scene {
namespace {

void require_share(std::string_view name, double value) {
  if (!(value >= 0.0 && value <= 1.0)) throw Error("A finish's {} must lie between 0 and 1; got {}.", name, value);
}

bool is_finite(const glm::dvec4& row) {
  return std::isfinite(row.x) && std::isfinite(row.y) && std::isfinite(row.z) && std::isfinite(row.w);
}

void validate(std::string_view name, const TextureMap& map) {
  if (!is_finite(map.to_picture[0]) || !is_finite(map.to_picture[1]))
    throw Error("How the picture of {} lies on the mesh must be finite numbers.", name);
}

}  // namespace

Picture::Picture(int width, int height, std::variant<Bytes, Numbers> texels, bool srgb)
    : width_(width), height_(height), texels_(std::move(texels)), srgb_(srgb) {
  const std::size_t count = std::visit([](const auto& all) { return all.size(); }, texels_);
  if (width < 1 || height < 1 || count != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    throw Error("A picture of {} x {} texels needs as many of them; got {}.", width, height, count);
  if (const auto* numbers = std::get_if<Numbers>(&texels_))
    if (!std::all_of(numbers->begin(), numbers->end(), [](const glm::vec4& texel) { return is_finite(texel); }))
      throw Error("A picture's texels must be finite.");
}

void validate(const Finish& finish) {
  validate("reflectance", finish.reflectance);
  validate("roughness", finish.roughness);
  validate("metallic", finish.metallic);
  validate("normal", finish.normal);
  validate("emission", finish.emission);
  require_share("metallicity", finish.metallicity);
  require_share("coat", finish.coat);
  require_share("coat_roughness", finish.coat_roughness);
  require_share("diffuse_roughness", finish.diffuse_roughness);
  if (!(finish.normal_strength >= 0.0 && std::isfinite(finish.normal_strength)))
    throw Error("A finish's normal_strength must be finite and at least 0; got {}.", finish.normal_strength);
  for (int channel = 0; channel < 3; ++channel)
    if (!(finish.radiance[channel] >= 0.0 && std::isfinite(finish.radiance[channel])))
      throw Error("A finish's radiance must be finite and at least 0; got {}.", finish.radiance[channel]);
}

}  // namespace mesograin::scene
