// A mesh in Stanford PLY: vertices and faces are kept, the rest is read over.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "io/mesh_builder.h"
#include "io/mesh_file.h"
#include "io/ply_elements.h"
#include "io/triangulate.h"

namespace mesograin::io {

using scene::Mesh;

namespace {

using ply::Element;
using ply::Property;
using ply::Values;

class PlyMeshReader {
 public:
  Mesh read(const ply::File& file) {
    for (const Element& element : file.elements) {
      require_elements(element, *file.values);
      if (element.name == "vertex")
        read_vertices(element, *file.values);
      else if (element.name == "face")
        read_faces(element, *file.values);
      else
        skip(element, *file.values);
    }
    if (!mesh_.has_faces()) throw Error("it holds no face; a mesh needs at least one triangle.");
    return mesh_.build();
  }

 private:
  void read_vertices(const Element& element, Values& values) {
    if (element.count == 0 || element.properties.empty()) throw Error("it holds no vertex; a mesh needs at least 3.");
    const std::array position{find(element, {"x"}), find(element, {"y"}), find(element, {"z"})};
    const std::array normal{find(element, {"nx"}), find(element, {"ny"}), find(element, {"nz"})};
    const std::array uv{find(element, {"u", "s", "texture_u"}), find(element, {"v", "t", "texture_v"})};
    if (!position[0] || !position[1] || !position[2]) throw Error("its vertices need the properties x, y and z.");
    has_normals_ = normal[0] && normal[1] && normal[2];
    has_uvs_ = uv[0] && uv[1];

    std::vector<float> row(element.properties.size());
    for (std::size_t i = 0; i < element.count; ++i) {
      for (std::size_t column = 0; column < row.size(); ++column)
        row[column] = read_scalar(element.properties[column], values);
      mesh_.positions.emplace_back(row[*position[0]], row[*position[1]], row[*position[2]]);
      if (has_normals_) mesh_.normals.emplace_back(row[*normal[0]], row[*normal[1]], row[*normal[2]]);
      if (has_uvs_) mesh_.uvs.emplace_back(row[*uv[0]], row[*uv[1]]);
    }
  }

  void read_faces(const Element& element, Values& values) {
    const auto indices = find(element, {"vertex_indices", "vertex_index"});
    if (element.count > 0 && (!indices || !element.properties[*indices].count_type))
      throw Error("its faces need the list property vertex_indices.");
    for (std::size_t face = 0; face < element.count; ++face)
      for (std::size_t column = 0; column < element.properties.size(); ++column) {
        if (column == *indices)
          read_face(element.properties[column], values);
        else
          skip(element.properties[column], values);
      }
  }

  void read_face(const Property& property, Values& values) {
    const std::size_t count = read_count(property, values);
    if (count < 3 || count > most_corners)
      throw Error("{}: a face needs 3 to {} corners; got {}.", values.place(), most_corners, count);
    corners_.clear();
    for (std::size_t i = 0; i < count; ++i) {
      const double number = values.next(property.type);
      if (!(number >= 0.0 && number < static_cast<double>(mesh_.positions.size())) || number != std::floor(number))
        throw Error("{}: a face's corner must name one of the {} vertices; got {}.", values.place(),
                    mesh_.positions.size(), number);
      const auto vertex = static_cast<std::uint32_t>(number);
      MeshBuilder::Corner corner{vertex, {}, {}};
      if (has_normals_) corner.normal = vertex;
      if (has_uvs_) corner.uv = vertex;
      corners_.push_back(corner);
    }
    mesh_.add_face(corners_);
  }

  bool has_normals_ = false;
  bool has_uvs_ = false;
  MeshBuilder mesh_;
  std::vector<MeshBuilder::Corner> corners_;
};

}  // namespace

Mesh parse_ply(std::string_view bytes) { return PlyMeshReader().read(ply::open(bytes)); }

std::string to_ply(const Mesh& mesh) {
  const bool has_uvs = !mesh.uvs().empty();
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\n{}element face {}\n"
      "property list uchar uint vertex_indices\nend_header\n",
      mesh.positions().size(), has_uvs ? "property float u\nproperty float v\n" : "", mesh.triangles().size());
  const auto add = [&bytes](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
  for (std::size_t i = 0; i < mesh.positions().size(); ++i) {
    add(mesh.positions()[i]);
    add(mesh.normals()[i]);
    if (has_uvs) add(mesh.uvs()[i]);
  }
  for (const glm::uvec3& triangle : mesh.triangles()) {
    bytes.push_back(3);
    add(triangle);
  }
  return bytes;
}

}  // namespace mesograin::io
