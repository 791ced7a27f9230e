// No date and no host: the same scene on the same device gives the same bytes.
#include "tool/provenance.h"

#include "scene/material.h"

namespace mesograin::tool {

std::map<std::string, std::string> provenance(const io::SceneFile& file, int samples, std::uint32_t seed,
                                              const gl::DeviceInfo& device) {
  const scene::Material& material = file.scene.instances.front().material;
  return {{"mesograin:version", MESOGRAIN_VERSION},
          {"mesograin:model", std::string(scene::model_names[static_cast<std::size_t>(material.model)])},
          {"mesograin:material", io::to_json(material)},
          {"mesograin:scene", file.source},
          {"mesograin:samples", std::to_string(samples)},
          {"mesograin:seed", std::to_string(seed)},
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
