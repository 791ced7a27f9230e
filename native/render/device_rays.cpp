// Groups of instances and single draws each name their mesh, which is there once for all of them.
#include "render/device_rays.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <map>

#include "render/device_layout.h"

namespace mesograin::render {
namespace {

static_assert(sizeof(casting::FlatNode) == sizeof(layout::TreeNode));

// Each ray asks all of them, one after the other.
constexpr std::size_t most_lone = 32;

std::vector<glm::vec4> lone_meshes(const Content& content) {
  std::vector<glm::vec4> rows;
  const std::size_t groups = content.units() - content.draws().size();
  for (std::size_t i = 0; i < content.draws().size(); ++i) {
    const Draw& draw = content.draws()[i];
    for (const glm::vec4& row : draw.rows(content.anchor())) rows.push_back(row);
    rows.emplace_back(static_cast<float>(draw.radius), static_cast<float>(content.object_number(i)),
                      content.shades_itself(draw) ? 1.0F : 0.0F, static_cast<float>(groups + i));
  }
  return rows;
}

}  // namespace

float DeviceRays::Meshes::add(const casting::FlatMesh& mesh) {
  const auto first_node = static_cast<float>(nodes.size()), first_triangle = static_cast<float>(corners.size());
  const auto first_vertex = static_cast<std::uint32_t>(vertices.size() / 2);
  const auto moved = [&](const glm::vec4& lower) {
    return glm::vec4(glm::vec3(lower), lower.w < 0.0F ? lower.w - first_triangle : lower.w + first_node);
  };
  for (const casting::FlatNode& node : mesh.nodes)
    nodes.push_back({moved(node.first_lower), node.first_upper, moved(node.second_lower), node.second_upper});
  for (const glm::uvec3& triangle : mesh.corners) corners.push_back(triangle + first_vertex);
  vertices.insert(vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  return first_node;
}

void DeviceRays::Meshes::add_levels(std::size_t of, const Details& details) {
  placed[of].x = static_cast<float>(placed.size());
  placed[of].y = static_cast<float>(details.count());
  for (std::size_t level = 0; level < details.count(); ++level)
    placed.emplace_back(add(details.flat(level)), details.error(level), 0.0F, 0.0F);
}

DeviceRays::Meshes::Meshes(DeviceCache& cache, const Content& content) : placed(content.units()) {
  std::map<const scene::Mesh*, std::size_t> known;
  for (std::size_t unit = 0; unit < content.units(); ++unit) {
    const Draw* draw = content.draw(unit);
    const scene::MeshPointer& mesh =
        draw != nullptr ? draw->source
                        : content.instances()->prototypes()[content.instances()->groups()[unit].prototype].mesh;
    const auto [found, is_new] = known.try_emplace(mesh.get(), unit);
    if (is_new) add_levels(unit, *cache.details(mesh));
    placed[unit] = placed[found->second];
    placed[unit].z = static_cast<float>(mesh->reach());
    const bool itself = draw == nullptr && content.instances()->shades_itself(content.instances()->groups()[unit]);
    placed[unit].w = itself ? 1.0F : 0.0F;
  }
}

DeviceRays::DeviceRays(DeviceCache& cache, Content& content) : DeviceRays(Meshes(cache, content), content) {}

DeviceRays::DeviceRays(const Meshes& meshes, Content& content)
    : instances_(*content.instances()),
      tree_(content.instances()->device_tree()),
      mesh_trees_(meshes.nodes),
      corners_(meshes.corners),
      vertices_(meshes.vertices),
      placed_(meshes.placed),
      lone_(lone_meshes(content)),
      lone_count_(static_cast<int>(content.draws().size())) {}

bool DeviceRays::suit(const Content& content) {
  return content.instances() != nullptr && content.draws().size() <= most_lone &&
         content.instances()->count() <= casting::most_in_flat_tree;
}

void DeviceRays::bind(const gl::Program& program, const glm::dmat4& anchor_to_clip, const glm::ivec2& size) const {
  program.use();
  instances_.bind();
  tree_.bind_storage(layout::TREE_BINDING);
  mesh_trees_.bind_storage(layout::MESH_TREES_BINDING);
  corners_.bind_storage(layout::MESH_CORNERS_BINDING);
  vertices_.bind_storage(layout::MESH_VERTICES_BINDING);
  placed_.bind_storage(layout::PLACED_MESHES_BINDING);
  lone_.bind_storage(layout::LONE_MESHES_BINDING);
  program.set("instance_count", static_cast<int>(instances_.count()));
  program.offer("lone_count", lone_count_);
  const glm::dmat4 rows = glm::transpose(anchor_to_clip);
  // As Instances::select has it.
  program.set("detail_depth", glm::vec4(rows[3]));
  program.set("detail_pixels", static_cast<float>(0.5 * std::max(glm::length(glm::dvec3(rows[0])) * size.x,
                                                                 glm::length(glm::dvec3(rows[1])) * size.y)));
  program.set("most_detail_error", in_full_ ? 0.0F : static_cast<float>(most_detail_error));
}

}  // namespace mesograin::render
