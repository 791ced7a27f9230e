// Sends meshes, compiles programs and uploads tables on first use.
#include "render/device_cache.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace mesograin::render {

DeviceMaterial::DeviceMaterial(scene::Model model, physics::MaterialInputs inputs)
    : model_(model),
      defines_(std::move(inputs.defines)),
      uniforms_(std::move(inputs.uniforms)),
      light_maps_(inputs.light_maps) {
  for (const auto& [name, table] : inputs.tables) {
    gl::Texture texture(GL_RGBA32F, table.width, table.height);
    texture.upload(GL_RGBA, GL_FLOAT, table.texels.data());
    texture.sample_linearly(true);
    tables_.emplace(name, std::move(texture));
  }
}

void DeviceMaterial::bind(const gl::Program& program) const {
  program.use();
  for (const auto& [name, value] : uniforms_)
    std::visit([&, &uniform = name](const auto& number) { program.set(uniform, number); }, value);
  for (const auto& [name, table] : tables_) program.set(name, table);
}

std::shared_ptr<gl::VertexArray> DeviceCache::mesh(const scene::MeshPointer& mesh) {
  const auto found = meshes_.find(mesh.get());
  // A new mesh may have been given the address of one that is gone.
  if (found != meshes_.end() && !found->second.source.expired()) return found->second.device;
  auto device = std::make_shared<gl::VertexArray>(mesh->positions(), mesh->normals(), mesh->uvs(), mesh->triangles());
  ++sent_.meshes;
  sent_.bytes += device->bytes();
  meshes_[mesh.get()] = {mesh, device};
  return device;
}

std::shared_ptr<DeviceMaterial> DeviceCache::material(const scene::Material& material, double grain_radius) {
  constexpr double radii_an_octave = 64.0;
  const double radius = physics::depends_on_grain_radius(material.model)
                            ? std::exp2(std::round(std::log2(grain_radius) * radii_an_octave) / radii_an_octave)
                            : 1.0;
  for (const MaterialEntry& entry : materials_)
    if (entry.source == material && entry.grain_radius == radius) return entry.device;
  physics::MaterialInputs inputs = physics::material_inputs(material, radius);
  ++sent_.materials;
  for (const auto& [name, table] : inputs.tables) sent_.bytes += table.texels.size() * sizeof(glm::vec4);
  auto device = std::make_shared<DeviceMaterial>(material.model, std::move(inputs));
  materials_.push_back({material, radius, device});
  return device;
}

void DeviceCache::prune() {
  std::erase_if(meshes_, [](const auto& entry) { return entry.second.source.expired(); });
  std::erase_if(materials_, [](const MaterialEntry& entry) { return entry.device.use_count() == 1; });
}

const gl::Program& DeviceCache::surface_program() {
  return program("surface", gl::ShaderSource({"passes/surface.vert"}, {}),
                 gl::ShaderSource({"passes/surface.frag"}, {}));
}

const gl::Program& DeviceCache::light_map_program(bool tessellated) {
  std::vector<gl::Stage> stages = {{GL_VERTEX_SHADER, gl::ShaderSource({"passes/light_map.vert"}, {})}};
  if (tessellated) {
    stages.push_back({GL_TESS_CONTROL_SHADER, gl::ShaderSource({"passes/light_map.tesc"}, {})});
    stages.push_back({GL_TESS_EVALUATION_SHADER, gl::ShaderSource({"passes/light_map.tese"}, {})});
  }
  stages.push_back({GL_FRAGMENT_SHADER, gl::ShaderSource({"passes/light_map.frag"}, {})});
  return program(tessellated ? "light_map tessellated" : "light_map", stages);
}

const gl::Program& DeviceCache::count_program() {
  return program("count", gl::ShaderSource({"passes/bake.vert"}, {}), gl::ShaderSource({"passes/count.frag"}, {}));
}

const gl::Program& DeviceCache::shading(const DeviceMaterial& material, Shading shading) {
  const std::string model(scene::model_names[static_cast<std::size_t>(material.model())]);
  const std::string pass = shading == Shading::unwrapped ? "bake" : "shade";
  const std::string vertex = shading == Shading::unwrapped ? "passes/bake.vert" : "passes/full_screen.vert";
  return program(fmt::format("{} {} {}", pass, model, fmt::join(material.defines(), " ")),
                 gl::ShaderSource({vertex}, {}),
                 gl::ShaderSource({"passes/" + pass + ".frag", "models/" + model + ".glsl"}, material.defines()));
}

const gl::Program& DeviceCache::program(const std::string& name, const gl::ShaderSource& vertex,
                                        const gl::ShaderSource& fragment) {
  return program(name, {{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, fragment}});
}

const gl::Program& DeviceCache::program(const std::string& name, const std::vector<gl::Stage>& stages) {
  std::unique_ptr<gl::Program>& slot = programs_[name];
  if (!slot) {
    slot = std::make_unique<gl::Program>(name, stages);
    ++sent_.programs;
  }
  return *slot;
}

}  // namespace mesograin::render
