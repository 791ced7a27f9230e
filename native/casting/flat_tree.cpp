// Embree builds it; its nodes are then laid into a list, each before its children.
#include "casting/flat_tree.h"

#include <algorithm>
#include <glm/common.hpp>
#include <memory>
#include <new>
#include <string_view>
#include <type_traits>
#include <utility>

#include "base/error.h"
#include "casting/device.h"

namespace mesograin::casting {
namespace {

constexpr unsigned children = 2;

constexpr std::string_view too_unequal =
    "Grains, or their meshes' triangles, are too unequal in size for the device's rays; draw fewer.";

struct Built {
  bool leaf;
};

struct Inner : Built {
  Built* child[children] = {};
  Box box[children] = {};
};

constexpr std::size_t most_in_any_leaf = 4;

struct Leaf : Built {
  std::size_t count = 0;
  std::uint32_t boxes[most_in_any_leaf] = {};
};

void* make_node(RTCThreadLocalAllocator allocator, unsigned /*count*/, void* /*user*/) {
  auto* node = new (rtcThreadLocalAlloc(allocator, sizeof(Inner), alignof(Inner))) Inner();
  node->leaf = false;
  return node;
}

void set_children(void* node, void** of, unsigned count, void* /*user*/) {
  for (unsigned i = 0; i < count; ++i) static_cast<Inner*>(node)->child[i] = static_cast<Built*>(of[i]);
}

void set_bounds(void* node, const RTCBounds** bounds, unsigned count, void* /*user*/) {
  for (unsigned i = 0; i < count; ++i)
    static_cast<Inner*>(node)->box[i] = {{bounds[i]->lower_x, bounds[i]->lower_y, bounds[i]->lower_z},
                                         {bounds[i]->upper_x, bounds[i]->upper_y, bounds[i]->upper_z}};
}

void* make_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count,
                void* /*user*/) {
  auto* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(Leaf), alignof(Leaf))) Leaf();
  leaf->leaf = true;
  leaf->count = count;
  for (std::size_t i = 0; i < count; ++i) leaf->boxes[i] = primitives[i].primID;
  return leaf;
}

class Flattening {
 public:
  Flattening(const std::vector<Box>& boxes, unsigned most_depth) : boxes_(boxes), most_depth_(most_depth) {}

  FlatTree of(const Built* root) {
    tree_.nodes.reserve(boxes_.size());
    tree_.order.reserve(boxes_.size());
    if (root == nullptr || root->leaf) {
      Box all = boxes_.empty() ? Box{} : boxes_.front();
      for (const Box& box : boxes_) all = {glm::min(all.lower, box.lower), glm::max(all.upper, box.upper)};
      tree_.nodes.emplace_back();
      // A node has two children, so that one that is alone is there twice.
      const Code alone = root != nullptr ? code(*static_cast<const Leaf*>(root)) : Code{-1.0F, 0.0F};
      for (unsigned child = 0; child < children; ++child) put(0, child, all, alone);
      return std::move(tree_);
    }
    add(*static_cast<const Inner*>(root), 1);
    return std::move(tree_);
  }

 private:
  struct Code {
    float which;
    float count;
  };

  Code code(const Leaf& leaf) {
    const auto first = static_cast<float>(tree_.order.size());
    tree_.order.insert(tree_.order.end(), leaf.boxes, leaf.boxes + leaf.count);
    return {-1.0F - first, static_cast<float>(leaf.count)};
  }

  void put(std::size_t node, unsigned child, const Box& box, const Code& code) {
    FlatNode& of = tree_.nodes[node];
    (child == 0 ? of.first_lower : of.second_lower) = glm::vec4(box.lower, code.which);
    (child == 0 ? of.first_upper : of.second_upper) = glm::vec4(box.upper, code.count);
  }

  std::size_t add(const Inner& inner, unsigned depth) {
    if (depth > most_depth_) throw Error(too_unequal);
    const std::size_t node = tree_.nodes.size();
    tree_.nodes.emplace_back();
    for (unsigned child = 0; child < children; ++child) {
      const Built* of = inner.child[child];
      const Code known = of->leaf ? code(*static_cast<const Leaf*>(of))
                                  : Code{static_cast<float>(add(*static_cast<const Inner*>(of), depth + 1)), 0.0F};
      put(node, child, inner.box[child], known);
    }
    return node;
  }

  const std::vector<Box>& boxes_;
  unsigned most_depth_;
  FlatTree tree_;
};

struct Release {
  void operator()(RTCBVH bvh) const { rtcReleaseBVH(bvh); }
};

}  // namespace

FlatTree flat_tree(const std::vector<Box>& boxes, std::size_t most_in_leaf, unsigned most_depth) {
  if (boxes.size() > most_in_flat_tree)
    throw Error("The device casts rays at up to {} things at once; got {}. Draw fewer grains, or simplify their mesh.",
                most_in_flat_tree, boxes.size());
  std::vector<RTCBuildPrimitive> primitives(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    primitives[i] = {boxes[i].lower.x, boxes[i].lower.y, boxes[i].lower.z, 0,
                     boxes[i].upper.x, boxes[i].upper.y, boxes[i].upper.z, static_cast<unsigned>(i)};
  const std::unique_ptr<std::remove_pointer_t<RTCBVH>, Release> bvh(rtcNewBVH(embree_device()));
  RTCBuildArguments arguments = rtcDefaultBuildArguments();
  arguments.byteSize = sizeof(arguments);
  arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
  arguments.maxBranchingFactor = children;
  // Leaves that are too large there are split below it, into halves.
  constexpr unsigned room_for_halves = 8;
  arguments.maxDepth = most_depth - room_for_halves;
  arguments.minLeafSize = 1;
  arguments.maxLeafSize = static_cast<unsigned>(std::min(most_in_leaf, most_in_any_leaf));
  arguments.bvh = bvh.get();
  arguments.primitives = primitives.data();
  arguments.primitiveCount = boxes.size();
  arguments.primitiveArrayCapacity = primitives.size();
  arguments.createNode = make_node;
  arguments.setNodeChildren = set_children;
  arguments.setNodeBounds = set_bounds;
  arguments.createLeaf = make_leaf;
  const auto* root = boxes.empty() ? nullptr : static_cast<const Built*>(rtcBuildBVH(&arguments));
  if (!boxes.empty() && root == nullptr) {
    if (rtcGetDeviceError(embree_device()) == RTC_ERROR_OUT_OF_MEMORY)
      throw Error("The grains do not fit into memory for casting rays at them; draw fewer grains.");
    throw Error(too_unequal);
  }
  return Flattening(boxes, most_depth).of(root);
}

}  // namespace mesograin::casting
