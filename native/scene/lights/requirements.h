// What all kinds of light ask of their numbers, said in the same words.
#pragma once

#include <glm/vec3.hpp>
#include <string_view>

namespace mesograin::scene {

/// Throws Error unless the vector is finite and has a length.
void require_direction(const glm::dvec3& direction, std::string_view name);

/// Throws Error unless every channel is finite and not negative.
void require_emission(const glm::dvec3& emission, std::string_view name);

/// Throws Error unless the place is finite.
void require_place(const glm::dvec3& place, std::string_view name);

/// Throws Error unless the angle lies between 0 and pi.
void require_angle(double angle, std::string_view name);

/// Throws Error unless the number is finite and not negative.
void require_size(double size, std::string_view name);

}  // namespace mesograin::scene
