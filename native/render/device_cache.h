// What is on the device already: meshes, programs and material tables, shared by all views and sent once.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/mat3x3.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "casting/mesh_tree.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"
#include "gl/volume.h"
#include "models/material_inputs.h"
#include "render/details.h"
#include "render/portion.h"
#include "render/program_shelf.h"
#include "scene/scene.h"
#include "transport/works.h"

namespace mesograin::render {

/// How a program learns what other objects leave of a light.
enum class Shadows {
  none,  ///< nothing stands in the light
  maps,  ///< from what each light sees
  cast,  ///< from what was found for each pixel
};

/// What a shading program is compiled for beside its material.
struct Shading {
  bool unwrapped = false;  ///< at its UVs; else as the camera sees it
  bool instanced = false;  ///< one of an array of instances
  bool mirrored = false;   ///< seen in another surface
  Shadows shadows = Shadows::none;
  bool exchange = false;          ///< light goes from grain to grain
  bool gathered = false;          ///< and was gathered for each pixel
  bool told = false;              ///< what has entered the grain is told, too: its surface alone is shaded
  bool world = false;             ///< there is a world to be seen through it
  bool alone = false;             ///< and nothing that may stand before it, but the object itself
  bool backdrop = false;          ///< and the camera sees it otherwise, through what does not refract, too
  bool film_transparent = false;  ///< or as a transparent film
  bool sees_behind = false;       ///< what stands there before that is found by rays
  bool mirrors_world = false;     ///< or in its facets
  bool mirrors_hindered = false;  ///< and rays find what stands before it
  bool lights_at_place = false;   ///< the place that is shaded draws its own directions of lights that have a place
  bool near_lights = false;       ///< such lights send each point of a grain that has light maps what they send there
  bool lights_about = false;      ///< and are so near that it matters where light comes in
  bool stored_lights = false;     ///< of some lights it is stored what they do in it, or will be
  bool stored_lamps = false;      ///< and of some that have a place
  bool summed = false;            ///< what is stored of a prototype was summed for each light
  bool together = false;          ///< and for all of them together
  bool light_lines = false;       ///< lines tell how far light that nothing has scattered has come
  std::optional<Portion> portion{};  ///< told alone
};

/// A material ready to draw with: what its programs are made of, and the uniforms and tables that they read.
class DeviceMaterial {
 public:
  /// A picture by the name of its sampler.
  using Pictures = std::map<std::string, std::shared_ptr<const gl::Texture>>;

  DeviceMaterial(scene::Model model, models::MaterialInputs inputs, Pictures pictures = {});

  /// One that may never be drawn, whose inputs `make` returns when something asks for more of it than is told here. It
  /// has no finish and wears no pictures.
  DeviceMaterial(scene::Model model, bool facets, std::function<models::MaterialInputs()> make);

  scene::Model model() const { return model_; }
  const std::vector<std::string>& defines() const { return known().defines; }

  /// Whether its programs are compiled with this word.
  bool has(const std::string& define) const;

  /// Whether it must be known where on its pictures a surface is.
  bool textured() const { return !pictures_.empty(); }

  /// Whether it is drawn by models::finish_shader, whatever its model.
  bool has_finish() const { return has_finish_; }

  /// Whether its surface is of facets that mirror, and they are seen.
  bool facets() const { return facets_; }

  /// Whether what is behind it is seen straight through it.
  bool shows_behind() const { return has("CLEAR") && !has("REFRACTION"); }

  /// Whether its model reads light maps.
  bool light_maps() const { return light_maps_; }

  /// Whether its model asks which lights reach places beside and below the one that is shaded.
  bool asks_below() const { return light_maps_ || scene::traits_of(model_).mesh; }

  /// Grows when it becomes another.
  int version() const { return version_; }

  /// Whether all of it is known.
  bool complete() const { return !make_; }

  /// What `make` would have returned.
  void complete(models::MaterialInputs inputs) const;

  /// From now on it is this one, wherever it is used.
  void become(scene::Model model, models::MaterialInputs inputs);

  /// Null if it has none of that name.
  const models::UniformValue* uniform(const std::string& name) const;

  /// Sets every uniform and binds every table on one of its programs.
  void bind(const gl::Program& program) const;

 private:
  struct Known {
    std::vector<std::string> defines;
    std::map<std::string, models::UniformValue> uniforms;
    std::map<std::string, gl::Texture> tables;
    std::map<std::string, gl::Volume> volumes;
  };
  const Known& known() const {
    if (!complete()) complete(make_());
    return known_;
  }

  scene::Model model_;
  mutable std::function<models::MaterialInputs()> make_;  // null once it is known
  mutable Known known_;
  Pictures pictures_;
  bool has_finish_;
  bool facets_;
  bool light_maps_;
  int version_ = 0;
};

/// Counts of what was sent to the device since it started.
struct Sent {
  std::size_t meshes = 0;
  std::size_t materials = 0;
  std::size_t programs = 0;
  std::size_t programs_freed = 0;  ///< of these, as others were needed since
  std::size_t bytes = 0;
};

/// Lives on the context's thread.
class DeviceCache {
 public:
  std::shared_ptr<gl::VertexArray> mesh(const scene::MeshPointer& mesh);

  /// Its levels of detail, the mesh itself among them.
  std::shared_ptr<Details> details(const scene::MeshPointer& mesh);

  /// For rays; see casting::available.
  std::shared_ptr<const casting::MeshTree> tree(const scene::MeshPointer& mesh);

  /// As scene::is_convex, found once.
  bool convex(const scene::MeshPointer& mesh);

  /// As scene::shape_of has it, found once.
  bool closed(const scene::MeshPointer& mesh);

  /// Whether a part of it may noticeably light another from outside, found once.
  bool hollow(const scene::MeshPointer& mesh);

  /// `grain_radius` as in models::material_inputs; materials are shared by grains within half a percent.
  std::shared_ptr<DeviceMaterial> material(const scene::Material& material, double grain_radius);

  /// What shades the surface alone of a grain of which numbers tell the rest.
  std::shared_ptr<DeviceMaterial> surface_of(scene::Material material);

  /// Computes on all cores what material() of each would have to, but for what may never be drawn: inputs of grains'
  /// models wait for complete(), since what is seen of many grains is found without them.
  void prepare(const std::vector<std::pair<scene::Material, double>>& materials);

  /// Computes on all cores what of these waits.
  void complete(const std::vector<const DeviceMaterial*>& materials);

  /// For a model that depends on the mesh, which `stretch` stretches. Until its transport is known, and where none can
  /// be, it is one that stands in for it.
  std::shared_ptr<DeviceMaterial> material(const scene::Material& material, const scene::MeshPointer& mesh,
                                           const glm::dmat3& stretch);

  /// Has materials whose transport is better known by now become those.
  void take_news();

  /// What a material waits for; null if it is no prototype's.
  std::shared_ptr<const transport::Computation> computation(const DeviceMaterial& material) const;

  /// The program that shades with a material; compiled on first use.
  const gl::Program& shading(const DeviceMaterial& material, const Shading& shading);

  /// The program that finds what the camera sees of a mesh, or of instances, for `shading` to shade. `textured`: where
  /// on its pictures, too.
  const gl::Program& surface_program(bool instanced, bool textured);

  /// The program that draws a shadow map.
  const gl::Program& shadow_program(bool instanced);

  /// A program that follows rays through instances, and the one that tells their depths and marks the stencil.
  const gl::Program& ray_program(const std::string& pass, bool textured);
  const gl::Program& mark_program();

  /// The program that draws a light map, of triangles or of patches; compiled when the first material needs one.
  const gl::Program& light_map_program(bool tessellated);

  /// The program that sums what is stored of a material's prototype for each light, or for all together.
  const gl::Program& sum_program(const DeviceMaterial& material, bool together, bool stored_lights);

  /// The program that follows each light into it until it is scattered.
  const gl::Program& tracing_program(const DeviceMaterial& material, bool together);

  /// The program that finds where straight lines from lights are inside it.
  const gl::Program& line_program();

  /// The program that counts how many triangles cover each texel of an unwrapped mesh.
  const gl::Program& count_program();

  /// Shows what was gathered of grains, or one portion of it.
  const gl::Program& gathered_program(std::optional<Portion> portion);

  /// Frees what no view holds any more.
  void prune();

  /// Of any view. Frees programs that none has used for long, if there are many.
  void begin_sample() { programs_.begin_sample(); }

  Sent sent() const;

 private:
  struct MeshEntry {
    std::weak_ptr<const scene::Mesh> source;
    std::shared_ptr<gl::VertexArray> device;
    std::shared_ptr<Details> details;
    std::shared_ptr<const casting::MeshTree> tree;
    std::optional<bool> convex;
    std::optional<bool> closed;
    std::optional<bool> hollow;
  };
  MeshEntry& mesh_entry(const scene::MeshPointer& mesh);

  struct MaterialEntry {
    scene::Material source;
    double grain_radius;
    std::shared_ptr<DeviceMaterial> device;
  };

  struct PrototypeEntry {
    scene::Material source;
    std::weak_ptr<const scene::Mesh> mesh;
    glm::dmat3 stretch;
    std::shared_ptr<const transport::Computation> computation;
    int news = 0;  // taken in
    std::shared_ptr<DeviceMaterial> device = nullptr;
  };

  /// A picture with what is seen beyond its edges and between its texels.
  struct PictureEntry {
    std::weak_ptr<const scene::Picture> source;
    scene::Wrap wrap;
    bool smooth;
    std::shared_ptr<const gl::Texture> device;
  };

  /// radius: as its entry has it. Null if there is none.
  std::shared_ptr<DeviceMaterial> known(const scene::Material& material, double radius) const;
  void take_news(PrototypeEntry& entry);
  void count(const models::MaterialInputs& inputs);
  std::shared_ptr<const gl::Texture> picture(const scene::TextureMap& map);
  std::shared_ptr<DeviceMaterial> send(scene::Model model, models::MaterialInputs inputs);
  std::shared_ptr<DeviceMaterial> send_later(const scene::Material& material, double radius);

  const gl::Program& program(const std::string& name, const gl::ShaderSource& vertex, const gl::ShaderSource& fragment);

  std::map<const scene::Mesh*, MeshEntry> meshes_;
  std::vector<MaterialEntry> materials_;
  std::vector<PictureEntry> pictures_;
  std::vector<PrototypeEntry> prototypes_;
  ProgramShelf programs_;
  Sent sent_;
};

}  // namespace mesograin::render
