// No date and no host: the same scene on the same device gives the same bytes.
#include "tool/provenance.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "scene/material.h"

namespace mesograin::tool {

std::string model_names(const scene::Scene& scene) {
  std::vector<std::string_view> names;
  for (const scene::Material& material : scene::materials_of(scene)) {
    const std::string_view name = scene::name_of(material.model);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

std::map<std::string, std::string> provenance(const io::SceneFile& file, int samples, std::uint32_t seed,
                                              const gl::DeviceInfo& device) {
  std::vector<std::string> materials;
  for (const scene::Material& material : scene::materials_of(file.scene)) {
    materials.push_back(io::to_json(material));
  }
  return {{"mesograin:version", MESOGRAIN_VERSION},
          {"mesograin:model", model_names(file.scene)},
          {"mesograin:material",
           materials.size() == 1 ? materials.front() : fmt::format("[{}]", fmt::join(materials, ", "))},
          {"mesograin:scene", file.source},
          {"mesograin:samples", std::to_string(samples)},
          {"mesograin:seed", std::to_string(seed)},
          {"mesograin:exchange", std::string(scene::exchange_names[static_cast<std::size_t>(file.scene.exchange)])},
          {"mesograin:units", "linear RGB radiance, premultiplied by the coverage in A; coefficients per scene unit"},
          {"mesograin:pixel_filter", "box, one pixel"},
          {"mesograin:device", device.renderer},
          {"mesograin:driver", device.version}};
}

std::map<std::string, std::string> bake_provenance(const std::string& view_from, int margin) {
  return {{"mesograin:uv", "u to the right, v up, (0, 0) at the lower left corner; row 0 is v = 1"},
          {"mesograin:view_from", view_from},
          {"mesograin:margin", std::to_string(margin)}};
}

}  // namespace mesograin::tool
