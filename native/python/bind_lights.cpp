// Lights of every kind and the world for Python.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <glm/gtc/type_ptr.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "lights/world_light.h"
#include "python/bindings.h"
#include "python/vectors.h"
#include "scene/light.h"
#include "scene/world.h"

namespace py = pybind11;

namespace mesograin::python {
namespace {

scene::LightShape parse_shape(const std::string& name) {
  if (name == "disc") return scene::LightShape::disc;
  if (name == "sphere") return scene::LightShape::sphere;
  throw Error("A light's shape must be one of disc, sphere; got '{}'.", name);
}

const char* name_of(scene::LightShape shape) { return shape == scene::LightShape::disc ? "disc" : "sphere"; }

template <typename Light>
Light validated(Light light) {
  validate(light);
  return light;
}

void bind_directional(py::module_& module) {
  using scene::DirectionalLight;
  py::class_<DirectionalLight>(module, "DirectionalLight", "A sun.")
      .def(
          py::init([](const Triple& direction_to_light, const Triple& irradiance, double angle, bool flat) {
            return validated(DirectionalLight{to_vector(direction_to_light), to_vector(irradiance), angle, flat});
          }),
          py::arg("direction_to_light"), py::arg("irradiance"), py::arg("angle") = 0.0, py::arg("flat") = false,
          "direction_to_light: world space, any length; irradiance: linear RGB on a plane that faces the light; angle: "
          "of the sun's disc, edge to edge, radians; flat: a disc that stands across, brighter towards its rim, as "
          "Cycles has it before Blender 4, else as bright all over.")
      .def_property_readonly("direction_to_light",
                             [](const DirectionalLight& l) { return to_triple(l.direction_to_light); })
      .def_property_readonly("irradiance", [](const DirectionalLight& l) { return to_triple(l.irradiance); })
      .def_readonly("angle", &DirectionalLight::angle)
      .def_readonly("flat", &DirectionalLight::flat);
}

void bind_point(py::module_& module) {
  using scene::PointLight;
  py::class_<PointLight>(module, "PointLight", "A light at a place: a point, or a ball of light.")
      .def(
          py::init([](const Triple& position, const Triple& radiant_intensity, double radius,
                      const std::string& shape) {
            return validated(PointLight{to_vector(position), to_vector(radiant_intensity), radius, parse_shape(shape)});
          }),
          py::arg("position"), py::arg("radiant_intensity"), py::arg("radius") = 0.0, py::arg("shape") = "disc",
          "position: world space; radiant_intensity: linear RGB, W/sr; radius: scene units; shape: disc, one that "
          "faces whatever it lights, or sphere.")
      .def_property_readonly("position", [](const PointLight& l) { return to_triple(l.position); })
      .def_property_readonly("radiant_intensity", [](const PointLight& l) { return to_triple(l.radiant_intensity); })
      .def_readonly("radius", &PointLight::radius)
      .def_property_readonly("shape", [](const PointLight& l) { return name_of(l.shape); });
}

void bind_spot(py::module_& module) {
  using scene::SpotLight;
  py::class_<SpotLight>(module, "SpotLight", "A point light of which only a cone is seen.")
      .def(
          py::init([](const Triple& position, const Triple& axis, const Triple& radiant_intensity, double radius,
                      const std::string& shape, double angle, double blend, bool cosine, const Triple& wide_x,
                      const Triple& wide_y) {
            return validated(SpotLight{to_vector(position), to_vector(axis), to_vector(radiant_intensity), radius,
                                       parse_shape(shape), angle, blend, cosine, to_vector(wide_x), to_vector(wide_y)});
          }),
          py::arg("position"), py::arg("axis"), py::arg("radiant_intensity"), py::arg("radius") = 0.0,
          py::arg("shape") = "disc", py::arg("angle") = 1.0, py::arg("blend") = 0.0, py::arg("cosine") = false,
          py::arg("wide_x") = Triple{}, py::arg("wide_y") = Triple{},
          "As PointLight; axis: in which it shines; angle: of the cone, edge to edge, radians; blend: the share of it "
          "that is its soft edge; cosine: weakens with the cosine from the axis; wide_x, wide_y: cross-section of a "
          "cone that is not round.")
      .def_property_readonly("position", [](const SpotLight& l) { return to_triple(l.position); })
      .def_property_readonly("axis", [](const SpotLight& l) { return to_triple(l.axis); })
      .def_property_readonly("radiant_intensity", [](const SpotLight& l) { return to_triple(l.radiant_intensity); })
      .def_readonly("radius", &SpotLight::radius)
      .def_property_readonly("shape", [](const SpotLight& l) { return name_of(l.shape); })
      .def_readonly("angle", &SpotLight::angle)
      .def_readonly("blend", &SpotLight::blend)
      .def_readonly("cosine", &SpotLight::cosine);
}

void bind_area(py::module_& module) {
  using scene::AreaLight;
  py::class_<AreaLight>(module, "AreaLight", "A flat light of one bright side.")
      .def(
          py::init([](const Triple& position, const Triple& half_x, const Triple& half_y, const Triple& radiance,
                      bool ellipse, double spread, bool drawn) {
            return validated(AreaLight{to_vector(position), to_vector(half_x), to_vector(half_y), to_vector(radiance),
                                       ellipse, spread, drawn});
          }),
          py::arg("position"), py::arg("half_x"), py::arg("half_y"), py::arg("radiance"), py::arg("ellipse") = false,
          py::arg("spread") = scene::AreaLight{}.spread, py::arg("drawn") = false,
          "position: its middle; half_x, half_y: from there to the middle of its sides, or half the ellipse's axes; it "
          "shines along -cross(half_x, half_y); radiance: linear RGB; spread: full angle of the cone that it shines "
          "into, radians; drawn: it stands for a surface of the scene, which is seen where it is.")
      .def_property_readonly("position", [](const AreaLight& l) { return to_triple(l.position); })
      .def_property_readonly("half_x", [](const AreaLight& l) { return to_triple(l.half_x); })
      .def_property_readonly("half_y", [](const AreaLight& l) { return to_triple(l.half_y); })
      .def_property_readonly("radiance", [](const AreaLight& l) { return to_triple(l.radiance); })
      .def_readonly("ellipse", &AreaLight::ellipse)
      .def_readonly("spread", &AreaLight::spread)
      .def_readonly("drawn", &AreaLight::drawn);
}

using Surroundings = scene::Surroundings;

std::shared_ptr<Surroundings> make_surroundings(const Array<float>& pixels) {
  if (pixels.ndim() != 3 || pixels.shape(2) != 3 || pixels.shape(0) > 1 << 16 || pixels.shape(1) > 1 << 16)
    throw Error("A world's image must have shape (h, w, 3), 65536 pixels a side at most.");
  const auto* first = reinterpret_cast<const glm::vec3*>(pixels.data());
  std::vector<glm::vec3> texels(first, first + pixels.shape(0) * pixels.shape(1));
  return std::make_shared<Surroundings>(static_cast<int>(pixels.shape(1)), static_cast<int>(pixels.shape(0)),
                                        std::move(texels));
}

// rotation: (3, 3), row by row, or nothing.
glm::dmat3 to_rotation(const std::optional<Array<double>>& rotation) {
  if (!rotation) return glm::dmat3(1.0);
  if (rotation->ndim() != 2 || rotation->shape(0) != 3 || rotation->shape(1) != 3)
    throw Error("rotation must be a 3 x 3 matrix.");
  return glm::transpose(glm::make_mat3(rotation->data()));
}

void bind_world(py::module_& module) {
  py::class_<Surroundings, std::shared_ptr<Surroundings>>(
      module, "Surroundings", "A picture of all directions, copied and immutable, for as many worlds as need it.")
      .def(
          py::init(&make_surroundings), py::arg("pixels"),
          "(h, w, 3) float32, linear RGB, row 0 at the top: z is up, the middle column looks along +x and +y lies left "
          "of it.")
      .def_property_readonly("size", [](const Surroundings& s) { return std::pair(s.width(), s.height()); });

  py::class_<scene::Backdrop>(module, "Backdrop", "What the camera sees in the place of a world, and nothing else.")
      .def(py::init([](const Triple& radiance, std::shared_ptr<Surroundings> image,
                       const std::optional<Array<double>>& rotation) {
             return scene::Backdrop{to_vector(radiance), std::move(image), to_rotation(rotation)};
           }),
           py::arg("radiance") = Triple{1.0, 1.0, 1.0}, py::arg("image") = py::none(), py::arg("rotation") = py::none(),
           "As a World's.");

  py::class_<scene::World>(module, "World", "What is all around the scene.")
      .def(py::init([](const Triple& radiance, std::shared_ptr<Surroundings> image,
                       const std::optional<Array<double>>& rotation, bool seen,
                       const std::optional<scene::Backdrop>& backdrop, bool film_transparent) {
             return validated(scene::World{to_vector(radiance), std::move(image), to_rotation(rotation), seen, backdrop,
                                           film_transparent});
           }),
           py::arg("radiance") = Triple{1.0, 1.0, 1.0}, py::arg("image") = py::none(), py::arg("rotation") = py::none(),
           py::arg("seen") = false, py::arg("backdrop") = py::none(), py::arg("film_transparent") = false,
           "radiance: linear RGB, multiplies the image, a Surroundings; rotation: (3, 3), from the world's directions "
           "to "
           "the image's; seen: behind the grains, else the picture is transparent there; backdrop: what is seen "
           "instead, a Backdrop; film_transparent: where grains that do not refract show the world, the picture is "
           "transparent as well, and alpha is no longer coverage.")
      .def_property_readonly("radiance", [](const scene::World& w) { return to_triple(w.radiance); })
      .def_property_readonly("has_image", [](const scene::World& w) { return w.image != nullptr; })
      .def_readonly("seen", &scene::World::seen)
      .def_readonly("film_transparent", &scene::World::film_transparent)
      .def(
          "look",
          [](const scene::World& w, const Triple& direction) {
            return to_triple(lights::radiance(w, to_vector(direction)));
          },
          py::arg("direction"), "Linear RGB that comes from a direction of unit length.");
}

}  // namespace

void bind_lights(py::module_& module) {
  bind_directional(module);
  bind_point(module);
  bind_spot(module);
  bind_area(module);
  bind_world(module);
}

}  // namespace mesograin::python
