// A linked shader program whose uniforms are known by name and type.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "gl/handle.h"
#include "gl/shader_source.h"
#include "gl/texture.h"
#include "gl/texture_array.h"
#include "gl/volume.h"

namespace mesograin::gl {

/// One stage of a program: GL_VERTEX_SHADER, GL_TESS_CONTROL_SHADER, ...
struct Stage {
  GLenum kind;
  ShaderSource source;
};

class Program {
 public:
  /// `name` is used in messages. Throws Error with the file, the line and the driver's log if a stage does not compile.
  Program(std::string name, const std::vector<Stage>& stages);
  Program(std::string name, const ShaderSource& vertex, const ShaderSource& fragment);
  Program(std::string name, const ShaderSource& compute);

  const std::string& name() const { return name_; }
  void use() const;

  /// True if the linker kept the uniform (or sampler) of that name.
  bool has(std::string_view uniform) const;

  /// True if the program's text declares the uniform (or sampler) of that name, or the struct that it is a member of,
  /// whether or not the linker kept it.
  bool declares(std::string_view uniform) const;

  /// Sets a uniform of the matching type. One that the linker dropped is passed over; one that the program does not
  /// declare, or of another type, throws std::logic_error.
  void set(std::string_view uniform, int value) const;
  void set(std::string_view uniform, float value) const;
  void set(std::string_view uniform, const glm::vec2& value) const;
  void set(std::string_view uniform, const glm::vec3& value) const;
  void set(std::string_view uniform, const glm::vec4& value) const;
  void set(std::string_view uniform, const glm::mat3& value) const;
  void set(std::string_view uniform, const glm::mat4& value) const;

  /// Binds the texture to the texture unit that belongs to the sampler of that name.
  void set(std::string_view sampler, const Texture& texture) const;
  void set(std::string_view sampler, const TextureArray& textures) const;
  void set(std::string_view sampler, const Volume& volume) const;

  /// As set(), for what not every program of its kind reads: nothing where the program does not declare it.
  template <typename Value>
  void offer(std::string_view uniform, const Value& value) const {
    if (declares(uniform)) set(uniform, value);
  }

 private:
  struct Traits {
    static GLuint create();
    static void destroy(GLuint name);
  };
  struct Uniform {
    GLint location;
    GLenum type;
    GLuint unit;  // for samplers
  };

  void note_declarations(const ShaderSource& source);
  void link();
  void reflect();
  const Uniform* find(std::string_view uniform, GLenum type) const;

  std::string name_;
  Handle<Traits> handle_;
  std::map<std::string, Uniform, std::less<>> uniforms_;
  std::set<std::string, std::less<>> declared_;
};

}  // namespace mesograin::gl
