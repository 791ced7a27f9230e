// Compiles, links and reflects shader programs.
#include "gl/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <regex>
#include <stdexcept>
#include <utility>

#include "base/error.h"

namespace mesograin::gl {
namespace {

struct ShaderTraits {
  static GLuint create() { return 0; }
  static void destroy(GLuint name) { glDeleteShader(name); }
};

using ShaderHandle = Handle<ShaderTraits>;

// A log of several lines as a part of one sentence.
std::string in_one_line(std::string_view log) {
  std::string line;
  while (!log.empty()) {
    const std::size_t end = std::min(log.find('\n'), log.size());
    if (end > 0) line += (line.empty() ? "" : "; ") + std::string(log.substr(0, end));
    log.remove_prefix(std::min(end + 1, log.size()));
  }
  return line;
}

const char* stage_name(GLenum stage) {
  switch (stage) {
    case GL_VERTEX_SHADER:
      return "vertex";
    case GL_TESS_CONTROL_SHADER:
      return "tessellation control";
    case GL_TESS_EVALUATION_SHADER:
      return "tessellation evaluation";
    case GL_FRAGMENT_SHADER:
      return "fragment";
    default:
      return "compute";
  }
}

ShaderHandle compile(const std::string& program, GLenum stage, const ShaderSource& source) {
  ShaderHandle shader(glCreateShader(stage));
  const char* text = source.text().c_str();
  glShaderSource(shader.name(), 1, &text, nullptr);
  glCompileShader(shader.name());
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  GLint length = 0;
  glGetShaderiv(shader.name(), GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  glGetShaderInfoLog(shader.name(), length, nullptr, log.data());
  throw Error("The {} shader of '{}' does not compile on this device: {}.", stage_name(stage), program,
              in_one_line(source.explain(log.c_str())));
}

}  // namespace

GLuint Program::Traits::create() { return glCreateProgram(); }
void Program::Traits::destroy(GLuint name) { glDeleteProgram(name); }

Program::Program(std::string name, const std::vector<Stage>& stages) : name_(std::move(name)) {
  std::vector<ShaderHandle> shaders;
  for (const Stage& stage : stages) {
    shaders.push_back(compile(name_, stage.kind, stage.source));
    note_declarations(stage.source);
    glAttachShader(handle_.name(), shaders.back().name());
  }
  link();
  for (const ShaderHandle& shader : shaders) glDetachShader(handle_.name(), shader.name());
  reflect();
}

Program::Program(std::string name, const ShaderSource& vertex, const ShaderSource& fragment)
    : Program(std::move(name), {{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, fragment}}) {}

Program::Program(std::string name, const ShaderSource& compute)
    : Program(std::move(name), {{GL_COMPUTE_SHADER, compute}}) {}

void Program::note_declarations(const ShaderSource& source) {
  static const std::regex declaration(R"(\buniform\s+\w+\s+(\w+)\s*;)");
  for (std::sregex_iterator found(source.text().begin(), source.text().end(), declaration), end; found != end; ++found)
    declared_.insert((*found)[1].str());
}

void Program::link() {
  glLinkProgram(handle_.name());
  GLint linked = GL_FALSE;
  glGetProgramiv(handle_.name(), GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return;
  GLint length = 0;
  glGetProgramiv(handle_.name(), GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  glGetProgramInfoLog(handle_.name(), length, nullptr, log.data());
  throw Error("The shader program '{}' does not link on this device: {}.", name_, in_one_line(log.c_str()));
}

void Program::reflect() {
  GLint count = 0;
  GLint longest = 0;
  glGetProgramiv(handle_.name(), GL_ACTIVE_UNIFORMS, &count);
  glGetProgramiv(handle_.name(), GL_ACTIVE_UNIFORM_MAX_LENGTH, &longest);
  std::string buffer(static_cast<std::size_t>(longest), '\0');
  GLuint next_unit = 0;
  for (GLint i = 0; i < count; ++i) {
    GLsizei length = 0;
    GLint size = 0;
    GLenum type = 0;
    glGetActiveUniform(handle_.name(), static_cast<GLuint>(i), longest, &length, &size, &type, buffer.data());
    const std::string uniform = buffer.substr(0, static_cast<std::size_t>(length));
    const GLint location = glGetUniformLocation(handle_.name(), uniform.c_str());
    if (location < 0) continue;  // a member of a block
    GLuint unit = 0;
    if (type == GL_SAMPLER_2D || type == GL_SAMPLER_2D_ARRAY || type == GL_SAMPLER_3D ||
        type == GL_UNSIGNED_INT_SAMPLER_2D || type == GL_UNSIGNED_INT_SAMPLER_3D) {
      unit = next_unit++;
      glProgramUniform1i(handle_.name(), location, static_cast<GLint>(unit));
    }
    uniforms_.emplace(uniform, Uniform{location, type, unit});
  }
}

void Program::use() const { glUseProgram(handle_.name()); }

bool Program::has(std::string_view uniform) const { return uniforms_.find(uniform) != uniforms_.end(); }

bool Program::declares(std::string_view uniform) const {
  return declared_.find(uniform.substr(0, uniform.find('.'))) != declared_.end();
}

const Program::Uniform* Program::find(std::string_view uniform, GLenum type) const {
  const auto found = uniforms_.find(uniform);
  if (found == uniforms_.end()) {
    if (!declares(uniform)) throw std::logic_error(fmt::format("'{}' has no uniform '{}'", name_, uniform));
    return nullptr;
  }
  if (found->second.type != type)
    throw std::logic_error(fmt::format("uniform '{}' of '{}' has type {:#x} and was given {:#x}", uniform, name_,
                                       found->second.type, type));
  return &found->second;
}

void Program::set(std::string_view uniform, int value) const {
  if (const Uniform* found = find(uniform, GL_INT)) glProgramUniform1i(handle_.name(), found->location, value);
}

void Program::set(std::string_view uniform, float value) const {
  if (const Uniform* found = find(uniform, GL_FLOAT)) glProgramUniform1f(handle_.name(), found->location, value);
}

void Program::set(std::string_view uniform, const glm::vec2& value) const {
  if (const Uniform* found = find(uniform, GL_FLOAT_VEC2))
    glProgramUniform2fv(handle_.name(), found->location, 1, glm::value_ptr(value));
}

void Program::set(std::string_view uniform, const glm::vec3& value) const {
  if (const Uniform* found = find(uniform, GL_FLOAT_VEC3))
    glProgramUniform3fv(handle_.name(), found->location, 1, glm::value_ptr(value));
}

void Program::set(std::string_view uniform, const glm::vec4& value) const {
  if (const Uniform* found = find(uniform, GL_FLOAT_VEC4))
    glProgramUniform4fv(handle_.name(), found->location, 1, glm::value_ptr(value));
}

void Program::set(std::string_view uniform, const glm::mat3& value) const {
  if (const Uniform* found = find(uniform, GL_FLOAT_MAT3))
    glProgramUniformMatrix3fv(handle_.name(), found->location, 1, GL_FALSE, glm::value_ptr(value));
}

void Program::set(std::string_view uniform, const glm::mat4& value) const {
  if (const Uniform* found = find(uniform, GL_FLOAT_MAT4))
    glProgramUniformMatrix4fv(handle_.name(), found->location, 1, GL_FALSE, glm::value_ptr(value));
}

void Program::set(std::string_view sampler, const Texture& texture) const {
  if (const Uniform* found = find(sampler, texture.holds_numbers() ? GL_UNSIGNED_INT_SAMPLER_2D : GL_SAMPLER_2D))
    texture.bind(found->unit);
}

void Program::set(std::string_view sampler, const TextureArray& textures) const {
  if (const Uniform* found = find(sampler, GL_SAMPLER_2D_ARRAY)) textures.bind(found->unit);
}

void Program::set(std::string_view sampler, const Volume& volume) const {
  if (const Uniform* found = find(sampler, volume.sampler_type())) volume.bind(found->unit);
}

}  // namespace mesograin::gl
