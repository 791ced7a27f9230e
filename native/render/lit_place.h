// A place of a surface that a picture shows, as rays leave it for the light.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>

#include "casting/rays.h"
#include "render/content.h"

namespace mesograin::render {

struct LitPlace {
  glm::vec3 place;       ///< from the anchor
  glm::vec3 normal;      ///< on the side that is seen
  float clearance;       ///< how far from there a ray begins that may meet the same object again; 0 if none may
  std::uint32_t object;  ///< by which rays know it
};

/// As shade.frag makes it of what surface.frag writes. `viewer`: its place from the anchor and 1, or the direction
/// towards it and 0.
LitPlace lit_place(const Content& content, const glm::vec4& position, const glm::vec4& facing, const glm::vec4& viewer);

/// Has a packet's ray begin there. False, and no ray, if it does not leave the surface.
bool set_off(casting::Packet& packet, unsigned ray, const LitPlace& from, const glm::vec3& along,
             float farthest = std::numeric_limits<float>::infinity());

}  // namespace mesograin::render
