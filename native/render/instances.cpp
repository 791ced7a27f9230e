// Sorts instances into groups and chooses what a picture shows of them.
#include "render/instances.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <iterator>
#include <utility>

#include "casting/flat_tree.h"
#include "render/device_layout.h"

namespace mesograin::render {
namespace {

// As in make_draw: a bound of how much a length grows.
double largest_stretch(const glm::dmat3& linear) {
  const glm::dmat3 squared = glm::transpose(linear) * linear;
  double largest = 0.0;
  for (int row = 0; row < 3; ++row)
    largest = std::max(largest, std::abs(squared[0][row]) + std::abs(squared[1][row]) + std::abs(squared[2][row]));
  return std::sqrt(largest);
}

// That its tables are for.
double radius_of(const scene::InstanceArray& array, const InstanceClass& alike) {
  return std::max(array.mesh->equivalent_radius() * alike.typical_scale, 1e-30);
}

}  // namespace

Instances::Instances(DeviceCache& cache, const std::vector<scene::InstanceArray>& arrays, const glm::dvec3& anchor) {
  std::size_t count = 0;
  for (const scene::InstanceArray& array : arrays) count += array.object_to_world().size();
  rows_.reserve(3 * count);
  radii_.reserve(count);
  members_.reserve(count);
  std::vector<std::vector<InstanceClass>> classes;
  std::vector<std::pair<scene::Material, double>> materials;
  for (const scene::InstanceArray& array : arrays) {
    classes.push_back(instance_classes(array));
    if (scene::traits_of(array.material.model).mesh) continue;
    for (const InstanceClass& alike : classes.back()) materials.emplace_back(array.material, radius_of(array, alike));
  }
  cache.prepare(materials);
  bool ordered = true;
  for (std::size_t number = 0; number < arrays.size(); ++number) {
    const std::size_t begin = members_.size();
    add(cache, arrays[number], classes[number], anchor);
    for (std::size_t i = begin; i < members_.size() && ordered; ++i) ordered = members_[i] == i - begin;
  }
  if (ordered) members_ = {};
  find_largest();
}

void Instances::find_largest() {
  for (InstanceGroup& group : groups_) {
    const auto first = radii_.begin() + group.first;
    group.largest = group.count > 0 ? *std::max_element(first, first + group.count) : 0.0F;
  }
}

const std::shared_ptr<DeviceMaterial>& InstanceGroup::surface(DeviceCache& cache) const {
  if (!surface_) surface_ = cache.surface_of(source);
  return surface_;
}

std::size_t Instances::prototype(DeviceCache& cache, const scene::MeshPointer& mesh) {
  for (std::size_t i = 0; i < prototypes_.size(); ++i)
    if (prototypes_[i].mesh == mesh) return i;
  prototypes_.push_back({mesh, cache.details(mesh), cache.convex(mesh), nullptr});
  return prototypes_.size() - 1;
}

void Instances::add(DeviceCache& cache, const scene::InstanceArray& array, const std::vector<InstanceClass>& classes,
                    const glm::dvec3& anchor) {
  const std::size_t of = prototype(cache, array.mesh);
  const scene::Mesh& mesh = *array.mesh;
  for (const InstanceClass& alike : classes) {
    InstanceGroup group;
    group.prototype = of;
    group.typical_scale = alike.typical_scale;
    if (scene::traits_of(array.material.model).mesh) {
      group.unstretch = glm::mat3(glm::inverse(alike.stretch));
      group.material = cache.material(array.material, array.mesh, alike.stretch);
    } else {
      group.material = cache.material(array.material, radius_of(array, alike));
    }
    group.source = array.material;
    if (group.material->light_maps() && !prototypes_[of].light_maps)
      prototypes_[of].light_maps = std::make_unique<LightMapAtlas>(array.mesh);
    const glm::dvec3 reduced =
        array.material.scale * (array.material.sigma_a + (1.0 - array.material.g) * array.material.sigma_s);
    group.mean_free_paths_across =
        2.0 * mesh.reach() * group.typical_scale * std::max({reduced.r, reduced.g, reduced.b});
    group.first = static_cast<std::uint32_t>(radii_.size());
    group.count = static_cast<std::uint32_t>(alike.members.size());
    groups_.push_back(std::move(group));
    for (const std::size_t member : alike.members) {
      members_.push_back(static_cast<std::uint32_t>(member));
      rows_.resize(rows_.size() + 3);
      radii_.emplace_back();
      place(radii_.size() - 1, mesh, array.object_to_world()[member], anchor);
    }
  }
}

void Instances::place(std::size_t instance, const scene::Mesh& mesh, const glm::dmat4& object_to_world,
                      const glm::dvec3& anchor) {
  const glm::dvec3 middle = 0.5 * (glm::dvec3(mesh.lower()) + glm::dvec3(mesh.upper()));
  const glm::dmat3 linear(object_to_world);
  const glm::dvec3 place = glm::dvec3(object_to_world * glm::dvec4(middle, 1.0)) - anchor;
  for (int row = 0; row < 3; ++row)
    rows_[3 * instance + static_cast<std::size_t>(row)] =
        glm::vec4(linear[0][row], linear[1][row], linear[2][row], place[row]);
  radii_[instance] = static_cast<float>(mesh.reach() * largest_stretch(linear));
  bounds_.include(glm::dvec3(ball(instance)), radii_[instance]);
}

void Instances::place(const std::vector<scene::InstanceArray>& arrays, const glm::dvec3& anchor) {
  bounds_ = {};
  tree_.reset();
  device_tree_.reset();
  device_.reset();
  std::size_t instance = 0;
  for (const scene::InstanceArray& array : arrays) {
    const std::size_t begin = instance;
    for (const std::size_t end = begin + array.object_to_world().size(); instance < end; ++instance)
      place(instance, *array.mesh, array.object_to_world()[members_.empty() ? instance - begin : members_[instance]],
            anchor);
  }
  find_largest();
}

void Instances::take_places(Instances& before) {
  const auto same = [](const InstanceGroup& a, const InstanceGroup& b) {
    return a.prototype == b.prototype && a.first == b.first && a.count == b.count;
  };
  const auto same_mesh = [](const Prototype& a, const Prototype& b) { return a.mesh == b.mesh; };
  if (rows_ != before.rows_ ||
      !std::equal(groups_.begin(), groups_.end(), before.groups_.begin(), before.groups_.end(), same) ||
      !std::equal(prototypes_.begin(), prototypes_.end(), before.prototypes_.begin(), before.prototypes_.end(),
                  same_mesh))
    return;
  // The tree looks at these very rows.
  rows_ = std::move(before.rows_);
  tree_ = std::move(before.tree_);
  device_tree_ = std::move(before.device_tree_);
  device_ = std::move(before.device_);
}

void Instances::bind() const {
  if (!device_) device_.emplace(rows_);
  device_->bind_storage(layout::INSTANCES_BINDING);
}

void Instances::drop_light_maps() {
  for (std::size_t i = 0; i < prototypes_.size(); ++i)
    if (std::none_of(groups_.begin(), groups_.end(),
                     [i](const InstanceGroup& group) { return group.prototype == i && group.material->light_maps(); }))
      prototypes_[i].light_maps.reset();
}

void Instances::take_light_maps(Instances& before) {
  for (Prototype& prototype : prototypes_)
    for (Prototype& old : before.prototypes_)
      if (prototype.light_maps && old.light_maps && old.mesh == prototype.mesh)
        prototype.light_maps = std::move(old.light_maps);
}

bool Instances::shades_itself(const InstanceGroup& group) const {
  return !group.material->light_maps() && !prototypes_[group.prototype].convex;
}

const InstanceGroup& Instances::group_of(std::size_t instance) const {
  const auto after =
      std::upper_bound(groups_.begin(), groups_.end(), instance,
                       [](std::size_t number, const InstanceGroup& group) { return number < group.first; });
  return *std::prev(after);
}

const casting::PlacedTree& Instances::tree(DeviceCache& cache) {
  if (tree_) return *tree_;
  std::vector<casting::PlacedGroup> groups;
  for (const InstanceGroup& group : groups_)
    groups.push_back({cache.tree(prototypes_[group.prototype].mesh), rows(group.first), group.count, group.first});
  tree_ = std::make_unique<casting::PlacedTree>(std::move(groups));
  return *tree_;
}

const gl::Buffer& Instances::device_tree() {
  if (device_tree_) return *device_tree_;
  std::vector<casting::Box> boxes(count());
  std::vector<float> groups(count());
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const InstanceGroup& group = groups_[g];
    const glm::vec3& half = prototypes_[group.prototype].details->half();
    for (std::uint32_t i = group.first; i < group.first + group.count; ++i) {
      const glm::vec4* of = rows(i);
      const glm::vec3 place(of[0].w, of[1].w, of[2].w);
      // What rounding may move a ray by on its way into the mesh's axes.
      constexpr float rounding = 1e-6F;
      const glm::vec3 reach = (1.0F + 10.0F * rounding) * glm::vec3(glm::dot(glm::abs(glm::vec3(of[0])), half),
                                                                    glm::dot(glm::abs(glm::vec3(of[1])), half),
                                                                    glm::dot(glm::abs(glm::vec3(of[2])), half)) +
                              rounding * glm::abs(place);
      boxes[i] = {place - reach, place + reach};
      groups[i] = static_cast<float>(g);
    }
  }
  casting::FlatTree tree = casting::flat_tree(boxes, 1, layout::MOST_DEPTH_OF_SCENE);
  const auto name = [&](glm::vec4& lower, glm::vec4& upper) {
    if (!(lower.w < 0.0F)) return;
    const std::uint32_t instance = tree.order[static_cast<std::size_t>(-1.0F - lower.w)];
    lower.w = -1.0F - static_cast<float>(instance);
    upper.w = groups[instance];
  };
  for (casting::FlatNode& node : tree.nodes) {
    name(node.first_lower, node.first_upper);
    name(node.second_lower, node.second_upper);
  }
  device_tree_.emplace(tree.nodes);
  return *device_tree_;
}

Selection Instances::select(const glm::dmat4& anchor_to_clip, int width, int height) const {
  Selection selection;
  // Rows of the matrix are planes; their lengths tell how far a ball reaches across them.
  const glm::dmat4 rows = glm::transpose(anchor_to_clip);
  const glm::vec4 x(rows[0]);
  const glm::vec4 y(rows[1]);
  const glm::vec4 z(rows[2]);
  const glm::vec4 w(rows[3]);
  const auto length = [](const glm::vec4& plane) { return glm::length(glm::vec3(plane)); };
  const glm::vec4 planes[6] = {w + x, w - x, w + y, w - y, w + z, w - z};
  float lengths[6];
  for (int i = 0; i < 6; ++i) lengths[i] = length(planes[i]);
  const float pixels = 0.5F * std::max(length(x) * static_cast<float>(width), length(y) * static_cast<float>(height));

  std::vector<std::vector<std::uint32_t>> by_level;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const InstanceGroup& group = groups_[g];
    const Details& details = *prototypes_[group.prototype].details;
    by_level.assign(details.count(), {});
    for (std::uint32_t i = group.first; i < group.first + group.count; ++i) {
      const glm::vec4 ball = this->ball(i);
      const glm::vec4 place(glm::vec3(ball), 1.0F);
      bool seen = true;
      for (int plane = 0; plane < 6 && seen; ++plane) seen = glm::dot(planes[plane], place) > -ball.w * lengths[plane];
      if (!seen) continue;
      const float depth = glm::dot(w, place);
      const float across = depth > 0.0F ? 2.0F * ball.w * pixels / depth : 1e6F;
      selection.largest_pixels_across = std::max(selection.largest_pixels_across, static_cast<double>(across));
      by_level[details.level(across)].push_back(i);
    }
    for (std::size_t level = 0; level < by_level.size(); ++level) {
      if (by_level[level].empty()) continue;
      selection.parts.push_back({g, level, static_cast<std::uint32_t>(selection.instances.size()),
                                 static_cast<std::uint32_t>(by_level[level].size())});
      selection.instances.insert(selection.instances.end(), by_level[level].begin(), by_level[level].end());
    }
  }
  return selection;
}

LightMapDirections Instances::light_directions(std::size_t prototype, const std::vector<glm::dvec3>& to_light) const {
  LightMapDirections directions;
  for (const InstanceGroup& group : groups_) {
    if (group.prototype != prototype || !group.material->light_maps()) continue;
    for (std::uint32_t i = group.first; i < group.first + group.count && !directions.all(); ++i) {
      // Transposed and so, but for the scale, inverted.
      const glm::dmat3 rows{glm::dvec3(rows_[3 * i]), glm::dvec3(rows_[3 * i + 1]), glm::dvec3(rows_[3 * i + 2])};
      for (const glm::dvec3& direction : to_light) directions.ask_for(glm::normalize(rows * direction));
    }
  }
  return directions;
}

}  // namespace mesograin::render
