// Reads, extends and writes a table one case at a time.
#include "table_file.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

namespace mesograin::referee {
namespace {

nlohmann::json cases_already_there(const std::filesystem::path& path, const nlohmann::json& head) {
  std::ifstream stream(path);
  if (!stream) return nlohmann::json::array();
  nlohmann::json table = nlohmann::json::parse(stream, nullptr, false);
  if (!table.is_object() || !table.contains("cases")) return nlohmann::json::array();
  nlohmann::json cases = std::move(table["cases"]);
  table.erase("cases");
  return table == head ? cases : nlohmann::json::array();
}

bool belongs_to(const nlohmann::json& stored, const nlohmann::json& key) {
  for (const auto& [name, value] : key.items())
    if (!stored.contains(name) || stored[name] != value) return false;
  return true;
}

/// One line a case and one a list of the head, so that a change of one case is a change of one line.
void write_atomically(const std::filesystem::path& path, const nlohmann::json& head, const nlohmann::json& cases) {
  std::string text = "{\n";
  for (const auto& [name, value] : head.items())
    text += fmt::format("{}: {},\n", nlohmann::json(name).dump(), value.dump());
  text += "\"cases\": [\n";
  for (std::size_t i = 0; i < cases.size(); ++i) text += cases[i].dump() + (i + 1 < cases.size() ? ",\n" : "\n");
  text += "]\n}\n";
  const std::filesystem::path unfinished = path.string() + ".unfinished";
  {
    std::ofstream stream(unfinished);
    stream << text;
    if (!stream.flush())
      throw std::runtime_error(
          fmt::format("Needed to write {}, but the disk refused; free some space.", unfinished.string()));
  }
  std::filesystem::rename(unfinished, path);
}

}  // namespace

double rounded(double value) { return std::strtod(fmt::format("{:.5g}", value).c_str(), nullptr); }

nlohmann::json values(const std::vector<Estimate>& estimates) {
  nlohmann::json list = nlohmann::json::array();
  for (const Estimate& estimate : estimates) list.push_back(rounded(estimate.value));
  return list;
}

nlohmann::json noises(const std::vector<Estimate>& estimates) {
  nlohmann::json list = nlohmann::json::array();
  for (const Estimate& estimate : estimates)
    list.push_back(std::strtod(fmt::format("{:.2g}", estimate.noise).c_str(), nullptr));
  return list;
}

void fill_table(const std::filesystem::path& path, const nlohmann::json& head, const std::vector<TableCase>& cases) {
  const nlohmann::json stored = cases_already_there(path, head);
  nlohmann::json finished = nlohmann::json::array();
  std::vector<const TableCase*> missing;
  double cost_left = 0;
  for (const TableCase& wanted : cases) {
    const auto found = std::find_if(stored.begin(), stored.end(),
                                    [&](const nlohmann::json& candidate) { return belongs_to(candidate, wanted.key); });
    if (found != stored.end()) {
      finished.push_back(*found);
    } else {
      missing.push_back(&wanted);
      cost_left += wanted.cost;
    }
  }
  fmt::print(stderr, "{}: {} cases there, {} to trace\n", path.string(), finished.size(), missing.size());
  std::filesystem::create_directories(path.parent_path());
  const auto start = std::chrono::steady_clock::now();
  double cost_done = 0;
  for (const TableCase* wanted : missing) {
    nlohmann::json entry = wanted->key;
    entry.update(wanted->trace());
    finished.push_back(std::move(entry));
    write_atomically(path, head, finished);
    cost_done += wanted->cost;
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    fmt::print(stderr, "  {} done, {:.0f} s so far, about {:.0f} s left\n", wanted->key.dump(), elapsed,
               elapsed / cost_done * (cost_left - cost_done));
  }
}

}  // namespace mesograin::referee
