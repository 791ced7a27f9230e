// Has the device sum and look, a group of nodes under one light at a time.
#include "render/passes/product_sums.h"

#include <utility>

#include "render/device_layout.h"

namespace mesograin::render {
namespace {

// As shaders/passes/sum_products.comp and unscattered_light.comp have it.
constexpr int nodes_a_group = 64;

// As shaders/models/unscattered.glsl has it.
constexpr int finer = 2;

// A pixel reads each product at six places, eight nodes at each, or more; a sum reads it once a node.
constexpr double nodes_a_pixel = 48.0;

// And walks ask for unscattered light at as many places, of which each node has `finer` cubed.
constexpr double nodes_looked_for = 1.0;

// OpenGL 4.5 has textures of at least so many layers.
constexpr int most_layers = 2048;

/// Whether the program asks for refracted light that nothing has scattered yet.
bool asks_for_unscattered(const DeviceMaterial& material) {
  return material.has("WALKED") && material.has("REFRACTION");
}

int finer_nodes(int nodes) { return finer * (nodes - 1) + 1; }

void dispatch(int nodes, std::size_t lights) {
  glDispatchCompute(static_cast<GLuint>((nodes + nodes_a_group - 1) / nodes_a_group), static_cast<GLuint>(lights), 1);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

}  // namespace

bool ProductSums::pay(const DeviceMaterial& material, const std::vector<LightDirection>& lights, double pixels) {
  const gl::Volume* nodes = material.volume("distances");
  if (nodes == nullptr || lights.empty()) return false;
  const bool looks = asks_for_unscattered(material);
  const double count = static_cast<double>(nodes->width()) * nodes->height() * nodes->depth();
  const int depth = looks ? finer_nodes(nodes->depth()) : nodes->depth();
  return (looks ? nodes_looked_for : nodes_a_pixel) * pixels > count &&
         static_cast<double>(lights.size()) * depth <= most_layers;
}

bool ProductSums::can_be_together(const DeviceMaterial& material) {
  return material.has("REFRACTION") && !material.has("WALKED");
}

bool ProductSums::hold(const Of& of) const {
  return sums_ && of_.material.lock() == of.material.lock() && of_.version == of.version &&
         of_.grain_to_prototype == of.grain_to_prototype && of_.to_lights == of.to_lights &&
         of_.irradiances == of.irradiances;
}

void ProductSums::sum(DeviceCache& cache, const Draw& draw, const std::vector<LightDirection>& lights, bool together) {
  const DeviceMaterial& material = *draw.material;
  Of of{draw.material, material.version(), glm::mat3(draw.grain_to_prototype), {}, {}};
  std::vector<layout::DistantLight> device;
  for (const LightDirection& light : lights) {
    of.to_lights.emplace_back(light.to_light);
    if (together) of.irradiances.emplace_back(light.irradiance);
    device.push_back({glm::vec4(light.to_light, 0.0), glm::vec4(light.irradiance, 0.0)});
  }
  if (hold(of)) return;
  directions_.emplace(device);
  directions_->bind_storage(layout::DISTANT_LIGHTS_BINDING);
  const std::size_t sums = together ? 1 : lights.size();
  const gl::Volume& nodes = *material.volume("distances");
  const auto prepare = [&](const gl::Program& program) {
    material.bind(program);
    program.set("grain_to_prototype", of.grain_to_prototype);
  };

  const GLenum format = material.has("GREY") && !together ? GL_R32F : GL_RGBA32F;
  sums_.emplace(format, nodes.width(), nodes.height(), nodes.depth() * static_cast<int>(sums));
  prepare(cache.sum_program(material, together));
  sums_->bind_image(0, format);
  dispatch(nodes.width() * nodes.height() * nodes.depth(), sums);

  unscattered_.reset();
  if (asks_for_unscattered(material)) {
    const int width = finer_nodes(nodes.width()), height = finer_nodes(nodes.height());
    const int depth = finer_nodes(nodes.depth());
    unscattered_.emplace(GL_RGBA32F, width, height, depth * static_cast<int>(lights.size()));
    prepare(cache.unscattered_program(material));
    unscattered_->bind_image(0, GL_RGBA32F);
    dispatch(width * height * depth, lights.size());
  }
  of_ = std::move(of);
}

void ProductSums::bind(const gl::Program& program) const {
  program.set("summed", *sums_);
  if (unscattered_) program.set("unscattered_light", *unscattered_);
}

}  // namespace mesograin::render
