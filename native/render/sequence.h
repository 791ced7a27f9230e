// Low-discrepancy points for antialiasing, for lights with extent, for the world and for lenses.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>

namespace mesograin::render {

/// Point `index` of the additive recurrence in two dimensions (M. Roberts, "The Unreasonable Effectiveness of
/// Quasirandom Sequences", 2018: the plastic number), rotated by `offset`; in [0, 1)^2.
glm::dvec2 r2_point(std::uint32_t index, glm::dvec2 offset);

/// Point `index` of a (0,2)-sequence: any run of 2^k points from a multiple of 2^k on is stratified in every way
/// (Kollig and Keller, "Efficient Multidimensional Sampling", 2002, section 3.2), scrambled by `seed` as Owen does, by
/// which the mean of a smooth function over such a run is off by its length to the power of -1.5; in [0, 1)^2. Without
/// correlation to the recurrence.
glm::dvec2 scrambled_point(std::uint32_t index, std::uint32_t seed);

/// A pair in [0, 1)^2 that depends on nothing but `seed`.
glm::dvec2 seeded_offset(std::uint32_t seed);

}  // namespace mesograin::render
