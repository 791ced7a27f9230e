// What is drawn: instances of meshes with a material each, the lights on them and the world around them.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/colour_factors.h"
#include "scene/light.h"
#include "scene/material.h"
#include "scene/mesh.h"
#include "scene/transforms.h"
#include "scene/world.h"

namespace mesograin::scene {

struct Instance {
  MeshPointer mesh;
  Material material;
  glm::dmat4 object_to_world{1.0};
  std::optional<std::uint32_t> object{};  ///< those of one number are parts of one; others are each their own
};

/// Many instances of one mesh and material: each is a transform, and a colour if they differ in it.
class InstanceArray {
 public:
  InstanceArray(MeshPointer of, const Material& with, Transforms object_to_world, ColourFactors factors = {})
      : InstanceArray(std::move(of), with, std::make_shared<const Transforms>(std::move(object_to_world)),
                      std::move(factors)) {}
  InstanceArray(MeshPointer of, const Material& with, std::shared_ptr<const Transforms> object_to_world,
                ColourFactors factors = {})
      : mesh(std::move(of)),
        material(with),
        object_to_world_(std::move(object_to_world)),
        factors_(std::make_shared<const ColourFactors>(std::move(factors))) {}

  MeshPointer mesh;
  Material material;
  const Transforms& object_to_world() const { return *object_to_world_; }
  const ColourFactors& factors() const { return *factors_; }

 private:
  std::shared_ptr<const Transforms> object_to_world_;  // copies of a scene, and who made them, share them
  std::shared_ptr<const ColourFactors> factors_;
};

/// Whether light goes from grain to grain: not, where there are arrays of them, or always; as four numbers a channel
/// for each grain (spherical harmonics to order 1), or so between grains and by rays of its own where a grain is seen.
/// addon/mesograin/schema/scene.json says the same.
enum class Exchange { off, heaps, order_1, gathered, path_traced };
inline constexpr std::array<std::string_view, 5> exchange_names{"off", "heaps", "order_1", "gathered", "path_traced"};
inline constexpr Exchange default_exchange = Exchange::heaps;
constexpr std::span<const std::string_view> names_of(Exchange) { return exchange_names; }
constexpr std::string_view parameter_of(Exchange) { return "exchange"; }

struct Scene {
  std::vector<Instance> instances;
  std::vector<Light> lights;
  World world{};
  std::vector<InstanceArray> arrays{};
  Exchange exchange = default_exchange;
  bool denoise = true;  ///< light that is found by rays of each pixel
};

/// The materials of all that is drawn, each once, in the order of the scene.
std::vector<Material> materials_of(const Scene& scene);

/// Throws Error for the first material, light, world or transform that cannot be drawn.
void validate(const Scene& scene);

}  // namespace mesograin::scene
