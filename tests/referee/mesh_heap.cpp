// Builds the tree by halving; a ray is asked of each prototype in the prototype's own space.
#include "mesh_heap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <map>

#include "base/error.h"

namespace mesograin::referee {
namespace {

constexpr double nowhere = std::numeric_limits<double>::infinity();

glm::dvec3 middle(const Box& box) { return 0.5 * (box.lower + box.upper); }

}  // namespace

MeshHeap::MeshHeap(const scene::Scene& scene) {
  std::map<const scene::Mesh*, std::size_t> known;
  const auto body_of = [&](const scene::MeshPointer& mesh) {
    const auto [at, is_new] = known.try_emplace(mesh.get(), bodies_.size());
    if (is_new) bodies_.emplace_back(*mesh, glm::dmat4(1.0), 1.0);
    return at->second;
  };
  std::vector<std::size_t> bodies;
  for (const scene::Instance& instance : scene.instances) bodies.push_back(body_of(instance.mesh));
  for (const scene::InstanceArray& array : scene.arrays) bodies.push_back(body_of(array.mesh));
  materials_.reserve(bodies.size());  // pointed to
  std::size_t next = 0;
  for (const scene::Instance& instance : scene.instances) {
    materials_.push_back(instance.material);
    place(bodies[next++], materials_.back(), instance.object_to_world);
  }
  for (const scene::InstanceArray& array : scene.arrays) {
    if (array.factors().any()) throw Error("The referee's instances are of one colour: an array's have factors.");
    materials_.push_back(array.material);
    for (const glm::dmat4& to_world : array.object_to_world()) place(bodies[next], materials_.back(), to_world);
    ++next;
  }
  if (placed_.empty()) throw Error("The referee needs something to trace: the scene has no objects.");
  build(0, placed_.size());
}

void MeshHeap::place(std::size_t body, const scene::Material& material, const glm::dmat4& to_world) {
  Box box{glm::dvec3(nowhere), glm::dvec3(-nowhere)};
  for (int corner = 0; corner < 8; ++corner) {
    const glm::bvec3 upper((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0);
    const glm::dvec3 at(to_world * glm::dvec4(glm::mix(bodies_[body].lower(), bodies_[body].upper(), upper), 1.0));
    box = {glm::min(box.lower, at), glm::max(box.upper, at)};
  }
  const bool solid = material.model != scene::Model::lambert;
  placed_.push_back({body, &material, to_world, glm::inverse(to_world), box, solid});
}

void MeshHeap::build(std::size_t first, std::size_t last) {
  constexpr std::size_t most_in_a_leaf = 2;
  const std::size_t self = nodes_.size();
  Box box = placed_[first].box;
  Box middles{middle(box), middle(box)};
  for (std::size_t i = first; i < last; ++i) {
    box = {glm::min(box.lower, placed_[i].box.lower), glm::max(box.upper, placed_[i].box.upper)};
    middles = {glm::min(middles.lower, middle(placed_[i].box)), glm::max(middles.upper, middle(placed_[i].box))};
  }
  nodes_.push_back({box, first, last - first});
  if (last - first <= most_in_a_leaf) return;
  const glm::dvec3 extent = middles.upper - middles.lower;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::size_t half = (first + last) / 2;
  const auto at = [&](std::size_t index) { return placed_.begin() + static_cast<std::ptrdiff_t>(index); };
  std::nth_element(at(first), at(half), at(last),
                   [axis](const Placed& a, const Placed& b) { return middle(a.box)[axis] < middle(b.box)[axis]; });
  build(first, half);
  nodes_[self].first = nodes_.size();
  nodes_[self].count = 0;
  build(half, last);
}

Box MeshHeap::bounds(bool solid) const {
  Box all{glm::dvec3(nowhere), glm::dvec3(-nowhere)};
  for (const Placed& of : placed_)
    if (of.solid || !solid) all = {glm::min(all.lower, of.box.lower), glm::max(all.upper, of.box.upper)};
  return all;
}

std::optional<MeshHeap::Hit> MeshHeap::meet(std::uint32_t number, const glm::dvec3& origin, const glm::dvec3& direction,
                                            bool enters) const {
  const Placed& of = placed_[number];
  glm::dvec3 from(of.to_body * glm::dvec4(origin, 1.0));
  const glm::dvec3 towards(of.to_body * glm::dvec4(direction, 0.0));
  const double scale = glm::length(towards);
  double before = 0.0;
  while (const std::optional<MeshHit> hit = bodies_[of.body].first_hit(from, towards / scale)) {
    const glm::dvec3 normal = glm::normalize(glm::transpose(glm::dmat3(of.to_body)) * hit->normal);
    const bool from_outside = glm::dot(normal, direction) < 0.0;
    before += hit->distance;
    if (!of.solid || from_outside == enters) return Hit{number, before / scale, normal};
    from += hit->distance * (towards / scale);
  }
  return std::nullopt;
}

std::optional<MeshHeap::Hit> MeshHeap::inside(std::uint32_t number, const glm::dvec3& origin,
                                              const glm::dvec3& direction) const {
  return meet(number, origin, direction, false);
}

std::optional<MeshHeap::Hit> MeshHeap::first(const glm::dvec3& origin, const glm::dvec3& direction) const {
  const glm::dvec3 inverse = 1.0 / direction;
  struct Task {
    std::size_t node;
    double begin;
  };
  std::array<Task, 64> tasks;
  std::size_t waiting = 0;
  std::optional<Hit> nearest;
  const auto furthest = [&] { return nearest ? nearest->distance : nowhere; };
  tasks[waiting++] = {0, nodes_.front().box.entry(origin, inverse, nowhere)};
  while (waiting > 0) {
    const Task task = tasks[--waiting];
    if (task.begin >= furthest()) continue;
    const Node& node = nodes_[task.node];
    for (std::size_t i = node.first; i < node.first + node.count; ++i) {
      if (placed_[i].box.entry(origin, inverse, furthest()) == nowhere) continue;
      const std::optional<Hit> hit = meet(static_cast<std::uint32_t>(i), origin, direction, true);
      if (hit && hit->distance < furthest()) nearest = hit;
    }
    if (node.count > 0) continue;
    const std::size_t children[] = {task.node + 1, node.first};
    double begins[2];
    for (int i = 0; i < 2; ++i) begins[i] = nodes_[children[i]].box.entry(origin, inverse, furthest());
    const int nearer = begins[1] < begins[0] ? 1 : 0;
    for (const int child : {1 - nearer, nearer})
      if (begins[child] < nowhere) tasks[waiting++] = {children[child], begins[child]};
  }
  return nearest;
}

}  // namespace mesograin::referee
