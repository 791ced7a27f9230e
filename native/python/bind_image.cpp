// EXR files and metrics for Python: arrays go in without a copy where they can, results are plain dicts for JSON.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/readable.h"
#include "image/filters.h"
#include "image/margin.h"
#include "image/metrics.h"
#include "image/significance.h"
#include "io/exr.h"
#include "python/bindings.h"

namespace py = pybind11;

namespace mesograin::python {
namespace {

using Pixels = py::array_t<float, py::array::c_style | py::array::forcecast>;
using Selection = py::array_t<bool, py::array::c_style | py::array::forcecast>;

std::string shape_of(const py::array& array) {
  std::string shape;
  for (py::ssize_t axis = 0; axis < array.ndim(); ++axis)
    shape += (axis > 0 ? ", " : "") + std::to_string(array.shape(axis));
  return shape;
}

/// Shape (h, w, c), or (h, w) for one channel.
image::ImageView to_view(const Pixels& pixels, const char* name) {
  if (pixels.ndim() != 2 && pixels.ndim() != 3)
    throw Error("{} must have shape (h, w, channels) or (h, w); got ({}).", name, shape_of(pixels));
  constexpr py::ssize_t longest = 1 << 20;
  for (py::ssize_t axis = 0; axis < pixels.ndim(); ++axis)
    if (pixels.shape(axis) < 1 || pixels.shape(axis) > longest)
      throw Error("{} must have 1 to {} pixels a side and as many channels; got shape ({}).", name, longest,
                  shape_of(pixels));
  return {pixels.data(), static_cast<int>(pixels.shape(1)), static_cast<int>(pixels.shape(0)),
          pixels.ndim() == 3 ? static_cast<int>(pixels.shape(2)) : 1};
}

/// The array takes the vector over.
py::array_t<float> to_array(image::Image image) {
  const std::vector<py::ssize_t> shape{image.height, image.width, image.channels};
  auto pixels = std::make_unique<std::vector<float>>(std::move(image.pixels));
  float* first = pixels->data();
  const py::capsule owner(pixels.release(), [](void* memory) { delete static_cast<std::vector<float>*>(memory); });
  return py::array_t<float>(shape, first, owner);
}

py::object to_number(double value) {
  if (std::isnan(value)) return py::none();
  return py::float_(value);
}

py::object to_place(const image::Place& place) { return py::list(py::make_tuple(place.x, place.y, place.channel)); }

py::tuple read_exr(const std::filesystem::path& path) {
  io::ExrFile file;
  {
    const py::gil_scoped_release release;
    file = io::read_exr(path);
  }
  // What a file names is text in Python, whatever its bytes.
  std::vector<std::string> channels;
  channels.reserve(file.channels.size());
  for (const std::string& name : file.channels) channels.push_back(base::readable(name));
  std::map<std::string, std::string> attributes;
  for (const auto& [name, value] : file.attributes) attributes.emplace(base::readable(name), base::readable(value));
  return py::make_tuple(to_array(std::move(file.image)), std::move(channels), std::move(attributes));
}

void write_exr(const std::filesystem::path& path, const Pixels& pixels,
               const std::optional<std::vector<std::string>>& channels,
               const std::map<std::string, std::string>& attributes, bool half) {
  const image::ImageView view = to_view(pixels, "pixels");
  const py::gil_scoped_release release;
  io::write_exr(path, view, channels.value_or(std::vector<std::string>{}), attributes,
                half ? io::SampleFormat::half : io::SampleFormat::float32);
}

py::array_t<bool> to_selection(const image::Mask& mask) {
  py::array_t<bool> selection({mask.height, mask.width});
  std::copy(mask.pixels.begin(), mask.pixels.end(), selection.mutable_data());
  return selection;
}

image::Mask to_mask(const Selection& selection) {
  if (selection.ndim() != 2) throw Error("mask must have shape (h, w); got ({}).", shape_of(selection));
  return {.width = static_cast<int>(selection.shape(1)),
          .height = static_cast<int>(selection.shape(0)),
          .pixels = {selection.data(), selection.data() + selection.size()}};
}

std::optional<image::Mask> to_mask(const std::optional<Selection>& selection) {
  if (!selection) return std::nullopt;
  return to_mask(*selection);
}

py::array_t<bool> default_mask(const Pixels& coverage, int erode) {
  return to_selection(image::default_mask(to_view(coverage, "coverage"), erode));
}

py::array_t<bool> crop_mask(const Selection& mask, const std::array<int, 4>& crop) {
  return to_selection(image::crop_mask(to_mask(mask), crop[0], crop[1], crop[2], crop[3]));
}

py::array_t<bool> mean_deviation_mask(const Pixels& error, const Selection& mask, double deviations) {
  return to_selection(image::mean_deviation_mask(to_view(error, "error"), to_mask(mask), deviations));
}

py::array_t<bool> otsu_mask(const Pixels& error, const Selection& mask, int median_size) {
  return to_selection(image::otsu_mask(to_view(error, "error"), to_mask(mask), median_size));
}

std::vector<image::ImageView> to_views(const std::vector<Pixels>& images, const char* name) {
  std::vector<image::ImageView> views;
  views.reserve(images.size());
  for (const Pixels& pixels : images) views.push_back(to_view(pixels, name));
  return views;
}

py::dict test_significance(const std::vector<Pixels>& images, const std::vector<Pixels>& references,
                           const Selection& selection, double false_alarm_rate, double relative_tolerance) {
  const std::vector<image::ImageView> views = to_views(images, "images");
  const std::vector<image::ImageView> reference_views = to_views(references, "references");
  const image::Mask mask = to_mask(selection);
  image::Significance significance;
  {
    const py::gil_scoped_release release;
    significance = image::test_significance(views, reference_views, mask, {false_alarm_rate, relative_tolerance});
  }
  py::dict result;
  result["differs"] = significance.differs;
  result["significant_pixels"] = significance.significant_pixels;
  result["pixels"] = significance.pixels;
  result["tests"] = significance.tests;
  result["threshold"] = significance.threshold;
  result["score_threshold"] = significance.score_threshold;
  result["false_alarm_rate"] = false_alarm_rate;
  result["relative_tolerance"] = relative_tolerance;
  result["p_value"] = to_array(std::move(significance.p_value));
  result["score"] = to_array(std::move(significance.score));
  return result;
}

py::object member_or_none(const std::optional<image::Errors>& errors, double image::Errors::*member) {
  return errors ? to_number((*errors).*member) : py::none();
}

py::dict to_dict(const image::Comparison& comparison) {
  std::optional<image::Errors> corrected, corrected_blocks;
  if (comparison.noise_floor) corrected = correct_for_noise(comparison.pixels, *comparison.noise_floor);
  if (comparison.noise_floor_blocks)
    corrected_blocks = correct_for_noise(comparison.blocks, *comparison.noise_floor_blocks);

  py::dict result, noise_floor, mask;
  result["e_mean"] = to_number(comparison.e_mean);
  result["bias"] = to_number(comparison.bias);
  result["max_error"] = to_number(comparison.max_error);
  result["max_error_at"] = to_place(comparison.max_error_at);
  result["rse_max"] = to_number(comparison.rse_max);
  result["rse_max_at"] = to_place(comparison.rse_max_at);
  for (const auto& [name, percentiles] : {std::pair{"ae", comparison.ae}, std::pair{"rse", comparison.rse}}) {
    const py::str prefix(name);
    result[prefix + py::str("_p50")] = to_number(percentiles.p50);
    result[prefix + py::str("_p95")] = to_number(percentiles.p95);
    result[prefix + py::str("_p99")] = to_number(percentiles.p99);
  }
  for (const image::ErrorsMember& member : image::errors_members) {
    const py::str name(member.name.data(), member.name.size());
    result[name] = to_number(comparison.pixels.*member.value);
    result[name + py::str("_corrected")] = member_or_none(corrected, member.value);
    result[name + py::str("_blocks")] = to_number(comparison.blocks.*member.value);
    result[name + py::str("_blocks_corrected")] = member_or_none(corrected_blocks, member.value);
    noise_floor[name] = member_or_none(comparison.noise_floor, member.value);
    noise_floor[name + py::str("_blocks")] = member_or_none(comparison.noise_floor_blocks, member.value);
  }
  mask["source"] = comparison.mask.source;
  mask["pixels"] = comparison.mask.pixels;
  mask["nan"] = comparison.mask.nan;
  mask["inf"] = comparison.mask.inf;
  mask["used"] = comparison.mask.used;
  mask["image_not_finite"] = comparison.mask.image_not_finite;
  result["noise_floor"] = noise_floor;
  result["mask"] = mask;
  result["epsilon"] = image::relative_epsilon;
  result["block_size"] = image::block_size;
  return result;
}

py::dict compare(const Pixels& pixels, const py::args& references, const std::optional<Selection>& selection) {
  const image::ImageView view = to_view(pixels, "image");
  const auto arrays = references.cast<std::vector<Pixels>>();
  const std::vector<image::ImageView> reference_views = to_views(arrays, "references");
  const std::optional<image::Mask> mask = to_mask(selection);
  image::Comparison comparison;
  {
    const py::gil_scoped_release release;
    comparison = image::compare(view, reference_views, mask);
  }
  return to_dict(comparison);
}

py::array_t<float> error_image(const Pixels& pixels, const py::args& references, const std::string& metric) {
  const auto arrays = references.cast<std::vector<Pixels>>();
  return to_array(
      image::error_image(to_view(pixels, "image"), to_views(arrays, "references"), image::parse_error_metric(metric)));
}

}  // namespace

void bind_image(py::module_& module) {
  module.def("read_exr", &read_exr, py::arg("path"),
             "An EXR's data window as (pixels, channels, attributes): float32 of shape (h, w, channels) with row 0 at "
             "the top, in the file's own units (linear radiance for Mesograin's); a name for each channel, layer by "
             "layer, R, G, B, A first; the header's string attributes. Half and unsigned integers become float, NaN "
             "and Inf stay. Raises Error if the file is missing, damaged, cut short, deep, of several parts, has "
             "subsampled channels, or announces more than 65535 pixels a side or 2^30 samples.");
  module.def("write_exr", &write_exr, py::arg("path"), py::arg("pixels"), py::arg("channels") = py::none(),
             py::arg("attributes") = std::map<std::string, std::string>{}, py::arg("half") = false,
             "Writes pixels of shape (h, w, channels) or (h, w), row 0 at the top, as float32 or half with ZIP "
             "compression and `attributes` (str to str) in the header. Without `channels`, 1 channel is Y, 3 are R G B "
             "and 4 are R G B A. In half, values from 65520 up become Inf. The file appears complete or not at all. "
             "Raises Error if names and shape don't fit, or the place can't be written.");
  module.def("default_mask", &default_mask, py::arg("coverage"), py::arg("erode") = 2,
             "(h, w) bool: where coverage, of shape (h, w), is 1 (within 1e-4), less a rim of `erode` pixels. Raises "
             "Error for another shape or a negative `erode`.");
  module.def(
      "extend_margin",
      [](const Pixels& texture, int margin) {
        return to_array(image::extend_margin(to_view(texture, "texture"), margin));
      },
      py::arg("texture"), py::arg("margin"),
      "(h, w, 4) float32: a baked texture whose charts reach `margin` texels farther, so that filtering does not mix "
      "them "
      "with what lies between. Texels covered in part become full; then each empty texel next to covered ones takes "
      "their mean, `margin` times over (Blender's margin of type EXTEND). 0 changes nothing. Raises Error unless "
      "texture "
      "is (h, w, 4), premultiplied by its coverage, and margin in [0, 32767].");
  module.def("crop_mask", &crop_mask, py::arg("mask"), py::arg("crop"),
             "(h, w) bool: mask inside crop = (left, top, right, bottom) in pixels, row 0 at the top, right and bottom "
             "not included. Raises Error if the crop does not lie in the mask.");
  module.def("mean_deviation_mask", &mean_deviation_mask, py::arg("error"), py::arg("mask"),
             py::arg("deviations") = 1.0,
             "(h, w) bool: mask where error, (h, w, channels), is at most its masked mean plus `deviations` standard "
             "deviations. Pixels with NaN or Inf stay, to be counted. Raises Error if shapes differ.");
  module.def("otsu_mask", &otsu_mask, py::arg("error"), py::arg("mask"), py::arg("median_size") = 4,
             "(h, w) bool: mask where the median of error over median_size x median_size pixels is in the lower of the "
             "two classes that Otsu's threshold parts. Raises Error if shapes differ.");
  module.def(
      "test_significance", &test_significance, py::arg("images"), py::arg("references"), py::arg("mask"),
      py::arg("false_alarm_rate") = 0.01, py::arg("relative_tolerance") = 0.002,
      "Tests the mean of a list of images against a list of K >= 2 references of independent noise, pixel by pixel "
      "(docs/metrics.md): {'differs', 'significant_pixels', 'pixels', 'tests', 'threshold', 'score_threshold', "
      "'false_alarm_rate', 'relative_tolerance', 'p_value': (h, w, 1) float32, 'score': (h, w, 1 or 3) float32, in "
      "standard deviations, positive where the images are too bright}. One image counts as exact, of several the noise "
      "counts. Raises Error if shapes differ or nothing can be tested.");
  module.def("compare", &compare, py::arg("image"), py::arg("mask") = py::none(),
             "compare(image, *references, mask=None): metrics of an image against a reference, or against the mean of "
             "several whose noise is independent: a flat dict that docs/metrics.md defines, with 'noise_floor' and "
             "'mask' dicts beside it. Images have shape (h, w, 1), (h, w, 3) or (h, w, 4), linear, row 0 at the top; a "
             "fourth channel is coverage and not compared. mask: (h, w) bool; without it, the default mask of the "
             "references' coverage if they have 4 channels, else all pixels. What is not defined or not known is None. "
             "Raises Error if shapes differ, or nothing finite is selected.");
  module.def("error_image", &error_image, py::arg("image"), py::arg("metric") = "rse",
             "error_image(image, *references, metric='rse'): one metric of each sample, float32 of shape (h, w, 1 or "
             "3): 'e', 'ae', 'se', 'rae', 'rse' or 'rse_root'. NaN and Inf pass through. Raises Error if shapes differ "
             "or the metric is unknown.");
}

}  // namespace mesograin::python
