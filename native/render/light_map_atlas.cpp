// Directions on a grid, layers in the order in which they were asked for.
#include "render/light_map_atlas.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <utility>

namespace mesograin::render {
namespace {

// What all maps of one prototype may take.
constexpr double most_bytes = 64.0 * 1024.0 * 1024.0;
constexpr double bytes_a_texel = 16.0;
constexpr int least_resolution = 64;

// Of the coarser grid, in nodes of the finer; both have the edges of the octahedral map.
constexpr int coarse_step = 2;
static_assert(LightMapDirections::half % coarse_step == 0);

double sign_not_zero(double value) { return value < 0.0 ? -1.0 : 1.0; }

// To [-1, 1]^2; the lower half is folded over the edges.
glm::dvec2 octahedral(const glm::dvec3& direction) {
  const glm::dvec3 on_octahedron = direction / (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z));
  const glm::dvec2 flat(on_octahedron);
  if (on_octahedron.z >= 0.0) return flat;
  return {(1.0 - std::abs(flat.y)) * sign_not_zero(flat.x), (1.0 - std::abs(flat.x)) * sign_not_zero(flat.y)};
}

glm::dvec3 from_octahedral(const glm::dvec2& flat) {
  glm::dvec3 direction(flat, 1.0 - std::abs(flat.x) - std::abs(flat.y));
  if (direction.z < 0.0) {
    direction.x = (1.0 - std::abs(flat.y)) * sign_not_zero(flat.x);
    direction.y = (1.0 - std::abs(flat.x)) * sign_not_zero(flat.y);
  }
  return glm::normalize(direction);
}

// The grain's own axes, the middle of its bounds at the origin.
glm::dmat4 to_middle(const scene::Mesh& mesh) {
  glm::dmat4 matrix(1.0);
  matrix[3] = glm::dvec4(-0.5 * (glm::dvec3(mesh.lower()) + glm::dvec3(mesh.upper())), 1.0);
  return matrix;
}

}  // namespace

void LightMapDirections::ask_for(const glm::dvec3& to_light) {
  if (all()) return;
  const glm::dvec2 flat = octahedral(to_light);
  const glm::dvec2 place = glm::abs(flat) * static_cast<double>(half);
  const glm::ivec2 low = glm::min(glm::ivec2(place), half - 1);
  const glm::dvec2 within = place - glm::dvec2(low);
  const glm::ivec2 signs(flat.x < 0.0 ? -1 : 1, flat.y < 0.0 ? -1 : 1);
  const int first = within.x + within.y > 1.0 ? 1 : 0;
  for (const glm::ivec2& corner : {glm::ivec2(first), glm::ivec2(1, 0), glm::ivec2(0, 1)}) {
    const glm::ivec2 at = half + signs * (low + corner);
    const int number = at.y * side + at.x;
    const auto node = static_cast<std::size_t>(number);
    if (asked_[node]) continue;
    asked_[node] = true;
    --left_;
  }
}

glm::dvec3 LightMapDirections::direction(int node) {
  const glm::dvec2 place(node % side, node / side);
  return from_octahedral(2.0 * place / static_cast<double>(side - 1) - 1.0);
}

int LightMapDirections::coarse(int node) {
  const auto nearest = [](int along) { return (along + coarse_step / 2) / coarse_step * coarse_step; };
  return nearest(node / side) * side + nearest(node % side);
}

LightMapDirections LightMapDirections::coarse() const {
  LightMapDirections result;
  for (int node = 0; node < count; ++node) {
    if (!is_asked_for(node) || result.is_asked_for(coarse(node))) continue;
    result.asked_[static_cast<std::size_t>(coarse(node))] = true;
    --result.left_;
  }
  return result;
}

LightMapAtlas::LightMapAtlas(const scene::MeshPointer& mesh) : drawing_(mesh, to_middle(*mesh)) {}

void LightMapAtlas::make_room(const LightMapDirections& directions, int resolution, std::size_t level) {
  int wanted = 0;
  for (int node = 0; node < LightMapDirections::count; ++node)
    if (directions.is_asked_for(node) || layers_[static_cast<std::size_t>(node)] >= 0) ++wanted;
  if (wanted == 0) return;
  // Room to grow, so that another light or another turn of the heap does not draw everything anew.
  const int room = std::min(2 * wanted, LightMapDirections::count);
  const int affordable = static_cast<int>(std::sqrt(most_bytes / bytes_a_texel / room));
  const int allowed = std::clamp(resolution, least_resolution, std::max(affordable, least_resolution));
  if (maps_ && wanted <= maps_->layers() && allowed <= maps_->width() && level_ <= level) return;
  level_ = level;
  maps_.emplace(GL_RGBA32F, allowed, allowed, room);
  depth_.emplace(GL_DEPTH_COMPONENT32F, allowed, allowed);
  std::fill(layers_.begin(), layers_.end(), -1);
  frames_.clear();
}

void LightMapAtlas::draw(const gl::VertexArray& device_mesh, const LightMapProgram& program, int node) {
  const int layer = static_cast<int>(frames_.size());
  frames_.push_back(drawing_.draw(device_mesh, program, LightMapDirections::direction(node), *maps_, layer, *depth_));
  layers_[static_cast<std::size_t>(node)] = layer;
}

void LightMapAtlas::send_frames() {
  device_frames_.emplace(frames_);
  std::vector<int> shown = layers_;
  for (int node = 0; node < LightMapDirections::count; ++node) {
    int& layer = shown[static_cast<std::size_t>(node)];
    if (layer < 0) layer = layers_[static_cast<std::size_t>(LightMapDirections::coarse(node))];
  }
  device_layers_.emplace(shown);
}

void LightMapAtlas::bind(const gl::Program& program) const {
  if (!device_frames_) return;
  program.set("light_maps", *maps_);
  device_frames_->bind_storage(layout::LIGHT_FRAMES_BINDING);
  device_layers_->bind_storage(layout::LIGHT_MAP_LAYERS_BINDING);
}

}  // namespace mesograin::render
