// One view's graph of passes on the device: light maps where a material needs them, shade one jittered sample, as the
// camera sees it or unwrapped, add it to the sum, resolve the mean on demand.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "gl/timer.h"
#include "gl/vertex_array.h"
#include "render/bake.h"
#include "render/device_cache.h"
#include "render/light_maps.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace mesograin::render {

inline constexpr int default_taps = 16;

struct PassTiming {
  std::string pass;
  double milliseconds;
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

  /// Adds one sample to the sum.
  void add_sample();

  /// Waits until the device has drawn what was asked for.
  void finish() const;

  /// The mean of the samples so far, (height, width, 4), first row at the top. Zero where there are none yet.
  void read(float* pixels);

  std::vector<PassTiming> timings() const;

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
  struct Draw {
    std::size_t instance;  // which of the scene's
    scene::MeshPointer source;
    std::shared_ptr<gl::VertexArray> mesh;
    std::shared_ptr<DeviceMaterial> material;
    const gl::Program* program;  // null: not drawn
    glm::dmat4 object_to_world;
    glm::dvec3 centre;                      // middle of its bounds, world space
    double radius;                          // of the sphere around its bounds
    double reach;                           // no point is farther from the centre
    double mean_free_paths_across;          // of the bounds' diameter, reduced, in the densest channel
    std::unique_ptr<LightMaps> light_maps;  // only if its material reads them
    glm::dmat4 object_to_grain() const;
  };

  Draw make_draw(const scene::Instance& instance, std::size_t index);

  /// Those of the scene before, if they serve, so that a change elsewhere costs no light map.
  std::unique_ptr<LightMaps> take_light_maps(const Draw& wanted);
  void update_light_maps(const std::vector<glm::dvec3>& to_light);
  void shade(const std::vector<glm::dvec3>& to_light);

  /// Finds what the camera sees. The stencil tells which draw: 1 for `first`, and so on up to the last it can hold.
  void draw_surfaces(std::size_t first, const glm::vec2& jitter);

  /// Shades those of the draws that the stencil tells apart.
  void shade_surfaces(std::size_t first);

  /// Shades the instances that are baked, where their UVs lie.
  void shade_unwrapped(const glm::vec2& jitter);

  /// Makes everything ready but for the geometry.
  void set_shading(const Draw& draw) const;

  /// Draws on no pixel that the instance's bounds do not cover; everywhere if they reach behind the camera.
  void confine_to(const Draw& draw) const;
  void accumulate();
  std::vector<glm::dvec3> sample_light_directions() const;
  double pixels_across(const Draw& draw) const;
  glm::dmat4 object_to_clip(const Draw& draw) const;

  DeviceCache& cache_;
  int width_;
  int height_;
  std::uint32_t seed_;
  int samples_ = 0;
  scene::Camera camera_;
  std::optional<ViewFrom> bake_;
  std::vector<scene::DirectionalLight> lights_;
  std::vector<Draw> draws_;
  std::unique_ptr<Targets> targets_;
  gl::FullScreenTriangle full_screen_;
  gl::Program accumulate_program_;
  gl::Program resolve_program_;
  gl::Timer light_map_timer_;
  gl::Timer shade_timer_;
  gl::Timer accumulate_timer_;
  bool timed_ = false;
  int taps_ = default_taps;
  int light_maps_drawn_ = 0;  // in the last sample
};

}  // namespace mesograin::render
