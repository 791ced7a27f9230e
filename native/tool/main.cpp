// mesograin-render: a scene in JSON, a picture or a baked texture in OpenEXR, nothing of Blender.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/readable.h"
#include "gl/context_thread.h"
#include "image/margin.h"
#include "io/exr.h"
#include "io/scene_json.h"
#include "render/bake.h"
#include "render/view.h"
#include "tool/drawing.h"
#include "tool/interruption.h"
#include "tool/progress.h"
#include "tool/provenance.h"

namespace {

using namespace mesograin;

constexpr int exit_failure = 1, exit_usage = 2;
constexpr std::string_view exit_codes =
    "Exit codes: 0 the picture was written; 1 the scene, the device or the output did not serve (one sentence says\n"
    "why); 2 the command line was wrong; 130 Ctrl-C, 143 SIGTERM: nothing was written. The picture appears complete "
    "or\n"
    "not at all. MESOGRAIN_GL_DEVICE chooses the device.";

struct Options {
  std::string scene;
  std::string output;
  std::string model;
  std::string size;
  std::string exchange;
  tool::Budget budget;
  std::uint32_t seed = 0;
  bool bake = false;
  std::string view_from{render::view_from_names.front()};
  int margin = 0;
  bool quiet = false;
};

/// The two numbers of "400x300", or twice that of "512".
io::SceneChoices parse_choices(const Options& options) {
  io::SceneChoices choices;
  if (!options.model.empty()) io::choose_model(choices, options.model);
  if (options.budget.error) choices.tolerance = 100.0 * *options.budget.error;
  if (!options.exchange.empty()) choices.exchange = scene::parse_choice<scene::Exchange>(options.exchange);
  if (options.size.empty()) return choices;
  const char* const end = options.size.data() + options.size.size();
  const auto width = std::from_chars(options.size.data(), end, choices.width);
  bool understood = width.ec == std::errc{} && choices.width > 0;
  if (understood && width.ptr == end) {
    choices.height = choices.width;
  } else {
    understood = understood && *width.ptr == 'x';
    const auto height = understood ? std::from_chars(width.ptr + 1, end, choices.height) : width;
    understood = understood && height.ec == std::errc{} && height.ptr == end;
  }
  if (!understood) throw Error("--size must be WIDTHxHEIGHT, such as 400x300, or SIDE; got '{}'.", options.size);
  require_size(choices);
  return choices;
}

/// The texture of all instances, with a word about UVs that do not serve well.
void set_bake(render::View& view, const Options& options, std::size_t instances) {
  if (instances == 0) throw Error("--bake draws textures of single objects; this scene has nothing but instances.");
  render::Bake bake;
  bake.view_from = render::parse_view_from(options.view_from);
  for (std::size_t i = 0; i < instances; ++i) bake.instances.push_back(i);
  view.set_bake(bake);
  for (const std::string& warning : warnings(view.uv_use())) fmt::print(stderr, "mesograin-render: {}\n", warning);
}

void run(const Options& options) {
  const std::filesystem::path output = options.output;
  if (output.extension() != ".exr")
    throw Error("The output is OpenEXR and must end in .exr; got '{}'.", options.output);
  const io::SceneFile file = io::read_scene(options.scene, parse_choices(options));
  {
    const tool::Uninterrupted uninterrupted;
    base::require_writable(output);
  }

  tool::Progress progress;
  render::View view(file.width, file.height, options.seed, !options.budget.seconds);
  view.set_scene(file.scene);
  view.set_camera(file.camera);
  if (options.bake) set_bake(view, options, file.scene.instances.size());
  const std::string came = tool::draw(view, options.budget, progress, options.quiet);
  for (const std::string& warning : view.warnings()) fmt::print(stderr, "mesograin-render: {}\n", warning);
  const double seconds = progress.seconds();

  image::Image picture{.width = file.width, .height = file.height, .channels = 4, .pixels = {}};
  picture.pixels.resize(static_cast<std::size_t>(file.width) * static_cast<std::size_t>(file.height) * 4);
  view.read(picture.pixels.data());
  if (options.bake) picture = image::extend_margin(picture.view(), options.margin);
  const gl::DeviceInfo& device = gl::ContextThread::instance().device_info();
  {
    const tool::Uninterrupted uninterrupted;
    std::map<std::string, std::string> attributes = tool::provenance(file, view.samples(), options.seed, device);
    if (options.bake) attributes.merge(tool::bake_provenance(options.view_from, options.margin));
    io::write_exr(output, picture.view(), {}, attributes);
  }
  if (options.quiet) return;
  progress.finish();
  fmt::print(stderr, "{}: {} x {} pixels, {} samples{} by {} in {:.1f} s on {}\n", output.string(), file.width,
             file.height, view.samples(), came.empty() ? "" : ", " + came + ",", tool::model_names(file.scene), seconds,
             device.renderer);
}

int command(int argument_count, char** arguments) {
  Options options;
  CLI::App app(
      "Renders or bakes a scene in JSON to OpenEXR: linear RGB radiance and coverage, float32, row 0 at the top.",
      "mesograin-render");
  app.add_option("scene", options.scene, "Scene in JSON")->required()->option_text("SCENE.json");
  app.add_option("-o,--output", options.output, "Picture to write")->required()->option_text("OUT.exr");
  app.add_option("-m,--model", options.model,
                 fmt::format("{}; default: the best for the material's kind", fmt::join(io::models_to_choose(), ", ")))
      ->check(CLI::IsMember(io::models_to_choose()))
      ->option_text("MODEL");
  CLI::Option* samples = app.add_option("-n,--samples", options.budget.samples, "Samples for each pixel; default 64")
                             ->check(CLI::Range(1, 1000000))
                             ->option_text("N");
  CLI::Option* error = app.add_option_function<double>(
                              "--error", [&](double percent) { options.budget.error = 0.01 * percent; },
                              "Instead: until the noise of a pixel is so many percent of its light; --model auto then "
                              "chooses models measured to be as near")
                           ->check(CLI::Range(0.01, 100.0))
                           ->excludes(samples)
                           ->option_text("PERCENT");
  app.add_option_function<double>(
         "--seconds", [&](double seconds) { options.budget.seconds = seconds; },
         "Instead: for so long, with what is known of light in and between grains by then")
      ->check(CLI::Range(0.01, 1e6))
      ->excludes(samples)
      ->excludes(error)
      ->option_text("S");
  app.add_option("--seed", options.seed, "Of the samples' places and of the models' own; default 0")->option_text("S");
  app.add_option("--size", options.size, "Pixels, instead of the scene's resolution")
      ->option_text("WIDTHxHEIGHT or SIDE");
  app.add_option(
         "--exchange", options.exchange,
         fmt::format("Light between grains: {}; default: as the scene says", fmt::join(scene::exchange_names, ", ")))
      ->check(CLI::IsMember(std::vector<std::string>(scene::exchange_names.begin(), scene::exchange_names.end())))
      ->option_text("HOW");
  CLI::Option* bake =
      app.add_flag("--bake", options.bake, "The surface's texture, unwrapped at its UVs with v upwards");
  app.add_option(
         "--view-from", options.view_from,
         fmt::format("What looks at a baked surface: {}; default the first", fmt::join(render::view_from_names, ", ")))
      ->needs(bake)
      ->check(CLI::IsMember(std::vector<std::string>(render::view_from_names.begin(), render::view_from_names.end())))
      ->option_text("WHERE");
  app.add_option("--margin", options.margin, "Texels by which what is baked reaches beyond the UVs; default 0")
      ->needs(bake)
      ->check(CLI::Range(0, 32767))
      ->option_text("TEXELS");
  app.add_flag("-q,--quiet", options.quiet, "No progress, only errors");
  app.set_version_flag("--version", MESOGRAIN_VERSION);
  app.footer(std::string(exit_codes));
  try {
    app.parse(argument_count, arguments);
  } catch (const CLI::ParseError& error) {
    std::ostringstream complaint;
    const int code = app.exit(error, std::cout, complaint);
    fmt::print(stderr, "{}", base::readable(complaint.str()));
    return code == 0 ? 0 : exit_usage;
  }

  tool::handle_interruptions();
  int code = 0;
  try {
    run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "mesograin-render: {}\n", base::readable(error.what()));
    code = exit_failure;
  }
  gl::ContextThread::shut_down();
  return code;
}

}  // namespace

int main(int argument_count, char** arguments) {
  try {
    return command(argument_count, arguments);
  } catch (...) {
    // Only saying what went wrong can still have failed, and then nothing is left to say it with.
    return exit_failure;
  }
}
