// One view's graph of passes on the device: light maps where a material needs them, what the camera sees, shadow maps
// where something may stand in the light, shade one jittered sample, as the camera sees it or unwrapped, add it to the
// sum, resolve the mean on demand.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "gl/timer.h"
#include "gl/vertex_array.h"
#include "render/bake.h"
#include "render/cast_content.h"
#include "render/cast_shadows.h"
#include "render/cast_surfaces.h"
#include "render/content.h"
#include "render/device_cache.h"
#include "render/exchange.h"
#include "render/lighting.h"
#include "render/receivers.h"
#include "render/shadow_maps.h"
#include "render/surfaces.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace mesograin::render {

inline constexpr int default_taps = 16;

/// How it is found what is seen of arrays, and what stands in the light.
enum class Visibility {
  automatic,  ///< drawn where there is a GPU, else cast
  drawn,      ///< by the device's rasteriser
  cast,       ///< by rays, on all cores
};

inline constexpr std::array<std::string_view, 3> visibility_names = {"automatic", "drawn", "cast"};

struct PassTiming {
  std::string pass;
  double milliseconds;
};

/// What of the arrays the last sample took the trouble of.
struct Statistics {
  std::size_t instances = 0;  ///< there are
  std::size_t drawn = 0;      ///< that the device drew for the camera, in as few triangles as they deserve
  std::size_t cast = 0;       ///< that rays were cast at
  std::size_t seen = 0;       ///< of those, that rays met
  std::optional<ExchangeStatistics> exchange;  ///< where light goes from grain to grain
};

/// Lives on the context's thread.
class Frame {
 public:
  Frame(DeviceCache& cache, int width, int height, std::uint32_t seed);

  void resize(int width, int height);
  void set_scene(scene::Scene scene);
  void set_camera(const scene::Camera& camera);

  /// From here to the next scene the picture is a texture: the instances unwrapped. Throws Error for instances that do
  /// not exist or have no UVs.
  void set_bake(const Bake& bake);

  /// Of the instances baked; throws Error if nothing is.
  UvUse uv_use();

  /// Light map samples that model 3 takes for one pixel and sample, over all lights.
  void set_taps(int taps);

  /// Throws Error where rays are asked for and cannot be cast.
  void set_visibility(Visibility visibility);

  /// Adds one sample to the sum. `go_on` is asked between its parts; where it says no, nothing is added, and the answer
  /// is false.
  bool add_sample(const GoOn& go_on);

  /// Takes in what has become known since the scene was set; if anything has, the samples begin anew. Returns whether
  /// they did.
  bool take_news();

  /// What the scene's materials wait for.
  std::vector<std::shared_ptr<const transport::Computation>> computations() const {
    return content_->computations(cache_);
  }
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

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  struct Targets {
    Targets(int width, int height);
    gl::Texture position;
    gl::Texture normal;
    gl::Texture depth;
    gl::Texture sample;
    gl::Texture sum;
    gl::Framebuffer surfaces;
    gl::Framebuffer shade;
    gl::Framebuffer accumulate;
  };

  /// Whether rays are cast for this content.
  bool casts() const;

  /// Whether any array does.
  bool reads_light_maps() const;

  /// Whether it is enough to know for each pixel which lights of this sample reach it.
  bool knows_shadows_by_pixel() const;

  bool update_light_maps(const GoOn& go_on);
  bool update_shadows(const GoOn& go_on);
  bool update_shadow_maps(const GoOn& go_on);
  bool update_cast_shadows(const GoOn& go_on);
  /// What a light of this layer sees: the same as in the sample before where it has not moved.
  const DeviceSelection* casters(const glm::dmat4& anchor_to_clip, const ShadowEye& eye, std::size_t layer,
                                 int resolution);

  /// Makes ready what find_surfaces needs of the content.
  void prepare_visibility();
  bool find_surfaces(const glm::vec2& jitter, std::size_t first, const GoOn& go_on);
  glm::vec4 viewer(const glm::dvec3& origin) const;
  bool shade(const GoOn& go_on);

  /// The world, everywhere.
  void draw_background(const glm::vec2& jitter);

  /// Shades those groups and draws that the stencil tells apart.
  void shade_surfaces(std::size_t first);

  /// Shades the instances that are baked, where their UVs lie.
  void shade_unwrapped(const glm::vec2& jitter);

  void set_world(const gl::Program& program) const;

  /// Makes everything ready but for the geometry.
  void set_common(const gl::Program& program) const;
  void set_viewer(const gl::Program& program, const glm::dvec3& origin) const;
  void set_draw(const gl::Program& program, const Draw& draw);
  void set_group(const gl::Program& program, const InstanceGroup& group);

  /// What a program is compiled for that shades this material in this scene.
  Shading shading(const DeviceMaterial& material, bool unwrapped, bool instanced) const;

  /// Whether the place that is shaded draws its own directions of the lights that have a place.
  bool lights_at_place(const DeviceMaterial& material, bool instanced) const;

  /// Sends the directions of light; places of lights are from `origin`.
  void set_lights(const gl::Program& program, const std::vector<LightDirection>& directions, const glm::dvec3& origin);

  /// Draws on no pixel that the instance's bounds do not cover; everywhere if they reach behind the camera.
  void confine_to(const Draw& draw) const;
  void accumulate();
  double pixels_across(const Draw& draw) const;

  DeviceCache& cache_;
  int width_;
  int height_;
  std::uint32_t seed_;
  int samples_ = 0;
  int version_ = 0;  // of the content, as it was last drawn
  scene::Camera camera_;
  std::optional<ViewFrom> bake_;
  Lighting lighting_;
  SampledLights sampled_lights_;  // of the sample under way
  std::optional<gl::Buffer> device_directions_;
  std::optional<gl::Buffer> device_lights_;
  std::optional<gl::Buffer> device_randoms_;
  scene::Scene scene_;
  std::unique_ptr<Content> content_ = std::make_unique<Content>();
  std::vector<std::size_t> baked_;  // draws
  Exchange exchange_;
  std::unique_ptr<DeviceSelection> selection_;  // for the camera; null if not known yet or without instances
  Receivers receivers_;                         // empty if not known yet
  ShadowMaps shadow_maps_;
  Visibility visibility_ = Visibility::automatic;
  std::unique_ptr<CastContent> cast_;  // null if not known yet
  CastSurfaces cast_surfaces_;
  CastShadows cast_shadows_;
  bool shadows_by_pixel_ = false;  // in the sample under way
  /// Where the light's eye was, and what it saw of the same receivers.
  struct Casters {
    ShadowEye eye;
    std::unique_ptr<DeviceSelection> selection;
  };
  std::vector<Casters> casters_;
  std::vector<glm::vec4> read_positions_;  // of surfaces that were drawn
  std::vector<glm::vec4> read_normals_;
  std::unique_ptr<Targets> targets_;
  gl::FullScreenTriangle full_screen_;
  gl::Program accumulate_program_;
  gl::Program resolve_program_;
  gl::Program background_program_;
  gl::Timer light_map_timer_;
  gl::Timer shadow_timer_;
  gl::Timer shade_timer_;
  gl::Timer accumulate_timer_;
  bool timed_ = false;
  int taps_ = default_taps;
  int light_maps_drawn_ = 0;           // in the last sample
  bool shadows_drawn_ = false;         // in the last sample
  double surface_milliseconds_ = 0.0;  // of rays, in the last sample
  double shadow_milliseconds_ = 0.0;
};

}  // namespace mesograin::render
