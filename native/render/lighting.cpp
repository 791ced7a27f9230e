// Low-discrepancy points choose a direction of every light for each sample.
#include "render/lighting.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "render/sequence.h"

namespace mesograin::render {
namespace {

// The angle that a direction of the world stands for, as a sun's disc would have it.
constexpr double world_angle = 0.5;

// Where each family of lights begins among the seeds of their points.
constexpr std::uint32_t sun_seeds = 0x10000U;
constexpr std::uint32_t world_seed = 0x20000U;
constexpr std::uint32_t local_seeds = 0x30000U;

std::optional<gl::Texture> sent(const scene::Surroundings* image) {
  std::optional<gl::Texture> texture;
  if (image == nullptr) return texture;
  texture.emplace(GL_RGB32F, image->width(), image->height());
  texture->upload(GL_RGB, GL_FLOAT, image->texels().data());
  texture->sample_linearly(true);
  return texture;
}

}  // namespace

void Lighting::set(const scene::Scene& scene) {
  suns_.clear();
  local_.clear();
  for (const scene::Light& light : scene.lights)
    if (const auto* sun = std::get_if<scene::DirectionalLight>(&light))
      suns_.push_back(*sun);
    else
      local_.push_back(light);
  if (scene.world == world_) return;
  world_ = scene.world;
  world_light_.reset();
  world_directions_.reset();
  if (world_.shines()) {
    world_light_.emplace(world_);
    world_directions_.emplace(*world_light_);
  }
  world_image_ = sent(world_.image.get());
  backdrop_image_ = sent(world_.backdrop ? world_.backdrop->image.get() : nullptr);
}

bool Lighting::is_light(const glm::dvec3& middle, double radius, const glm::dvec3& radiance) const {
  // A light lies a little before its face, and single precision has rounded either.
  constexpr double near = 1e-2, alike = 1e-5;
  return std::any_of(local_.begin(), local_.end(), [&](const scene::Light& light) {
    const auto* area = std::get_if<scene::AreaLight>(&light);
    return area != nullptr && glm::distance(area->position, middle) <= (1.0 + near) * radius &&
           glm::distance(area->radiance, radiance) <= alike * glm::length(radiance);
  });
}

SampledLights Lighting::sample(std::uint32_t index, std::uint32_t seed, int world_directions) {
  SampledLights sampled;
  for (std::size_t i = 0; i < suns_.size(); ++i) {
    const glm::dvec2 random = scrambled_point(index, seed + sun_seeds + static_cast<std::uint32_t>(i));
    const lights::LightDraw drawn = lights::sample(suns_[i], glm::dvec3(0.0), random);
    sampled.distant.push_back({drawn.to_light, drawn.irradiance, suns_[i].angle});
  }
  if (world_light_) sampled.world_density = world_directions * world_light_->density();
  for (int i = 0; world_light_ && i < world_directions; ++i) {
    // All pixels share them, so the picture as a whole is as far off as the mean of their irradiance is.
    const std::uint32_t place = index * static_cast<std::uint32_t>(world_directions) + static_cast<std::uint32_t>(i);
    const lights::LightDraw drawn = world_directions_->at(*world_light_, place, seed + world_seed);
    sampled.distant.push_back({drawn.to_light, drawn.irradiance / static_cast<double>(world_directions), world_angle,
                               world_directions * world_light_->density(drawn.to_light)});
  }
  for (std::size_t i = 0; i < local_.size(); ++i)
    sampled.randoms.push_back(scrambled_point(index, seed + local_seeds + static_cast<std::uint32_t>(i)));
  return sampled;
}

std::vector<LightDirection> Lighting::at(const SampledLights& sampled, const glm::dvec3& place) const {
  std::vector<LightDirection> directions = sampled.distant;
  for (std::size_t i = 0; i < local_.size(); ++i) {
    const lights::DeviceLight packed = lights::pack(local_[i], place);
    const lights::LightDraw drawn = lights::draw_light(packed, glm::dvec3(0.0), sampled.randoms[i]);
    directions.push_back({drawn.to_light, drawn.irradiance, lights::light_angle(packed, drawn.reach)});
  }
  return directions;
}

std::vector<ShadowEye> Lighting::eyes(const SampledLights& sampled, const glm::dvec3& anchor) const {
  std::vector<ShadowEye> eyes;
  for (const LightDirection& direction : sampled.distant) eyes.emplace_back(direction.to_light, 0.0);
  for (std::size_t i = 0; i < local_.size(); ++i) {
    const lights::DeviceLight packed = lights::pack(local_[i], anchor);
    const lights::LightDraw drawn = lights::draw_light(packed, glm::dvec3(0.0), sampled.randoms[i]);
    // What turns its back on the anchor still has its middle.
    const bool seen = drawn.reach < lights::LIGHT_INFINITELY_FAR;
    eyes.emplace_back(seen ? drawn.reach * drawn.to_light : glm::dvec3(packed.place), 1.0);
  }
  return eyes;
}

double Lighting::nearness(const glm::dvec3& middle, double within, double radius, bool inside) const {
  double nearest = 0.0;
  for (const scene::Light& light : local_)
    nearest = std::max(nearest, lights::nearness(lights::pack(light, middle), glm::dvec3(0.0), within, radius, inside));
  return nearest;
}

std::vector<lights::DeviceLight> Lighting::local(const glm::dvec3& origin) const {
  std::vector<lights::DeviceLight> packed;
  packed.reserve(local_.size());
  for (const scene::Light& light : local_) packed.push_back(lights::pack(light, origin));
  return packed;
}

std::vector<std::array<glm::vec4, 5>> Lighting::device_local(const glm::dvec3& origin) const {
  std::vector<std::array<glm::vec4, 5>> device;
  for (const lights::DeviceLight& light : local(origin)) device.push_back(lights::to_device(light));
  return device;
}

}  // namespace mesograin::render
