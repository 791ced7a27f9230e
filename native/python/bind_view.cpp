// The renderer for Python: the GIL is released while the device works, and Ctrl-C ends a render after its sample.
#include <fmt/ranges.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "gl/context_thread.h"
#include "python/bindings.h"
#include "render/view.h"

namespace py = pybind11;

namespace mesograin::python {
namespace {

using Pixels = py::array_t<float, py::array::c_style>;

py::dict device_info() {
  const gl::DeviceInfo& info = [] {
    const py::gil_scoped_release release;
    return gl::ContextThread::instance().device_info();
  }();
  py::list tried;
  for (const gl::DeviceAttempt& attempt : info.tried) {
    py::dict entry;
    entry["device"] = attempt.device;
    entry["hardware"] = attempt.hardware;
    entry["result"] = attempt.result;
    tried.append(entry);
  }
  py::dict result;
  result["chosen"] = info.chosen;
  result["renderer"] = info.renderer;
  result["version"] = info.version;
  result["hardware"] = info.hardware;
  result["tried"] = tried;
  return result;
}

// Python hears of Ctrl-C on its main thread alone.
bool on_main_thread() {
  const py::module_ threading = py::module_::import("threading");
  return threading.attr("current_thread")().is(threading.attr("main_thread")());
}

/// Whether it is ready after so long; nothing: at last.
template <typename Result>
bool wait_for(const std::shared_future<Result>& future, std::optional<double> seconds) {
  if (seconds) return future.wait_for(std::chrono::duration<double>(*seconds)) == std::future_status::ready;
  future.wait();
  return true;
}

// Waits without the GIL, but looks for Ctrl-C often enough that it seems immediate. On another thread it does not look:
// each look is Python running beside Blender's main thread, which Blender before Python 3.12 does not always survive.
void render(render::View& view, int samples) {
  const std::shared_future<double> done = view.start(samples);
  if (!on_main_thread()) {
    const py::gil_scoped_release release;
    done.get();
    return;
  }
  constexpr auto patience = std::chrono::milliseconds(20);
  for (;;) {
    {
      const py::gil_scoped_release release;
      if (done.wait_for(patience) == std::future_status::ready) break;
    }
    if (PyErr_CheckSignals() != 0) {
      view.cancel();
      const py::gil_scoped_release release;
      done.wait();
      break;
    }
  }
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();
  done.get();
}

// A scene, a camera, a moment or portions that are being taken, for a caller who has something else to do.
class Taking {
 public:
  explicit Taking(std::shared_future<void> done) : done_(std::move(done)) {}

  bool wait(std::optional<double> seconds) const { return wait_for(done_, seconds); }
  bool done() const { return wait(0.0); }
  void result() const { done_.get(); }

 private:
  std::shared_future<void> done_;
};

// What has become known, being taken in, for a caller who has something else to do.
class News {
 public:
  explicit News(render::View& view) : any_(view.start_news()) {}

  bool wait(std::optional<double> seconds) const { return wait_for(any_, seconds); }
  bool done() const { return wait(0.0); }
  bool result() const { return any_.get(); }

 private:
  std::shared_future<bool> any_;
};

// Samples under way, for a caller who has something else to do. The work is the device thread's: no thread of Python's
// waits for it.
class Rendering {
 public:
  Rendering(render::View& view, int samples, bool read)
      : picture_(read ? std::make_shared<render::Picture>() : nullptr), seconds_(view.start(samples, picture_)) {}

  bool wait(std::optional<double> seconds) const { return wait_for(seconds_, seconds); }
  bool done() const { return wait(0.0); }
  double result() const { return seconds_.get(); }
  const std::shared_ptr<render::Picture>& picture() const { return picture_; }

 private:
  std::shared_ptr<render::Picture> picture_;
  std::shared_future<double> seconds_;
};

// A picture being read, for a caller who has something else to do.
class Reading {
 public:
  explicit Reading(render::View& view) : done_(view.start_read(picture_)) {}

  bool wait(std::optional<double> seconds) const { return wait_for(done_, seconds); }
  bool done() const { return wait(0.0); }
  std::shared_ptr<render::Picture> result() const {
    done_.get();
    return picture_;
  }

 private:
  std::shared_ptr<render::Picture> picture_ = std::make_shared<render::Picture>();
  std::shared_future<void> done_;
};

float* pixels_of(const render::View& view, Pixels& out) {
  const auto height = static_cast<py::ssize_t>(view.height());
  const auto width = static_cast<py::ssize_t>(view.width());
  if (out.ndim() != 3 || out.shape(0) != height || out.shape(1) != width || out.shape(2) != 4)
    throw Error("read() needs a C-contiguous float32 array of shape ({}, {}, 4).", height, width);
  return out.mutable_data();
}

Pixels read(render::View& view, std::optional<Pixels> out) {
  if (!out) out = Pixels({py::ssize_t{view.height()}, py::ssize_t{view.width()}, py::ssize_t{4}});
  float* pixels = pixels_of(view, *out);
  const py::gil_scoped_release release;
  view.read(pixels);
  return *std::move(out);
}

render::Portion portion_of(const std::string& name) {
  const auto found = std::find(render::portion_names.begin(), render::portion_names.end(), name);
  if (found == render::portion_names.end())
    throw Error("A portion must be one of {}; got '{}'.", fmt::join(render::portion_names, ", "), name);
  return static_cast<render::Portion>(found - render::portion_names.begin());
}

Taking start_portions(render::View& view, const std::vector<std::string>& names) {
  std::vector<render::Portion> portions;
  portions.reserve(names.size());
  for (const std::string& name : names) portions.push_back(portion_of(name));
  return Taking(view.start_portions(std::move(portions)));
}

Taking start_moment(render::View& view, const scene::Camera& camera, std::optional<scene::Scene> scene) {
  return Taking(view.start_moment(camera, std::move(scene)));
}

Pixels read_portion(render::View& view, const std::string& name) {
  const render::Portion portion = portion_of(name);
  Pixels pixels({static_cast<py::ssize_t>(view.height()), static_cast<py::ssize_t>(view.width()), py::ssize_t{4}});
  float* const numbers = pixels.mutable_data();
  const py::gil_scoped_release release;
  view.read_portion(portion, numbers);
  return pixels;
}

py::dict read_surfaces(render::View& view) {
  const auto height = static_cast<py::ssize_t>(view.height());
  const auto width = static_cast<py::ssize_t>(view.width());
  Pixels positions({height, width, py::ssize_t{4}});
  Pixels normals({height, width, py::ssize_t{3}});
  {
    float* const places = positions.mutable_data();
    float* const facing = normals.mutable_data();
    const py::gil_scoped_release release;
    view.read_surfaces(places, facing);
  }
  py::dict result;
  result["position"] = std::move(positions);
  result["normal"] = std::move(normals);
  return result;
}

py::list of_timings(const std::vector<render::PassTiming>& passes) {
  py::list result;
  for (const render::PassTiming& timing : passes) {
    py::dict entry;
    entry["pass"] = timing.pass;
    entry["milliseconds"] = timing.milliseconds;
    result.append(entry);
  }
  return result;
}

py::list timings(render::View& view) {
  return of_timings([&] {
    const py::gil_scoped_release release;
    return view.timings();
  }());
}

py::dict of_exchange(const render::ExchangeStatistics& exchange) {
  py::dict result;
  result["grains"] = exchange.grains;
  result["others"] = exchange.others;
  result["kinds"] = exchange.kinds;
  result["links"] = exchange.links;
  result["steps"] = exchange.steps;
  result["residual"] = exchange.residual;
  result["summed_on_device"] = exchange.summed_on_device;
  result["milliseconds"] = exchange.milliseconds;
  result["final"] = exchange.final;
  py::dict found;
  found["tables"] = exchange.parts.tables;
  found["links"] = exchange.parts.links;
  found["sources"] = exchange.parts.sources;
  found["solutions"] = exchange.parts.solutions;
  found["renewed"] = exchange.parts.renewed;
  result["found"] = found;
  result["balls"] = exchange.balls;
  result["gathered"] = exchange.gathered;
  py::dict means;
  means["walked"] = exchange.means.walked;
  means["looked_into"] = exchange.means.looked_into;
  means["modelled"] = exchange.means.modelled;
  means["sharing"] = exchange.means.sharing;
  result["means"] = means;
  py::dict levels;
  for (std::size_t i = 0; i < render::level_names.size(); ++i)
    levels[std::string(render::level_names[i]).c_str()] = exchange.levels.grains[i];
  levels["surface"] = exchange.levels.surfaces;
  result["levels"] = levels;
  result["walks_saved"] = exchange.levels.walks_saved;
  const auto pair = [](const render::Range& range) { return py::make_tuple(range.least, range.most); };
  py::list stuff;
  for (const render::Stuff& one : exchange.stuff) {
    py::dict entry;
    entry["surface"] = heap::surface_names[static_cast<std::size_t>(one.surface)];
    entry["thickness"] = pair(one.thickness);
    entry["albedo"] = pair(one.albedo);
    entry["g"] = pair(one.g);
    entry["eta"] = pair(one.eta);
    stuff.append(entry);
  }
  result["stuff"] = stuff;
  return result;
}

py::dict of_statistics(const render::Statistics& counts) {
  py::dict result;
  result["instances"] = counts.instances;
  result["drawn"] = counts.drawn;
  result["cast"] = counts.cast;
  result["seen"] = counts.seen;
  result["exchange"] = counts.exchange ? py::object(of_exchange(*counts.exchange)) : py::object(py::none());
  return result;
}

py::dict statistics(render::View& view) {
  return of_statistics([&] {
    const py::gil_scoped_release release;
    return view.statistics();
  }());
}

/// None if it was not read.
py::object of_picture(const std::shared_ptr<render::Picture>& picture) {
  if (!picture || picture->pixels.empty()) return py::none();
  const std::vector<py::ssize_t> shape{picture->height, picture->width, 4};
  // Its memory, not a copy: numpy holds the picture for as long as it needs it.
  const py::capsule holder(new std::shared_ptr<render::Picture>(picture),
                           [](void* held) { delete static_cast<std::shared_ptr<render::Picture>*>(held); });
  py::dict result;
  result["pixels"] = Pixels(shape, picture->pixels.data(), holder);
  result["timings"] = of_timings(picture->timings);
  result["statistics"] = of_statistics(picture->statistics);
  return result;
}

py::object drawn(const Rendering& rendering) {
  {
    const py::gil_scoped_release release;
    rendering.wait(std::nullopt);
  }
  return of_picture(rendering.picture());
}

py::object result_of(const Reading& reading) {
  return of_picture([&] {
    const py::gil_scoped_release release;
    return reading.result();
  }());
}

void set_bake(render::View& view, std::vector<std::size_t> instances, const std::string& view_from) {
  const render::Bake bake{std::move(instances), render::parse_view_from(view_from)};
  const py::gil_scoped_release release;
  view.set_bake(bake);
}

void set_visibility(render::View& view, const std::string& by) {
  const auto found = std::find(render::visibility_names.begin(), render::visibility_names.end(), by);
  if (found == render::visibility_names.end())
    throw Error("Visibility must be one of {}; got '{}'.", fmt::join(render::visibility_names, ", "), by);
  const py::gil_scoped_release release;
  view.set_visibility(static_cast<render::Visibility>(found - render::visibility_names.begin()));
}

void set_summing(render::View& view, const std::string& by) {
  const auto found = std::find(render::summing_names.begin(), render::summing_names.end(), by);
  if (found == render::summing_names.end())
    throw Error("Summing must be one of {}; got '{}'.", fmt::join(render::summing_names, ", "), by);
  const py::gil_scoped_release release;
  view.set_summing(static_cast<render::Summing>(found - render::summing_names.begin()));
}

py::dict uv_use(render::View& view) {
  render::UvUse use;
  {
    const py::gil_scoped_release release;
    use = view.uv_use();
  }
  py::dict result;
  result["texels"] = use.texels;
  result["overlapping"] = use.overlapping;
  result["triangles_outside"] = use.triangles_outside;
  result["warnings"] = render::warnings(use);
  return result;
}

py::dict sent() {
  const render::Sent counts = [] {
    const py::gil_scoped_release release;
    return render::View::sent();
  }();
  py::dict result;
  result["meshes"] = counts.meshes;
  result["materials"] = counts.materials;
  result["programs"] = counts.programs;
  result["programs_freed"] = counts.programs_freed;
  result["bytes"] = counts.bytes;
  return result;
}

}  // namespace

void bind_view(py::module_& module) {
  module.def("device_info", &device_info,
             "The device that renders: {'chosen', 'renderer', 'version', 'hardware', 'tried': [{'device', 'hardware', "
             "'result'}, ...]}. Raises Error, listing every device tried, if none offers OpenGL 4.5 through EGL.");
  module.def(
      "take_gl_errors", [] { return gl::ContextThread::instance().take_gl_errors(); },
      py::call_guard<py::gil_scoped_release>(), "The OpenGL errors since the last call, oldest first; normally [].");
  module.def(
      "sent", &sent,
      "What all views have sent to the device so far: {'meshes', 'materials', 'programs', 'programs_freed', 'bytes'}; "
      "programs_freed of the programs are no longer there, as many others were needed since.");
  module.def("shut_down", &gl::ContextThread::shut_down, py::call_guard<py::gil_scoped_release>(),
             "Frees the device; views made before can no longer be used. Done by itself when Python ends.");

  using Release = py::call_guard<py::gil_scoped_release>;
  py::class_<Rendering>(module, "Rendering", "Samples that View.start() began and the device's thread draws.")
      .def_property_readonly("done", &Rendering::done, "Whether they are drawn, cancelled or failed.")
      .def("wait", &Rendering::wait, py::arg("seconds") = py::none(), Release(),
           "Waits for their end, if `seconds` is given at most so long; whether it has come.")
      .def("result", &Rendering::result, Release(),
           "Waits for their end; the seconds that they took. Raises Error as View.render() does.")
      .def(
          "picture", &drawn,
          "Waits for their end; as Reading.result(), of View.start(read=True). None if they were cancelled or failed.");
  py::class_<Reading>(module, "Reading", "A picture that View.start_read() reads.")
      .def_property_readonly("done", &Reading::done, "Whether it is read, or has failed.")
      .def("wait", &Reading::wait, py::arg("seconds") = py::none(), Release(),
           "Waits for that, if `seconds` is given at most so long; whether it has come.")
      .def("result", &result_of,
           "Waits for that: {'pixels': as View.read() gives them, 'timings': and 'statistics': as View's, of the same "
           "samples}.");
  py::class_<Taking>(module, "Taking",
                     "What the view was given without waiting: a scene, a camera, a moment or portions.")
      .def_property_readonly("done", &Taking::done, "Whether the view has it, or it has failed.")
      .def("wait", &Taking::wait, py::arg("seconds") = py::none(), Release(),
           "Waits for that, if `seconds` is given at most so long; whether it has come.")
      .def("result", &Taking::result, Release(), "Waits for that. Raises Error as View.set_scene() and its like do.");
  py::class_<News>(module, "News", "What View.start_news() takes in.")
      .def_property_readonly("done", &News::done, "Whether that is done, or has failed.")
      .def("wait", &News::wait, py::arg("seconds") = py::none(), Release(),
           "Waits for that, if `seconds` is given at most so long; whether it is done.")
      .def("result", &News::result, Release(), "Waits for that. As View.take_news().");
  py::class_<render::View>(
      module, "View",
      "An image of a scene, through a camera or unwrapped, that gets better with every sample (box pixel filter, "
      "one pixel wide). Many views share one device and what was sent to it.")
      .def(py::init<int, int, std::uint32_t, bool>(), py::arg("width"), py::arg("height"), py::arg("seed") = 0,
           py::arg("patient") = true, Release(),
           "Light's transport in meshes and light between grains take seconds to compute, in the background. A patient "
           "view draws nothing before they are known; another draws what is known, and take_news() tells when it is "
           "more.")
      .def("resize", &render::View::resize, py::arg("width"), py::arg("height"), Release(),
           "Reallocates the targets and nothing else.")
      .def("set_scene", &render::View::set_scene, py::arg("scene"), Release(),
           "Restarts the accumulation. Meshes and materials already on the device are not sent again.")
      .def(
          "start_scene",
          [](render::View& view, scene::Scene scene) { return Taking(view.start_scene(std::move(scene))); },
          py::arg("scene"), Release(),
          "As set_scene(), without waiting: gives the Taking under way. Whatever else is asked of the view waits for "
          "it.")
      .def("set_taps", &render::View::set_taps, py::arg("taps"), Release(),
           "Sets how many light map samples model 3 takes for one pixel and sample, over all lights (default 16), and "
           "restarts the\n"
           "accumulation. Raises Error unless it is in [1, 65536].")
      .def("set_visibility", &set_visibility, py::arg("by"),
           "How it is found what is seen of arrays and what stands in their light: 'drawn' by the device, 'cast' by "
           "rays on all cores,\n"
           "'device_rays' by rays that the device follows, which it draws instead beside more than 32 single objects, "
           "or 'automatic',\n"
           "the device's where there is a GPU, else all cores'. Restarts the accumulation. Raises Error where rays "
           "cannot "
           "be cast.")
      .def("set_summing", &set_summing, py::arg("by"),
           "Who sums over the ways of light between grains, in scenes that are set from now on: the 'processor' on all "
           "cores, the 'device', as far as it can, or 'automatic', the device where there is a GPU and a million ways "
           "or more.")
      .def("set_levels", &render::View::set_levels, py::arg("by_size"), Release(),
           "Whether light between grains is followed less closely into those of arrays that are seen small: in a ball, "
           "not in their own\n"
           "mesh, below 8 pixels across, by no walk at all below 4 (default); or into all as closely as it can be. "
           "Restarts the accumulation.")
      .def("set_camera", &render::View::set_camera, py::arg("camera"), Release(),
           "Restarts the accumulation; sends nothing.")
      .def(
          "start_camera",
          [](render::View& view, const scene::Camera& camera, int width, int height) {
            return Taking(view.start_camera(camera, width, height));
          },
          py::arg("camera"), py::arg("width"), py::arg("height"), Release(),
          "As resize() and set_camera(), without waiting: gives the Taking under way, as start_scene().")
      .def(
          "set_moment",
          [](render::View& view, const scene::Camera& camera, std::optional<scene::Scene> scene) {
            start_moment(view, camera, std::move(scene)).result();
          },
          py::arg("camera"), py::arg("scene") = py::none(), Release(),
          "Another moment of the exposure: what set_scene() took elsewhere, if a scene is given, seen through this "
          "camera. Samples from now on are added to those before; nothing but transforms is sent. Light between grains "
          "stays each grain's own as it was found for set_scene(). Raises Error for a scene of other things, and for a "
          "bake.")
      .def("start_moment", &start_moment, py::arg("camera"), py::arg("scene") = py::none(), Release(),
           "As set_moment(), without waiting: gives the Taking under way, as start_scene().")
      .def(
          "set_portions",
          [](render::View& view, const std::vector<std::string>& names) { start_portions(view, names).result(); },
          py::arg("portions"), Release(),
          "Has these portions of the picture's light told beside it: any of 'diffuse', 'specular', 'subsurface', "
          "'single_scattering', 'transmission', 'exchange', 'emission', 'environment', whose sum is the picture, and "
          "'normal'. Restarts the accumulation; each costs about its own shading. A bake has none.")
      .def("start_portions", &start_portions, py::arg("portions"), Release(),
           "As set_portions(), without waiting: gives the Taking under way, as start_scene().")
      .def("read_portion", &read_portion, py::arg("portion"),
           "The mean of one of set_portions()'s, (height, width, 4) float32, linear RGB, or the normal's x, y and z "
           "premultiplied by coverage; row 0 at the top. Raises Error for one that is not told.")
      .def("set_bake", &set_bake, py::arg("instances"), py::arg("view_from") = "above_surface",
           "Instead of what the camera sees, until the next set_scene(): the texture of the scene's instances of these "
           "numbers, which share one unwrapping, at their UVs; u to the right, v up. Each texel is the mean over its "
           "area. view_from: 'above_surface' looks along the normal; 'active_camera' from set_camera()'s, but never "
           "from below a rise of 0.2. Restarts the accumulation. Raises Error for instances that the scene does not "
           "have or that have no UVs.")
      .def("uv_use", &uv_use,
           "How the unwrapping being baked uses the texture: {'texels': whose middle is covered, 'overlapping': more "
           "than once, by the first of which the texel is baked, 'triangles_outside': that reach out of [0, 1]^2, "
           "where they are cut off, 'warnings': sentences about both}. Raises Error if nothing is being baked or no "
           "texel is covered.")
      .def("take_news", &render::View::take_news, Release(),
           "Takes in what has become known of light since; if anything has, restarts the accumulation. "
           "Returns whether it did.")
      .def(
          "start_news", [](render::View& view) { return News(view); }, Release(),
          "As take_news(), without waiting: gives the News under way. Whatever else is asked of the view waits for it.")
      .def_property_readonly("preparing", &render::View::preparing,
                             "The share that is done of what the scene's picture waits for; None if all is known.")
      .def_property_readonly("awaited", &render::View::awaited,
                             "What that is: 'transport' in meshes, 'exchange' of light between grains; [] if all is "
                             "known.")
      .def_property_readonly("warnings", &render::View::warnings,
                             "One sentence for each thing that is not drawn by the model asked for.")
      .def("render", &render, py::arg("samples") = 1,
           "Adds samples to the mean. Ctrl-C or cancel() ends it after the sample under way.")
      .def(
          "start", [](render::View& view, int samples, bool read) { return Rendering(view, samples, read); },
          py::arg("samples") = 1, py::arg("read") = false, Release(),
          "As render(), without waiting: gives the Rendering under way, which has the picture, too, if it is to be "
          "read.")
      .def("cancel", &render::View::cancel,
           "Ends a render() of another thread, or what start() began, amid its current sample.")
      .def_property_readonly("samples", &render::View::samples, "Samples in the mean so far.")
      .def_property_readonly("width", &render::View::width)
      .def_property_readonly("height", &render::View::height)
      .def(
          "read", &read, py::arg("out") = py::none(),
          "The mean: (height, width, 4) float32, linear RGB premultiplied by coverage, and coverage; row 0 at the top, "
          "which in a bake is v = 1. "
          "`out`, if given, is filled and returned.")
      .def(
          "statistics", &statistics,
          "What of the scene's arrays the last sample took the trouble of: {'instances': there are, 'drawn': that the "
          "device drew for the camera, 'cast': that rays were cast at, 'seen': of those, that rays met, 'exchange': "
          "of light from grain to grain, None where there is none: {'grains': that send light to each other, "
          "'others': objects that do not, 'kinds': of grains, 'links': ways of light between them, 'steps' and "
          "'residual' of the solution, 'summed_on_device': whether the device took its sums, 'milliseconds' that it "
          "took, 'final': no better one is under way, 'found': how "
          "often its 'tables', 'links', 'sources' and 'solutions' were found so far, 'balls': whether all grains are "
          "that round, 'gathered': whether rays of the last sample found more of some grains that are seen, 'means': "
          "how "
          "many grains are shown by which, where rays find what is seen: {'walked': light is followed into them, "
          "'looked_into': clear ones, through their facets, 'modelled': by their model, 'sharing': of all these, those "
          "so deep that they share numbers}, 'levels': how many of those walked the last sample showed by which: "
          "{'own_shape': walks in their mesh, 'ball': in a ball, 'told': none}, and of those that refract 'surface': "
          "how many by no more than their surface, seen or not where the device follows rays, 'walks_saved': by that, "
          "'stuff': "
          "[{'surface', 'thickness', 'albedo', 'g', 'eta'}] of what they are made of, all but the first from least to "
          "most; thickness in mean free paths to the radius, albedo of one scattering}}.")
      .def(
          "start_read", [](render::View& view) { return Reading(view); }, Release(),
          "As read(), without waiting: gives the Reading under way, of the samples that are drawn so far.")
      .def("read_surfaces", &read_surfaces,
           "What rays through the pixels' middles meet, whatever the samples so far: {'position': (height, width, 4) "
           "float32, in the world, and 1, or 0 where they meet nothing; 'normal': (height, width, 3), of unit length, "
           "on the side that is seen}; row 0 at the top. Raises Error for a bake.")
      .def("timings", &timings, "[{'pass', 'milliseconds'}, ...] of the last sample, in the order the passes ran.");
}

}  // namespace mesograin::python
