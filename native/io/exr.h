// OpenEXR files: linear float pictures that carry their provenance as string attributes in the header.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "image/image.h"

namespace mesograin::io {

enum class SampleFormat { float32, half };

struct ExrFile {
  image::Image image;
  std::vector<std::string> channels;              ///< one name for each channel of `image`
  std::map<std::string, std::string> attributes;  ///< the header's string attributes
};

/// Reads the data window of a single-part scanline or tiled file (a tiled file's finest level), whatever its
/// compression; half and unsigned integer samples become float, NaN and Inf stay. Channels come layer by layer, within
/// a layer R, G, B, A first and the others by name.
/// Throws Error if the file is missing, corrupt, cut short, deep, of several parts, has subsampled channels or
/// announces more than 65535 pixels a side or 2^30 samples in all (checked before anything is allocated).
ExrFile read_exr(const std::filesystem::path& path);

/// The same from a file's bytes.
ExrFile parse_exr(std::string bytes);

/// Writes scanlines with ZIP compression; `path` appears complete or not at all. Without names, 1 channel is Y, 3 are
/// R G B and 4 are R G B A. In half, values from 65520 up become Inf.
/// Throws Error if names, attributes or the image's shape don't fit, or the file can't be written.
void write_exr(const std::filesystem::path& path, const image::ImageView& image, std::vector<std::string> channels = {},
               const std::map<std::string, std::string>& attributes = {}, SampleFormat format = SampleFormat::float32);

}  // namespace mesograin::io
