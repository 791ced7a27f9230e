// Wavefront OBJ: v, vn, vt and f; every other statement says nothing about the surface and is passed over.
#include <fmt/format.h>

#include <cstdint>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "io/mesh_builder.h"
#include "io/mesh_file.h"
#include "io/number.h"
#include "io/triangulate.h"

namespace mesograin::io {

using scene::Mesh;

namespace {

/// Takes the next word off the front of `line`; empty when there is none.
std::string_view take_word(std::string_view& line) {
  constexpr std::string_view blanks = " \t\r\v\f";
  const std::size_t start = std::min(line.find_first_not_of(blanks), line.size());
  const std::size_t end = std::min(line.find_first_of(blanks, start), line.size());
  const std::string_view word = line.substr(start, end - start);
  line.remove_prefix(end);
  return word;
}

class ObjReader {
 public:
  Mesh read(std::string_view text) {
    while (!text.empty()) {
      ++line_number_;
      const std::size_t end = std::min(text.find('\n'), text.size());
      read_line(text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (!mesh_.has_faces()) throw Error("it holds no face; a mesh needs at least one triangle.");
    return mesh_.build();
  }

 private:
  void read_line(std::string_view line) {
    const std::string_view statement = take_word(line);
    if (statement == "v")
      mesh_.positions.push_back(read_vector<glm::vec3>(line, "v"));
    else if (statement == "vn")
      mesh_.normals.push_back(read_vector<glm::vec3>(line, "vn"));
    else if (statement == "vt")
      mesh_.uvs.push_back(read_vector<glm::vec2>(line, "vt"));
    else if (statement == "f")
      read_face(line);
  }

  template <typename Vector>
  Vector read_vector(std::string_view line, std::string_view statement) const {
    Vector vector(0.0F);
    for (int axis = 0; axis < Vector::length(); ++axis) {
      const std::string_view word = take_word(line);
      const auto value = parse_float(word);
      if (!value)
        throw Error("line {}: '{}' needs {} finite numbers; got '{}' as number {}.", line_number_, statement,
                    Vector::length(), word.substr(0, 40), axis + 1);
      vector[axis] = *value;
    }
    return vector;
  }

  void read_face(std::string_view line) {
    corners_.clear();
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
      if (word.starts_with('#')) break;
      corners_.push_back(read_corner(word));
    }
    if (corners_.size() < 3 || corners_.size() > most_corners)
      throw Error("line {}: a face needs 3 to {} corners; got {}.", line_number_, most_corners, corners_.size());
    mesh_.add_face(corners_);
  }

  /// position, position/uv, position//normal or position/uv/normal
  MeshBuilder::Corner read_corner(std::string_view word) const {
    std::string_view parts[3];
    std::string_view rest = word;
    for (std::string_view& part : parts) {
      const std::size_t end = std::min(rest.find('/'), rest.size());
      part = rest.substr(0, end);
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    MeshBuilder::Corner corner{};
    corner.position = resolve(parts[0], mesh_.positions.size(), "vertices", word);
    if (!parts[1].empty()) corner.uv = resolve(parts[1], mesh_.uvs.size(), "UVs", word);
    if (!parts[2].empty()) corner.normal = resolve(parts[2], mesh_.normals.size(), "normals", word);
    return corner;
  }

  /// Numbers count from 1; negative ones count back from the last.
  std::uint32_t resolve(std::string_view text, std::size_t count, std::string_view what, std::string_view word) const {
    const auto number = parse_integer(text);
    const auto last = static_cast<long long>(count);
    if (!number || *number == 0 || *number > last || *number < -last)
      throw Error("line {}: the corner '{}' must name one of the {} {} so far.", line_number_, word.substr(0, 40),
                  count, what);
    return static_cast<std::uint32_t>(*number > 0 ? *number - 1 : last + *number);
  }

  MeshBuilder mesh_;
  std::vector<MeshBuilder::Corner> corners_;
  int line_number_ = 0;
};

}  // namespace

Mesh parse_obj(std::string_view text) { return ObjReader().read(text); }

}  // namespace mesograin::io
