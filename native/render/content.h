// What a view draws: instances one by one, and arrays of them.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "render/bounds.h"
#include "render/draw.h"
#include "render/instances.h"
#include "render/receivers.h"
#include "scene/scene.h"

namespace mesograin::render {

class Content {
 public:
  Content() = default;

  /// Takes over the light maps of `before` that still serve. The instances of these numbers are in no array, however
  /// many are like them.
  Content(DeviceCache& cache, const scene::Scene& scene, Content before, const std::vector<std::size_t>& alone = {});

  /// Puts everything where this scene has it, which differs in transforms alone from the one that it was made of.
  /// Throws Error if there are others or more or fewer.
  void place(const scene::Scene& scene);

  std::vector<Draw>& draws() { return draws_; }
  const std::vector<Draw>& draws() const { return draws_; }

  /// Has draws go without what their materials need no more.
  void take_news();

  /// Sum of the versions of all materials.
  int version() const;

  /// What materials wait for, each once.
  std::vector<std::shared_ptr<const transport::Computation>> computations(const DeviceCache& cache) const;

  /// Null if there are no arrays.
  Instances* instances() { return instances_ ? &*instances_ : nullptr; }
  const Instances* instances() const { return instances_ ? &*instances_ : nullptr; }

  /// A place amid the scene: all but single draws' matrices is told from there.
  const glm::dvec3& anchor() const { return anchor_; }

  /// Of everything, from the anchor.
  const Bounds& bounds() const { return bounds_; }

  /// Of everything but the ground: a single draw that cannot shade itself and is larger than any other.
  const Bounds& over_ground() const { return over_ground_; }

  /// How many things are shaded apart: groups of instances, then draws.
  std::size_t units() const { return (instances_ ? instances_->groups().size() : 0) + draws_.size(); }

  /// Null if it is a group of instances.
  const Draw* draw(std::size_t unit) const {
    const std::size_t groups = units() - draws_.size();
    return unit < groups ? nullptr : &draws_[unit - groups];
  }

  const DeviceMaterial& material(std::size_t unit) const {
    const Draw* single = draw(unit);
    return single != nullptr ? *single->material : *instances_->groups()[unit].material;
  }

  /// The number of its first object.
  std::size_t first_number(std::size_t unit) const {
    const std::size_t groups = units() - draws_.size();
    return unit < groups ? instances_->groups()[unit].first : number(unit - groups);
  }

  /// Of which this draw is all.
  std::size_t unit(std::size_t draw) const { return units() - draws_.size() + draw; }

  /// The number by which shaders know a draw; instances of arrays come first.
  std::size_t number(std::size_t draw) const { return (instances_ ? instances_->count() : 0) + draw; }

  /// The number by which shadows know it: the materials of one object are draws of their own, whose surfaces go on into
  /// each other.
  std::size_t object_number(std::size_t draw) const { return number(draws_[draw].object); }

  /// Whether a draw may stand in its own light, for all that its model knows.
  bool shades_itself(const Draw& draw) const { return draw.part || (!draw.convex && !draw.light_maps); }

  /// Of the instance of this number.
  Receiver receiver(std::size_t number) const;

  /// The draw of this instance of the scene's, which is in no array.
  std::size_t draw_of(std::size_t instance) const;

  /// Whether something may stand in the light of something, for all that its model knows: there are two objects, or one
  /// with a hollow whose own light no stored transport tells.
  bool shadows() const { return shadows_; }

  /// Whether something may stand before what something mirrors: there are two objects, or one with a hollow.
  bool hinders_mirrors() const { return hinders_mirrors_; }

  /// Whether there is one object, and nothing else for it to see.
  bool alone() const { return count() == 1; }

  /// Whether any material wears pictures.
  bool textured() const { return textured_; }

  /// Whether what stands behind is seen straight through a single draw.
  bool shows_behind(std::size_t unit) const { return draw(unit) != nullptr && material(unit).shows_behind(); }

  /// Whether any does, and there may be something behind it.
  bool any_shows_behind() const;

  /// Has what waits of the materials that units ask for computed (null: none); DeviceCache::complete.
  void complete(DeviceCache& cache, const std::function<const DeviceMaterial*(std::size_t unit)>& asked_of) const;

  /// Whether any of these units has facets that mirror.
  bool facets(const std::function<bool(std::size_t unit)>& of) const;

 private:
  std::size_t count() const { return (instances_ ? instances_->count() : 0) + draws_.size(); }
  void tell_objects(const scene::Scene& scene);
  void find_bounds();
  void find_what_hinders();

  std::vector<Draw> draws_;
  std::optional<Instances> instances_;
  glm::dvec3 anchor_{0.0};
  Bounds bounds_;
  Bounds over_ground_;
  std::optional<std::size_t> ground_;  // which draw
  std::vector<std::size_t> alone_;     // instances that are in no array, whatever they are
  bool shadows_ = false;
  bool hinders_mirrors_ = false;
  bool textured_ = false;
};

}  // namespace mesograin::render
