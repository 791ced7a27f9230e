// Casts shadows, or draws shadow maps around what the picture shows.
#include "render/passes/shadow_pass.h"

#include <algorithm>
#include <bit>
#include <chrono>

#include "render/sequence.h"

namespace mesograin::render {
namespace {

// Texels on a side of a shadow map.
constexpr int least_resolution = 256;
constexpr int most_resolution = 2048;

// Whether it is enough to know for each pixel which lights of this sample reach it.
bool known_by_pixel(const Sample& sample) {
  if (sample.unwrapping != nullptr || !(sample.cast || sample.device_rays)) return false;
  for (std::size_t unit = 0; unit < sample.content.units(); ++unit)
    if (sample.material(unit).asks_below() && sample.asks_model(unit)) return false;
  return true;
}

// Whether what goes straight through a draw may come into another object below its surface.
bool crosses_into_others(const Sample& sample) {
  if (!sample.straight_through || sample.unwrapping != nullptr) return false;
  int below = 0;
  for (std::size_t unit = 0; unit < sample.content.units(); ++unit)
    if (sample.material(unit).asks_below() && sample.asks_model(unit)) ++below;
  return below > 1;
}

Receivers receivers_of(const Sample& sample) {
  const Content& content = sample.content;
  if (sample.unwrapping == nullptr)
    return receivers(sample.targets.surfaces, sample.size.x, sample.size.y,
                     [&](std::size_t number) { return content.receiver(number); });
  Receivers result;
  for (const std::size_t baked : sample.unwrapping->draws)
    result.grains.push_back(content.receiver(content.number(baked)).ball);
  return result;
}

}  // namespace

bool ShadowPass::run(const Sample& sample, const ArrayVisibility& arrays, SurfacePass& surfaces) {
  const std::vector<ShadowEye> eyes = sample.lighting.eyes(sample.lights, sample.content.anchor());
  few_ = eyes.size() <= most_cast_lights;
  by_pixel_ = few_ && known_by_pixel(sample);
  opaque_by_pixel_ = few_ && sample.straight_through && sample.unwrapping == nullptr;
  ran_ = sample.content.shadows() && !eyes.empty();
  if (!ran_) return true;
  const auto start = std::chrono::steady_clock::now();
  const auto asks = [&](std::size_t number) { return !sample.gathers_all_of(number); };
  bool whole = by_pixel_ || update_maps(sample, arrays, eyes);
  if (by_pixel_ && sample.device_rays && !sample.straight_through)
    cast_on_device(sample, arrays, surfaces, eyes);
  else if (whole && (by_pixel_ || opaque_by_pixel_))
    whole = cast(sample, arrays, surfaces.seen(sample), asks, eyes, cast_);
  milliseconds_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return whole;
}

void ShadowPass::cast_on_device(const Sample& sample, const ArrayVisibility& arrays, const SurfacePass& surfaces,
                                const std::vector<ShadowEye>& eyes) {
  const gl::Texture& reached = cast_.on_device(sample.size);
  for (std::size_t light = 0; light < eyes.size(); ++light)
    cast_shadows(sample.cache, arrays.device_rays(), anchor_to_clip(sample.content, sample.camera), sample.targets,
                 surfaces.of_device(), sample.viewer(sample.content.anchor()), static_cast<int>(light), eyes[light],
                 reached);
}

bool ShadowPass::cast(const Sample& sample, const ArrayVisibility& arrays, const SeenSurfaces& seen,
                      const std::function<bool(std::size_t)>& asks, const std::vector<ShadowEye>& eyes,
                      CastShadows& shadows) {
  const StraightThrough through(arrays.tree(), sample.content, sample.exchange);
  return shadows.cast(arrays.tree(), sample.content, seen, asks, eyes, sample.straight_through ? &through : nullptr,
                      sample.index, sample.go_on);
}

bool ShadowPass::cast_for(const DeviceMaterial& material) const {
  return by_pixel_ || (opaque_by_pixel_ && !material.asks_below());
}

Shadows ShadowPass::kind(const Content& content, const DeviceMaterial& material) const {
  return !content.shadows() ? Shadows::none : cast_for(material) ? Shadows::cast : Shadows::maps;
}

bool ShadowPass::update_maps(const Sample& sample, const ArrayVisibility& arrays, const std::vector<ShadowEye>& eyes) {
  const Content& content = sample.content;
  if (receivers_.empty()) {
    casters_.clear();
    receivers_ = receivers_of(sample);
  }
  // About a texel a pixel, or two pixels where a ray finds each: the jitter makes them finer with every sample.
  const bool through = crosses_into_others(sample);
  const int pixels = std::max(sample.size.x, sample.size.y) / (through ? 2 : 1);
  const int resolution =
      std::clamp(static_cast<int>(std::bit_ceil(static_cast<unsigned>(pixels))), least_resolution, most_resolution);
  const glm::dvec2 jitter = r2_point(sample.index, seeded_offset(sample.seed + 0x20000U));
  std::vector<glm::vec2> texels;
  const auto draw = [&](const glm::dmat4& to_clip, const ShadowEye& eye, gl::TextureArray& maps, int layer,
                        const gl::Texture& depth) {
    if (sample.cast || through) {
      const StraightThrough straight(arrays.tree(), content, sample.exchange);
      const ThroughToMap straight_on{through ? &straight : nullptr, static_cast<std::size_t>(layer), sample.index};
      if (!cast_shadow_map(arrays.tree(), content, to_clip, eye, straight_on, resolution, texels, sample.go_on))
        return false;
      maps.upload(layer, GL_RG, GL_FLOAT, texels.data());
      return true;
    }
    if (sample.device_rays && sample.unwrapping == nullptr) {
      cast_shadow_map(sample.cache, arrays.device_rays(), content, to_clip, eye, maps, layer);
      return sample.go_on();
    }
    const gl::Framebuffer target(maps, layer, depth);
    return draw_casters(sample.cache, content,
                        casters(content, to_clip, eye, static_cast<std::size_t>(layer), resolution), to_clip, eye,
                        target, sample.go_on);
  };
  return maps_.update(eyes, receivers_, content.bounds(), content.over_ground(), resolution, jitter, draw);
}

const DeviceSelection* ShadowPass::casters(const Content& content, const glm::dmat4& anchor_to_clip,
                                           const ShadowEye& eye, std::size_t layer, int resolution) {
  if (content.instances() == nullptr) return nullptr;
  if (casters_.size() <= layer) casters_.resize(layer + 1);
  Casters& known = casters_[layer];
  if (!known.selection || known.eye != eye)
    known = {eye,
             std::make_unique<DeviceSelection>(content.instances()->select(anchor_to_clip, resolution, resolution))};
  return known.selection.get();
}

void ShadowPass::bind(const gl::Program& program, const DeviceMaterial& material) const {
  if (!ran_) return;
  if (cast_for(material))
    cast_.bind(program);
  else
    maps_.bind(program);
}

bool ShadowPass::run_mirrored(const Sample& sample, const ArrayVisibility& arrays, const SeenSurfaces& seen) {
  const std::vector<ShadowEye> eyes = sample.lighting.eyes(sample.lights, sample.content.anchor());
  const auto asks = [](std::size_t) { return true; };
  return !ran_ || !few_ || cast(sample, arrays, seen, asks, eyes, mirrored_);
}

Shadows ShadowPass::kind_mirrored(const Content& content, const DeviceMaterial& material) const {
  return content.shadows() && few_ && !material.asks_below() ? Shadows::cast : kind(content, material);
}

void ShadowPass::bind_mirrored(const gl::Program& program, const DeviceMaterial& material) const {
  if (ran_ && few_ && !material.asks_below())
    mirrored_.bind(program);
  else
    bind(program, material);
}

void ShadowPass::forget_content() {
  casters_.clear();
  receivers_.clear();
}

}  // namespace mesograin::render
