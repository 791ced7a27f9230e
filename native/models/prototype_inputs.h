// What the model `transport` needs: light's transport in one prototype, a mesh with its material, as textures.
#pragma once

#include <glm/mat3x3.hpp>

#include "models/material_inputs.h"
#include "scene/mesh.h"

namespace mesograin::models {

/// An instance's linear transform as a turn (perhaps mirrored) after a stretch. Prototypes are stretched, never turned.
struct TurnAndStretch {
  glm::dmat3 turn;
  glm::dmat3 stretch;
};

/// The polar decomposition (Higham, "Computing the polar decomposition - with applications", 1986).
TurnAndStretch turn_and_stretch(const glm::dmat3& linear);

/// A prototype's inputs, and the model that they are for.
struct Prototype {
  scene::Model model;
  MaterialInputs inputs;
};

/// Computed once for each prototype; takes seconds. What is too thick for the stored grid is left to model 3. Throws
/// Error as material_inputs does, and if the mesh is not closed, crosses itself or encloses no volume.
Prototype prototype_inputs(const scene::Material& material, const scene::Mesh& mesh, const glm::dmat3& stretch);

}  // namespace mesograin::models
