// A GL object's name with exactly one owner; freed where it dies, which must be the context's thread.
#pragma once

#include <epoxy/gl.h>

#include <utility>

namespace mesograin::gl {

/// `Traits` has static `GLuint create()` and `void destroy(GLuint)`.
template <typename Traits>
class Handle {
 public:
  Handle() : name_(Traits::create()) {}
  explicit Handle(GLuint name) : name_(name) {}
  Handle(Handle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (name_ != 0) Traits::destroy(name_);
  }

  GLuint name() const { return name_; }

 private:
  GLuint name_ = 0;
};

}  // namespace mesograin::gl
