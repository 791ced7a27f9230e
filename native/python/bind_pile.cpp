// Piles of grains for scripts: arrays in, arrays out, without Python's lock.
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "pile/work.h"
#include "python/bindings.h"
#include "python/vectors.h"

namespace py = pybind11;

namespace mesograin::python {
namespace {

using Arrays = std::pair<Array<double>, Array<std::uint32_t>>;

pile::Mesh to_mesh(const Arrays& arrays) {
  const auto& [vertices, triangles] = arrays;
  if (vertices.ndim() != 2 || vertices.shape(1) != 3 || triangles.ndim() != 2 || triangles.shape(1) != 3)
    throw Error("A mesh must be vertices of shape (n, 3) and triangles of shape (t, 3).");
  pile::Mesh mesh;
  for (py::ssize_t i = 0; i < vertices.shape(0); ++i)
    mesh.vertices.emplace_back(vertices.at(i, 0), vertices.at(i, 1), vertices.at(i, 2));
  for (py::ssize_t i = 0; i < triangles.shape(0); ++i)
    mesh.triangles.push_back({triangles.at(i, 0), triangles.at(i, 1), triangles.at(i, 2)});
  return mesh;
}

py::tuple to_tuple(const pile::Pile& found) {
  Array<double> middles({found.middles.size(), std::size_t{3}});
  Array<double> turns({found.turns.size(), std::size_t{4}});
  for (std::size_t i = 0; i < found.middles.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) middles.mutable_at(i, axis) = found.middles[i][axis];
    const glm::dquat& turn = found.turns[i];
    const double parts[4] = {turn.w, turn.x, turn.y, turn.z};
    for (int part = 0; part < 4; ++part) turns.mutable_at(i, part) = parts[part];
  }
  const Array<std::uint32_t> numbers(static_cast<py::ssize_t>(found.numbers.size()), found.numbers.data());
  return py::make_tuple(middles, turns, found.largest_overlap, numbers);
}

std::unique_ptr<pile::Work> start_settling(std::vector<double> radii, std::vector<std::uint32_t> shapes,
                                           const std::vector<Arrays>& meshes,
                                           const std::optional<std::pair<double, double>>& walls,
                                           const std::optional<Arrays>& surface, double floor, double friction,
                                           std::uint64_t seed, bool inside) {
  pile::Grains grains{std::move(radii), std::move(shapes), {}};
  for (const Arrays& mesh : meshes) grains.meshes.push_back(to_mesh(mesh));
  pile::Walls held;
  if (walls) held.half = {0.5 * walls->first, 0.5 * walls->second};
  pile::Ground ground;
  if (surface) ground.mesh = to_mesh(*surface);
  ground.floor = floor;
  ground.inside = inside;
  return std::make_unique<pile::Work>(std::move(grains), std::move(ground), held, friction, seed);
}

py::tuple result_of(pile::Work& work) {
  const auto found = [&] {
    const py::gil_scoped_release release;
    return work.result();
  }();
  return to_tuple(found);
}

py::tuple settle(std::vector<double> radii, std::vector<std::uint32_t> shapes, const std::vector<Arrays>& meshes,
                 const std::optional<std::pair<double, double>>& walls, const std::optional<Arrays>& surface,
                 double floor, double friction, std::uint64_t seed, bool inside) {
  return result_of(
      *start_settling(std::move(radii), std::move(shapes), meshes, walls, surface, floor, friction, seed, inside));
}

}  // namespace

void bind_pile(py::module_& module) {
  py::class_<pile::Work>(module, "Settling", "A pile that settles beside its caller; what start_settling returns.")
      .def_property_readonly("share", &pile::Work::share, "How far it is, 0 to 1.")
      .def_property_readonly("done", &pile::Work::done)
      .def("cancel", &pile::Work::cancel, "Ends it soon; result() then raises Error.")
      .def("result", &result_of, "Waits; what settle returns. Raises Error.");
  const auto define = [&module](const char* name, auto function, const char* text) {
    module.def(name, function, py::arg("radii"), py::arg("shapes") = std::vector<std::uint32_t>(),
               py::arg("meshes") = std::vector<Arrays>(), py::arg("walls") = py::none(),
               py::arg("surface") = py::none(), py::arg("floor") = 0.0, py::arg("friction") = 0.5, py::arg("seed") = 0,
               py::arg("inside") = false, text);
  };
  define("start_settling", &start_settling, "As settle, without waiting: a Settling.");
  define(
      "settle", &settle,
      "((n, 3) float64, (n, 4) float64, largest overlap, (n,) uint32): where grains of these radii lie after they "
      "fell, z up, and how they are turned, as quaternions (w, x, y, z); the overlap in radii of the smaller grain; "
      "last, which of the grains these are. shapes: which of meshes each has, closed and as large as the unit sphere, "
      "(vertices, triangles) each; without meshes they are "
      "balls. walls: (x, y), how far apart upright walls around the origin are; None lets the pile run out. surface: "
      "(vertices, triangles) of what they fall on or into. floor: the height of the plane below it all. inside: "
      "they begin in the room that the surface encloses, as many as fit, and the others are left out. Raises Error.");
}

}  // namespace mesograin::python
