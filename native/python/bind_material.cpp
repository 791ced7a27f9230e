// Materials for Python: the schema's parameters by their names, checked on the way in.
#include <fmt/ranges.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "python/bindings.h"
#include "scene/material.h"

namespace py = pybind11;

namespace mesograin::python {
namespace {

using scene::Material;
using scene::Parameter;

// What Python sees of each type of parameter.
double to_python(double value) { return value; }
bool to_python(bool value) { return value; }
std::array<double, 3> to_python(const glm::dvec3& value) { return {value.x, value.y, value.z}; }
template <typename Choice>
std::string_view to_python(Choice value) {
  return scene::name_of(value);
}

template <typename Value>
Value cast(const Parameter& parameter, const py::handle& given, const char* need) {
  try {
    return given.cast<Value>();
  } catch (const py::cast_error&) {
    throw Error("{} must be {}; got {}.", parameter.name, need, py::repr(given).cast<std::string>());
  }
}

void take(const Parameter& parameter, const py::handle& given, double& value) {
  value = cast<double>(parameter, given, "a number");
}
void take(const Parameter& parameter, const py::handle& given, bool& value) {
  value = cast<bool>(parameter, given, "True or False");
}
void take(const Parameter& parameter, const py::handle& given, glm::dvec3& value) {
  const auto triple = cast<std::array<double, 3>>(parameter, given, "three numbers");
  value = {triple[0], triple[1], triple[2]};
}
template <typename Choice>
void take(const Parameter& parameter, const py::handle& given, Choice& value) {
  value = scene::parse_choice<Choice>(cast<std::string>(parameter, given, "a name"));
}

Material make_material(const py::kwargs& given) {
  Material material;
  std::vector<std::string_view> names;
  std::size_t taken = 0;
  scene::for_each_parameter([&](const Parameter& parameter, auto member) {
    names.push_back(parameter.name);
    const py::str name(parameter.name.data(), parameter.name.size());
    if (!given.contains(name)) return;
    take(parameter, given[name], material.*member);
    ++taken;
  });
  names.emplace_back("finish");
  if (given.contains("finish")) {
    material.finish = given["finish"].cast<std::optional<scene::Finish>>();
    ++taken;
  }
  if (taken < given.size())
    for (const auto& [name, value] : given)
      if (const auto text = name.cast<std::string>(); std::find(names.begin(), names.end(), text) == names.end())
        throw Error("A material takes {}; got '{}'.", fmt::join(names, ", "), text);
  validate(material);
  return material;
}

std::string describe_parameters() {
  std::string text = "Parameters, by name:\n";
  scene::for_each_parameter([&](const Parameter& parameter, auto member) {
    const std::string standard = py::str(py::repr(py::cast(to_python(Material{}.*member))));
    text += fmt::format("\n{}={}: {}.", parameter.name, standard, parameter.sentence);
  });
  return text +
         "\nfinish=None: a Finish, of an opaque surface that is more than its model.\n\nRaises Error naming the "
         "parameter, what came and what is allowed.";
}

}  // namespace

void bind_material(py::module_& module) {
  bind_finish(module);
  const std::string parameters = describe_parameters();
  py::class_<Material> material(module, "Material",
                                "A grain's material, read-only. sigma_a and sigma_s are per scene unit, linear RGB.");
  material.def(py::init(&make_material), parameters.c_str());
  scene::for_each_parameter([&](const Parameter& parameter, auto member) {
    material.def_property_readonly(
        parameter.name.data(), [member](const Material& self) { return to_python(self.*member); },
        std::string(parameter.sentence).c_str());
  });
  material.def_property_readonly(
      "finish", [](const Material& self) { return self.finish; }, "The Finish, or None.");
  material.def(
      "__eq__", [](const Material& a, const Material& b) { return a == b; }, py::is_operator());
  module.def(
      "schema", [] { return py::module_::import("json").attr("loads")(std::string(scene::grain_schema)); },
      "The parameters and the models that this module was built with, as a dict: addon/mesograin/schema/grain.json.");
}

}  // namespace mesograin::python
