// Each pixel looks at its grain a few times a sample.
#include "render/passes/gather_pass.h"

#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>

#include "render/cast_work.h"
#include "render/clear_looks.h"

namespace mesograin::render {
namespace {

// A pixel's noise of so many is a fifth; it falls with every sample.
constexpr int rays_a_sample = 4;

}  // namespace

bool GatherPass::run(const Sample& sample, const ArrayVisibility& arrays, SurfacePass& surfaces) {
  const heap::Gather* gather = sample.exchange.gather();
  ran_ = gather != nullptr && sample.unwrapping == nullptr;
  if (!ran_) return true;
  const auto start = std::chrono::steady_clock::now();
  std::optional<ClearLooks> clear;
  if (sample.cast) clear.emplace(arrays.tree(), sample.content, sample.exchange);
  const SeenSurfaces seen = surfaces.seen(sample);
  const std::vector<Exchange::Role>& roles = sample.exchange.roles();
  pixels_.assign(seen.normals.size(), glm::vec4(0.0F));
  const auto width = static_cast<std::size_t>(sample.size.x);
  const std::uint64_t seed = (static_cast<std::uint64_t>(sample.seed) << 32U) + sample.index;
  const bool whole = cast_rows(sample.size.y, sample.go_on, [&](int first, int end) {
    for (std::size_t i = width * static_cast<std::size_t>(first); i < width * static_cast<std::size_t>(end); ++i) {
      const glm::vec4& facing = seen.normals[i];
      if (facing.w == 0.0F) continue;
      const std::size_t number = static_cast<std::size_t>(std::abs(facing.w)) - 1;
      const std::optional<std::uint32_t>& grain = roles[number].grain;
      if (!grain) continue;
      const glm::vec3 place = glm::vec3(sample.content.receiver(number).ball) + glm::vec3(seen.positions[i]);
      const glm::vec3 towards = glm::normalize(glm::vec3(seen.viewer) - seen.viewer.w * place);
      transport::Random random(seed, i);
      const glm::vec3 normal(facing);
      if (gather->sees_all(*grain)) {
        const glm::vec3 from_middle(seen.positions[i]);
        pixels_[i] = glm::vec4(gather->look_at_all(*grain, from_middle, normal, towards, rays_a_sample, random), 2.0F);
      } else if (clear && gather->sees_into(*grain)) {
        const glm::vec3 into = gather->look_into({*grain, place, normal, towards}, *clear, rays_a_sample, random);
        pixels_[i] = glm::vec4(into, 1.0F);
      } else {
        pixels_[i] = glm::vec4(gather->look(*grain, normal, towards, rays_a_sample, random), 1.0F);
      }
    }
  });
  if (!whole) return false;
  if (!device_ || device_->width() != sample.size.x || device_->height() != sample.size.y)
    device_.emplace(GL_RGBA32F, sample.size.x, sample.size.y);
  device_->upload(GL_RGBA, GL_FLOAT, pixels_.data());
  milliseconds_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return true;
}

void GatherPass::bind(const gl::Program& program) const {
  if (ran_) program.offer("gathered", *device_);
}

}  // namespace mesograin::render
