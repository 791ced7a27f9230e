// The tables stored in tests/data/referee: which cases, how many photons.
#pragma once

#include <filesystem>

namespace mesograin::referee {

/// half_space.json: reflectance per transmitted flux over albedo, eta and incidence.
void make_half_space_table(const std::filesystem::path& directory, unsigned threads);

/// sphere.json: exitance in parallel light over material, eta and radius.
void make_sphere_table(const std::filesystem::path& directory, unsigned threads);

/// sphere_anisotropic.json: the same for media that scatter forwards or backwards.
void make_anisotropic_sphere_table(const std::filesystem::path& directory, unsigned threads);

}  // namespace mesograin::referee
