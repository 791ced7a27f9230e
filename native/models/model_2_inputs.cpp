// The half-space's inputs and one or two tables more.
#include "models/body_inputs.h"
#include "models/half_space_inputs.h"
#include "models/inputs_of_models.h"

namespace mesograin::models {

using namespace physics;

MaterialInputs model_2_inputs(const scene::Material& material, double grain_radius) {
  MaterialInputs inputs = half_space_inputs(material);
  const BodySurface surface = body_surface(material);
  // Anisotropic first-order scattering keeps its phase function; everything else leaves by the interface's own lobe.
  // Jensen's dipole stands for all orders at once; the better dipole never holds the first.
  const bool separate =
      !surface.cosine_entry && (material.profile == scene::Profile::better_dipole ||
                                (material.profile == scene::Profile::half_space && material.g != 0.0));
  if (separate) {
    inputs.defines.emplace_back("SEPARATE_SINGLE");
    add_body_difference("single_difference", material, grain_radius, {.single = true, .multiple = false}, inputs);
  }
  add_body_difference("body_table", material, grain_radius,
                      {.single = !surface.cosine_entry && !separate, .multiple = true}, inputs);
  if (is_grey(body_media(material, grain_radius))) inputs.defines.emplace_back("GREY");
  add_body_uniforms(material, grain_radius, inputs);
  return inputs;
}

}  // namespace mesograin::models
