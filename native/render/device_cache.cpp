// Sends meshes, compiles programs and uploads tables on first use.
#include "render/device_cache.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "models/dielectric_inputs.h"
#include "models/finish.h"
#include "models/prototype_inputs.h"
#include "scene/advice.h"
#include "scene/convexity.h"
#include "transport/convexity.h"
#include "transport/effort.h"

namespace mesograin::render {
namespace {

std::string portion_define(Portion portion) { return fmt::format("PORTION {}", static_cast<int>(portion)); }

// But for what rounding makes of turned instances.
bool is_same(const glm::dmat3& a, const glm::dmat3& b) {
  double difference = 0.0, size = 0.0;
  for (int i = 0; i < 3; ++i) {
    difference += glm::dot(a[i] - b[i], a[i] - b[i]);
    size += glm::dot(a[i], a[i]);
  }
  return difference <= 1e-12 * size;
}

// The radius that stands for all within half a percent.
double typical(double grain_radius) {
  constexpr double radii_an_octave = 64.0;
  return std::exp2(std::round(std::log2(grain_radius) * radii_an_octave) / radii_an_octave);
}

/// That its inputs are for.
double table_radius(const scene::Material& material, double grain_radius) {
  return scene::traits_of(material.model).grain_radius ? typical(grain_radius) : 1.0;
}

// The walks of what is seen of many grains ask no model, and a model's tables for a grain's radius take longest.
bool may_never_be_drawn(const scene::Material& material) {
  return scene::traits_of(material.model).grain_radius && !material.finish;
}

std::vector<models::MaterialInputs> inputs_of(const std::vector<std::pair<scene::Material, double>>& materials) {
  std::vector<models::MaterialInputs> inputs(materials.size());
  transport::run_pieces({}, materials.size(), [&](std::size_t i) {
    inputs[i] = models::material_inputs(materials[i].first, materials[i].second);
  });
  return inputs;
}

std::size_t texels_of(const scene::Picture& picture) {
  return static_cast<std::size_t>(picture.width()) * static_cast<std::size_t>(picture.height());
}

// The device's rows begin at the bottom.
template <typename Texel>
std::vector<Texel> turned_over(const scene::Picture& picture, const std::vector<Texel>& texels) {
  const auto width = static_cast<std::ptrdiff_t>(picture.width());
  std::vector<Texel> turned;
  turned.reserve(texels.size());
  for (auto row = texels.end(); row != texels.begin(); row -= width) turned.insert(turned.end(), row - width, row);
  return turned;
}

std::shared_ptr<const gl::Texture> sent_picture(const scene::TextureMap& map) {
  constexpr GLint wraps[] = {GL_REPEAT, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_BORDER, GL_MIRRORED_REPEAT};
  const scene::Picture& picture = *map.picture;
  const auto* bytes = std::get_if<scene::Picture::Bytes>(&picture.texels());
  const auto texture =
      std::make_shared<gl::Texture>(bytes != nullptr ? GL_RGBA8 : GL_RGBA32F, picture.width(), picture.height());
  if (bytes != nullptr)
    texture->upload(GL_RGBA, GL_UNSIGNED_BYTE, turned_over(picture, *bytes).data());
  else
    texture->upload(GL_RGBA, GL_FLOAT,
                    turned_over(picture, std::get<scene::Picture::Numbers>(picture.texels())).data());
  texture->wrap(wraps[static_cast<std::size_t>(map.wrap)]);
  texture->sample_linearly(map.smooth);
  return texture;
}

bool nearly_convex(const scene::Mesh& mesh) {
  const auto unit = static_cast<float>(std::max(mesh.reach(), 1e-30));
  std::vector<glm::vec3> positions(mesh.positions());
  for (glm::vec3& position : positions) position /= unit;
  std::vector<glm::vec3> normals;
  normals.reserve(mesh.triangles().size());
  for (const glm::uvec3& triangle : mesh.triangles()) {
    const glm::vec3& corner = positions[triangle.x];
    const glm::vec3 normal = glm::cross(positions[triangle.y] - corner, positions[triangle.z] - corner);
    normals.push_back(normal / std::max(glm::length(normal), 1e-30F));
  }
  return transport::nearly_convex(positions, mesh.triangles(), normals);
}

}  // namespace

DeviceMaterial::DeviceMaterial(scene::Model model, models::MaterialInputs inputs, Pictures pictures)
    : model_(model),
      pictures_(std::move(pictures)),
      has_finish_(inputs.finish),
      facets_(inputs.facets),
      light_maps_(inputs.light_maps) {
  complete(std::move(inputs));
}

DeviceMaterial::DeviceMaterial(scene::Model model, bool facets, std::function<models::MaterialInputs()> make)
    : model_(model),
      make_(std::move(make)),
      has_finish_(false),
      facets_(facets),
      light_maps_(scene::traits_of(model).light_maps) {}

void DeviceMaterial::complete(models::MaterialInputs inputs) const {
  known_.defines = std::move(inputs.defines);
  known_.uniforms = std::move(inputs.uniforms);
  for (const auto& [name, table] : inputs.tables) {
    gl::Texture texture(GL_RGBA32F, table.width, table.height);
    texture.upload(GL_RGBA, GL_FLOAT, table.texels.data());
    texture.sample_linearly(true);
    known_.tables.emplace(name, std::move(texture));
  }
  for (const auto& [name, volume] : inputs.volumes) {
    constexpr GLenum formats[] = {GL_R16F, GL_RG16F, GL_RGB16F, GL_RGBA16F};
    constexpr GLenum components[] = {GL_RED, GL_RG, GL_RGB, GL_RGBA};
    constexpr GLenum of_bytes[] = {GL_R8_SNORM, GL_RG8_SNORM, GL_RGB8_SNORM, GL_RGBA8_SNORM};
    const GLenum format = (volume.bytes ? of_bytes : formats)[volume.channels - 1];
    gl::Volume texture(format, volume.width, volume.height, volume.depth);
    texture.upload(components[volume.channels - 1], volume.texels.data());
    known_.volumes.emplace(name, std::move(texture));
  }
  make_ = nullptr;
}

void DeviceMaterial::become(scene::Model model, models::MaterialInputs inputs) {
  const int version = version_ + 1;
  *this = DeviceMaterial(model, std::move(inputs));
  version_ = version;
}

bool DeviceMaterial::has(const std::string& define) const {
  const std::vector<std::string>& all = defines();
  return std::find(all.begin(), all.end(), define) != all.end();
}

const models::UniformValue* DeviceMaterial::uniform(const std::string& name) const {
  const auto found = known().uniforms.find(name);
  return found == known().uniforms.end() ? nullptr : &found->second;
}

void DeviceMaterial::bind(const gl::Program& program) const {
  program.use();
  for (const auto& [name, value] : known().uniforms)
    std::visit([&, &uniform = name](const auto& number) { program.offer(uniform, number); }, value);
  for (const auto& [name, table] : known().tables) program.offer(name, table);
  for (const auto& [name, volume] : known().volumes) program.offer(name, volume);
  for (const auto& [name, picture] : pictures_) program.offer(name, *picture);
}

DeviceCache::MeshEntry& DeviceCache::mesh_entry(const scene::MeshPointer& mesh) {
  MeshEntry& entry = meshes_[mesh.get()];
  // A new mesh may have been given the address of one that is gone.
  if (entry.source.expired()) {
    entry = MeshEntry();
    entry.source = mesh;
  }
  return entry;
}

std::shared_ptr<gl::VertexArray> DeviceCache::mesh(const scene::MeshPointer& mesh) {
  MeshEntry& entry = mesh_entry(mesh);
  if (!entry.device) {
    entry.device =
        std::make_shared<gl::VertexArray>(mesh->positions(), mesh->normals(), mesh->uvs(), mesh->triangles());
    ++sent_.meshes;
    sent_.bytes += entry.device->bytes();
  }
  return entry.device;
}

std::shared_ptr<Details> DeviceCache::details(const scene::MeshPointer& mesh) {
  MeshEntry& entry = mesh_entry(mesh);
  if (!entry.details) entry.details = std::make_shared<Details>(*mesh, this->mesh(mesh));
  return entry.details;
}

std::shared_ptr<const casting::MeshTree> DeviceCache::tree(const scene::MeshPointer& mesh) {
  MeshEntry& entry = mesh_entry(mesh);
  if (!entry.tree) entry.tree = std::make_shared<casting::MeshTree>(*mesh);
  return entry.tree;
}

bool DeviceCache::convex(const scene::MeshPointer& mesh) {
  MeshEntry& entry = mesh_entry(mesh);
  if (!entry.convex) entry.convex = scene::is_convex(*mesh);
  return *entry.convex;
}

bool DeviceCache::closed(const scene::MeshPointer& mesh) {
  MeshEntry& entry = mesh_entry(mesh);
  if (!entry.closed) entry.closed = scene::shape_of(*mesh, glm::dmat3(1.0)).closed;
  return *entry.closed;
}

bool DeviceCache::hollow(const scene::MeshPointer& mesh) {
  MeshEntry& entry = mesh_entry(mesh);
  if (!entry.hollow) entry.hollow = !convex(mesh) && !(closed(mesh) && nearly_convex(*mesh));
  return *entry.hollow;
}

std::shared_ptr<DeviceMaterial> DeviceCache::material(const scene::Material& material, double grain_radius) {
  const double radius = table_radius(material, grain_radius);
  if (std::shared_ptr<DeviceMaterial> known = this->known(material, radius)) return known;
  materials_.push_back({material, radius, send(material.model, models::material_inputs(material, radius))});
  return materials_.back().device;
}

std::shared_ptr<DeviceMaterial> DeviceCache::surface_of(scene::Material material) {
  material.model = scene::Model::model_1;
  const double radius = table_radius(material, 1.0);
  if (std::shared_ptr<DeviceMaterial> known = this->known(material, radius)) return known;
  materials_.push_back({material, radius, send_later(material, radius)});
  return materials_.back().device;
}

void DeviceCache::prepare(const std::vector<std::pair<scene::Material, double>>& materials) {
  std::vector<std::pair<scene::Material, double>> missing;
  for (const auto& [material, grain_radius] : materials) {
    const std::pair one(material, table_radius(material, grain_radius));
    if (known(one.first, one.second)) continue;
    if (may_never_be_drawn(material))
      materials_.push_back({one.first, one.second, send_later(one.first, one.second)});
    else if (std::ranges::find(missing, one) == missing.end())
      missing.push_back(one);
  }
  std::vector<models::MaterialInputs> inputs = inputs_of(missing);
  for (std::size_t i = 0; i < missing.size(); ++i)
    materials_.push_back({missing[i].first, missing[i].second, send(missing[i].first.model, std::move(inputs[i]))});
}

void DeviceCache::complete(const std::vector<const DeviceMaterial*>& materials) {
  std::vector<const MaterialEntry*> waiting;
  for (const MaterialEntry& entry : materials_)
    if (!entry.device->complete() && std::ranges::find(materials, entry.device.get()) != materials.end())
      waiting.push_back(&entry);
  // What does not depend on the size is made once for all sizes: other materials first, while it is.
  std::ranges::stable_sort(waiting, {}, &MaterialEntry::grain_radius);
  std::vector<std::pair<scene::Material, double>> missing;
  missing.reserve(waiting.size());
  for (const MaterialEntry* entry : waiting) missing.emplace_back(entry->source, entry->grain_radius);
  std::vector<models::MaterialInputs> inputs = inputs_of(missing);
  for (std::size_t i = 0; i < waiting.size(); ++i) {
    count(inputs[i]);
    waiting[i]->device->complete(std::move(inputs[i]));
  }
}

std::shared_ptr<DeviceMaterial> DeviceCache::send_later(const scene::Material& material, double radius) {
  models::require_valid(material);
  ++sent_.materials;
  return std::make_shared<DeviceMaterial>(material.model, models::shows_reflections(material),
                                          [this, material, radius] {
                                            models::MaterialInputs inputs = models::material_inputs(material, radius);
                                            count(inputs);
                                            return inputs;
                                          });
}

std::shared_ptr<DeviceMaterial> DeviceCache::known(const scene::Material& material, double radius) const {
  for (const MaterialEntry& entry : materials_)
    if (entry.source == material && entry.grain_radius == radius) return entry.device;
  return nullptr;
}

std::shared_ptr<DeviceMaterial> DeviceCache::material(const scene::Material& material, const scene::MeshPointer& mesh,
                                                      const glm::dmat3& stretch) {
  for (const PrototypeEntry& entry : prototypes_)
    if (entry.source == material && entry.mesh.lock() == mesh && is_same(entry.stretch, stretch)) return entry.device;
  models::material_inputs(material);  // throws for what the model cannot answer
  PrototypeEntry entry{material, mesh, stretch,
                       transport::Works::instance().ask(models::transport_order(material, mesh, stretch))};
  const transport::News news = entry.computation->news();
  if (news.stored) {
    entry.news = news.number;
    entry.device = send(material.model, models::prototype_inputs(material, *news.stored));
  } else {
    const double radius = mesh->equivalent_radius() * std::cbrt(std::abs(glm::determinant(stretch)));
    models::StandIn stand_in = models::stand_in(material, typical(std::max(radius, 1e-30)));
    entry.device = send(stand_in.model, std::move(stand_in.inputs));
  }
  prototypes_.push_back(std::move(entry));
  return prototypes_.back().device;
}

void DeviceCache::take_news() {
  for (PrototypeEntry& entry : prototypes_) take_news(entry);
}

void DeviceCache::take_news(PrototypeEntry& entry) {
  const transport::News news = entry.computation->news();
  if (news.number == entry.news) return;
  entry.news = news.number;
  if (!news.stored) return;
  models::MaterialInputs inputs = models::prototype_inputs(entry.source, *news.stored);
  count(inputs);
  entry.device->become(entry.source.model, std::move(inputs));
}

std::shared_ptr<const transport::Computation> DeviceCache::computation(const DeviceMaterial& material) const {
  for (const PrototypeEntry& entry : prototypes_)
    if (entry.device.get() == &material) return entry.computation;
  return nullptr;
}

void DeviceCache::count(const models::MaterialInputs& inputs) {
  for (const auto& [name, table] : inputs.tables) sent_.bytes += table.texels.size() * sizeof(glm::vec4);
  for (const auto& [name, volume] : inputs.volumes) sent_.bytes += volume.texels.size() * (volume.bytes ? 1 : 2);
}

std::shared_ptr<DeviceMaterial> DeviceCache::send(scene::Model model, models::MaterialInputs inputs) {
  ++sent_.materials;
  count(inputs);
  DeviceMaterial::Pictures pictures;
  for (const auto& [name, map] : inputs.pictures) pictures.emplace(name, picture(map));
  return std::make_shared<DeviceMaterial>(model, std::move(inputs), std::move(pictures));
}

std::shared_ptr<const gl::Texture> DeviceCache::picture(const scene::TextureMap& map) {
  for (const PictureEntry& entry : pictures_)
    if (entry.source.lock() == map.picture && entry.wrap == map.wrap && entry.smooth == map.smooth) return entry.device;
  pictures_.push_back({map.picture, map.wrap, map.smooth, sent_picture(map)});
  sent_.bytes +=
      texels_of(*map.picture) * (std::holds_alternative<scene::Picture::Bytes>(map.picture->texels()) ? 4 : 16);
  return pictures_.back().device;
}

void DeviceCache::prune() {
  std::erase_if(meshes_, [](const auto& entry) { return entry.second.source.expired(); });
  std::erase_if(materials_, [](const MaterialEntry& entry) { return entry.device.use_count() == 1; });
  std::erase_if(prototypes_, [](const PrototypeEntry& entry) { return entry.device.use_count() == 1; });
  std::erase_if(pictures_, [](const PictureEntry& entry) { return entry.device.use_count() == 1; });
}

const gl::Program& DeviceCache::surface_program(bool instanced, bool textured) {
  const std::string vertex = instanced ? "instanced_surface" : "surface";
  std::vector<std::string> defines;
  if (textured) defines.emplace_back("TEXTURED");
  return program(textured ? vertex + " textured" : vertex, gl::ShaderSource({"passes/" + vertex + ".vert"}, defines),
                 gl::ShaderSource({"passes/surface.frag"}, defines));
}

const gl::Program& DeviceCache::shadow_program(bool instanced) {
  const std::string vertex = instanced ? "instanced_shadow" : "shadow";
  return program(vertex, gl::ShaderSource({"passes/" + vertex + ".vert"}, {}),
                 gl::ShaderSource({"passes/shadow.frag"}, {}));
}

const gl::Program& DeviceCache::ray_program(const std::string& pass, bool textured) {
  std::vector<std::string> defines;
  if (textured) defines.emplace_back("TEXTURED");
  return programs_.find(textured ? pass + " textured" : pass,
                        {{GL_COMPUTE_SHADER, gl::ShaderSource({"passes/" + pass + ".comp"}, defines)}});
}

const gl::Program& DeviceCache::mark_program() {
  return program("mark", gl::ShaderSource({"passes/full_screen.vert"}, {}), gl::ShaderSource({"passes/mark.frag"}, {}));
}

const gl::Program& DeviceCache::light_map_program(bool tessellated) {
  std::vector<gl::Stage> stages = {{GL_VERTEX_SHADER, gl::ShaderSource({"passes/light_map.vert"}, {})}};
  if (tessellated) {
    stages.push_back({GL_TESS_CONTROL_SHADER, gl::ShaderSource({"passes/light_map.tesc"}, {})});
    stages.push_back({GL_TESS_EVALUATION_SHADER, gl::ShaderSource({"passes/light_map.tese"}, {})});
  }
  stages.push_back({GL_FRAGMENT_SHADER, gl::ShaderSource({"passes/light_map.frag"}, {})});
  return programs_.find(tessellated ? "light_map tessellated" : "light_map", stages);
}

const gl::Program& DeviceCache::sum_program(const DeviceMaterial& material, bool together, bool stored_lights) {
  std::vector<std::string> defines;
  for (const std::string define : {"GREY", "MANY_TERMS", "MORE_TERMS", "MOST_TERMS", "REFRACTION"})
    if (material.has(define)) defines.push_back(define);
  if (together) defines.emplace_back("TOGETHER");
  if (stored_lights) defines.emplace_back("STORED_LIGHTS");
  return programs_.find(fmt::format("sum_products {}", fmt::join(defines, " ")),
                        {{GL_COMPUTE_SHADER, gl::ShaderSource({"passes/sum_products.comp"}, defines)}});
}

const gl::Program& DeviceCache::tracing_program(const DeviceMaterial& material, bool together) {
  std::vector<std::string> defines = {"REFRACTION"};
  if (material.has("CONVEX")) defines.emplace_back("CONVEX");
  if (together) defines.emplace_back("TOGETHER");
  return programs_.find(fmt::format("trace_light {}", fmt::join(defines, " ")),
                        {{GL_COMPUTE_SHADER, gl::ShaderSource({"passes/trace_light.comp"}, defines)}});
}

const gl::Program& DeviceCache::line_program() {
  return programs_.find("cut_light_lines",
                        {{GL_COMPUTE_SHADER, gl::ShaderSource({"passes/cut_light_lines.comp"}, {})}});
}

const gl::Program& DeviceCache::gathered_program(std::optional<Portion> portion) {
  std::vector<std::string> defines;
  if (portion) defines.push_back(portion_define(*portion));
  return program(fmt::format("gathered {}", fmt::join(defines, " ")), gl::ShaderSource({"passes/full_screen.vert"}, {}),
                 gl::ShaderSource({"passes/gathered.frag"}, defines));
}

const gl::Program& DeviceCache::count_program() {
  return program("count", gl::ShaderSource({"passes/bake.vert"}, {}), gl::ShaderSource({"passes/count.frag"}, {}));
}

const gl::Program& DeviceCache::shading(const DeviceMaterial& material, const Shading& shading) {
  const std::string model(material.has_finish() ? models::finish_shader
                                                : scene::model_names[static_cast<std::size_t>(material.model())]);
  const std::string pass = shading.unwrapped ? "bake" : "shade";
  const std::string vertex = shading.unwrapped ? "passes/bake.vert" : "passes/full_screen.vert";
  std::vector<std::string> defines = material.defines();
  if (material.light_maps()) defines.emplace_back("LIGHT_MAPS");
  if (scene::traits_of(material.model()).mesh) defines.emplace_back("WHOLE_GRAIN");
  if (shading.instanced) defines.emplace_back("INSTANCED");
  if (shading.mirrored) defines.emplace_back("MIRRORED");
  if (shading.shadows != Shadows::none) defines.emplace_back("SHADOWS");
  if (shading.shadows == Shadows::cast) defines.emplace_back("CAST_SHADOWS");
  if (shading.exchange) defines.emplace_back("EXCHANGE");
  if (shading.gathered) defines.emplace_back("GATHERED");
  if (shading.told) defines.emplace_back("TOLD");
  const bool straight = material.shows_behind() && !shading.unwrapped;
  const bool film = straight && shading.film_transparent;
  const bool backdrop = straight && shading.backdrop;
  const bool any_behind = shading.world || film || backdrop || shading.sees_behind;
  if (any_behind && material.has("CLEAR")) defines.emplace_back("WORLD");
  if (shading.world && shading.alone && material.has("WALKED")) defines.emplace_back("WALKS_END_IN_WORLD");
  if (film) defines.emplace_back("FILM_TRANSPARENT");
  if (backdrop) defines.emplace_back("BACKDROP");
  if (shading.sees_behind) defines.emplace_back("SEES_BEHIND");
  if (shading.mirrors_world && material.facets()) {
    defines.emplace_back("MIRRORS_WORLD");
    if (shading.mirrors_hindered) defines.emplace_back("MIRRORS_HINDERED");
  }
  if (shading.lights_at_place) defines.emplace_back("LIGHTS_AT_PLACE");
  if (shading.near_lights) defines.emplace_back("NEAR_LIGHTS");
  if (shading.lights_about) defines.emplace_back("LIGHTS_ABOUT");
  if (shading.stored_lights) defines.emplace_back("STORED_LIGHTS");
  if (shading.stored_lamps) defines.emplace_back("STORED_LAMPS");
  if (shading.summed) defines.emplace_back("SUMMED");
  if (shading.light_lines) defines.emplace_back("LIGHT_LINES");
  if (shading.together) defines.emplace_back("TOGETHER");
  if (shading.portion) defines.push_back(portion_define(*shading.portion));
  return program(fmt::format("{} {} {}", pass, model, fmt::join(defines, " ")), gl::ShaderSource({vertex}, {}),
                 gl::ShaderSource({"passes/" + pass + ".frag", "models/" + model + ".glsl"}, defines));
}

const gl::Program& DeviceCache::program(const std::string& name, const gl::ShaderSource& vertex,
                                        const gl::ShaderSource& fragment) {
  return programs_.find(name, {{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, fragment}});
}

Sent DeviceCache::sent() const {
  Sent all = sent_;
  all.programs = programs_.compiled();
  all.programs_freed = programs_.freed();
  return all;
}

}  // namespace mesograin::render
