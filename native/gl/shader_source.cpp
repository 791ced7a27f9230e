// Expands #includes with #line markers.
#include "gl/shader_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>

#include "base/error.h"
#include "gl/shader_library.h"

namespace mesograin::gl {

ShaderSource::ShaderSource(const std::vector<std::string>& paths, const std::vector<std::string>& defines) {
  begin(defines);
  for (const std::string& path : paths) include(path, "the renderer");
}

ShaderSource ShaderSource::from_text(std::string_view name, std::string_view text,
                                     const std::vector<std::string>& defines) {
  ShaderSource source;
  source.begin(defines);
  source.append(name, text);
  return source;
}

void ShaderSource::begin(const std::vector<std::string>& defines) {
  text_ = "#version 450 core\n";
  for (const std::string& define : defines) text_ += "#define " + define + "\n";
}

void ShaderSource::include(std::string_view path, std::string_view from) {
  if (std::find(files_.begin(), files_.end(), path) != files_.end()) return;
  const std::vector<ShaderFile>& library = shader_files();
  const auto file =
      std::find_if(library.begin(), library.end(), [&](const ShaderFile& candidate) { return candidate.path == path; });
  if (file == library.end()) throw Error("There is no shader file '{}', which {} includes.", path, from);
  append(path, file->text);
}

void ShaderSource::append(std::string_view name, std::string_view text) {
  const std::size_t number = files_.size();
  files_.emplace_back(name);
  text_ += fmt::format("#line 1 {}\n", number);
  std::size_t line_number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++line_number;
    constexpr std::string_view directive = "#include \"";
    if (line.substr(0, directive.size()) == directive) {
      const std::string_view path = line.substr(directive.size(), line.rfind('"') - directive.size());
      include(path, name);
      text_ += fmt::format("#line {} {}\n", line_number + 1, number);
    } else {
      text_ += line;
      text_ += '\n';
    }
  }
}

std::string ShaderSource::explain(std::string_view log) const {
  static const std::regex place(R"((^|\n)(ERROR: |WARNING: )?(\d+)[:(](\d+)\)?(\(\d+\))?)");
  std::string explained;
  std::string rest(log);
  for (std::smatch match; std::regex_search(rest, match, place); rest = match.suffix()) {
    const std::size_t number = std::stoul(match[3]);
    explained += match.prefix().str() + match[1].str();
    explained += (number < files_.size() ? files_[number] : "?") + ":" + match[4].str();
  }
  return explained + rest;
}

}  // namespace mesograin::gl
