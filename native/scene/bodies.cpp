// Copies are fitted as point sets with known partners: the turn is the orthogonal polar factor of their correlation,
// found by Newton's iteration (Higham, Computing the polar decomposition, SIAM J. Sci. Stat. Comput. 1986, eq. 3.1).
#include "scene/bodies.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <ranges>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "scene/pieces.h"
#include "scene/welding.h"

namespace mesograin::scene {
namespace {

constexpr double one_place = 1e-6;    // of the mesh's reach
constexpr double same_place = 1e-4;   // of a body's own reach
constexpr double same_normal = 2e-2;  // a degree
constexpr int most_probes = 8;        // vertices of a surface that are looked for in another

/// A connected piece of the surface.
struct Shell {
  std::vector<std::uint32_t> triangles;
  bool closed = true;
  double volume = 0.0;  // below 0 where it faces inwards
  glm::vec3 lower{0.0F};
  glm::vec3 upper{0.0F};
};

bool has_no_area(const glm::uvec3& corners) {
  return corners.x == corners.y || corners.y == corners.z || corners.z == corners.x;
}

glm::uvec3 named(const glm::uvec3& triangle, std::span<const std::uint32_t> vertices) {
  return {vertices[triangle.x], vertices[triangle.y], vertices[triangle.z]};
}

/// Whether there is nothing to take apart or to turn, closed or not.
bool is_one_grain(const std::vector<Shell>& shells) { return shells.size() == 1 && !(shells.front().volume < 0.0); }

std::vector<Shell> shells_of(const Mesh& mesh, std::span<const std::uint32_t> vertices) {
  const std::vector<glm::uvec3>& triangles = mesh.triangles();
  Pieces pieces(std::size_t{std::ranges::max(vertices)} + 1);
  for (const glm::uvec3& triangle : triangles) {
    const glm::uvec3 corners = named(triangle, vertices);
    pieces.join(corners.x, corners.y);
    pieces.join(corners.y, corners.z);
  }
  std::vector<Shell> shells;
  std::unordered_map<std::uint32_t, std::size_t> numbers;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const std::size_t number = numbers.try_emplace(pieces.of(vertices[triangles[i].x]), shells.size()).first->second;
    if (number == shells.size()) shells.emplace_back();
    shells[number].triangles.push_back(i);
  }
  for (Shell& shell : shells) {
    shell.lower = shell.upper = mesh.positions()[triangles[shell.triangles.front()].x];
    const glm::dvec3 origin(shell.lower);
    for (const std::uint32_t i : shell.triangles) {
      glm::dvec3 places[3];
      for (int corner = 0; corner < 3; ++corner) {
        const glm::vec3& position = mesh.positions()[triangles[i][corner]];
        shell.lower = glm::min(shell.lower, position);
        shell.upper = glm::max(shell.upper, position);
        places[corner] = glm::dvec3(position) - origin;
      }
      shell.volume += glm::dot(places[0], glm::cross(places[1], places[2])) / 6.0;
    }
  }
  if (is_one_grain(shells)) return shells;

  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (Shell& shell : shells) {
    edges.clear();
    for (const std::uint32_t i : shell.triangles) {
      const glm::uvec3 corners = named(triangles[i], vertices);
      for (int corner = 0; corner < 3 && !has_no_area(corners); ++corner)
        edges.push_back(std::minmax({corners[corner], corners[(corner + 1) % 3]}));
    }
    std::ranges::sort(edges);
    for (std::size_t first = 0; first < edges.size() && shell.closed;) {
      std::size_t next = first;
      while (next < edges.size() && edges[next] == edges[first]) ++next;
      shell.closed = (next - first) % 2 == 0;
      first = next;
    }
  }
  return shells;
}

/// How often a closed surface goes around a place (van Oosterom and Strackee, The solid angle of a plane triangle,
/// IEEE Trans. Biomed. Eng. 1983, eq. 8).
double winding(const Mesh& mesh, const Shell& shell, const glm::dvec3& place) {
  double sum = 0.0;
  for (const std::uint32_t i : shell.triangles) {
    const glm::uvec3& triangle = mesh.triangles()[i];
    const glm::dvec3 a = glm::dvec3(mesh.positions()[triangle.x]) - place;
    const glm::dvec3 b = glm::dvec3(mesh.positions()[triangle.y]) - place;
    const glm::dvec3 c = glm::dvec3(mesh.positions()[triangle.z]) - place;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    sum += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)),
                            la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  return sum / (4.0 * std::numbers::pi);
}

bool is_within(const Mesh& mesh, const Shell& inner, const Shell& outer) {
  const std::size_t step = std::max<std::size_t>(inner.triangles.size() / most_probes, 1);
  for (std::size_t i = 0; i < inner.triangles.size(); i += step) {
    const std::uint32_t corner = mesh.triangles()[inner.triangles[i]].x;
    if (std::abs(winding(mesh, outer, glm::dvec3(mesh.positions()[corner]))) < 0.5) return false;
  }
  return true;
}

bool box_is_within(const Shell& inner, const Shell& outer) {
  return glm::all(glm::greaterThanEqual(inner.lower, outer.lower)) &&
         glm::all(glm::lessThanEqual(inner.upper, outer.upper));
}

/// Which shells are one body: numbers of each one's, those of closed ones in order; open ones have none.
std::vector<std::optional<std::uint32_t>> bodies_of_shells(const Mesh& mesh, const std::vector<Shell>& shells) {
  std::vector<std::uint32_t> from_left;
  for (std::uint32_t i = 0; i < shells.size(); ++i)
    if (shells[i].closed) from_left.push_back(i);
  std::ranges::stable_sort(from_left, {}, [&](std::uint32_t i) { return shells[i].lower.x; });

  Pieces pieces(shells.size());
  std::vector<std::uint32_t> open_there;  // those from further left that may reach as far
  for (std::size_t k = 0; k < from_left.size(); ++k) {
    const std::uint32_t inner = from_left[k];
    std::erase_if(open_there, [&](std::uint32_t i) { return shells[i].upper.x < shells[inner].lower.x; });
    int around = 0;
    std::optional<std::uint32_t> next;  // the smallest around it
    const auto look = [&](std::uint32_t outer) {
      if (!box_is_within(shells[inner], shells[outer]) || !is_within(mesh, shells[inner], shells[outer])) return;
      ++around;
      if (!next || std::abs(shells[outer].volume) < std::abs(shells[*next].volume)) next = outer;
    };
    for (const std::uint32_t outer : open_there) look(outer);
    for (std::size_t i = k + 1; i < from_left.size() && shells[from_left[i]].lower.x == shells[inner].lower.x; ++i)
      look(from_left[i]);
    const bool is_cavity = shells[inner].volume < 0.0;
    if (next && (is_cavity || around % 2 == 1)) pieces.join(inner, *next);
    open_there.push_back(inner);
  }
  std::vector<std::optional<std::uint32_t>> found(shells.size());
  for (std::uint32_t i = 0; i < shells.size(); ++i)
    if (shells[i].closed) found[i] = pieces.of(i);
  return found;
}

/// A part of a mesh with positions of its own, in the order in which the whole has them.
struct Cut {
  std::vector<std::uint32_t> rows;
  std::vector<glm::uvec3> triangles;
  float facing = 1.0F;  // of the whole's normals; -1 where these face inwards
};

Cut cut(const Mesh& mesh, std::vector<std::uint32_t> triangles, bool is_inside_out) {
  std::ranges::sort(triangles);
  Cut part;
  if (is_inside_out) part.facing = -1.0F;
  for (const std::uint32_t i : triangles)
    for (int corner = 0; corner < 3; ++corner) part.rows.push_back(mesh.triangles()[i][corner]);
  std::ranges::sort(part.rows);
  part.rows.erase(std::unique(part.rows.begin(), part.rows.end()), part.rows.end());
  const auto renumbered = [&](std::uint32_t row) {
    return static_cast<std::uint32_t>(std::ranges::lower_bound(part.rows, row) - part.rows.begin());
  };
  for (const std::uint32_t i : triangles) {
    const glm::uvec3& triangle = mesh.triangles()[i];
    part.triangles.emplace_back(renumbered(triangle.x), renumbered(is_inside_out ? triangle.z : triangle.y),
                                renumbered(is_inside_out ? triangle.y : triangle.z));
  }
  return part;
}

/// The part as a mesh, about `middle`.
MeshPointer mesh_of(const Mesh& mesh, Cut part, const glm::dvec3& middle) {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec2> uvs;
  for (const std::uint32_t row : part.rows) {
    positions.emplace_back(glm::dvec3(mesh.positions()[row]) - middle);
    normals.push_back(part.facing * mesh.normals()[row]);
    if (!mesh.uvs().empty()) uvs.push_back(mesh.uvs()[row]);
  }
  return std::make_shared<const Mesh>(std::move(positions), std::move(normals), std::move(part.triangles),
                                      std::move(uvs));
}

glm::dvec3 middle_of(const Mesh& mesh, const Cut& part) {
  glm::dvec3 sum(0.0);
  for (const std::uint32_t row : part.rows) sum += glm::dvec3(mesh.positions()[row]);
  return sum / static_cast<double>(part.rows.size());
}

/// What copies have in common: few others need to be looked at.
struct Likeness {
  std::size_t rows;
  std::size_t triangles;
  double first;  // how far the first position is from the middle, over that of all

  Likeness less(double by) const { return {rows, triangles, first - by}; }
  bool operator<(const Likeness& other) const {
    return std::tie(rows, triangles, first) < std::tie(other.rows, other.triangles, other.first);
  }
};

Likeness likeness_of(const Mesh& mesh, const Cut& part) {
  const glm::dvec3 middle = middle_of(mesh, part);
  const auto from_middle = [&](std::uint32_t row) { return glm::dvec3(mesh.positions()[row]) - middle; };
  double sum = 0.0;
  for (const std::uint32_t row : part.rows) sum += glm::dot(from_middle(row), from_middle(row));
  const double mean = std::sqrt(sum / static_cast<double>(part.rows.size()));
  return {part.rows.size(), part.triangles.size(),
          mean > 0.0 ? glm::length(from_middle(part.rows.front())) / mean : 0.0};
}

/// The turn that is nearest to a matrix; none if that mirrors or is flat.
std::optional<glm::dmat3> turn_of(glm::dmat3 matrix) {
  if (!(glm::determinant(matrix) > 0.0)) return std::nullopt;
  for (int i = 0; i < 60; ++i) {
    const glm::dmat3 next = 0.5 * (matrix + glm::transpose(glm::inverse(matrix)));
    double change = 0.0;
    for (int column = 0; column < 3; ++column) change += glm::length(next[column] - matrix[column]);
    matrix = next;
    if (change < 1e-12) return matrix;
  }
  return std::nullopt;
}

/// Where a body, whose middle is its origin, stands as a part of a mesh; none if that is no copy of it.
std::optional<glm::dmat4> placing_of(const Mesh& body, const Mesh& mesh, const Cut& part) {
  const glm::dvec3 middle = middle_of(mesh, part);
  glm::dmat3 correlation(0.0);
  double of_body = 0.0, of_part = 0.0;
  for (std::size_t i = 0; i < part.rows.size(); ++i) {
    const glm::dvec3 from(body.positions()[i]);
    const glm::dvec3 to = glm::dvec3(mesh.positions()[part.rows[i]]) - middle;
    correlation += glm::outerProduct(to, from);
    of_body += glm::dot(from, from);
    of_part += glm::dot(to, to);
  }
  if (!(of_body > 0.0 && of_part > 0.0)) return std::nullopt;
  const std::optional<glm::dmat3> turn = turn_of(correlation / std::sqrt(of_body * of_part));
  if (!turn) return std::nullopt;
  const double scale = std::sqrt(of_part / of_body);
  const double allowed = same_place * scale * body.reach();
  for (std::size_t i = 0; i < part.rows.size(); ++i) {
    const std::uint32_t row = part.rows[i];
    const glm::dvec3 to = middle + scale * (*turn * glm::dvec3(body.positions()[i]));
    if (glm::distance(to, glm::dvec3(mesh.positions()[row])) > allowed) return std::nullopt;
    if (glm::distance(*turn * glm::dvec3(body.normals()[i]), glm::dvec3(part.facing * mesh.normals()[row])) >
        same_normal)
      return std::nullopt;
  }
  glm::dmat4 placing(scale * *turn);
  placing[3] = glm::dvec4(middle, 1.0);
  return placing;
}

}  // namespace

std::vector<Bodies> bodies_of(const Mesh& mesh, std::span<const std::uint32_t> vertices, bool copies) {
  if (vertices.size() != mesh.positions().size())
    throw Error("A mesh of {} positions has as many numbers of vertices; got {}.", mesh.positions().size(),
                vertices.size());
  std::vector<Shell> shells = shells_of(mesh, vertices);
  if (is_one_grain(shells)) return {};
  if (!std::ranges::all_of(shells, &Shell::closed)) shells = shells_of(mesh, welded(mesh, one_place));
  if (is_one_grain(shells)) return {};

  struct Closed {
    std::vector<std::uint32_t> triangles;
    double volume = 0.0;
  };
  const std::vector<std::optional<std::uint32_t>> numbers = bodies_of_shells(mesh, shells);
  std::vector<Closed> closed;  // in the order of their first shells
  std::unordered_map<std::uint32_t, std::size_t> in_order;
  std::vector<std::uint32_t> open;
  for (std::size_t i = 0; i < shells.size(); ++i) {
    const std::vector<std::uint32_t>& its = shells[i].triangles;
    if (!numbers[i]) {
      open.insert(open.end(), its.begin(), its.end());
      continue;
    }
    const std::size_t number = in_order.try_emplace(*numbers[i], closed.size()).first->second;
    if (number == closed.size()) closed.emplace_back();
    closed[number].triangles.insert(closed[number].triangles.end(), its.begin(), its.end());
    closed[number].volume += shells[i].volume;
  }
  const bool one_inside_out = closed.size() == 1 && open.empty() && closed.front().volume < 0.0;
  if (closed.size() < 2 && !one_inside_out) return {};
  copies = copies && closed.size() > 1;

  std::vector<Bodies> found;
  std::multimap<Likeness, std::size_t> alike;
  for (Closed& each : closed) {
    Cut part = cut(mesh, std::move(each.triangles), each.volume < 0.0);
    const Likeness likeness = likeness_of(mesh, part);
    bool is_copy = false;
    if (copies)
      for (auto like = alike.lower_bound(likeness.less(same_place)),
                end = alike.upper_bound(likeness.less(-same_place));
           like != end && !is_copy; ++like) {
        Bodies& other = found[like->second];
        if (other.mesh->triangles() != part.triangles) continue;
        if (const std::optional<glm::dmat4> placing = placing_of(*other.mesh, mesh, part)) {
          other.placings.push_back(*placing);
          is_copy = true;
        }
      }
    if (is_copy) continue;
    const glm::dvec3 middle = copies ? middle_of(mesh, part) : glm::dvec3(0.0);
    glm::dmat4 placing(1.0);
    placing[3] = glm::dvec4(middle, 1.0);
    alike.emplace(likeness, found.size());
    found.push_back({mesh_of(mesh, std::move(part), middle), {placing}});
  }
  if (!open.empty())
    found.push_back({mesh_of(mesh, cut(mesh, std::move(open), false), glm::dvec3(0.0)), {glm::dmat4(1.0)}});
  return found;
}

}  // namespace mesograin::scene
