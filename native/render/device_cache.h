// What is on the device already: meshes, programs and material tables, shared by all views and sent once.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gl/program.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"
#include "physics/material_inputs.h"
#include "scene/scene.h"

namespace mesograin::render {

/// How a surface gets onto its target: as the camera sees it, or unwrapped at its UVs.
enum class Shading { seen, unwrapped };

/// A material ready to draw with: what its programs are made of, and the uniforms and tables that they read.
class DeviceMaterial {
 public:
  DeviceMaterial(scene::Model model, physics::MaterialInputs inputs);

  scene::Model model() const { return model_; }
  const std::vector<std::string>& defines() const { return defines_; }

  /// Whether its model reads light maps.
  bool light_maps() const { return light_maps_; }

  /// Sets every uniform and binds every table on one of its programs.
  void bind(const gl::Program& program) const;

 private:
  scene::Model model_;
  std::vector<std::string> defines_;
  std::map<std::string, physics::UniformValue> uniforms_;
  std::map<std::string, gl::Texture> tables_;
  bool light_maps_;
};

/// Counts of what was sent to the device since it started.
struct Sent {
  std::size_t meshes = 0;
  std::size_t materials = 0;
  std::size_t programs = 0;
  std::size_t bytes = 0;
};

/// Lives on the context's thread.
class DeviceCache {
 public:
  std::shared_ptr<gl::VertexArray> mesh(const scene::MeshPointer& mesh);

  /// `grain_radius` as in physics::material_inputs; materials are shared by grains within half a percent.
  std::shared_ptr<DeviceMaterial> material(const scene::Material& material, double grain_radius);

  /// The program that shades with a material; compiled on first use.
  const gl::Program& shading(const DeviceMaterial& material, Shading shading);

  /// The program that finds what the camera sees of a mesh, for `shading` to shade.
  const gl::Program& surface_program();

  /// The program that draws a light map, of triangles or of patches; compiled when the first material needs one.
  const gl::Program& light_map_program(bool tessellated);

  /// The program that counts how many triangles cover each texel of an unwrapped mesh.
  const gl::Program& count_program();

  /// Frees what no view holds any more.
  void prune();

  const Sent& sent() const { return sent_; }

 private:
  struct MeshEntry {
    std::weak_ptr<const scene::Mesh> source;
    std::shared_ptr<gl::VertexArray> device;
  };
  struct MaterialEntry {
    scene::Material source;
    double grain_radius;
    std::shared_ptr<DeviceMaterial> device;
  };

  const gl::Program& program(const std::string& name, const std::vector<gl::Stage>& stages);
  const gl::Program& program(const std::string& name, const gl::ShaderSource& vertex, const gl::ShaderSource& fragment);

  std::map<const scene::Mesh*, MeshEntry> meshes_;
  std::vector<MaterialEntry> materials_;
  std::map<std::string, std::unique_ptr<gl::Program>> programs_;
  Sent sent_;
};

}  // namespace mesograin::render
