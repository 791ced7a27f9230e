// A grain's material as every room names it, what is allowed of it, and what its model is known to need.
#pragma once

#include <cstddef>
#include <string_view>

#include "scene/grain.h"

namespace mesograin::scene {

/// Throws Error, naming the parameter, the value that came and the range allowed.
void validate(const Material& material);

/// The name of a Model, Boundary, Masking or Profile.
template <typename Choice>
constexpr std::string_view name_of(Choice value) {
  return names_of(value)[static_cast<std::size_t>(value)];
}

/// Where `name` stands among names_of(Choice). Throws Error listing the names allowed.
template <typename Choice>
Choice parse_choice(std::string_view name);

inline Model parse_model(std::string_view name) { return parse_choice<Model>(name); }

constexpr const ModelTraits& traits_of(Model model) { return model_traits[static_cast<std::size_t>(model)]; }

/// Throws Error that lists what `parameter` may be called, unless one of `names` is `name`; else its place among them.
std::size_t find_name(std::string_view parameter, std::span<const std::string_view> names, std::string_view name);

template <typename Choice>
Choice parse_choice(std::string_view name) {
  return static_cast<Choice>(find_name(parameter_of(Choice{}), names_of(Choice{}), name));
}

}  // namespace mesograin::scene
