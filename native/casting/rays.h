// Eight rays side by side, as wide as the machine's registers: what is cast together should lie together. Or one, which
// goes nowhere near any other.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>

namespace mesograin::casting {

inline constexpr unsigned rays_in_packet = 8;

/// No instance has this number, and no ray of this number starts from one.
inline constexpr std::uint32_t nobody = 0x7FFFFFFFU;

struct Packet {
  alignas(32) float origin_x[rays_in_packet] = {};
  alignas(32) float origin_y[rays_in_packet] = {};
  alignas(32) float origin_z[rays_in_packet] = {};
  alignas(32) float direction_x[rays_in_packet] = {};
  alignas(32) float direction_y[rays_in_packet] = {};
  alignas(32) float direction_z[rays_in_packet] = {};
  alignas(32) float farthest[rays_in_packet] = {};  ///< in lengths of the direction
  std::uint32_t from[rays_in_packet] = {};          ///< the instance that it starts from and cannot meet, or nobody
  float own[rays_in_packet] = {};  ///< if positive it can meet that instance too, but no nearer than this
  bool cast[rays_in_packet] = {};  ///< the others are left alone

  void set(unsigned ray, const glm::vec3& origin, const glm::vec3& direction,
           float up_to = std::numeric_limits<float>::infinity()) {
    origin_x[ray] = origin.x;
    origin_y[ray] = origin.y;
    origin_z[ray] = origin.z;
    direction_x[ray] = direction.x;
    direction_y[ray] = direction.y;
    direction_z[ray] = direction.z;
    farthest[ray] = up_to;
    from[ray] = nobody;
    own[ray] = 0.0F;
    cast[ray] = true;
  }
};

/// What a ray met first.
struct Hit {
  float distance;          ///< in lengths of the direction
  std::uint32_t group;     ///< of the tree
  std::uint32_t number;    ///< of the instance
  std::uint32_t triangle;  ///< of the mesh
  float second;            ///< barycentric coordinates: of the triangle's second corner
  float third;             ///< and its third
};

struct SingleRay {
  glm::vec3 origin;
  glm::vec3 direction;
  std::uint32_t from = nobody;  ///< as in Packet
  float own = 0.0F;
  float farthest = std::numeric_limits<float>::infinity();
};

/// What each ray of a packet met first.
struct Hits {
  bool met[rays_in_packet] = {};
  float distance[rays_in_packet] = {};          ///< in lengths of the direction
  std::uint32_t group[rays_in_packet] = {};     ///< of the tree
  std::uint32_t number[rays_in_packet] = {};    ///< of the instance
  std::uint32_t triangle[rays_in_packet] = {};  ///< of the mesh
  float second[rays_in_packet] = {};            ///< barycentric coordinates: of the triangle's second corner
  float third[rays_in_packet] = {};             ///< and its third

  Hit of(unsigned ray) const {
    return {distance[ray], group[ray], number[ray], triangle[ray], second[ray], third[ray]};
  }
};

}  // namespace mesograin::casting
