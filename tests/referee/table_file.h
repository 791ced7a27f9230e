// A JSON table that grows case by case and resumes where it stopped.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "batches.h"

namespace mesograin::referee {

/// One case still to trace: `key` tells it from the others, `trace` returns what to store beside the key.
struct TableCase {
  nlohmann::json key;
  double cost = 1;  ///< relative time, for the estimate of what is left
  std::function<nlohmann::json()> trace;
};

/// Five significant digits: below the noise, and short in the file.
double rounded(double value);
nlohmann::json values(const std::vector<Estimate>& estimates);
nlohmann::json noises(const std::vector<Estimate>& estimates);

/// Fills `path`: keeps the cases already there if the file was made with the same `head` (a JSON object), traces the
/// others, and writes the file (atomically) after each; says what it does and how long it will take on stderr.
void fill_table(const std::filesystem::path& path, const nlohmann::json& head, const std::vector<TableCase>& cases);

}  // namespace mesograin::referee
