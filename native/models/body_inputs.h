// What models 2 and 3 know of the grain as a whole: how a sphere of its medium answers, over the cosine between normal
// and light and the sphere's radius.
#pragma once

#include <vector>

#include "models/material_inputs.h"
#include "physics/body/body_medium.h"
#include "physics/kernels/surface_kernel.h"
#include "scene/material.h"

namespace mesograin::models {

struct Orders {
  double single;  ///< how much of it
  bool multiple;
};

/// The columns of every table over the body: from -1 to 1, dense at the terminator.
std::vector<double> body_cosines();

/// Table `name`: how the sphere differs from the half-space that half_space_inputs describes. Below 0, what it keeps of
/// the half-space's light, less 1; above 0, the exitance it has beyond the half-space's, over what its lobe sends out
/// (FlowingLobe). Alpha: red's flow; those of all three are in table "flow_table", unless they are one.
void add_body_difference(const char* name, const scene::Material& material, double grain_radius, const Orders& orders,
                         MaterialInputs& inputs);

/// Table "body_table": the kernels' integral over the lit surface of the sphere, exitance per irradiance on a plane
/// that faces the light. `kernels` for red, green and blue; distances begin at `resolution`, in grain radii.
void add_planar_body(const std::array<const physics::SurfaceKernel*, 3>& kernels, const physics::BodySurface& surface,
                     double resolution, MaterialInputs& inputs);

/// The uniforms of shaders/models/body_light.glsl.
void add_body_uniforms(const scene::Material& material, double grain_radius, MaterialInputs& inputs);

}  // namespace mesograin::models
