// mesograin-referee: the photon Monte Carlo that judges the product's physics, as a command.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <exception>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/file.h"
#include "half_space.h"
#include "heap_file.h"
#include "io/scene_json.h"
#include "picture_file.h"
#include "table_file.h"
#include "tables.h"

namespace {

using namespace mesograin::referee;

void add_effort(CLI::App* command, Effort& effort) {
  command->add_option("--photons", effort.photons, "photons to trace")->capture_default_str();
  command->add_option("--seed", effort.seed, "the answer depends on it alone")->capture_default_str();
  command->add_option("--threads", effort.threads, "0: as many as the machine has")->capture_default_str();
}

/// Says on stderr, at most once a second, how far the picture is and how long it will take.
class Progress {
 public:
  explicit Progress(int rows) : rows_(rows) {}

  void row_done() {
    const std::scoped_lock lock(mutex_);
    ++done_;
    const auto now = Clock::now();
    if (now - said_ < std::chrono::seconds(1)) return;
    said_ = now;
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    fmt::print(stderr, "{} of {} rows, about {:.0f} s left\n", done_, rows_, elapsed / done_ * (rows_ - done_));
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::mutex mutex_;
  const int rows_;
  int done_ = 0;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point said_ = start_;
};

void add_half_space(CLI::App& application) {
  CLI::App* command =
      application.add_subcommand("half-space", "reflectance of a half-space per transmitted flux, as JSON");
  auto setup = std::make_shared<HalfSpaceCase>();
  auto effort = std::make_shared<Effort>();
  setup->albedos = {0.1, 0.5, 0.8, 0.9, 0.95, 0.99, 0.999};
  command->add_option("--eta", setup->eta, "index inside over index outside")
      ->check(CLI::Range(0.5, 4.0))
      ->capture_default_str();
  command->add_option("--g", setup->g, "mean cosine of scattering")
      ->check(CLI::Range(-0.99, 0.99))
      ->capture_default_str();
  command->add_option("--albedo", setup->albedos, "sigma_s / sigma_t, any number of them")->check(CLI::Range(0.0, 1.0));
  command->add_option("--cosine", setup->incidence.cosine, "of the incident beam, outside")
      ->check(CLI::Range(0.01, 1.0))
      ->capture_default_str();
  command->add_flag("--diffuse", setup->incidence.diffuse, "cosine-weighted incidence instead of a beam");
  add_effort(command, *effort);
  command->callback([setup, effort] {
    const HalfSpaceResult result = trace_half_space(*setup, *effort);
    const nlohmann::json answer{{"albedos", setup->albedos},
                                {"single", values(result.single)},
                                {"single_noise", noises(result.single)},
                                {"multiple", values(result.multiple)},
                                {"multiple_noise", noises(result.multiple)},
                                {"total", values(result.total)},
                                {"total_noise", noises(result.total)}};
    fmt::print("{}\n", answer.dump(1));
  });
}

void add_render(CLI::App& application) {
  CLI::App* command = application.add_subcommand(
      "render", "a picture of a scene's sphere, mesh or many meshes, in OpenEXR, with its noise");
  auto scene_path = std::make_shared<std::string>();
  auto output = std::make_shared<std::string>();
  auto choices = std::make_shared<mesograin::io::SceneChoices>();
  auto wanted = std::make_shared<PictureCase>();
  auto scattered = std::make_shared<bool>(false);
  command->add_option("scene", *scene_path, "scene in JSON")->required()->option_text("SCENE.json");
  command->add_option("-o,--output", *output, "picture to write")->required()->option_text("OUT.exr");
  command->add_option("-n,--samples", wanted->samples, "paths a pixel")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  command->add_option("--width", choices->width, "pixels, instead of the scene's")->check(CLI::Range(1, 16384));
  command->add_option("--height", choices->height, "pixels, instead of the scene's")->check(CLI::Range(1, 16384));
  command->add_option("--seed", wanted->seed, "the picture depends on it alone")->capture_default_str();
  command->add_option("--threads", wanted->threads, "0: as many as the machine has")->capture_default_str();
  command->add_flag("--scattered", *scattered, "of many meshes, no light that only surfaces have sent on");
  command->callback([=] {
    mesograin::base::require_writable(*output);
    const mesograin::io::SceneFile file = mesograin::io::read_scene(*scene_path, *choices);
    Progress progress(file.height);
    const auto trace = [&](auto setup, const auto& tracer) {
      setup.samples = wanted->samples;
      setup.seed = wanted->seed;
      setup.threads = wanted->threads;
      write_picture(*output, file, setup, tracer(setup, [&progress] { progress.row_done(); }));
    };
    if (is_heap(file)) {
      MeshHeapCase setup = mesh_heap_case(file);
      setup.scattered = *scattered;
      trace(std::move(setup), trace_mesh_heap);
    } else {
      trace(picture_case(file), trace_picture);
    }
  });
}

void add_heap(CLI::App& application) {
  CLI::App* command = application.add_subcommand("heap", "a picture of a heap of balls, in OpenEXR, with its shares");
  auto heap_path = std::make_shared<std::string>();
  auto output = std::make_shared<std::string>();
  auto wanted = std::make_shared<HeapCase>();
  command->add_option("heap", *heap_path, "heap in JSON")->required()->option_text("HEAP.json");
  command->add_option("-o,--output", *output, "picture to write")->required()->option_text("OUT.exr");
  command->add_option("-n,--samples", wanted->samples, "paths a pixel")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  command->add_option("--seed", wanted->seed, "the picture depends on it alone")->capture_default_str();
  command->add_option("--threads", wanted->threads, "0: as many as the machine has")->capture_default_str();
  command->callback([=] {
    mesograin::base::require_writable(*output);
    std::vector<HeapCase> cases = heap_cases(*heap_path);
    std::vector<HeapPicture> pictures;
    for (HeapCase& setup : cases) {
      setup.samples = wanted->samples;
      setup.seed = wanted->seed;
      setup.threads = wanted->threads;
      pictures.push_back(trace_heap(setup));
    }
    write_heap(*output, cases, pictures);
  });
}

void add_tables(CLI::App& application) {
  CLI::App* command = application.add_subcommand("tables", "make or complete the tables the tests read");
  auto directory = std::make_shared<std::string>("tests/data/referee");
  auto threads = std::make_shared<unsigned>(1);
  auto names = std::make_shared<std::vector<std::string>>(
      std::vector<std::string>{"half_space", "sphere", "sphere_anisotropic"});
  command->add_option("--directory", *directory, "where the tables are")->capture_default_str();
  command->add_option("--threads", *threads, "0: as many as the machine has")->capture_default_str();
  command->add_option("--only", *names, "which tables, in this order")->check(CLI::IsMember(*names));
  command->callback([directory, threads, names] {
    for (const std::string& name : *names) {
      if (name == "half_space") make_half_space_table(*directory, *threads);
      if (name == "sphere") make_sphere_table(*directory, *threads);
      if (name == "sphere_anisotropic") make_anisotropic_sphere_table(*directory, *threads);
    }
  });
}

int command(int argument_count, char** arguments) {
  CLI::App application{"A double-precision photon Monte Carlo that shares no code with the product's physics.",
                       "mesograin-referee"};
  application.require_subcommand(1);
  add_half_space(application);
  add_render(application);
  add_heap(application);
  add_tables(application);
  try {
    application.parse(argument_count, arguments);
  } catch (const CLI::ParseError& error) {
    return application.exit(error);
  } catch (const std::exception& error) {
    fmt::print(stderr, "mesograin-referee: {}\n", error.what());
    return 1;
  }
  return 0;
}

}  // namespace

int main(int argument_count, char** arguments) {
  try {
    return command(argument_count, arguments);
  } catch (...) {
    // Only saying what went wrong can still have failed, and then nothing is left to say it with.
    return 1;
  }
}
