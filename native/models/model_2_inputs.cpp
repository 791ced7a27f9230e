// The half-space's inputs and one or two tables more.
#include <algorithm>
#include <cmath>

#include "models/body_inputs.h"
#include "models/half_space_inputs.h"
#include "models/inputs_of_models.h"

namespace mesograin::models {

using namespace physics;

namespace {

// From this |g| on nothing of the first order leaves like diffused light; less of it the nearer g is to 0, where all
// does.
constexpr double least_separate_g = 0.1;

// How much of first-order scattering keeps its phase function and has a table of its own.
double separate_share(const scene::Material& material, const BodySurface& surface) {
  if (surface.cosine_entry) return 0.0;
  // Jensen's dipole stands for all orders at once; the better dipole never holds the first.
  if (material.profile == scene::Profile::better_dipole) return 1.0;
  if (material.profile != scene::Profile::half_space) return 0.0;
  const double share = std::min(std::abs(material.g) / least_separate_g, 1.0);
  return share * share * (3.0 - 2.0 * share);  // smoothly: matching asks for derivatives
}

}  // namespace

MaterialInputs model_2_inputs(const scene::Material& material, double grain_radius) {
  MaterialInputs inputs = half_space_inputs(material);
  const BodySurface surface = body_surface(material);
  const double separate = separate_share(material, surface);
  if (separate > 0.0) {
    inputs.defines.emplace_back("SEPARATE_SINGLE");
    inputs.uniforms["separate_single"] = static_cast<float>(separate);
    add_body_difference("single_difference", material, grain_radius, {.single = 1.0, .multiple = false}, inputs);
  }
  add_body_difference("body_table", material, grain_radius,
                      {.single = surface.cosine_entry ? 0.0 : 1.0 - separate, .multiple = true}, inputs);
  if (is_grey(body_media(material, grain_radius))) inputs.defines.emplace_back("GREY");
  add_body_uniforms(material, grain_radius, inputs);
  return inputs;
}

}  // namespace mesograin::models
