// Whole files: read at once, or written so that they appear complete or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace mesograin::base {

/// Throws Error when there is no such file, it is not a regular file, or it can't be read.
std::string read_file(const std::filesystem::path& path);

/// Throws the Error that write_file_atomically would, as far as it can be known before there is anything to write.
void require_writable(const std::filesystem::path& path);

/// Writes a temporary file in the same folder, flushes it to the disk and renames it to `path`; on any failure the
/// temporary file is removed, whatever stood at `path` is left as it was, and Error is thrown.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

}  // namespace mesograin::base
