// Draws a map for every light, unless those at hand serve.
#include "render/light_maps.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace mesograin::render {

LightMaps::LightMaps(scene::MeshPointer mesh, const glm::dmat4& object_to_grain)
    : drawing_(std::move(mesh), object_to_grain) {}

bool LightMaps::are_of(const scene::MeshPointer& mesh, const glm::dmat4& object_to_grain) const {
  return mesh == drawing_.mesh() && object_to_grain == drawing_.object_to_grain();
}

int LightMaps::update(const gl::VertexArray& device_mesh, const LightMapProgram& program,
                      const std::vector<glm::dvec3>& to_light, int resolution) {
  if (maps_ && to_light == to_light_ && resolution <= resolution_) return 0;
  if (to_light.empty()) return 0;
  const auto layers = static_cast<int>(to_light.size());
  if (!maps_ || maps_->layers() != layers || resolution > resolution_) {
    maps_.emplace(GL_RGBA32F, resolution, resolution, layers);
    resolution_ = resolution;
  }
  const gl::Texture depth(GL_DEPTH_COMPONENT32F, resolution_, resolution_);
  std::vector<layout::StoredLightFrame> frames;
  frames.reserve(to_light.size());
  for (int layer = 0; layer < layers; ++layer)
    frames.push_back(
        drawing_.draw(device_mesh, program, to_light[static_cast<std::size_t>(layer)], *maps_, layer, depth));
  frames_.emplace(frames);
  to_light_ = to_light;
  return layers;
}

void LightMaps::bind(const gl::Program& program) const {
  if (!maps_) return;
  program.set("light_maps", *maps_);
  frames_->bind_storage(layout::LIGHT_FRAMES_BINDING);
}

std::vector<float> LightMaps::read(int light) const {
  const auto side = static_cast<std::size_t>(resolution_);
  std::vector<float> texels(side * side * 4);
  maps_->read(light, texels.data());
  return texels;
}

int light_map_resolution(double pixels_across, double mean_free_paths_across) {
  constexpr double least = 256.0;
  constexpr double most = 1024.0;
  const double wanted = std::clamp(std::max(pixels_across, 4.0 * mean_free_paths_across), least, most);
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::ceil(wanted))));
}

}  // namespace mesograin::render
