// Scenes from JSON for Python: a file, its text, or the dict that json.loads makes of it.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "base/error.h"
#include "io/scene_json.h"
#include "python/bindings.h"

namespace py = pybind11;

namespace mesograin::python {
namespace {

io::SceneFile read(const py::object& source, const io::SceneChoices& choices) {
  std::string text;
  if (py::isinstance<py::dict>(source))
    text = py::module_::import("json").attr("dumps")(source).cast<std::string>();
  else if (py::isinstance<py::str>(source))
    text = source.cast<std::string>();

  const std::size_t start = text.find_first_not_of(" \t\r\n");
  const bool is_json = start != std::string::npos && text[start] == '{';
  if (!is_json) {
    const auto path = source.cast<std::filesystem::path>();
    const py::gil_scoped_release release;
    return io::read_scene(path, choices);
  }
  const py::gil_scoped_release release;
  try {
    return io::parse_scene(text, {}, choices);
  } catch (const Error& error) {
    throw Error("Can't use the scene: {}", error.what());
  }
}

py::tuple load_scene(const py::object& source, const std::optional<std::string>& model,
                     const std::optional<std::pair<int, int>>& size) {
  io::SceneChoices choices;
  if (model) io::choose_model(choices, *model);
  if (size) {
    choices.width = size->first;
    choices.height = size->second;
    require_size(choices);
  }
  io::SceneFile file = read(source, choices);
  return py::make_tuple(std::move(file.scene), file.camera, py::make_tuple(file.width, file.height));
}

void write_scene(const std::filesystem::path& path, const scene::Scene& scene, const scene::Camera& camera,
                 const std::pair<int, int>& size) {
  const io::SceneChoices choices{.model = std::nullopt, .width = size.first, .height = size.second};
  require_size(choices);
  const py::gil_scoped_release release;
  io::write_scene(path, {scene, camera, choices.width, choices.height, {}});
}

}  // namespace

void bind_scene_file(py::module_& module) {
  module.def("write_scene", &write_scene, py::arg("path"), py::arg("scene"), py::arg("camera"), py::arg("size"),
             "Writes a scene that load_scene reads as it is: JSON at `path`, beside it meshes in PLY, arrays of "
             "instances in NPY and the world's image in EXR. Raises Error if a file can't be written.");
  module.def("load_scene", &load_scene, py::arg("source"), py::arg("model") = py::none(), py::arg("size") = py::none(),
             "(Scene, Camera, (width, height)) from a scene in JSON: a path, the text itself, or a dict of the same "
             "form (docs/scene-json.md); of text and dicts, files are looked for in the current folder. `model` "
             "answers the material instead of the best one for its kind, and \"auto\" is what `advise` says of each "
             "translucent object; `size` is (width, height) instead of the scene's resolution. Raises Error naming the "
             "key, what is needed and what came.");
}

}  // namespace mesograin::python
