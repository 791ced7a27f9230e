// Which parts of the native rooms reach Python; one file each.
#pragma once

#include <pybind11/pybind11.h>

namespace mesograin::python {

void bind_finish(pybind11::module_& module);
void bind_image(pybind11::module_& module);
void bind_lights(pybind11::module_& module);
void bind_material(pybind11::module_& module);
void bind_pile(pybind11::module_& module);
void bind_physics(pybind11::module_& module);
void bind_rounds(pybind11::module_& module);
void bind_scene(pybind11::module_& module);
void bind_scene_file(pybind11::module_& module);
void bind_view(pybind11::module_& module);

}  // namespace mesograin::python
