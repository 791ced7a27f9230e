// The Python module mesograin_native: errors, version, and what the other files of this room bind.
#include <pybind11/pybind11.h>

#include "base/error.h"
#include "gl/context_thread.h"
#include "python/bindings.h"

namespace py = pybind11;

PYBIND11_MODULE(mesograin_native, module) {
  module.doc() = "Mesograin's renderer: scenes in, linear float32 images out. Works with and without Blender.";
  module.attr("__version__") = MESOGRAIN_VERSION;
  py::register_exception<mesograin::Error>(module, "Error", PyExc_RuntimeError).doc() =
      "What a user can cause: one sentence with what was needed, what came and what to do.";

  mesograin::python::bind_image(module);
  mesograin::python::bind_material(module);
  mesograin::python::bind_scene(module);
  mesograin::python::bind_physics(module);
  mesograin::python::bind_pile(module);
  mesograin::python::bind_scene_file(module);
  mesograin::python::bind_view(module);
  mesograin::python::bind_rounds(module);

  // The driver must be left in order before the interpreter unloads it.
  py::module_::import("atexit").attr("register")(py::cpp_function([] {
    const py::gil_scoped_release release;
    mesograin::gl::ContextThread::shut_down();
  }));
}
