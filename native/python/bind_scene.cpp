// Scene structs for Python: arrays are copied in, parameters are checked on the way.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <glm/gtc/type_ptr.hpp>
#include <optional>
#include <string>
#include <vector>

#include "python/bindings.h"
#include "scene/camera.h"
#include "scene/error.h"
#include "scene/scene.h"

namespace py = pybind11;

namespace mesograin::python {
namespace {

using Triple = std::array<double, 3>;
template <typename Number>
using Array = py::array_t<Number, py::array::c_style | py::array::forcecast>;

glm::dvec3 to_vector(const Triple& triple) { return {triple[0], triple[1], triple[2]}; }
Triple to_triple(const glm::dvec3& vector) { return {vector.x, vector.y, vector.z}; }

template <typename Vector, typename Number>
std::vector<Vector> to_vectors(const Array<Number>& array, const char* name) {
  constexpr auto columns = static_cast<py::ssize_t>(Vector::length());
  if (array.ndim() != 2 || array.shape(1) != columns) {
    std::string shape;
    for (py::ssize_t axis = 0; axis < array.ndim(); ++axis)
      shape += (axis > 0 ? ", " : "") + std::to_string(array.shape(axis));
    throw Error("{} must have shape (n, {}); got ({}).", name, columns, shape);
  }
  const auto* first = reinterpret_cast<const Vector*>(array.data());
  return {first, first + array.shape(0)};
}

glm::dmat4 to_matrix(const Array<double>& array, const char* name) {
  if (array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4) throw Error("{} must be a 4 x 4 matrix.", name);
  return glm::transpose(glm::make_mat4(array.data()));  // numpy's rows are GLM's columns
}

Array<double> to_array(const glm::dmat4& matrix) {
  Array<double> array({4, 4});
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) array.mutable_at(row, column) = matrix[column][row];
  return array;
}

scene::Mesh make_mesh(const Array<float>& positions, const std::optional<Array<float>>& normals,
                      const Array<std::uint32_t>& indices, const std::optional<Array<float>>& uvs) {
  return {to_vectors<glm::vec3>(positions, "positions"),
          normals ? to_vectors<glm::vec3>(*normals, "normals") : std::vector<glm::vec3>{},
          to_vectors<glm::uvec3>(indices, "indices"),
          uvs ? to_vectors<glm::vec2>(*uvs, "uvs") : std::vector<glm::vec2>{}};
}

scene::Material make_material(const std::string& model, const Triple& reflectance, const Triple& sigma_a,
                              const Triple& sigma_s, double g, double eta, double roughness, double scale,
                              bool specular, const std::string& boundary, const std::string& masking,
                              const std::string& profile) {
  scene::Material material;
  material.model = scene::parse_model(model);
  material.reflectance = to_vector(reflectance);
  material.sigma_a = to_vector(sigma_a);
  material.sigma_s = to_vector(sigma_s);
  material.g = g;
  material.eta = eta;
  material.roughness = roughness;
  material.scale = scale;
  material.specular = specular;
  material.boundary = scene::parse_boundary(boundary);
  material.masking = scene::parse_masking(masking);
  material.profile = scene::parse_profile(profile);
  validate(material);
  return material;
}

void bind_material(py::module_& module) {
  const scene::Material standard;
  py::class_<scene::Material>(
      module, "Material",
      "A grain's material, read-only. sigma_a and sigma_s are per scene unit, linear RGB; scale "
      "multiplies both; roughness is the GGX alpha; specular shows what a dielectric boundary reflects.")
      .def(py::init(&make_material), py::kw_only(), py::arg("model") = "lambert",
           py::arg("reflectance") = to_triple(standard.reflectance), py::arg("sigma_a") = to_triple(standard.sigma_a),
           py::arg("sigma_s") = to_triple(standard.sigma_s), py::arg("g") = standard.g, py::arg("eta") = standard.eta,
           py::arg("roughness") = standard.roughness, py::arg("scale") = standard.scale,
           py::arg("specular") = standard.specular, py::arg("boundary") = "dielectric",
           py::arg("masking") = "correlated", py::arg("profile") = "half_space",
           "Raises Error naming the parameter, what came and what is allowed.")
      .def_property_readonly(
          "model", [](const scene::Material& m) { return scene::model_names[static_cast<std::size_t>(m.model)]; })
      .def_property_readonly("reflectance", [](const scene::Material& m) { return to_triple(m.reflectance); })
      .def_property_readonly("sigma_a", [](const scene::Material& m) { return to_triple(m.sigma_a); })
      .def_property_readonly("sigma_s", [](const scene::Material& m) { return to_triple(m.sigma_s); })
      .def_readonly("g", &scene::Material::g)
      .def_readonly("eta", &scene::Material::eta)
      .def_readonly("roughness", &scene::Material::roughness)
      .def_readonly("scale", &scene::Material::scale)
      .def_readonly("specular", &scene::Material::specular)
      .def_property_readonly(
          "boundary",
          [](const scene::Material& m) { return scene::boundary_names[static_cast<std::size_t>(m.boundary)]; })
      .def_property_readonly(
          "masking", [](const scene::Material& m) { return scene::masking_names[static_cast<std::size_t>(m.masking)]; })
      .def_property_readonly(
          "profile", [](const scene::Material& m) { return scene::profile_names[static_cast<std::size_t>(m.profile)]; })
      .def(
          "__eq__", [](const scene::Material& a, const scene::Material& b) { return a == b; }, py::is_operator());
}

void bind_mesh_and_instance(py::module_& module) {
  py::class_<scene::Mesh, std::shared_ptr<scene::Mesh>>(
      module, "Mesh", "A triangle mesh. Its arrays are copied and never change, so it is sent to the device only once.")
      .def(
          py::init(&make_mesh), py::arg("positions"), py::arg("normals").none(true), py::arg("indices"),
          py::arg("uvs") = py::none(),
          "positions (n, 3) float32; normals (n, 3) float32, or None for smooth ones; indices (t, 3) uint32, "
          "counter-clockwise seen from outside; uvs (n, 2) float32 or None. Raises Error for arrays that make no mesh.")
      .def_property_readonly("vertex_count", [](const scene::Mesh& mesh) { return mesh.positions().size(); })
      .def_property_readonly("has_uvs", [](const scene::Mesh& mesh) { return !mesh.uvs().empty(); })
      .def_property_readonly("triangle_count", [](const scene::Mesh& mesh) { return mesh.triangles().size(); });

  py::class_<scene::Instance>(module, "Instance", "A mesh with its material at its place in the world.")
      .def(py::init([](std::shared_ptr<scene::Mesh> mesh, const scene::Material& material,
                       const std::optional<Array<double>>& transform) {
             return scene::Instance{std::move(mesh), material,
                                    transform ? to_matrix(*transform, "transform") : glm::dmat4(1.0)};
           }),
           py::arg("mesh").none(false), py::arg("material"), py::arg("transform") = py::none(),
           "transform: (4, 4) float64, object to world; None is the identity.")
      .def_readonly("material", &scene::Instance::material)
      .def_property_readonly("transform", [](const scene::Instance& i) { return to_array(i.object_to_world); });
}

void bind_light_and_camera(py::module_& module) {
  py::class_<scene::DirectionalLight>(module, "DirectionalLight", "A sun.")
      .def(
          py::init([](const Triple& direction_to_light, const Triple& irradiance, double angle) {
            scene::DirectionalLight light{to_vector(direction_to_light), to_vector(irradiance), angle};
            validate(light);
            return light;
          }),
          py::arg("direction_to_light"), py::arg("irradiance"), py::arg("angle") = 0.0,
          "direction_to_light: world space, any length; irradiance: linear RGB on a plane that faces the light; angle: "
          "of the sun's disc, edge to edge, radians.")
      .def_property_readonly("direction_to_light",
                             [](const scene::DirectionalLight& l) { return to_triple(l.direction_to_light); })
      .def_property_readonly("irradiance", [](const scene::DirectionalLight& l) { return to_triple(l.irradiance); })
      .def_readonly("angle", &scene::DirectionalLight::angle);

  py::class_<scene::Camera>(module, "Camera", "Two matrices: perspective, orthographic, shifted, all the same.")
      .def(py::init([](const Array<double>& world_to_camera, const Array<double>& camera_to_clip) {
             scene::Camera camera{to_matrix(world_to_camera, "world_to_camera"),
                                  to_matrix(camera_to_clip, "camera_to_clip")};
             validate(camera);
             return camera;
           }),
           py::arg("world_to_camera"), py::arg("camera_to_clip"),
           "Both (4, 4) float64; camera space looks along -z with y up, clip space is OpenGL's.")
      .def_static(
          "look_at",
          [](const Triple& position, const Triple& look_at, const Triple& up, double fov_degrees, double aspect,
             double near_plane, double far_plane) {
            return scene::Camera::look_at(to_vector(position), to_vector(look_at), to_vector(up), fov_degrees, aspect,
                                          near_plane, far_plane);
          },
          py::arg("position"), py::arg("look_at"), py::arg("up"), py::arg("fov_degrees"), py::arg("aspect") = 1.0,
          py::arg("near_plane") = 0.0, py::arg("far_plane") = 0.0,
          "A pinhole; fov_degrees spans the shorter side; planes of 0 stand for the distance to look_at / 100 and x "
          "100.")
      .def_property_readonly("world_to_camera", [](const scene::Camera& c) { return to_array(c.world_to_camera); })
      .def_property_readonly("camera_to_clip", [](const scene::Camera& c) { return to_array(c.camera_to_clip); })
      .def(
          "__eq__", [](const scene::Camera& a, const scene::Camera& b) { return a == b; }, py::is_operator());
}

}  // namespace

void bind_scene(py::module_& module) {
  bind_material(module);
  bind_mesh_and_instance(module);
  bind_light_and_camera(module);
  py::class_<scene::Scene>(module, "Scene", "Instances and lights.")
      .def(py::init([](std::vector<scene::Instance> instances, std::vector<scene::DirectionalLight> lights) {
             scene::Scene scene{std::move(instances), std::move(lights)};
             validate(scene);
             return scene;
           }),
           py::kw_only(), py::arg("instances") = std::vector<scene::Instance>{},
           py::arg("lights") = std::vector<scene::DirectionalLight>{},
           "Raises Error for a transform that cannot be inverted.")
      .def_readonly("instances", &scene::Scene::instances)
      .def_readonly("lights", &scene::Scene::lights);
}

}  // namespace mesograin::python
