// Has the device sum them, a group of nodes under one light at a time.
#include "render/passes/product_sums.h"

#include <vector>

#include "render/device_layout.h"

namespace mesograin::render {
namespace {

// As shaders/passes/sum_products.comp has it.
constexpr int nodes_a_group = 64;

// A pixel reads each product at six places, eight nodes at each, or more; a sum reads it once a node.
constexpr double nodes_a_pixel = 48.0;

// OpenGL 4.5 has textures of at least so many layers.
constexpr int most_layers = 2048;

}  // namespace

bool ProductSums::pay(const DeviceMaterial& material, const std::vector<LightDirection>& lights, double pixels) {
  const gl::Volume* nodes = material.volume("distances");
  if (nodes == nullptr || lights.empty()) return false;
  const double count = static_cast<double>(nodes->width()) * nodes->height() * nodes->depth();
  return nodes_a_pixel * pixels > count && static_cast<double>(lights.size()) * nodes->depth() <= most_layers;
}

void ProductSums::sum(DeviceCache& cache, const DeviceMaterial& material, const std::vector<LightDirection>& lights,
                      const glm::mat3& grain_to_prototype) {
  std::vector<layout::DistantLight> device;
  device.reserve(lights.size());
  for (const LightDirection& light : lights) device.push_back({glm::vec4(light.to_light, 0.0), glm::vec4(0.0F)});
  directions_.emplace(device);
  directions_->bind_storage(layout::DISTANT_LIGHTS_BINDING);

  const gl::Volume& nodes = *material.volume("distances");
  const GLenum format = material.has("GREY") ? GL_R32F : GL_RGBA32F;
  sums_.emplace(format, nodes.width(), nodes.height(), nodes.depth() * static_cast<int>(lights.size()));
  const gl::Program& program = cache.sum_program(material);
  material.bind(program);
  program.set("grain_to_prototype", grain_to_prototype);
  sums_->bind_image(0, format);
  const int count = nodes.width() * nodes.height() * nodes.depth();
  glDispatchCompute(static_cast<GLuint>((count + nodes_a_group - 1) / nodes_a_group),
                    static_cast<GLuint>(lights.size()), 1);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

}  // namespace mesograin::render
