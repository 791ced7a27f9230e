// What the model `transport` needs: light's transport in one prototype, a mesh with its material, as textures.
#pragma once

#include <glm/mat3x3.hpp>

#include "models/material_inputs.h"
#include "scene/mesh.h"
#include "transport/works.h"

namespace mesograin::models {

/// An instance's linear transform as a turn (perhaps mirrored) after a stretch. Prototypes are stretched, never turned.
struct TurnAndStretch {
  glm::dmat3 turn;
  glm::dmat3 stretch;
};

/// The polar decomposition (Higham, "Computing the polar decomposition - with applications", 1986).
TurnAndStretch turn_and_stretch(const glm::dmat3& linear);

/// What is to be computed of a prototype's transport.
transport::Order transport_order(const scene::Material& material, scene::MeshPointer mesh, const glm::dmat3& stretch);

/// Whether the model reads what is stored of single lights: not where light is walked.
bool stores_lights(const scene::Material& material);

/// The inputs of the material's own model, once the transport is known. Throws Error as material_inputs does.
MaterialInputs prototype_inputs(const scene::Material& material, const transport::StoredTransport& stored);

/// The model, and its inputs, that draws what no transport is known of.
struct StandIn {
  scene::Model model;
  MaterialInputs inputs;
};
StandIn stand_in(const scene::Material& material, double grain_radius);

}  // namespace mesograin::models
