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

using Corners = std::pair<std::pair<double, double>, std::pair<double, double>>;

pile::Ground to_ground(const std::optional<Array<double>>& heights, const std::optional<Corners>& corners) {
  pile::Ground ground;
  if (!heights) return ground;
  if (heights->ndim() != 2 || heights->shape(0) < 2 || heights->shape(1) < 2 || !corners)
    throw Error("heights must have shape (rows, columns), at least 2 of each, and come with their corners.");
  ground.heights.assign(heights->data(), heights->data() + heights->size());
  ground.columns = static_cast<std::size_t>(heights->shape(1));
  const auto& [lower, upper] = *corners;
  ground.lower = {lower.first, lower.second};
  ground.step = {(upper.first - lower.first) / static_cast<double>(heights->shape(1) - 1),
                 (upper.second - lower.second) / static_cast<double>(heights->shape(0) - 1)};
  if (!(ground.step.x > 0.0 && ground.step.y > 0.0))
    throw Error("The corners of the heights must be the lower and the upper one.");
  return ground;
}

py::tuple to_tuple(const pile::Pile& found) {
  Array<double> middles({found.middles.size(), std::size_t{3}});
  for (std::size_t i = 0; i < found.middles.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) middles.mutable_at(i, axis) = found.middles[i][axis];
  return py::make_tuple(middles, found.largest_overlap);
}

std::unique_ptr<pile::Work> start_settling(std::vector<double> radii,
                                           const std::optional<std::pair<double, double>>& walls,
                                           const std::optional<Array<double>>& heights,
                                           const std::optional<Corners>& corners, double friction, std::uint64_t seed) {
  pile::Walls held;
  if (walls) held.half = {0.5 * walls->first, 0.5 * walls->second};
  return std::make_unique<pile::Work>(std::move(radii), to_ground(heights, corners), held, friction, seed);
}

py::tuple result_of(pile::Work& work) {
  const auto found = [&] {
    const py::gil_scoped_release release;
    return work.result();
  }();
  return to_tuple(found);
}

py::tuple settle(std::vector<double> radii, const std::optional<std::pair<double, double>>& walls,
                 const std::optional<Array<double>>& heights, const std::optional<Corners>& corners, double friction,
                 std::uint64_t seed) {
  return result_of(*start_settling(std::move(radii), walls, heights, corners, friction, seed));
}

}  // namespace

void bind_pile(py::module_& module) {
  py::class_<pile::Work>(module, "Settling", "A pile that settles beside its caller; what start_settling returns.")
      .def_property_readonly("share", &pile::Work::share, "How far it is, 0 to 1.")
      .def_property_readonly("done", &pile::Work::done)
      .def("cancel", &pile::Work::cancel, "Ends it soon; result() then raises Error.")
      .def("result", &result_of, "Waits; what settle returns. Raises Error.");
  module.def("start_settling", &start_settling, py::arg("radii"), py::arg("walls") = py::none(),
             py::arg("heights") = py::none(), py::arg("corners") = py::none(), py::arg("friction") = 0.5,
             py::arg("seed") = 0, "As settle, without waiting: a Settling.");
  module.def(
      "settle", &settle, py::arg("radii"), py::arg("walls") = py::none(), py::arg("heights") = py::none(),
      py::arg("corners") = py::none(), py::arg("friction") = 0.5, py::arg("seed") = 0,
      "((n, 3) float64, largest overlap): where balls of these radii lie after they fell on the ground, z up; the "
      "overlap in radii of the smaller ball. walls: (x, y), how far apart upright walls around the origin are; "
      "None lets the pile run out. heights: (rows, columns) float64 of the ground, a row for each y, between "
      "corners ((x, y), (x, y)); None is the plane z = 0. Raises Error.");
}

}  // namespace mesograin::python
