// Writes FOLDER/NAME.vert, FOLDER/NAME.frag and any stage between them for every distinct program that a material can
// ask for, for every fixed pass, and for each file that none of these uses. Fails when such a file is a pass: then this
// list has fallen behind.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "gl/shader_library.h"
#include "gl/shader_source.h"
#include "models/material_inputs.h"
#include "scene/material.h"

namespace {

using mesograin::gl::ShaderSource;
namespace scene = mesograin::scene;

class Writer {
 public:
  explicit Writer(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::filesystem::create_directories(folder_);
  }

  void write(const std::string& name, const ShaderSource& vertex, const ShaderSource& fragment) {
    write_stage(name + ".vert", vertex);
    write_stage(name + ".frag", fragment);
  }

  void write_stage(const std::string& file, const ShaderSource& source) {
    std::ofstream(folder_ / file) << source.text();
    all_ += source.text();
  }

  /// The files of the shader library whose first line is in no text written.
  std::vector<std::string> unused() const {
    std::vector<std::string> names;
    for (const auto& file : mesograin::gl::shader_files())
      if (all_.find(file.text.substr(0, file.text.find('\n'))) == std::string::npos) names.emplace_back(file.path);
    return names;
  }

 private:
  std::filesystem::path folder_;
  std::string all_;
};

/// One material for each combination of the choices that are made when a shader is compiled.
std::vector<scene::Material> every_choice() {
  std::vector<scene::Material> materials;
  for (std::size_t model = 0; model < scene::model_names.size(); ++model)
    for (std::size_t boundary = 0; boundary < scene::boundary_names.size(); ++boundary)
      for (std::size_t masking = 0; masking < scene::masking_names.size(); ++masking)
        for (std::size_t profile = 0; profile < scene::profile_names.size(); ++profile)
          for (const auto& [roughness, specular] : {std::pair{0.0, true}, {0.3, true}, {0.3, false}}) {
            scene::Material material;
            material.specular = specular;
            material.model = static_cast<scene::Model>(model);
            material.boundary = static_cast<scene::Boundary>(boundary);
            material.masking = static_cast<scene::Masking>(masking);
            material.profile = static_cast<scene::Profile>(profile);
            material.roughness = roughness;
            materials.push_back(material);
            if (material.model == scene::Model::transport && roughness == 0.0) {
              material.g = 0.5;
              materials.push_back(material);
              material.g = 0.0;
            }
            if (material.model != scene::Model::model_3 && material.model != scene::Model::transport) continue;
            material.sigma_s = {1.0, 2.0, 3.0};  // a coloured one is another program than a grey one
            materials.push_back(material);
            if (roughness > 0.0) continue;
            material.g = 0.5;
            materials.push_back(material);
          }
  return materials;
}

/// The programs of `transport` that read what was summed or is stored for each light, and of the passes that sum it.
void write_sums(Writer& writer, const std::string& name, const std::vector<std::string>& defines, std::size_t number) {
  const auto has = [&](const char* word) { return std::find(defines.begin(), defines.end(), word) != defines.end(); };
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), defines.begin(), defines.end());
    return more;
  };
  const bool straight = !has("REFRACTION");
  std::vector<std::vector<std::string>> summed = {{"SUMMED", straight ? "LIGHT_LINES" : "CONVEX"}};
  if (!straight)
    summed.push_back({"SUMMED", "TOGETHER"});
  else if (!has("WALKED"))
    summed.push_back({"SUMMED", "LIGHT_LINES", "TOGETHER"});
  if (has("WALKED")) {
    writer.write(fmt::format("{}+WALKS_END_IN_WORLD", name), ShaderSource({"passes/full_screen.vert"}, {}),
                 ShaderSource({"passes/shade.frag", "models/transport.glsl"}, with({"WALKS_END_IN_WORLD"})));
    summed.push_back({"SUMMED", straight ? "LIGHT_LINES" : "TOGETHER", "WALKS_END_IN_WORLD"});
  }
  for (const std::vector<std::string>& more : summed) {
    writer.write(fmt::format("{}+{}", name, fmt::join(more, "+")), ShaderSource({"passes/full_screen.vert"}, {}),
                 ShaderSource({"passes/shade.frag", "models/transport.glsl"}, with(more)));
    writer.write_stage(fmt::format("sum_products_{}_{}.comp", number, more.back()),
                       ShaderSource({"passes/sum_products.comp"}, with(more)));
    if (has("WALKED")) continue;
    std::vector<std::string> stored = with(more);
    stored.emplace_back("STORED_LIGHTS");
    writer.write_stage(fmt::format("sum_products_{}_{}_stored.comp", number, more.back()),
                       ShaderSource({"passes/sum_products.comp"}, stored));
  }
  if (!has("WALKED"))
    for (const std::vector<std::string>& more :
         std::vector<std::vector<std::string>>{{"STORED_LIGHTS"}, {"STORED_LIGHTS", "STORED_LAMPS", "LIGHTS_AT_PLACE"}})
      writer.write(fmt::format("{}+{}", name, fmt::join(more, "+")), ShaderSource({"passes/full_screen.vert"}, {}),
                   ShaderSource({"passes/shade.frag", "models/transport.glsl"}, with(more)));
  if (straight) writer.write_stage("cut_light_lines.comp", ShaderSource({"passes/cut_light_lines.comp"}, {}));
  if (straight || !has("WALKED")) return;
  for (const std::vector<std::string>& more : summed)
    writer.write_stage(fmt::format("trace_light_{}_{}.comp", number, more.back()),
                       ShaderSource({"passes/trace_light.comp"}, with(more)));
}

void write_shading(Writer& writer) {
  // As render::Shading.
  const std::vector<std::string> clear = {"CLEAR", "WORLD", "MANY_TERMS"};
  const std::vector<std::string> cast = {"SHADOWS", "CAST_SHADOWS"};
  const std::vector<std::string> near = {"NEAR_LIGHTS", "LIGHTS_ABOUT"};
  const std::vector<std::string> told = {"INSTANCED", "SHADOWS", "CAST_SHADOWS", "EXCHANGE", "TOLD"};
  const std::vector<std::string> near_instances = {"INSTANCED", "SHADOWS", "LIGHTS_AT_PLACE", "NEAR_LIGHTS",
                                                   "LIGHTS_ABOUT"};
  const std::vector<std::vector<std::string>> shadings = {{"INSTANCED"},
                                                          {"SHADOWS"},
                                                          cast,
                                                          {"MIRRORED", "INSTANCED", "SHADOWS", "LIGHTS_AT_PLACE"},
                                                          {"EXCHANGE"},
                                                          {"EXCHANGE", "GATHERED"},
                                                          {"LIGHTS_AT_PLACE"},
                                                          {"PORTION 0"},
                                                          {"PORTION 5", "EXCHANGE"},
                                                          {"PORTION 8"},
                                                          {"INSTANCED", "SHADOWS", "LIGHTS_AT_PLACE"},
                                                          near,
                                                          near_instances,
                                                          told,
                                                          clear};
  const std::vector<std::vector<std::string>> mirrors = {
      {"MIRRORS_WORLD"}, {"MIRRORS_WORLD", "MIRRORS_HINDERED"}, {"MIRRORS_WORLD", "MIRRORS_HINDERED", "SHADOWS"}};
  std::set<std::string> written;
  for (const scene::Material& material : every_choice()) {
    const std::string model(scene::model_names[static_cast<std::size_t>(material.model)]);
    std::vector<std::string> defines;
    bool facets = false;
    try {
      mesograin::models::MaterialInputs inputs = mesograin::models::material_inputs(material);
      defines = std::move(inputs.defines);
      facets = inputs.facets;
      if (inputs.light_maps) defines.emplace_back("LIGHT_MAPS");
      if (scene::traits_of(material.model).mesh) defines.emplace_back("WHOLE_GRAIN");
    } catch (const mesograin::Error&) {
      continue;  // a choice that this model refuses
    }
    const std::string name = fmt::format("{}+{}", model, fmt::join(defines, "+"));
    if (!written.insert(name).second) continue;
    writer.write(name, ShaderSource({"passes/full_screen.vert"}, {}),
                 ShaderSource({"passes/shade.frag", "models/" + model + ".glsl"}, defines));
    if (material.model == scene::Model::transport) write_sums(writer, name, defines, written.size());
    if (facets && written.insert(model + " mirrors").second)
      for (const std::vector<std::string>& shading : mirrors) {
        std::vector<std::string> all = defines;
        all.insert(all.end(), shading.begin(), shading.end());
        writer.write(fmt::format("{}+{}", name, fmt::join(shading, "+")), ShaderSource({"passes/full_screen.vert"}, {}),
                     ShaderSource({"passes/shade.frag", "models/" + model + ".glsl"}, all));
      }
    // What else a program is compiled for asks the same of a model, so one of its choices stands for all of them.
    if (!written.insert(model).second) continue;
    for (const std::vector<std::string>& shading : shadings) {
      if (shading == told && material.model != scene::Model::model_1) continue;  // which shades surfaces alone
      if (shading == clear && !scene::traits_of(material.model).mesh) continue;  // who knows no mesh is never clear
      // Light is looked up where it enters, in maps.
      const bool maps = std::find(defines.begin(), defines.end(), "LIGHT_MAPS") != defines.end();
      if (maps ? shading == cast : shading == near || shading == near_instances) continue;
      std::vector<std::string> all = defines;
      all.insert(all.end(), shading.begin(), shading.end());
      const ShaderSource fragment({"passes/shade.frag", "models/" + model + ".glsl"}, all);
      writer.write(fmt::format("{}+{}", name, fmt::join(shading, "+")), ShaderSource({"passes/full_screen.vert"}, {}),
                   fragment);
    }
    writer.write("bake+" + name, ShaderSource({"passes/bake.vert"}, {}),
                 ShaderSource({"passes/bake.frag", "models/" + model + ".glsl"}, defines));
  }
}

/// Each thing that a surface may wear or be alone, and all together.
void write_finishes(Writer& writer) {
  const auto picture = std::make_shared<const scene::Picture>(1, 1, scene::Picture::Bytes{glm::u8vec4(255)}, true);
  std::vector<scene::Finish> finishes(12);
  scene::Finish& all = finishes[8];
  finishes[0].reflectance.picture = all.reflectance.picture = picture;
  finishes[1].roughness.picture = all.roughness.picture = picture;
  finishes[2].metallic.picture = all.metallic.picture = picture;
  finishes[3].normal.picture = all.normal.picture = picture;
  finishes[4].emission.picture = all.emission.picture = picture;
  finishes[4].radiance = all.radiance = glm::dvec3(1.0);
  finishes[5].coat = all.coat = 0.04;
  finishes[6].retro_reflective = true;
  finishes[7].coat = 0.04;
  finishes[7].coat_shades_base = true;
  finishes[9].metallicity = 1.0;
  finishes[9].metal_whitens = true;
  finishes[10] = all;
  finishes[10].coat_shades_base = finishes[10].metal_whitens = finishes[10].facets_keep_energy = true;
  finishes[10].facets_shade_bumps = finishes[10].bent_normals_stay = true;
  finishes[11].diffuse_roughness = 0.5;
  for (std::size_t i = 0; i < finishes.size(); ++i)
    for (const scene::Masking masking : {scene::Masking::correlated, scene::Masking::separable}) {
      scene::Material material;
      material.model = scene::Model::lambert;
      material.masking = masking;
      material.finish = finishes[i];
      const mesograin::models::MaterialInputs inputs = mesograin::models::material_inputs(material);
      std::vector<std::string> defines = inputs.defines;
      const std::string name = fmt::format("finish_{}+{}", i, fmt::join(defines, "+"));
      for (const std::string pass : {"shade", "bake"})
        writer.write(fmt::format("{}+{}", pass, name),
                     ShaderSource({pass == "bake" ? "passes/bake.vert" : "passes/full_screen.vert"}, {}),
                     ShaderSource({"passes/" + pass + ".frag", "models/finish.glsl"}, defines));
      defines.insert(defines.end(), {"INSTANCED", "SHADOWS", "EXCHANGE", "LIGHTS_AT_PLACE"});
      if (inputs.facets) defines.emplace_back("MIRRORS_WORLD");
      writer.write("shade+instanced+" + name, ShaderSource({"passes/full_screen.vert"}, {}),
                   ShaderSource({"passes/shade.frag", "models/finish.glsl"}, defines));
    }
  for (const std::string instanced : {"", "instanced_"})
    writer.write(instanced + "surface+textured",
                 ShaderSource({fmt::format("passes/{}surface.vert", instanced)}, {"TEXTURED"}),
                 ShaderSource({"passes/surface.frag"}, {"TEXTURED"}));
}

void write_passes(Writer& writer) {
  for (const std::string pass : {"accumulate", "background", "gathered", "mark", "resolve"})
    writer.write(pass, ShaderSource({"passes/full_screen.vert"}, {}), ShaderSource({"passes/" + pass + ".frag"}, {}));
  writer.write("mirror", ShaderSource({"passes/full_screen.vert"}, {}), ShaderSource({"passes/mirror.frag"}, {}));
  writer.write("count", ShaderSource({"passes/bake.vert"}, {}), ShaderSource({"passes/count.frag"}, {}));
  for (const std::string pass : {"surface", "shadow"})
    for (const std::string instanced : {"", "instanced_"})
      writer.write(instanced + pass, ShaderSource({fmt::format("passes/{}{}.vert", instanced, pass)}, {}),
                   ShaderSource({fmt::format("passes/{}.frag", pass)}, {}));
  for (const std::string pass : {"cast_surfaces", "cast_shadows", "cast_shadow_map"})
    writer.write_stage(pass + ".comp", ShaderSource({"passes/" + pass + ".comp"}, {}));
  writer.write_stage("cast_surfaces+textured.comp", ShaderSource({"passes/cast_surfaces.comp"}, {"TEXTURED"}));
  for (const std::vector<std::string>& defines :
       std::vector<std::vector<std::string>>{{}, {"FINE", "CHANGED"}, {"SHARED"}, {"FINE", "SHARED", "CHANGED"}})
    writer.write_stage(fmt::format("sum_links+{}.comp", fmt::join(defines, "+")),
                       ShaderSource({"passes/sum_links.comp"}, defines));
  for (const std::string name : {"light_map", "light_map+tessellated"})
    writer.write(name, ShaderSource({"passes/light_map.vert"}, {}), ShaderSource({"passes/light_map.frag"}, {}));
  for (const std::string suffix : {".tesc", ".tese"})
    writer.write_stage("light_map+tessellated" + suffix, ShaderSource({"passes/light_map" + suffix}, {}));
}

/// Each on its own, so that it is checked before any program uses it.
void write_unused(Writer& writer) {
  for (const std::string& path : writer.unused()) {
    if (path.starts_with("passes/")) throw mesograin::Error("No program written here uses {}.", path);
    writer.write(std::filesystem::path(path).stem(), ShaderSource({"passes/full_screen.vert"}, {}),
                 ShaderSource::from_text(path, "#include \"" + path + "\"\nvoid main() {}\n", {}));
  }
}

}  // namespace

int main(int count, char** arguments) {
  try {
    if (count != 2) throw mesograin::Error("One argument is needed, the folder to write to; got {}.", count - 1);
    Writer writer(arguments[1]);
    write_shading(writer);
    write_finishes(writer);
    write_passes(writer);
    write_unused(writer);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
