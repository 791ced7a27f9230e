# Writes shader_library.cpp: the text of every file in SHADERS (semicolon list), as raw string literals.
set(content "// Generated from shaders/.\n#include \"gl/shader_library.h\"\n\nnamespace mesograin::gl {\n\n")
string(APPEND content "const std::vector<ShaderFile>& shader_files() {\n  static const std::vector<ShaderFile> files{\n")
foreach(shader IN LISTS SHADERS)
  file(READ ${ROOT}/${shader} text)
  string(APPEND content "      {\"${shader}\", R\"~glsl~(${text})~glsl~\"},\n")
endforeach()
string(APPEND content "  };\n  return files;\n}\n\n}  // namespace mesograin::gl\n")
file(WRITE ${OUTPUT} "${content}")
