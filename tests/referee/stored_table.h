// A stored table as the tests read it.
#pragma once

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace mesograin::referee {

class StoredTable {
 public:
  explicit StoredTable(const std::string& name) {
    std::ifstream stream(std::filesystem::path(MESOGRAIN_REFEREE_TABLES) / name);
    table_ = nlohmann::json::parse(stream);
  }
  std::vector<double> head(const std::string& name) const { return table_.at(name).get<std::vector<double>>(); }
  const nlohmann::json& cases() const { return table_.at("cases"); }

 private:
  nlohmann::json table_;
};

}  // namespace mesograin::referee
