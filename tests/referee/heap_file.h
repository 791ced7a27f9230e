// The command's way from a heap in JSON to a picture in OpenEXR.
#pragma once

#include <filesystem>
#include <vector>

#include "heap_picture.h"

namespace mesograin::referee {

/// A heap's cases, one for each channel that differs. Of a file with "spheres" (the path of a table of x, y, z and
/// radius beside it), "camera", "resolution", "material" and "light", as tests/data/heaps/manifest.json has them.
/// Throws Error.
std::vector<HeapCase> heap_cases(const std::filesystem::path& path);

/// Writes R, G, B, and of green alone direct, crossed, alone and noise (see HeapPicture).
void write_heap(const std::filesystem::path& path, const std::vector<HeapCase>& cases,
                const std::vector<HeapPicture>& pictures);

}  // namespace mesograin::referee
