// What a kind takes is what the model that answers it reads.
#include "io/material_json.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "io/finish_json.h"
#include "io/number.h"
#include "io/scene_json.h"

namespace mesograin::io {

using namespace scene;

namespace {

/// What `interface` says in words of what `boundary` says in one name.
Boundary read_interface(const Node& node, double roughness) {
  const std::string interface = node.text();
  if (interface == "none (index-matched)") return Boundary::index_matched;
  constexpr std::string_view rough = "GGX alpha ";
  if (interface.starts_with(rough)) {
    const auto alpha = parse_float(std::string_view(interface).substr(rough.size()));
    if (!alpha || std::abs(*alpha - roughness) > 1e-6) node.fail("must name the roughness, {}", roughness);
  } else if (interface != "smooth") {
    node.fail("must be \"smooth\", \"GGX alpha <roughness>\" or \"none (index-matched)\"");
  }
  return Boundary::dielectric;
}

void require_product(const Node& node, const char* key, const glm::dvec3& product) {
  if (node.has(key) && !agree(node[key].rgb(), product))
    node[key].fail("must be the product of its two factors, [{}, {}, {}]", product.x, product.y, product.z);
}

void read_parameter(const Node& node, const Parameter& parameter, double& value) {
  value = node.number(parameter.least, parameter.most);
}
void read_parameter(const Node& node, const Parameter& parameter, glm::dvec3& value) {
  value = node.rgb(parameter.most);
}
void read_parameter(const Node& node, const Parameter& /*parameter*/, bool& value) { value = node.boolean(); }
template <typename Choice>
void read_parameter(const Node& node, const Parameter& /*parameter*/, Choice& value) {
  value = at(node, [&] { return parse_choice<Choice>(node.text()); });
}

/// Beside a parameter, what says the same in other words.
std::vector<std::string_view> synonyms(std::string_view parameter) {
  if (parameter == "roughness") return {"remaproughness"};
  if (parameter == "boundary") return {"interface"};
  if (parameter == "sigma_a") return {"sigma_a_times_scale"};
  if (parameter == "sigma_s") return {"sigma_s_times_scale"};
  return {};
}

void read_synonyms(const Node& node, Material& material) {
  if (node.has("interface")) {
    if (node.has("boundary")) node["interface"].fail("must not stand beside boundary, which says the same");
    material.boundary = read_interface(node["interface"], material.roughness);
  }
  require_product(node, "sigma_s_times_scale", material.sigma_s * material.scale);
  require_product(node, "sigma_a_times_scale", material.sigma_a * material.scale);
  if (node.has("remaproughness") && node["remaproughness"].boolean())
    node["remaproughness"].fail("must be false, because roughness is the GGX alpha itself");
}

/// The models that answer a kind, the preferred one first.
std::vector<Model> models_of(const Node& kind) {
  const std::string name = kind.text();
  std::vector<Model> models;
  std::vector<std::string> known;
  for (std::size_t i = 0; i < model_traits.size(); ++i) {
    const ModelTraits& traits = model_traits[i];
    for (const std::string_view each : traits.kinds)
      if (const std::string quoted = fmt::format("\"{}\"", each); std::ranges::find(known, quoted) == known.end())
        known.push_back(quoted);
    if (std::ranges::find(traits.kinds, name) != traits.kinds.end())
      models.insert(traits.preferred ? models.begin() : models.end(), static_cast<Model>(i));
  }
  if (models.empty()) kind.fail("must be one of {}", fmt::join(known, ", "));
  return models;
}

Json to_value(double value) { return value; }
Json to_value(bool value) { return value; }
Json to_value(const glm::dvec3& value) { return {value.x, value.y, value.z}; }
template <typename Choice>
Json to_value(Choice value) {
  return name_of(value);
}

}  // namespace

bool answers_kind(const Node& kind, Model model) {
  const std::vector<Model> models = models_of(kind);
  return std::ranges::find(models, model) != models.end();
}

Material read_material(const Node& node, const std::optional<Model>& asked, const std::filesystem::path& folder) {
  const std::vector<Model> models = models_of(node["kind"]);
  Material material;
  material.model = asked.value_or(models.front());
  if (std::ranges::find(models, material.model) == models.end()) {
    std::vector<std::string_view> names;
    names.reserve(models.size());
    for (const Model model : models) names.push_back(name_of(model));
    throw Error("{}.kind is \"{}\", which {} answers; got the model {}.", node.path(), node["kind"].text(),
                fmt::join(names, " or "), name_of(material.model));
  }
  const std::span<const std::string_view> parameters = traits_of(material.model).parameters;
  std::vector<std::string_view> keys{"kind"};
  keys.insert(keys.end(), parameters.begin(), parameters.end());
  for (const std::string_view parameter : parameters)
    for (const std::string_view synonym : synonyms(parameter)) keys.push_back(synonym);
  const bool opaque = !traits_of(material.model).translucent;
  if (opaque) keys.emplace_back("finish");
  node.require_object(keys, provenance_keys);
  for_each_parameter([&](const Parameter& parameter, auto member) {
    if (std::ranges::find(parameters, parameter.name) == parameters.end()) return;
    if (parameter.required || node.has(parameter.name))
      read_parameter(node[parameter.name], parameter, material.*member);
  });
  read_synonyms(node, material);
  if (opaque && node.has("finish")) material.finish = read_finish(node["finish"], folder);
  at(node, [&] { validate(material); });
  return material;
}

std::string to_json(const Material& material) {
  Json json;
  for_each_parameter(
      [&](const Parameter& parameter, auto member) { json[std::string(parameter.name)] = to_value(material.*member); });
  return json.dump();
}

}  // namespace mesograin::io
