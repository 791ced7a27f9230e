// Finds what other objects leave of each light: a bit for each pixel and light where that is enough, else shadow maps.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "gl/program.h"
#include "render/cast_shadows.h"
#include "render/passes/array_visibility.h"
#include "render/passes/sample.h"
#include "render/passes/surface_pass.h"
#include "render/receivers.h"
#include "render/shadow_maps.h"

namespace mesograin::render {

class ShadowPass {
 public:
  /// After the surfaces are found. False if ended.
  bool run(const Sample& sample, const ArrayVisibility& arrays, SurfacePass& surfaces);

  /// After run(), of what other surfaces mirror. False if ended.
  bool run_mirrored(const Sample& sample, const ArrayVisibility& arrays, const SeenSurfaces& seen);

  /// How programs of this sample's content learn of them, each of its own material.
  Shadows kind(const Content& content, const DeviceMaterial& material) const;

  /// Makes them what shaders/scene/shadows.glsl reads, if there are any in this sample.
  void bind(const gl::Program& program, const DeviceMaterial& material) const;

  /// The same for what other surfaces mirror: of what is opaque, rays find what stands in the light; in what is
  /// translucent it is known as far as the shadow maps reach, which are drawn around what is seen.
  Shadows kind_mirrored(const Content& content, const DeviceMaterial& material) const;
  void bind_mirrored(const gl::Program& program, const DeviceMaterial& material) const;

  /// Whether the last run had any light to ask for.
  bool ran() const { return ran_; }

  /// That the last run took of this side.
  double milliseconds() const { return milliseconds_; }

  void forget_content();
  void forget_view() { receivers_.clear(); }

 private:
  /// Where the light's eye was, and what it saw of the same receivers.
  struct Casters {
    ShadowEye eye;
    std::unique_ptr<DeviceSelection> selection;
  };

  bool cast(const Sample& sample, const ArrayVisibility& arrays, const SeenSurfaces& seen,
            const std::function<bool(std::size_t)>& asks, const std::vector<ShadowEye>& eyes, CastShadows& shadows);

  /// The same by the device's rays.
  void cast_on_device(const Sample& sample, const ArrayVisibility& arrays, const SurfacePass& surfaces,
                      const std::vector<ShadowEye>& eyes);

  bool update_maps(const Sample& sample, const ArrayVisibility& arrays, const std::vector<ShadowEye>& eyes);

  /// What a light of this layer sees: the same as in the sample before where it has not moved.
  const DeviceSelection* casters(const Content& content, const glm::dmat4& anchor_to_clip, const ShadowEye& eye,
                                 std::size_t layer, int resolution);

  Receivers receivers_;  // empty if not known yet
  std::vector<Casters> casters_;
  ShadowMaps maps_;
  CastShadows cast_;
  CastShadows mirrored_;
  bool cast_for(const DeviceMaterial& material) const;

  bool by_pixel_ = false;
  bool opaque_by_pixel_ = false;  // of surfaces that are opaque, beside the maps of others
  bool few_ = false;              // lights: each may have a bit
  bool ran_ = false;
  double milliseconds_ = 0.0;
};

}  // namespace mesograin::render
