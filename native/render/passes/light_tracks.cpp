// Has the device follow the rays, a group of one light's at a time.
#include "render/passes/light_tracks.h"

#include <algorithm>

namespace mesograin::render {
namespace {

// As shaders/models/light_tracks.glsl has it.
constexpr int rays_across = 64;
constexpr int layers_of_pieces = 24;
constexpr int cells_a_node = 2;

// As shaders/passes/trace_light.comp has it.
constexpr int rays_a_group = 64;

int cells(int nodes) { return cells_a_node * (nodes - 1) + 1; }

}  // namespace

int LightTracks::layers(const glm::ivec3& nodes) { return std::max(cells(nodes.z), layers_of_pieces); }

void LightTracks::trace(DeviceCache& cache, const DeviceMaterial& material, const glm::ivec3& nodes,
                        const glm::mat3& grain_to_prototype, std::size_t lights, bool together, int sample) {
  const int width = cells(nodes.x), height = cells(nodes.y);
  const int count = static_cast<int>(lights), depth = cells(nodes.z) * (together ? 1 : count);
  if (!tracks_ || tracks_->width() != width || tracks_->height() != height || tracks_->depth() != depth ||
      pieces_->depth() != layers_of_pieces * count) {
    tracks_.emplace(GL_R32UI, width, height, depth);
    drawn_rays_.emplace(GL_R32UI, width, height, depth);
    pieces_.emplace(GL_RGBA32F, rays_across, rays_across, layers_of_pieces * count);
  }
  tracks_->clear();
  drawn_rays_->clear();
  const gl::Program& program = cache.tracing_program(material, together);
  material.bind(program);
  program.set("grain_to_prototype", grain_to_prototype);
  program.set("sample_index", sample);
  tracks_->bind_image(0, GL_R32UI);
  drawn_rays_->bind_image(1, GL_R32UI);
  pieces_->bind_image(2, GL_RGBA32F);
  glDispatchCompute(rays_across * rays_across / rays_a_group, static_cast<GLuint>(lights), 1);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void LightTracks::bind(const gl::Program& program) const {
  program.set("tracks", *tracks_);
  program.set("drawn_rays", *drawn_rays_);
  program.set("pieces", *pieces_);
}

}  // namespace mesograin::render
