// Has the device sum and look, a group of nodes under one light at a time.
#include "render/passes/product_sums.h"

#include <utility>
#include <variant>

#include "render/device_layout.h"

namespace mesograin::render {
namespace {

// As shaders/passes/sum_products.comp has it.
constexpr int nodes_a_group = 64;

// A pixel reads each product at six places, eight nodes at each, or more; a sum reads it once a node.
constexpr double nodes_a_pixel = 48.0;

// Rays cost as much as that many pixels' walks that each look for unscattered light themselves.
constexpr double pixels_of_rays = 500.0;

// OpenGL 4.5 has textures of at least so many layers.
constexpr int most_layers = 2048;

/// Whether the program asks for refracted light that nothing has scattered yet.
bool asks_for_unscattered(const DeviceMaterial& material) {
  return material.has("WALKED") && material.has("REFRACTION");
}

/// That light is stored at; (0, 0, 0): none is.
glm::ivec3 light_nodes(const DeviceMaterial& material) {
  const models::UniformValue* last = material.uniform("stored.last_node");
  return last == nullptr ? glm::ivec3(0) : glm::ivec3(std::get<glm::vec3>(*last)) + 1;
}

int product(const glm::ivec3& size) { return size.x * size.y * size.z; }

}  // namespace

bool ProductSums::pay(const DeviceMaterial& material, const std::vector<LightDirection>& lights, double pixels) {
  const glm::ivec3 nodes = light_nodes(material);
  if (nodes.x == 0 || lights.empty()) return false;
  const bool follows = asks_for_unscattered(material);
  const int depth = follows ? LightTracks::layers(nodes) : nodes.z;
  return (follows ? pixels > pixels_of_rays : nodes_a_pixel * pixels > product(nodes)) &&
         static_cast<double>(lights.size()) * depth <= most_layers;
}

bool ProductSums::can_be_together(const DeviceMaterial& material, std::size_t lights) {
  return !material.has("WALKED") || (material.has("REFRACTION") && lights <= LightTracks::most_together);
}

bool ProductSums::hold(const Of& of) const {
  return sums_ && of_.material.lock() == of.material.lock() && of_.version == of.version &&
         of_.stored_lights == of.stored_lights && of_.lines == of.lines &&
         of_.grain_to_prototype == of.grain_to_prototype && of_.to_lights == of.to_lights &&
         of_.irradiances == of.irradiances;
}

void ProductSums::sum(const Sample& sample, const Draw& draw, std::optional<std::size_t> stored, int lines,
                      bool together) {
  const DeviceMaterial& material = *draw.material;
  const std::vector<LightDirection>& lights = sample.lights.distant;
  Of of{draw.material,
        material.version(),
        stored ? sample.stored_lights.version(*stored) : 0,
        lines,
        glm::mat3(draw.grain_to_prototype),
        {},
        {}};
  std::vector<layout::DistantLight> device;
  for (const LightDirection& light : lights) {
    of.to_lights.emplace_back(light.to_light);
    if (together) of.irradiances.emplace_back(light.irradiance);
    device.push_back({glm::vec4(light.to_light, 0.0), glm::vec4(light.irradiance, light.density)});
  }
  const bool held = hold(of);
  tracked_ = asks_for_unscattered(material);
  if (held && (!tracked_ || tracked_sample_ == sample.index)) return;
  directions_.emplace(device);
  directions_->bind_storage(layout::DISTANT_LIGHTS_BINDING);
  const glm::ivec3 nodes = light_nodes(material);
  if (tracked_)
    tracks_.trace(sample.cache, material, nodes, of.grain_to_prototype, lights.size(), together,
                  static_cast<int>(sample.index));
  tracked_sample_ = sample.index;
  if (held) return;
  if (lines > 0) lines_.cut(sample.cache, material, of.grain_to_prototype, lights.size(), lines);

  const std::size_t sums = together ? 1 : lights.size();
  const GLenum format = material.has("GREY") && !together ? GL_R32F : GL_RGBA32F;
  sums_.emplace(format, nodes.x, nodes.y, nodes.z * static_cast<int>(sums));
  const gl::Program& program = sample.cache.sum_program(material, together, stored.has_value());
  material.bind(program);
  program.set("grain_to_prototype", of.grain_to_prototype);
  if (stored) sample.stored_lights.bind(program, *stored, material, draw.grain_to_prototype);
  sums_->bind_image(0, format);
  glDispatchCompute(static_cast<GLuint>((product(nodes) + nodes_a_group - 1) / nodes_a_group),
                    static_cast<GLuint>(sums), 1);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  of_ = std::move(of);
}

void ProductSums::bind(const gl::Program& program) const {
  program.set("summed", *sums_);
  if (tracked_) tracks_.bind(program);
  if (of_.lines > 0) lines_.bind(program);
}

}  // namespace mesograin::render
