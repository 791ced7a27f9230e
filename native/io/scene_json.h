// Scenes in JSON, for scripts and for the command line; docs/scene-json.md describes the format.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/auto.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace mesograin::io {

/// A scene with the camera and the size of the picture that go with it.
struct SceneFile {
  scene::Scene scene;
  scene::Camera camera;
  int width = 0;
  int height = 0;
  std::string source;  ///< the JSON it came from, on one line
};

/// What the caller of a scene may decide in its stead.
struct SceneChoices {
  std::optional<scene::Model> model;  ///< else the best that answers the material's kind
  int width = 0;                      ///< 0: as in the scene
  int height = 0;
  std::optional<scene::Exchange> exchange{};       ///< else as in the scene
  bool automatic = false;                          ///< instead of `model`: each translucent object's by scene::advise
  double tolerance = scene::automatic::tolerance;  ///< for that, in %
};

/// Takes a model's name, or "auto". Throws Error for another.
void choose_model(SceneChoices& choices, std::string_view name);

/// What choose_model takes.
std::vector<std::string> models_to_choose();

/// Throws Error unless the chosen size is one that can be rendered, or is left to the scene.
void require_size(const SceneChoices& choices);

/// Reads a file; mesh files are looked for beside it.
/// Throws Error that names the file and the key, what is needed and what came.
SceneFile read_scene(const std::filesystem::path& path, const SceneChoices& choices = {});

/// The same from JSON text; mesh files are looked for in `folder`.
SceneFile parse_scene(std::string_view text, const std::filesystem::path& folder, const SceneChoices& choices = {});

/// Writes a scene that read_scene reads as it is, `file.source` aside: the JSON at `path`, beside it each mesh as PLY,
/// each array of instances as NPY and the world's image as EXR, all named after it. Throws Error if a file can't be
/// written.
void write_scene(const std::filesystem::path& path, const SceneFile& file);

/// A material as JSON on one line, all parameters by their names.
std::string to_json(const scene::Material& material);

}  // namespace mesograin::io
