// Timestamp queries, which may overlap where elapsed-time queries may not.
#include "gl/timer.h"

namespace mesograin::gl {
namespace {

GLuint64 wait_for(GLuint query) {
  GLuint64 nanoseconds = 0;
  glGetQueryObjectui64v(query, GL_QUERY_RESULT, &nanoseconds);
  return nanoseconds;
}

}  // namespace

GLuint Timer::Traits::create() {
  GLuint name = 0;
  glCreateQueries(GL_TIMESTAMP, 1, &name);
  return name;
}

void Timer::Traits::destroy(GLuint name) { glDeleteQueries(1, &name); }

void Timer::start() const { glQueryCounter(begin_.name(), GL_TIMESTAMP); }

void Timer::stop() const { glQueryCounter(end_.name(), GL_TIMESTAMP); }

double Timer::milliseconds() const {
  return static_cast<double>(wait_for(end_.name()) - wait_for(begin_.name())) * 1e-6;
}

}  // namespace mesograin::gl
