// Turns a pass file and its #includes into one text, and a driver's line numbers back into files and lines.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mesograin::gl {

class ShaderSource {
 public:
  /// Assembles files (paths relative to shaders/): #version, one #define for each of `defines` ("NAME" or "NAME
  /// value"), the files in order, with every #include "path" replaced by that file's text once. Throws Error for a file
  /// that does not exist.
  ShaderSource(const std::vector<std::string>& paths, const std::vector<std::string>& defines);

  /// As above for a text that is in no file, shown as `name` in messages.
  static ShaderSource from_text(std::string_view name, std::string_view text, const std::vector<std::string>& defines);

  const std::string& text() const { return text_; }

  /// The driver's log with "0:12(3)" and "0(12)" rewritten as "physics/fresnel.glsl:12".
  std::string explain(std::string_view log) const;

 private:
  ShaderSource() = default;
  void begin(const std::vector<std::string>& defines);
  void append(std::string_view name, std::string_view text);
  void include(std::string_view path, std::string_view from);

  std::string text_;
  std::vector<std::string> files_;  // the number that #line gives each file is its index here
};

}  // namespace mesograin::gl
