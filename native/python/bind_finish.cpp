// Finishes for Python: pictures are copied in, what is not named has none.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>

#include "base/error.h"
#include "python/bindings.h"
#include "python/vectors.h"
#include "scene/finish.h"
#include "scene/material.h"

namespace py = pybind11;

namespace mesograin::python {
namespace {

using scene::Finish;
using scene::Picture;
using scene::TextureMap;

template <typename Texel, typename Number>
std::vector<Texel> to_texels(const Array<Number>& pixels) {
  if (pixels.ndim() != 3 || pixels.shape(2) != 4 || pixels.shape(0) > 1 << 16 || pixels.shape(1) > 1 << 16)
    throw Error("A picture must have shape (h, w, 4), 65536 pixels a side at most.");
  const auto* first = reinterpret_cast<const Texel*>(pixels.data());
  return {first, first + pixels.shape(0) * pixels.shape(1)};
}

std::shared_ptr<Picture> make_picture(const py::array& pixels, bool srgb) {
  const bool bytes = py::isinstance<py::array_t<std::uint8_t>>(pixels);
  std::variant<Picture::Bytes, Picture::Numbers> texels;
  if (bytes)
    texels = to_texels<glm::u8vec4>(Array<std::uint8_t>(pixels));
  else
    texels = to_texels<glm::vec4>(Array<float>(pixels));
  return std::make_shared<Picture>(static_cast<int>(pixels.shape(1)), static_cast<int>(pixels.shape(0)),
                                   std::move(texels), srgb);
}

TextureMap make_map(std::shared_ptr<Picture> picture, bool by_position, const std::optional<Array<double>>& to_picture,
                    const std::string& wrap, bool smooth) {
  TextureMap map;
  map.picture = std::move(picture);
  map.by_position = by_position;
  if (to_picture) {
    if (to_picture->ndim() != 2 || to_picture->shape(0) != 2 || to_picture->shape(1) != 4)
      throw Error("to_picture must be a 2 x 4 matrix.");
    for (py::ssize_t row = 0; row < 2; ++row)
      map.to_picture[static_cast<std::size_t>(row)] = glm::make_vec4(to_picture->data(row, 0));
  }
  map.wrap = static_cast<scene::Wrap>(scene::find_name("wrap", scene::wrap_names, wrap));
  map.smooth = smooth;
  return map;
}

void bind_pictures(py::module_& module) {
  py::class_<Picture, std::shared_ptr<Picture>>(
      module, "Picture", "Texels that surfaces wear, copied and immutable, for as many materials as need them.")
      .def(py::init(&make_picture), py::arg("pixels"), py::arg("srgb") = false,
           "(h, w, 4) uint8 or float32, row 0 at the top; srgb: R, G and B are made linear where they are looked up.")
      .def_property_readonly("size", [](const Picture& p) { return std::pair(p.width(), p.height()); });

  py::class_<TextureMap>(module, "TextureMap", "How a Picture lies on a mesh.")
      .def(py::init(&make_map), py::arg("picture").none(false), py::arg("by_position") = false,
           py::arg("to_picture") = py::none(), py::arg("wrap") = "repeat", py::arg("smooth") = true,
           "to_picture: (2, 4), from (u, v, 0, 1), or, by_position, from (x, y, z, 1) in the mesh's own space, to the "
           "picture, (0, 0) at its lower left; wrap: what is beyond its edges, repeat, extend, clip or mirror.");
}

}  // namespace

void bind_finish(py::module_& module) {
  bind_pictures(module);
  py::class_<Finish>(module, "Finish", "What an opaque surface has beside its model's parameters.")
      .def(
          py::init([](const py::kwargs& given) {
            Finish finish;
            const auto take = [&](const char* name, auto& value) {
              if (!given.contains(name)) return false;
              value = given[name].cast<std::remove_reference_t<decltype(value)>>();
              return true;
            };
            std::size_t taken = 0;
            for (const auto& [name, map] :
                 {std::pair{"reflectance", &finish.reflectance}, std::pair{"roughness", &finish.roughness},
                  std::pair{"metallic", &finish.metallic}, std::pair{"normal", &finish.normal},
                  std::pair{"emission", &finish.emission}})
              taken += take(name, *map);
            for (const auto& [name, number] :
                 {std::pair{"metallicity", &finish.metallicity}, std::pair{"normal_strength", &finish.normal_strength},
                  std::pair{"coat", &finish.coat}, std::pair{"coat_roughness", &finish.coat_roughness},
                  std::pair{"diffuse_roughness", &finish.diffuse_roughness}})
              taken += take(name, *number);
            for (const auto& [name, chosen] : {std::pair{"retro_reflective", &finish.retro_reflective},
                                               std::pair{"coat_shades_base", &finish.coat_shades_base},
                                               std::pair{"metal_whitens", &finish.metal_whitens},
                                               std::pair{"facets_keep_energy", &finish.facets_keep_energy},
                                               std::pair{"facets_shade_bumps", &finish.facets_shade_bumps},
                                               std::pair{"bent_normals_stay", &finish.bent_normals_stay},
                                               std::pair{"faces_are_lights", &finish.faces_are_lights}})
              taken += take(name, *chosen);
            Triple radiance{};
            if (take("radiance", radiance)) {
              finish.radiance = to_vector(radiance);
              ++taken;
            }
            if (taken < given.size())
              throw Error("A finish takes no such value among {}.", py::str(given.attr("keys")()).cast<std::string>());
            validate(finish);
            return finish;
          }),
          "reflectance, roughness, metallic, normal, emission: TextureMaps; metallicity=0: the share that is a "
          "conductor; normal_strength=1; coat=0: reflectance of the dielectric over the rest, seen straight on, with "
          "coat_roughness=0.5, the square root of the GGX alpha; coat_shades_base=False: what the coat reflects is "
          "lost to what lies under it; retro_reflective=False: diffuse as Burley has it; diffuse_roughness=0: else as "
          "Oren "
          "and Nayar have it; metal_whitens=False: the "
          "conductor's reflectance rises to 1 at grazing (Schlick); facets_keep_energy=False: what one bounce off "
          "facets loses is sent on in their lobe (Turquin); facets_shade_bumps=False: what a bent normal shades of "
          "itself is masked as facets are (Estevez et al.), else by Cycles' former cubic; bent_normals_stay=False: for "
          "the diffuse share, else they are bent back until a mirror would reflect what is above the surface; "
          "radiance=(0, 0, 0) that it sends out; faces_are_lights=False: area lights of the scene stand for that.");
}

}  // namespace mesograin::python
