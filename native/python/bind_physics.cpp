// Numbers of the physics for scripts: albedos and the constants of an interface.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>

#include "base/error.h"
#include "physics/fresnel_moments.h"
#include "physics/half_space/half_space_albedo.h"
#include "python/bindings.h"

namespace py = pybind11;

namespace mesograin::python {

void bind_physics(py::module_& module) {
  module.def(
      "half_space_albedo",
      [](const scene::Material& material, std::optional<double> cosine) {
        const glm::dvec3 albedo = physics::half_space_albedo(material, cosine);
        return std::array{albedo.r, albedo.g, albedo.b};
      },
      py::arg("material"), py::arg("cosine") = py::none(), py::call_guard<py::gil_scoped_release>(),
      "Fraction of light that a half-space of the material sends back, linear RGB, all orders of scattering, exact\n"
      "(Chandrasekhar 1960; internal reflection included, what the interface reflects outside is not).\n"
      "cosine: of the light's angle to the normal, in (0, 1]; None for light from everywhere. Raises Error.");
  module.def(
      "diffusion_boundary",
      [](double eta) {
        if (!(eta >= 0.5 && eta <= 4.0)) throw Error("eta must lie between 0.5 and 4; got {}.", eta);
        const physics::DiffusionBoundary boundary = physics::diffusion_boundary(eta);
        py::dict constants;
        constants["a"] = boundary.a;
        constants["c_phi"] = boundary.c_phi;
        constants["c_e"] = boundary.c_e;
        constants["exit_transmittance"] = boundary.exit_transmittance;
        return constants;
      },
      py::arg("eta"),
      "Constants of diffusion theory at an interface of relative index eta in [0.5, 4], by quadrature:\n"
      "a, c_phi, c_e (d'Eon and Irving 2011) and exit_transmittance, which normalises an exit lobe. Raises Error.");
}

}  // namespace mesograin::python
