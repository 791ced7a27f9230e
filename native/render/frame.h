// One view: its scene, its camera, and the passes that draw a sample of it, in their order.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "render/bake.h"
#include "render/content.h"
#include "render/device_cache.h"
#include "render/exchange.h"
#include "render/lighting.h"
#include "render/passes/accumulate_pass.h"
#include "render/passes/array_visibility.h"
#include "render/passes/light_map_pass.h"
#include "render/passes/mirror_pass.h"
#include "render/passes/sample.h"
#include "render/passes/shade_pass.h"
#include "render/passes/shadow_pass.h"
#include "render/passes/subpixel_pass.h"
#include "render/passes/surface_pass.h"
#include "render/passes/targets.h"
#include "render/passes/timings.h"
#include "render/portion.h"
#include "render/stored_lights.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace mesograin::render {

inline constexpr int default_taps = 16;

/// What of the arrays the last sample took the trouble of.
struct Statistics {
  std::size_t instances = 0;  ///< there are
  std::size_t drawn = 0;      ///< that the device drew for the camera, in as few triangles as they deserve
  std::size_t cast = 0;       ///< that rays were cast at
  std::size_t seen = 0;       ///< of those, that rays met; not told where the device follows them
  std::optional<ExchangeStatistics> exchange;  ///< where light goes from grain to grain
};

/// Of one portion of a picture's light.
struct PortionSum {
  std::unique_ptr<Sum> sum;
  int samples = 0;
};

/// Lives on the context's thread.
class Frame {
 public:
  Frame(DeviceCache& cache, int width, int height, std::uint32_t seed, bool patient);

  void resize(int width, int height);
  void set_scene(scene::Scene scene);
  void set_camera(const scene::Camera& camera);

  /// Another moment of the exposure: what set_scene() took elsewhere, if a scene is given, seen through this camera.
  /// Samples from now on see it so and are added to those before. Light between grains stays each grain's own as it was
  /// found for set_scene(). Throws Error for a scene of other things, and for a bake.
  void set_moment(const scene::Camera& camera, const scene::Scene* scene);

  /// Has these told beside the picture from now on; the samples begin anew. Each costs about what its own shading does.
  void set_portions(const std::vector<Portion>& portions);

  /// The mean of one of them, as read(). Throws Error if it is not told.
  void read_portion(Portion portion, float* pixels);

  /// From here to the next scene the picture is a texture: the instances unwrapped. Throws Error for instances that do
  /// not exist or have no UVs.
  void set_bake(const Bake& bake);

  /// Of the instances baked; throws Error if nothing is.
  UvUse uv_use();

  /// Light map samples that model 3 takes for one pixel and sample, over all lights.
  void set_taps(int taps);

  /// Throws Error where rays are asked for and cannot be cast.
  void set_visibility(Visibility visibility);
  void set_levels(bool by_size);

  /// Of light between grains, as it is solved from now on.
  void set_summing(Summing by) { exchange_.set_summing(by); }

  /// Adds one sample to the sum. `go_on` is asked between its parts; where it says no, nothing is added, and the answer
  /// is false.
  /// `hurried`: it is shown alone, to someone who waits for it: where the device follows rays itself, rays on this side
  /// are left to the samples after it, which begin anew.
  bool add_sample(const GoOn& go_on, bool hurried = false);

  /// That the sum holds.
  int samples() const { return samples_; }

  /// Takes in what has become known since the scene was set; if anything has, the samples begin anew. Returns whether
  /// they did.
  bool take_news();

  /// What the scene's materials wait for, and its lamps.
  std::vector<std::shared_ptr<const transport::Computation>> computations() const;
  std::shared_ptr<const heap::Solving> solving() const { return exchange_.solving(); }

  /// Waits until the device has drawn what was asked for.
  void finish() const;

  /// The mean of the samples so far, (height, width, 4), first row at the top. Zero where there are none yet.
  void read(float* pixels);

  /// What rays through the pixels' middles meet, first row at the top. `positions`, (height, width, 4): in the world,
  /// and 1; 0 where they meet nothing. `normals`, (height, width, 3): of unit length, on the side that is seen. Throws
  /// Error for a bake, which has no view.
  void read_surfaces(float* positions, float* normals);

  std::vector<PassTiming> timings() const;

  Statistics statistics() const;

  int width() const { return size_.x; }
  int height() const { return size_.y; }

 private:
  /// Of this content, seen as it is now.
  Sample begin_sample(const GoOn& go_on, bool hurried);

  /// How many samples the next one is added to.
  int added_to() const { return hurried_ && samples_ == 1 ? 0 : samples_; }

  /// The surfaces, what stands in their light, and their shading.
  bool draw_seen(const Sample& sample);

  /// The portions of what was drawn.
  bool add_portions(Sample sample);
  bool draw_unwrapped(const Sample& sample);
  bool update_shadows(const Sample& sample);

  /// Whether each sample sees the scene from a place of its own.
  bool looks_through_lens() const { return camera_.lens && !unwrapping_; }

  /// The camera from the middle of its lens.
  scene::Camera pinhole() const;

  /// The camera from the place of its lens that this sample looks through.
  scene::Camera seen_through(std::uint32_t index) const;

  /// What is seen, or how, has changed; the samples before it stay.
  void forget_what_is_seen();

  /// The same, and the samples begin anew.
  void forget_view();
  void forget_content();

  DeviceCache& cache_;
  glm::ivec2 size_;
  std::uint32_t seed_;
  bool patient_;
  scene::Scene scene_;
  scene::Camera camera_;
  Lighting lighting_;
  std::unique_ptr<Content> content_ = std::make_unique<Content>();
  int version_ = 0;  // of the content, as it was last drawn
  std::optional<Unwrapping> unwrapping_;
  StoredLights stored_lights_;
  Exchange exchange_;
  ArrayVisibility arrays_;
  std::unique_ptr<Targets> targets_;
  std::map<Portion, PortionSum> portions_;
  LightMapPass light_maps_;
  SurfacePass surfaces_;
  ShadowPass shadows_;
  bool levels_ = true;
  GatherPass gather_;
  ShadePass shade_;
  MirrorPass mirror_;
  SubpixelPass subpixels_;
  AccumulatePass accumulate_;
  PassTimers timers_;
  std::size_t told_grains_ = 0;  // that the last sample showed
  bool timed_ = false;
  double pixels_at_once_ = std::numeric_limits<double>::infinity();  // by how long the last sample's took
  int samples_ = 0;
  bool more_known_ = false;  // the scene was shown before less was known of it
  bool hurried_ = false;     // the only one of them lacks what others have
};

}  // namespace mesograin::render
