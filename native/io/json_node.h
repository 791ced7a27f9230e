// A value in a JSON file that knows its place, so that every mistake is named where it stands.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/readable.h"

namespace mesograin::io {

using Json = nlohmann::json;

/// What tells how a reference was made, and nothing about the scene.
inline constexpr std::array<std::string_view, 28> provenance_keys{"about",
                                                                  "cautions",
                                                                  "composite_of",
                                                                  "engine",
                                                                  "file",
                                                                  "halves",
                                                                  "images",
                                                                  "integrator",
                                                                  "light_set",
                                                                  "mask",
                                                                  "max",
                                                                  "maxdepth",
                                                                  "method",
                                                                  "name",
                                                                  "noise",
                                                                  "note",
                                                                  "noise_rse_max",
                                                                  "noise_rse_mean",
                                                                  "noise_relative_to_mean",
                                                                  "mean_inside_mask",
                                                                  "pbrt_commit",
                                                                  "seconds_each_render",
                                                                  "seeds",
                                                                  "sensor",
                                                                  "spp_per_half",
                                                                  "symmetry",
                                                                  "units",
                                                                  "wavelengths"};

/// A value and its place.
class Node {
 public:
  Node(const Json& value, std::string path) : value_(value), path_(std::move(path)) {}

  template <typename... Arguments>
  [[noreturn]] void fail(fmt::format_string<Arguments...> need, Arguments&&... arguments) const {
    throw Error("{} {}; got {}.", path_.empty() ? "the scene" : path_,
                fmt::format(need, std::forward<Arguments>(arguments)...), brief());
  }

  const std::string& path() const { return path_; }
  bool is_number() const { return value_.is_number(); }
  bool is_text() const { return value_.is_string(); }
  bool is_object() const { return value_.is_object(); }

  /// Refuses keys that are neither in `known` nor in `ignored`.
  void require_object(std::span<const std::string_view> known, std::span<const std::string_view> ignored = {}) const {
    if (!value_.is_object()) fail("must be an object");
    for (const auto& item : value_.items())
      if (std::find(known.begin(), known.end(), item.key()) == known.end() &&
          std::find(ignored.begin(), ignored.end(), item.key()) == ignored.end())
        throw Error("{} is an unknown key; those allowed {} are {}.", child_path(item.key()),
                    path_.empty() ? "in the scene" : "in " + path_, fmt::join(known, ", "));
  }

  bool has(std::string_view key) const { return value_.contains(key); }
  Node operator[](std::string_view key) const {
    if (!has(key)) throw Error("{} is missing; {} needs it.", child_path(key), path_.empty() ? "the scene" : path_);
    return {value_.at(std::string(key)), child_path(key)};
  }

  /// Of an object.
  std::vector<std::string> keys() const {
    std::vector<std::string> names;
    for (const auto& item : value_.items()) names.push_back(item.key());
    return names;
  }

  std::size_t size() const { return value_.is_array() ? value_.size() : 0; }
  Node operator[](std::size_t index) const { return {value_.at(index), fmt::format("{}[{}]", path_, index)}; }

  double number(double low = -std::numeric_limits<double>::max(),
                double high = std::numeric_limits<double>::max()) const {
    if (!value_.is_number()) fail("must be a number");
    const double number = value_.get<double>();
    if (!(number >= low && number <= high)) {
      if (high == std::numeric_limits<double>::max()) fail("must be a finite number of at least {}", low);
      fail("must lie between {} and {}", low, high);
    }
    return number;
  }

  int integer(int low, int high) const {
    if (!value_.is_number_integer()) fail("must be a whole number from {} to {}", low, high);
    return static_cast<int>(number(low, high));
  }

  std::string text() const {
    if (!value_.is_string()) fail("must be text");
    return value_.get<std::string>();
  }

  bool boolean() const {
    if (!value_.is_boolean()) fail("must be true or false");
    return value_.get<bool>();
  }

  glm::dvec3 vector() const {
    if (size() != 3) fail("must be a list of 3 numbers");
    return {(*this)[std::size_t{0}].number(), (*this)[1].number(), (*this)[2].number()};
  }

  /// One number for all channels, or a list of three.
  glm::dvec3 rgb(double high = std::numeric_limits<double>::max()) const {
    if (value_.is_number()) return glm::dvec3(number(0.0, high));
    if (size() != 3) fail("must be a number or a list of 3 numbers");
    return {(*this)[std::size_t{0}].number(0.0, high), (*this)[1].number(0.0, high), (*this)[2].number(0.0, high)};
  }

 private:
  std::string child_path(std::string_view key) const {
    const std::string name = base::shortened(key, 60);
    return path_.empty() ? name : fmt::format("{}.{}", path_, name);
  }

  std::string brief() const { return base::shortened(value_.dump(-1, ' ', true, Json::error_handler_t::replace), 60); }

  const Json& value_;
  std::string path_;
};

/// Holds a sentence of another room against the key that it is about.
template <typename Action>
auto at(const Node& node, Action action) {
  try {
    return action();
  } catch (const Error& error) {
    throw Error("{}: {}", node.path(), error.what());
  }
}

/// Equal but for rounding in the file.
inline bool agree(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::length(a - b) <= 1e-5 * (glm::length(a) + glm::length(b));
}

}  // namespace mesograin::io
