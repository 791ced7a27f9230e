// An instance that is drawn by itself, exactly: its matrices are composed in double precision, its light maps are its
// own.
#pragma once

#include <array>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <vector>

#include "render/device_cache.h"
#include "render/light_maps.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace mesograin::render {

struct Draw {
  static constexpr std::size_t of_an_array = static_cast<std::size_t>(-1);

  Draw(DeviceCache& cache, const scene::Instance& from, std::size_t index);

  std::size_t instance;  // which of the scene's, or of_an_array
  scene::MeshPointer source;
  std::shared_ptr<gl::VertexArray> mesh;
  std::shared_ptr<DeviceMaterial> material;
  scene::Material look;  // of the material
  double size;           // radius of the sphere with its mean chord, for which the material's tables are
  glm::dmat4 object_to_world;
  glm::dvec3 centre;                      // middle of its bounds, world space
  glm::dvec3 settled;                     // the same where light between grains was found
  double radius;                          // of the sphere around its bounds
  double reach;                           // no point is farther from the centre
  double mean_free_paths_across;          // of the bounds' diameter, reduced, in the densest channel
  bool convex;                            // no part of it shades another
  glm::dmat3 grain_to_prototype{1.0};     // a turn, for a material that depends on the mesh
  std::size_t object = 0;                 // the first draw that is a part of the same
  bool part = false;                      // whether there is another part of the same
  std::unique_ptr<LightMaps> light_maps;  // only if its material reads them

  glm::dmat4 object_to_grain() const;

  /// Reduced mean free paths to that radius, in the densest channel.
  double thickness() const { return 0.5 * mean_free_paths_across * size / radius; }

  /// Its transform as Instances::rows has those of instances.
  std::array<glm::vec4, 3> rows(const glm::dvec3& anchor) const;

  /// Puts it elsewhere; it keeps the tables that its material has for its size.
  void place(const glm::dmat4& to_world);

  /// How many pixels its bounds' diameter takes of a picture.
  double pixels_across(const scene::Camera& camera, int width, int height) const;

  /// What draws it near a lamp, if its own model has another for that; else null. Made when it is asked for first.
  const DeviceMaterial* near_lamps(DeviceCache& cache) const;

  /// Light maps for it: those of one of `others`, which then has none, if they serve, so that a change elsewhere costs
  /// no light map.
  void take_light_maps(std::vector<Draw>& others);

 private:
  void measure();

  mutable std::shared_ptr<DeviceMaterial> near_lamps_;
};

}  // namespace mesograin::render
