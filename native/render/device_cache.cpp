// Sends meshes, compiles programs and uploads tables on first use.
#include "render/device_cache.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace mesograin::render {

DeviceMaterial::DeviceMaterial(physics::MaterialInputs inputs, const gl::Program& program)
    : program_(program), uniforms_(std::move(inputs.uniforms)), light_maps_(inputs.light_maps) {
  for (const auto& [name, table] : inputs.tables) {
    gl::Texture texture(GL_RGBA32F, table.width, table.height);
    texture.upload(GL_RGBA, GL_FLOAT, table.texels.data());
    texture.sample_linearly(true);
    tables_.emplace(name, std::move(texture));
  }
}

void DeviceMaterial::bind() const {
  program_.use();
  for (const auto& [name, value] : uniforms_)
    std::visit([&, &uniform = name](const auto& number) { program_.set(uniform, number); }, value);
  for (const auto& [name, table] : tables_) program_.set(name, table);
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
  const gl::Program& shading = program(material.model, inputs.defines);
  ++sent_.materials;
  for (const auto& [name, table] : inputs.tables) sent_.bytes += table.texels.size() * sizeof(glm::vec4);
  auto device = std::make_shared<DeviceMaterial>(std::move(inputs), shading);
  materials_.push_back({material, radius, device});
  return device;
}

void DeviceCache::prune() {
  std::erase_if(meshes_, [](const auto& entry) { return entry.second.source.expired(); });
  std::erase_if(materials_, [](const MaterialEntry& entry) { return entry.device.use_count() == 1; });
}

const gl::Program& DeviceCache::light_map_program() {
  return program("light_map", gl::ShaderSource({"passes/light_map.vert"}, {}),
                 gl::ShaderSource({"passes/light_map.frag"}, {}));
}

const gl::Program& DeviceCache::program(scene::Model model, const std::vector<std::string>& defines) {
  const std::string model_name(scene::model_names[static_cast<std::size_t>(model)]);
  return program(fmt::format("{} {}", model_name, fmt::join(defines, " ")), gl::ShaderSource({"passes/shade.vert"}, {}),
                 gl::ShaderSource({"passes/shade.frag", "models/" + model_name + ".glsl"}, defines));
}

const gl::Program& DeviceCache::program(const std::string& name, const gl::ShaderSource& vertex,
                                        const gl::ShaderSource& fragment) {
  std::unique_ptr<gl::Program>& slot = programs_[name];
  if (!slot) {
    slot = std::make_unique<gl::Program>(name, vertex, fragment);
    ++sent_.programs;
  }
  return *slot;
}

}  // namespace mesograin::render
