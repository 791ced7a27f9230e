// Scene structs for Python: arrays are copied in, parameters are checked on the way.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "python/bindings.h"
#include "python/vectors.h"
#include "scene/advice.h"
#include "scene/bodies.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace py = pybind11;

namespace mesograin::python {
namespace {

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

Array<double> to_array(const glm::dmat4& matrix) {
  Array<double> array({4, 4});
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) array.mutable_at(row, column) = matrix[column][row];
  return array;
}

template <typename Number, typename Vector>
Array<Number> to_rows(const std::vector<Vector>& vectors) {
  Array<Number> array({static_cast<py::ssize_t>(vectors.size()), static_cast<py::ssize_t>(Vector::length())});
  std::copy(vectors.begin(), vectors.end(), reinterpret_cast<Vector*>(array.mutable_data()));
  return array;
}

scene::Mesh make_mesh(const Array<float>& positions, const std::optional<Array<float>>& normals,
                      const Array<std::uint32_t>& indices, const std::optional<Array<float>>& uvs) {
  return {to_vectors<glm::vec3>(positions, "positions"),
          normals ? to_vectors<glm::vec3>(*normals, "normals") : std::vector<glm::vec3>{},
          to_vectors<glm::uvec3>(indices, "indices"),
          uvs ? to_vectors<glm::vec2>(*uvs, "uvs") : std::vector<glm::vec2>{}};
}

// Python's meshes cannot be changed either.
template <typename Drawn>
std::shared_ptr<scene::Mesh> mesh_of(const Drawn& drawn) {
  return std::const_pointer_cast<scene::Mesh>(drawn.mesh);
}

template <typename Number>
std::span<const Number> numbers_of(const Array<Number>& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

template <typename Number, typename Matrices>
Array<Number> to_array_of_matrices(const Matrices& matrices) {
  Array<Number> array({matrices.size(), std::size_t{4}, std::size_t{4}});
  Number* number = array.mutable_data();
  for (const glm::dmat4& matrix : matrices)
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) *number++ = static_cast<Number>(matrix[column][row]);
  return array;
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
      .def_property_readonly("triangle_count", [](const scene::Mesh& mesh) { return mesh.triangles().size(); })
      .def(
          "arrays",
          [](const scene::Mesh& mesh) {
            return py::make_tuple(to_rows<float>(mesh.positions()), to_rows<float>(mesh.uvs()),
                                  to_rows<std::uint32_t>(mesh.triangles()));
          },
          "Copies of its positions (n, 3), UVs (n, 2), or (0, 2) if it has none, and indices (t, 3).")
      .def(
          "bodies",
          [](const scene::Mesh& mesh, const Array<std::uint32_t>& vertices, bool copies) {
            std::vector<std::pair<std::shared_ptr<scene::Mesh>, Array<double>>> found;
            for (const scene::Bodies& each : scene::bodies_of(mesh, numbers_of(vertices), copies))
              found.emplace_back(mesh_of(each), to_array_of_matrices<double>(each.placings));
            return found;
          },
          py::arg("vertices"), py::arg("copies") = true,
          "[(Mesh, (m, 4, 4) float64)] of a mesh of many grains: each closed surface, facing outwards, and where it "
          "stands in the whole; none if there are fewer than two, unless it is one that is inside out. What is open "
          "comes last, as one; cavities belong to what is around them. "
          "vertices: (n,) uint32, for each position the number of its vertex; surfaces that touch share none. copies: "
          "whether copies of one body are placings of it; else each has a mesh in its own place. Raises Error unless "
          "there are as many vertices as positions.");

  py::class_<scene::Instance>(module, "Instance", "A mesh with its material at its place in the world.")
      .def(py::init([](std::shared_ptr<scene::Mesh> mesh, const scene::Material& material,
                       const std::optional<Array<double>>& transform, std::optional<std::uint32_t> object) {
             return scene::Instance{std::move(mesh), material,
                                    transform ? to_matrix(*transform, "transform") : glm::dmat4(1.0), object};
           }),
           py::arg("mesh").none(false), py::arg("material"), py::arg("transform") = py::none(),
           py::arg("object") = py::none(),
           "transform: (4, 4) float64, object to world; None is the identity. object: a number; instances of the same "
           "one are parts of one object, whose surfaces go on into each other. None is an object of its own.")
      .def_property_readonly("mesh", &mesh_of<scene::Instance>)
      .def_readonly("material", &scene::Instance::material)
      .def_property_readonly("transform", [](const scene::Instance& i) { return to_array(i.object_to_world); })
      .def_readonly("object", &scene::Instance::object);
}

void bind_advice(py::module_& module) {
  module.def(
      "shape_of",
      [](const scene::Mesh& mesh, const std::optional<Array<double>>& transform) {
        const glm::dmat4 matrix = transform ? to_matrix(*transform, "transform") : glm::dmat4(1.0);
        const scene::Shape shape = scene::shape_of(mesh, glm::dmat3(matrix));
        return py::make_tuple(shape.volume, shape.area, shape.closed);
      },
      py::arg("mesh"), py::arg("transform") = py::none(),
      "(volume, area, whether it is closed) of a mesh as a transform, (4, 4) float64, has it.");
  module.def(
      "advise",
      [](const scene::Material& material, double volume, double area, bool closed, double tolerance) {
        scene::Advice advice = scene::advise(material, {volume, area, closed}, tolerance);
        return py::make_tuple(scene::name_of(advice.model), advice.error, std::move(advice.sentence));
      },
      py::arg("material"), py::arg("volume"), py::arg("area"), py::arg("closed"),
      py::arg("tolerance") = scene::automatic::tolerance,
      "(model, its measured error in %, why in a sentence) for a grain of this medium: the cheapest that was measured "
      "to be within a tolerance in % for its size and shape, or the nearest. Lengths are those that sigma_a and "
      "sigma_s "
      "are per.");
}

// Blender's are of single precision: no copy is made of them in double.
scene::Transforms to_transforms(const py::array& array) {
  if (array.ndim() != 3 || array.shape(1) != 4 || array.shape(2) != 4)
    throw Error("transforms must have shape (n, 4, 4); got {} dimensions, the last of {}.", array.ndim(),
                array.ndim() > 0 ? array.shape(array.ndim() - 1) : 0);
  if (py::isinstance<py::array_t<float>>(array)) return scene::Transforms::of_rows(numbers_of(Array<float>(array)));
  return scene::Transforms::of_rows(numbers_of(Array<double>(array)));
}

void bind_transforms(py::module_& module) {
  py::class_<scene::Transforms, std::shared_ptr<scene::Transforms>>(
      module, "Transforms", "Where the instances of arrays stand; scenes share it, so it is held but once.")
      .def(py::init(&to_transforms), py::arg("matrices"),
           "matrices: (n, 4, 4), object to world. Raises Error for another shape, or for a last row that is not 0, 0, "
           "0, 1.")
      .def(
          "matrices",
          [](const scene::Transforms& transforms) -> py::array {
            if (transforms.single_precision()) return to_array_of_matrices<float>(transforms);
            return to_array_of_matrices<double>(transforms);
          },
          "(n, 4, 4), as they were given: float32 where that holds them, else float64.")
      .def("__len__", &scene::Transforms::size)
      .def(
          "__eq__", [](const scene::Transforms& a, const scene::Transforms& b) { return &a == &b || a == b; },
          py::is_operator());
}

using Factors = std::map<std::string, Array<float>>;

scene::ColourFactors to_factors(const Factors& factors) {
  scene::ColourFactors found;
  for (const auto& [name, array] : factors) {
    std::vector<glm::vec3> numbers = to_vectors<glm::vec3>(array, "factors");
    if (name == "sigma_a")
      found.sigma_a = std::move(numbers);
    else if (name == "sigma_s")
      found.sigma_s = std::move(numbers);
    else if (name == "reflectance")
      found.reflectance = std::move(numbers);
    else
      throw Error("Factors are of sigma_a, sigma_s or reflectance; got '{}'.", name);
  }
  return found;
}

Factors from_factors(const scene::InstanceArray& array) {
  Factors factors;
  const auto add = [&](const char* name, const std::vector<glm::vec3>& numbers) {
    if (numbers.empty()) return;
    Array<float> rows({numbers.size(), std::size_t{3}});
    std::copy_n(&numbers.front().x, 3 * numbers.size(), rows.mutable_data());
    factors.emplace(name, std::move(rows));
  };
  add("sigma_a", array.factors().sigma_a);
  add("sigma_s", array.factors().sigma_s);
  add("reflectance", array.factors().reflectance);
  return factors;
}

void bind_instance_array(py::module_& module) {
  py::class_<scene::InstanceArray>(module, "InstanceArray",
                                   "Many instances of one mesh with one material: grains of a heap, a transform each.")
      .def(py::init([](std::shared_ptr<scene::Mesh> mesh, const scene::Material& material,
                       std::shared_ptr<scene::Transforms> transforms, const Factors& factors) {
             return scene::InstanceArray(std::move(mesh), material, std::move(transforms), to_factors(factors));
           }),
           py::arg("mesh").none(false), py::arg("material"), py::arg("transforms").none(false),
           py::arg("factors") = Factors{},
           "transforms: Transforms, which is shared. factors: {parameter: (n, 3) float32} by which each instance's "
           "sigma_a, sigma_s or reflectance is multiplied. Raises Error for another shape.")
      .def(py::init([](std::shared_ptr<scene::Mesh> mesh, const scene::Material& material, const py::array& transforms,
                       const Factors& factors) {
             return scene::InstanceArray(std::move(mesh), material, to_transforms(transforms), to_factors(factors));
           }),
           py::arg("mesh").none(false), py::arg("material"), py::arg("transforms"), py::arg("factors") = Factors{},
           "transforms: (n, 4, 4), as Transforms takes it.")
      .def(
          "with_material",
          [](const scene::InstanceArray& array, const scene::Material& material) {
            scene::InstanceArray other = array;
            other.material = material;
            return other;
          },
          py::arg("material"), "The same instances of another material; nothing is copied.")
      .def_property_readonly("mesh", &mesh_of<scene::InstanceArray>)
      .def_property_readonly("factors", &from_factors)
      .def_readonly("material", &scene::InstanceArray::material)
      .def_property_readonly(
          "transforms",
          [](const scene::InstanceArray& array) { return to_array_of_matrices<double>(array.object_to_world()); })
      .def("__len__", [](const scene::InstanceArray& array) { return array.object_to_world().size(); });
}

void bind_lens(py::module_& module) {
  py::class_<scene::Lens>(module, "Lens", "The opening that a camera looks through: what is out of focus is blurred.")
      .def(py::init([](double aperture_radius, double focus_distance, int blades, double rotation, double ratio) {
             const scene::Lens lens{aperture_radius, focus_distance, blades, rotation, ratio};
             validate(lens);
             return lens;
           }),
           py::arg("aperture_radius"), py::arg("focus_distance"), py::arg("blades") = 0, py::arg("rotation") = 0.0,
           py::arg("ratio") = 1.0,
           "aperture_radius and focus_distance, along the camera's axis, in scene units; fewer than 3 blades leave a "
           "round opening; rotation of the blades in radians; ratio of the opening's height to its width. Raises Error "
           "for numbers that no lens has.")
      .def_readonly("aperture_radius", &scene::Lens::aperture_radius)
      .def_readonly("focus_distance", &scene::Lens::focus_distance)
      .def_readonly("blades", &scene::Lens::blades)
      .def_readonly("rotation", &scene::Lens::rotation)
      .def_readonly("ratio", &scene::Lens::ratio)
      .def(
          "__eq__", [](const scene::Lens& a, const scene::Lens& b) { return a == b; }, py::is_operator());
}

void bind_camera(py::module_& module) {
  py::class_<scene::Camera>(module, "Camera",
                            "Two matrices: perspective, orthographic, shifted, all the same; and a Lens.")
      .def(py::init([](const Array<double>& world_to_camera, const Array<double>& camera_to_clip,
                       const std::optional<scene::Lens>& lens) {
             scene::Camera camera{to_matrix(world_to_camera, "world_to_camera"),
                                  to_matrix(camera_to_clip, "camera_to_clip"), lens};
             validate(camera);
             return camera;
           }),
           py::arg("world_to_camera"), py::arg("camera_to_clip"), py::arg("lens") = py::none(),
           "Both (4, 4) float64; camera space looks along -z with y up, clip space is OpenGL's. Without a Lens "
           "everything is sharp.")
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
      .def_readonly("lens", &scene::Camera::lens)
      .def(
          "__eq__", [](const scene::Camera& a, const scene::Camera& b) { return a == b; }, py::is_operator());
}

}  // namespace

void bind_scene(py::module_& module) {
  bind_mesh_and_instance(module);
  bind_advice(module);
  bind_transforms(module);
  bind_instance_array(module);
  bind_lens(module);
  bind_camera(module);
  bind_lights(module);
  py::class_<scene::Scene>(module, "Scene", "Instances, lights and the world around them.")
      .def(py::init([](std::vector<scene::Instance> instances, std::vector<scene::Light> lights,
                       const std::optional<scene::World>& world, std::vector<scene::InstanceArray> arrays,
                       const std::string& exchange, bool denoise) {
             scene::Scene scene{std::move(instances),
                                std::move(lights),
                                world.value_or(scene::World{}),
                                std::move(arrays),
                                scene::parse_choice<scene::Exchange>(exchange),
                                denoise};
             validate(scene);
             return scene;
           }),
           py::kw_only(), py::arg("instances") = std::vector<scene::Instance>{},
           py::arg("lights") = std::vector<scene::Light>{}, py::arg("world") = py::none(),
           py::arg("arrays") = std::vector<scene::InstanceArray>{},
           py::arg("exchange") = std::string(scene::exchange_names[static_cast<std::size_t>(scene::default_exchange)]),
           py::arg("denoise") = true,
           "arrays: InstanceArrays, drawn beside the instances. exchange: 'order_1', and light goes from grain to "
           "grain; 'heaps', where there are arrays of them; 'gathered', and each pixel's share of it is found by rays; "
           "'path_traced', and it is followed to its end; 'off', and it does not. denoise: whether what rays of each "
           "pixel find of it is told to its neighbours, "
           "less and "
           "less with each sample. Raises Error for a transform that cannot be inverted.")
      .def_readonly("instances", &scene::Scene::instances)
      .def_readonly("arrays", &scene::Scene::arrays)
      .def_property_readonly(
          "exchange",
          [](const scene::Scene& scene) { return scene::exchange_names[static_cast<std::size_t>(scene.exchange)]; })
      .def_readonly("denoise", &scene::Scene::denoise)
      .def_readonly("lights", &scene::Scene::lights)
      .def_readonly("world", &scene::Scene::world);
}

}  // namespace mesograin::python
