// The command's way from a scene in JSON to a picture in OpenEXR.
#pragma once

#include <filesystem>
#include <functional>

#include "io/scene_json.h"
#include "mesh_heap_picture.h"
#include "picture.h"

namespace mesograin::referee {

/// The sphere of a scene with its camera and lights. Throws Error unless the scene's geometry is a sphere and its
/// material a medium.
PictureCase picture_case(const io::SceneFile& file);

/// Whether a scene has several objects, or instances of one: then all of its light is traced.
bool is_heap(const io::SceneFile& file);

MeshHeapCase mesh_heap_case(const io::SceneFile& file);

/// Writes R, G, B, A (premultiplied radiance, coverage) and noise.R, noise.G, noise.B, with what made them in the
/// header.
void write_picture(const std::filesystem::path& path, const io::SceneFile& file, const PictureCase& setup,
                   const Picture& picture);
void write_picture(const std::filesystem::path& path, const io::SceneFile& file, const MeshHeapCase& setup,
                   const Picture& picture);

}  // namespace mesograin::referee
