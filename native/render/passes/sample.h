// What the passes of one sample read: what is shown, from where, and under which of the lights' directions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "render/bake.h"
#include "render/content.h"
#include "render/device_cache.h"
#include "render/exchange.h"
#include "render/go_on.h"
#include "render/levels.h"
#include "render/lighting.h"
#include "render/passes/targets.h"
#include "render/portion.h"
#include "render/stored_lights.h"
#include "scene/camera.h"

namespace mesograin::render {

/// The draws that a bake unwraps.
struct Unwrapping {
  std::vector<std::size_t> draws;
  ViewFrom view_from;
};

/// Whether surfaces of facets look themselves for what they mirror.
enum class Mirrors {
  none,
  unhindered,  ///< the world: nothing can stand in the way
  hindered,    ///< rays find what does, and that is mirrored
};

struct Sample {
  DeviceCache& cache;
  Content& content;
  const Lighting& lighting;
  const StoredLights& stored_lights;
  const Exchange& exchange;
  Targets& targets;
  scene::Camera camera;          ///< a pinhole
  const Unwrapping* unwrapping;  ///< null for what the camera sees
  glm::ivec2 size;
  std::uint32_t index;
  std::uint32_t seed;
  glm::vec2 jitter;  ///< of the picture, in clip space
  SampledLights lights;
  bool cast;         ///< rays find what is seen of arrays
  bool device_rays;  ///< or the device's own, which know of arrays what surface.frag draws, and no more
  bool traced;       ///< rays can be followed through all of the content
  bool gathers;      ///< light between grains is gathered for pixels that show them
  bool denoises;     ///< and neighbours that show the same tell each other what was found
  bool levels;       ///< it is followed less closely into those that are seen small
  Awaited awaited;   ///< of the first sample
  bool learns;       ///< grains' inner light is found beside it, for another picture of the same light
  Mirrors mirrors = Mirrors::none;
  bool straight_through = false;  ///< light that goes straight through single draws is followed
  double pixels_at_once;          ///< that are shaded from one question whether to go on to the next
  const GoOn& go_on;
  std::optional<Portion> portion{};  ///< of its light, that is shaded alone
  std::vector<bool> told{};          ///< of units: numbers tell what has entered its grains
  std::vector<bool> near_lamps{};    ///< of units: Draw::near_lamps shades it

  /// The camera from `origin` and 1; for a parallel projection the direction towards it and 0.
  glm::vec4 viewer(const glm::dvec3& origin) const;

  /// Whether the place that is shaded draws its own directions of the lights that have a place.
  bool lights_at_place(const DeviceMaterial& material, bool instanced) const {
    return lighting.any_local() && (instanced || !material.light_maps());
  }

  /// Whether it matters to a unit of the content where the light of a lamp comes in.
  bool lights_about(std::size_t unit) const;

  /// Whether any grains are seen into through their own facets.
  bool looks_into_facets() const {
    return gathers && traced &&
           (learns || exchange.follows_paths() || exchange.gather()->sees_into_any() || !exchange.balls());
  }

  /// Whether what is seen must be of the meshes in full: rays go on from there on this side.
  bool sees_in_full() const { return gathers || straight_through || mirrors == Mirrors::hindered; }

  /// Whether all light of an object that is seen is gathered; its unit's others are then, too.
  bool gathers_all_of(std::size_t number) const;

  /// Whether of a unit's grains no more is shaded than their surface, for it is told what has entered them.
  bool tells(std::size_t unit) const { return unit < told.size() && told[unit]; }

  /// What shades a unit.
  const DeviceMaterial& material(std::size_t unit) const {
    if (tells(unit)) return *content.instances()->groups()[unit].surface(cache);
    const bool near = unit < near_lamps.size() && near_lamps[unit];
    return near ? *content.draw(unit)->near_lamps(cache) : content.material(unit);
  }

  /// Whether any pixel asks a unit's model, and so for the light maps and the shadows that it knows.
  bool asks_model(std::size_t unit) const {
    return !tells(unit) && (mirrors == Mirrors::hindered || !gathers_all_of(content.first_number(unit)));
  }
};

/// For Sample::near_lamps: in how many samples a draw is so goes by how near a lamp is to it.
std::vector<bool> near_lamps(const Sample& sample);

}  // namespace mesograin::render
