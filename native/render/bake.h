// What a bake is: which instances are unwrapped at their UVs, and from where their surface is looked at.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace mesograin::render {

/// Blender's words for its own bake.
enum class ViewFrom {
  above_surface,  ///< along the normal, everywhere
  active_camera,  ///< from the camera; a surface that it sees from below, or hardly, is seen from low above
};

inline constexpr std::array<std::string_view, 2> view_from_names{"above_surface", "active_camera"};

/// The enumerator called `name`; throws Error listing the names allowed.
ViewFrom parse_view_from(std::string_view name);

struct Bake {
  std::vector<std::size_t> instances;  ///< of the scene; those that share one unwrapping, such as an object's materials
  ViewFrom view_from = ViewFrom::above_surface;
};

/// How an unwrapping uses its texture.
struct UvUse {
  std::size_t texels = 0;             ///< whose middle is covered
  std::size_t overlapping = 0;        ///< whose middle is covered more than once: the first triangle is what is baked
  std::size_t triangles_outside = 0;  ///< that reach out of [0, 1]^2, where they are cut off
};

/// What the artist should know of it, a sentence each; throws Error if no texel is covered.
std::vector<std::string> warnings(const UvUse& use);

}  // namespace mesograin::render
