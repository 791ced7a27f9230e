// A surface that is smooth needs no table, one whose reflections are not seen no highlight.
#include "models/dielectric_inputs.h"

#include "physics/half_space/dielectric_surface.h"

namespace mesograin::models {

using namespace physics;

bool shows_reflections(const scene::Material& material) {
  return has_dielectric_surface(material) && material.specular;
}

void add_reflection(const scene::Material& material, MaterialInputs& inputs) {
  if (!has_dielectric_surface(material)) return;
  inputs.uniforms["surface.eta"] = static_cast<float>(material.eta);
  inputs.uniforms["surface.roughness"] = static_cast<float>(material.roughness);
  if (shows_reflections(material)) {
    inputs.facets = true;
    inputs.defines.emplace_back("SPECULAR");
    if (material.masking == scene::Masking::separable) inputs.defines.emplace_back("MASKING_SEPARABLE");
  }
}

void add_dielectric(const scene::Material& material, MaterialInputs& inputs) {
  add_reflection(material, inputs);
  if (!has_rough_surface(material)) return;
  const Passage passage = rough_passage(material);
  Table table{static_cast<int>(passage.transmittance.size()), 1, {}};
  for (const double value : passage.transmittance) table.texels.emplace_back(glm::dvec4(value));
  inputs.defines.emplace_back("ROUGH_SURFACE");
  inputs.tables["passage"] = std::move(table);
}

}  // namespace mesograin::models
