// Transforms, or places with a size each; from lists, NPY or the vertices of a PLY file.
#include "io/instances_json.h"

#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <optional>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "io/npy_file.h"
#include "io/ply_elements.h"

namespace mesograin::io {

using namespace scene;

namespace {

using Matrices = std::vector<glm::dmat4>;

glm::dmat4 placed(const glm::dvec3& place, double scale) {
  return glm::scale(glm::translate(glm::dmat4(1.0), place), glm::dvec3(scale));
}

/// (n, 4, 4) and (n, 3, 4) are transforms, (n, 3) places, (n, 4) places and sizes.
Matrices transforms_of(const NumberArray& array) {
  const std::vector<std::size_t>& shape = array.shape;
  const bool matrices = shape.size() == 3 && (shape[1] == 3 || shape[1] == 4) && shape[2] == 4;
  const bool places = shape.size() == 2 && (shape[1] == 3 || shape[1] == 4);
  if (!matrices && !places)
    throw Error(
        "its shape must be (n, 4, 4) or (n, 3, 4) for transforms, (n, 3) for places or (n, 4) for places and "
        "scales; got ({}).",
        fmt::join(shape, ", "));
  Matrices transforms;
  transforms.reserve(shape[0]);
  const std::size_t length = matrices ? shape[1] * 4 : shape[1];
  for (std::size_t i = 0; i < shape[0]; ++i) {
    const double* numbers = array.numbers.data() + i * length;
    if (places) {
      transforms.push_back(placed({numbers[0], numbers[1], numbers[2]}, length == 4 ? numbers[3] : 1.0));
      continue;
    }
    glm::dmat4 rows(1.0);
    for (std::size_t number = 0; number < length; ++number)
      rows[static_cast<int>(number / 4)][static_cast<int>(number % 4)] = numbers[number];
    transforms.push_back(glm::transpose(rows));
  }
  return transforms;
}

/// The vertices of a PLY file: x, y, z and, where they are there, `scale` and the turn `qw`, `qx`, `qy`, `qz`.
Matrices parse_ply_places(std::string_view bytes) {
  ply::File file = ply::open(bytes);
  Matrices transforms;
  for (const ply::Element& element : file.elements) {
    require_elements(element, *file.values);
    if (element.name != "vertex") {
      skip(element, *file.values);
      continue;
    }
    const std::array columns{find(element, {"x"}),  find(element, {"y"}),    find(element, {"z"}),
                             find(element, {"qw"}), find(element, {"qx"}),   find(element, {"qy"}),
                             find(element, {"qz"}), find(element, {"scale"})};
    if (!columns[0] || !columns[1] || !columns[2]) throw Error("its vertices need the properties x, y and z.");
    const bool turned = columns[3] && columns[4] && columns[5] && columns[6];
    std::vector<double> row(element.properties.size());
    for (std::size_t i = 0; i < element.count; ++i) {
      for (std::size_t column = 0; column < row.size(); ++column)
        row[column] = read_scalar(element.properties[column], *file.values);
      const auto at = [&](std::size_t which, double otherwise) {
        return columns[which] ? row[*columns[which]] : otherwise;
      };
      glm::dmat4 transform = placed({at(0, 0.0), at(1, 0.0), at(2, 0.0)}, at(7, 1.0));
      if (turned) {
        const glm::dquat turn(at(3, 1.0), at(4, 0.0), at(5, 0.0), at(6, 0.0));
        if (!(glm::length(turn) > 0.0))
          throw Error("{}: the turn qw, qx, qy, qz of vertex {} has no length.", file.values->place(), i);
        transform *= glm::mat4_cast(glm::normalize(turn));
      }
      transforms.push_back(transform);
    }
  }
  return transforms;
}

Matrices read_places(const Node& node) {
  const Node places = node["positions"];
  const bool each = node.has("scales") && !node["scales"].is_number();
  if (each && node["scales"].size() != places.size())
    node["scales"].fail("must be one number, or one for each of the {} positions", places.size());
  Matrices transforms;
  transforms.reserve(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double scale = each ? node["scales"][i].number() : node.has("scales") ? node["scales"].number() : 1.0;
    transforms.push_back(placed(places[i].vector(), scale));
  }
  return transforms;
}

/// What `parse` makes of a file's bytes.
template <typename Parse>
auto read_whole(const std::filesystem::path& path, const Parse& parse) {
  const std::string bytes = base::read_file(path);
  try {
    return parse(bytes);
  } catch (const Error& error) {
    throw Error("Can't read {}: {}", path.string(), error.what());
  }
}

Matrices read_file(const Node& name, const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / name.text();
  if (path.extension() != ".npy" && path.extension() != ".ply") name.fail("must be a .npy or .ply file");
  return at(name, [&] {
    return read_whole(path, [&](const std::string& bytes) {
      return path.extension() == ".npy" ? transforms_of(parse_npy(bytes)) : parse_ply_places(bytes);
    });
  });
}

Matrices read_transforms(const Node& node, const std::filesystem::path& folder) {
  node.require_object(std::array<std::string_view, 5>{"transforms", "positions", "scales", "file", "factors"},
                      provenance_keys);
  if (node.has("transforms") + node.has("positions") + node.has("file") != 1)
    node.fail("must have one of transforms, positions and file");
  if (node.has("scales") && !node.has("positions")) node["scales"].fail("must stand beside positions");
  if (node.has("file")) return read_file(node["file"], folder);
  if (node.has("positions")) return read_places(node);
  Matrices transforms;
  const Node list = node["transforms"];
  for (std::size_t i = 0; i < list.size(); ++i) transforms.push_back(read_transform(list[i]));
  return transforms;
}

/// A list, a file of one, or a range that is drawn from.
std::vector<glm::vec3> read_factors(const Node& node, const std::filesystem::path& folder, std::size_t count) {
  if (node.is_object()) {
    node.require_object(std::array<std::string_view, 3>{"from", "to", "seed"});
    const int seed = node.has("seed") ? node["seed"].integer(0, 1 << 30) : 0;
    return random_factors(node["from"].rgb(), node["to"].rgb(), count, static_cast<std::uint64_t>(seed));
  }
  std::vector<glm::vec3> factors;
  if (node.is_text()) {
    const std::filesystem::path path = folder / node.text();
    const NumberArray array = at(node, [&] { return read_whole(path, parse_npy); });
    if (array.shape.size() != 2 || array.shape[1] != 3)
      node.fail("must be an .npy of shape (n, 3), not ({})", fmt::join(array.shape, ", "));
    for (std::size_t i = 0; i < array.shape[0]; ++i)
      factors.emplace_back(array.numbers[3 * i], array.numbers[3 * i + 1], array.numbers[3 * i + 2]);
    return factors;
  }
  for (std::size_t i = 0; i < node.size(); ++i) factors.emplace_back(node[i].rgb());
  return factors;
}

ColourFactors read_colour_factors(const Node& node, const std::filesystem::path& folder, std::size_t count) {
  node.require_object(std::array<std::string_view, 3>{"sigma_a", "sigma_s", "reflectance"});
  ColourFactors factors;
  const auto read = [&](const char* name, std::vector<glm::vec3>& numbers) {
    if (node.has(name)) numbers = read_factors(node[name], folder, count);
  };
  read("sigma_a", factors.sigma_a);
  read("sigma_s", factors.sigma_s);
  read("reflectance", factors.reflectance);
  at(node, [&] { validate(factors, count); });
  return factors;
}

}  // namespace

glm::dmat4 read_transform(const Node& rows) {
  glm::dmat4 transform(1.0);
  if (rows.size() != 3 && rows.size() != 4) rows.fail("must be a list of 3 or 4 rows");
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const Node numbers = rows[row];
    if (numbers.size() != 4) numbers.fail("must be a list of 4 numbers");
    for (std::size_t column = 0; column < 4; ++column)
      transform[static_cast<int>(column)][static_cast<int>(row)] = numbers[column].number();
  }
  return transform;
}

void read_instances(const Node& node, const Instance& prototype, const std::filesystem::path& folder,
                    std::vector<InstanceArray>& arrays) {
  Matrices transforms = read_transforms(node, folder);
  if (transforms.empty()) node.fail("must place at least one instance");
  for (glm::dmat4& transform : transforms) transform *= prototype.object_to_world;
  ColourFactors factors;
  if (node.has("factors")) factors = read_colour_factors(node["factors"], folder, transforms.size());
  at(node,
     [&] { arrays.emplace_back(prototype.mesh, prototype.material, Transforms(transforms), std::move(factors)); });
}

}  // namespace mesograin::io
