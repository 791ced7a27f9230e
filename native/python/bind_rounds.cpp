// When a picture that gets better with every sample is good enough, for Python.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "base/error.h"
#include "image/rounds.h"
#include "python/bindings.h"

namespace py = pybind11;

namespace mesograin::python {
namespace {

using Pixels = py::array_t<float, py::array::c_style | py::array::forcecast>;

int next(image::UntilError& until, const Pixels& pixels, int samples) {
  if (pixels.ndim() != 3) throw Error("A picture has shape (h, w, 4); got one of {} axes.", pixels.ndim());
  const image::ImageView view{pixels.data(), static_cast<int>(pixels.shape(1)), static_cast<int>(pixels.shape(0)),
                              static_cast<int>(pixels.shape(2))};
  const py::gil_scoped_release release;
  return until.next(view, samples);
}

}  // namespace

void bind_rounds(py::module_& module) {
  py::class_<image::UntilError>(
      module, "UntilError",
      "UntilError(error): draws until the noise of a pixel is no more than a share of its light. Where samples are "
      "spread more evenly than by chance there is less noise than it tells. Raises Error unless `error` is above 0.")
      .def(py::init<double>(), py::arg("error"))
      .def_readonly_static("first", &image::UntilError::first, "Samples of the first picture to show it.")
      .def("next", &next, py::arg("pixels"), py::arg("samples"),
           "How many samples come next; 0 if that is all. pixels: (h, w, 4) float32, linear RGB premultiplied by "
           "coverage, and coverage, the mean of so many samples, among which are those of the picture before. Raises "
           "Error for another shape, or no more samples than before.")
      .def_property_readonly("target", &image::UntilError::target, "How many are needed, as far as is known.")
      .def_property_readonly("noise", &image::UntilError::noise,
                             "The relative L1 a pixel that the last picture is expected to have to that of endless "
                             "samples, over pixels that anything covers; None before the second.");
  py::class_<image::UntilTime>(
      module, "UntilTime",
      "UntilTime(seconds): draws for so long, and one sample at least. Times are in seconds from "
      "the start. Raises Error unless `seconds` is above 0.")
      .def(py::init<double>(), py::arg("seconds"))
      .def("next", &image::UntilTime::next, py::arg("samples"), py::arg("now"),
           "There are so many samples now: how many come next; 0 if that is all.")
      .def("waits_for_light", &image::UntilTime::waits_for_light, py::arg("now"),
           "Whether the first sample is still to wait for what light does in and between grains.")
      .def("is_over", &image::UntilTime::is_over, py::arg("now"));
}

}  // namespace mesograin::python
