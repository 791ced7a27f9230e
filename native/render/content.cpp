// Many equal instances become an array; a scene's bounds are those of its instances' balls.
#include "render/content.h"

#include <algorithm>
#include <glm/common.hpp>
#include <map>
#include <optional>
#include <utility>

#include "base/error.h"
#include "scene/colour_classes.h"

namespace mesograin::render {
namespace {

// Instances of one mesh and material that are as many as an array deserves are drawn as one; the others are added to
// `alone`, whose own are left out.
std::vector<scene::InstanceArray> gathered(const scene::Scene& scene, std::vector<std::size_t>& alone) {
  std::vector<bool> taken(scene.instances.size(), false);
  for (const std::size_t instance : alone) taken[instance] = true;
  std::map<const scene::Mesh*, std::vector<std::vector<std::size_t>>> alike;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (taken[i]) continue;
    const scene::Instance& instance = scene.instances[i];
    std::vector<std::vector<std::size_t>>& of_mesh = alike[instance.mesh.get()];
    const auto same = std::find_if(of_mesh.begin(), of_mesh.end(), [&](const std::vector<std::size_t>& members) {
      return scene.instances[members.front()].material == instance.material;
    });
    if (same == of_mesh.end())
      of_mesh.push_back({i});
    else
      same->push_back(i);
  }
  std::vector<scene::InstanceArray> arrays;
  for (const auto& [mesh, of_mesh] : alike)
    for (const std::vector<std::size_t>& members : of_mesh) {
      if (members.size() < fewest_in_array) {
        alone.insert(alone.end(), members.begin(), members.end());
        continue;
      }
      const scene::Instance& first = scene.instances[members.front()];
      std::vector<glm::dmat4> transforms;
      transforms.reserve(members.size());
      for (const std::size_t member : members) transforms.push_back(scene.instances[member].object_to_world);
      arrays.emplace_back(first.mesh, first.material, scene::Transforms(transforms));
    }
  std::sort(alone.begin(), alone.end());
  return arrays;
}

// All arrays there are, instances that deserve one first.
std::vector<scene::InstanceArray> arrays_of(const scene::Scene& scene, std::vector<std::size_t>& alone) {
  std::vector<scene::InstanceArray> arrays = gathered(scene, alone);
  for (const scene::InstanceArray& array : scene::by_colour(scene.arrays))
    if (!array.object_to_world().empty()) arrays.push_back(array);
  return arrays;
}

glm::dvec3 middle(const scene::Mesh& mesh, const glm::dmat4& object_to_world) {
  const glm::dvec3 of_bounds = 0.5 * (glm::dvec3(mesh.lower()) + glm::dvec3(mesh.upper()));
  return glm::dvec3(object_to_world * glm::dvec4(of_bounds, 1.0));
}

/// The place before, if that is amid the scene, too: what has not moved is then told by the same numbers.
glm::dvec3 amid(const scene::Scene& scene, const std::optional<glm::dvec3>& before) {
  Bounds middles;
  for (const scene::Instance& instance : scene.instances)
    middles.include(middle(*instance.mesh, instance.object_to_world), 0.0);
  for (const scene::InstanceArray& array : scene.arrays)
    for (const glm::dmat4 object_to_world : array.object_to_world())
      middles.include(middle(*array.mesh, object_to_world), 0.0);
  if (middles.empty()) return glm::dvec3(0.0);
  if (before && *before == glm::clamp(*before, middles.lower, middles.upper)) return *before;
  return 0.5 * (middles.lower + middles.upper);
}

}  // namespace

Content::Content(DeviceCache& cache, const scene::Scene& scene, Content before,
                 const std::vector<std::size_t>& alone_too)
    : anchor_(amid(scene, before.bounds_.empty() ? std::nullopt : std::optional(before.anchor_))), alone_(alone_too) {
  std::vector<std::size_t> alone = alone_too;
  const std::vector<scene::InstanceArray> arrays = arrays_of(scene, alone);
  if (!arrays.empty()) {
    instances_.emplace(cache, arrays, anchor_);
    if (before.instances_) {
      instances_->take_light_maps(*before.instances_);
      instances_->take_places(*before.instances_);
    }
  }
  for (const std::size_t index : alone) {
    draws_.emplace_back(cache, scene.instances[index], index);
    draws_.back().take_light_maps(before.draws_);
  }
  // Neighbours that share a material need it bound once.
  std::stable_sort(draws_.begin(), draws_.end(),
                   [](const Draw& a, const Draw& b) { return a.material.get() < b.material.get(); });
  tell_objects(scene);
  for (std::size_t i = 0; i < draws_.size(); ++i)
    if (!shades_itself(draws_[i]) && !draws_[i].light_maps && (!ground_ || draws_[i].radius > draws_[*ground_].radius))
      ground_ = i;
  find_bounds();
  find_what_hinders();
  textured_ = std::any_of(draws_.begin(), draws_.end(), [](const Draw& draw) { return draw.material->textured(); });
  if (instances_)
    for (const InstanceGroup& group : instances_->groups()) textured_ = textured_ || group.material->textured();
}

void Content::find_bounds() {
  bounds_ = over_ground_ = {};
  for (std::size_t i = 0; i < draws_.size(); ++i) {
    bounds_.include(draws_[i].centre - anchor_, draws_[i].radius);
    if (i != ground_) over_ground_.include(draws_[i].centre - anchor_, draws_[i].radius);
  }
  if (!instances_) return;
  bounds_.include(instances_->bounds());
  over_ground_.include(instances_->bounds());
}

void Content::place(const scene::Scene& scene) {
  std::vector<std::size_t> alone = alone_;
  const std::vector<scene::InstanceArray> arrays = arrays_of(scene, alone);
  std::size_t count = 0;
  for (const scene::InstanceArray& array : arrays) count += array.object_to_world().size();
  const std::size_t in_arrays = instances_ ? instances_->count() : 0;
  if (count != in_arrays || alone.size() != draws_.size())
    throw Error(
        "A moment of an exposure shows the things of its scene elsewhere: {} instances in arrays and {} others; got {} "
        "and {}.",
        in_arrays, draws_.size(), count, alone.size());
  for (Draw& draw : draws_) draw.place(scene.instances[draw.instance].object_to_world);
  if (instances_) instances_->place(arrays, anchor_);
  find_bounds();
}

bool Content::facets(const std::function<bool(std::size_t unit)>& of) const {
  for (std::size_t unit = 0; unit < units(); ++unit)
    if (material(unit).facets() && of(unit)) return true;
  return false;
}

void Content::complete(DeviceCache& cache,
                       const std::function<const DeviceMaterial*(std::size_t unit)>& asked_of) const {
  std::vector<const DeviceMaterial*> asked;
  for (std::size_t unit = 0; unit < units(); ++unit) {
    const DeviceMaterial* material = asked_of(unit);
    if (material != nullptr && !material->complete()) asked.push_back(material);
  }
  if (!asked.empty()) cache.complete(asked);
}

bool Content::any_shows_behind() const {
  if ((instances_ ? instances_->count() : 0) + draws_.size() < 2) return false;
  return std::any_of(draws_.begin(), draws_.end(), [](const Draw& draw) { return draw.material->shows_behind(); });
}

void Content::find_what_hinders() {
  shadows_ = hinders_mirrors_ = count() > 1;
  for (const Draw& draw : draws_) {
    hinders_mirrors_ = hinders_mirrors_ || shades_itself(draw);
    shadows_ = shadows_ || (shades_itself(draw) && !scene::traits_of(draw.material->model()).mesh);
  }
}

void Content::take_news() {
  for (Draw& draw : draws_)
    if (!draw.material->light_maps()) draw.light_maps.reset();
  if (instances_) instances_->drop_light_maps();
  find_what_hinders();
}

int Content::version() const {
  int sum = 0;
  for (const Draw& draw : draws_) sum += draw.material->version();
  if (instances_)
    for (const InstanceGroup& group : instances_->groups()) sum += group.material->version();
  return sum;
}

std::vector<std::shared_ptr<const transport::Computation>> Content::computations(const DeviceCache& cache) const {
  std::vector<std::shared_ptr<const transport::Computation>> found;
  const auto add = [&](const DeviceMaterial& material) {
    std::shared_ptr<const transport::Computation> computation = cache.computation(material);
    if (computation && std::find(found.begin(), found.end(), computation) == found.end())
      found.push_back(std::move(computation));
  };
  for (const Draw& draw : draws_) add(*draw.material);
  if (instances_)
    for (const InstanceGroup& group : instances_->groups()) add(*group.material);
  return found;
}

void Content::tell_objects(const scene::Scene& scene) {
  std::map<std::uint32_t, std::size_t> first;
  for (std::size_t draw = 0; draw < draws_.size(); ++draw) {
    draws_[draw].object = draw;
    const std::optional<std::uint32_t>& object = scene.instances[draws_[draw].instance].object;
    if (!object) continue;
    const auto [found, is_first] = first.try_emplace(*object, draw);
    if (is_first) continue;
    draws_[draw].object = found->second;
    draws_[draw].part = true;
    draws_[found->second].part = true;
  }
}

std::size_t Content::draw_of(std::size_t instance) const {
  const auto found =
      std::find_if(draws_.begin(), draws_.end(), [&](const Draw& draw) { return draw.instance == instance; });
  return static_cast<std::size_t>(found - draws_.begin());
}

Receiver Content::receiver(std::size_t number) const {
  const std::size_t in_arrays = instances_ ? instances_->count() : 0;
  if (number < in_arrays) return {instances_->ball(number), true, false};
  const Draw& draw = draws_[number - in_arrays];
  return {glm::vec4(glm::vec3(draw.centre - anchor_), static_cast<float>(draw.radius)), draw.light_maps != nullptr,
          number - in_arrays == ground_};
}

}  // namespace mesograin::render
