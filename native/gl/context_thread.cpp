// Runs posted work in order on the thread that owns the context.
#include "gl/context_thread.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "base/error.h"

namespace mesograin::gl {
namespace {

// Never destroyed by static destruction: the driver may already be gone by then. shut_down() ends it in order.
std::mutex& instance_mutex() {
  static auto* mutex = new std::mutex;
  return *mutex;
}

std::unique_ptr<ContextThread>& instance_slot() {
  static auto* slot = new std::unique_ptr<ContextThread>;
  return *slot;
}

std::mutex& beside_mutex() {
  static auto* mutex = new std::mutex;
  return *mutex;
}

std::shared_ptr<ContextThread>& beside_slot() {
  static auto* slot = new std::shared_ptr<ContextThread>;
  return *slot;
}

// Asked by work on the thread, which must not wait for shut_down(), which waits for it.
thread_local ContextThread* own = nullptr;

constexpr std::chrono::milliseconds look_again(20);

const char* error_name(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
      return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
      return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
      return "GL_OUT_OF_MEMORY";
    default:
      return "an unknown GL error";
  }
}

}  // namespace

ContextThread& ContextThread::instance() {
  if (own != nullptr) return *own;
  const std::lock_guard lock(instance_mutex());
  std::unique_ptr<ContextThread>& slot = instance_slot();
  if (!slot) slot.reset(new ContextThread);
  return *slot;
}

std::shared_ptr<ContextThread> ContextThread::beside() {
  const std::lock_guard lock(beside_mutex());
  // At the process' end nothing would shut it down any more.
  if (!running()) throw Error("The renderer has been shut down; start it again before asking for more.");
  std::shared_ptr<ContextThread>& slot = beside_slot();
  if (!slot) slot.reset(new ContextThread);
  return slot;
}

void ContextThread::shut_down() {
  {
    const std::lock_guard lock(instance_mutex());
    instance_slot().reset();
  }
  const std::lock_guard lock(beside_mutex());
  if (beside_slot()) beside_slot()->end();
  beside_slot().reset();
}

bool ContextThread::running() {
  const std::lock_guard lock(instance_mutex());
  return instance_slot() != nullptr;
}

ContextThread::ContextThread() {
  std::promise<DeviceInfo> started;
  std::future<DeviceInfo> info = started.get_future();
  thread_ = std::thread([this, started = std::move(started)]() mutable { loop(std::move(started)); });
  try {
    device_info_ = info.get();
  } catch (...) {
    thread_.join();
    throw;
  }
}

ContextThread::~ContextThread() { end(); }

void ContextThread::end() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void ContextThread::require_running() const {
  if (stopping_) throw Error("The renderer has been shut down; start it again before asking for more.");
}

ContextThread::Job ContextThread::next_job() {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (!queue_.empty()) {
      Job job = std::move(queue_.front());
      queue_.pop_front();
      return job;
    }
    if (stopping_ && steps_.empty()) return nullptr;
    const auto is_urgent = [](const Step& each) { return each.urgent() && each.ready(); };
    const auto is_next = [this](const Step& each) { return stopping_ || each.ready(); };
    auto next = std::find_if(steps_.begin(), steps_.end(), is_urgent);
    if (next == steps_.end()) next = std::find_if(steps_.begin(), steps_.end(), is_next);
    if (next != steps_.end()) {
      Job job = std::move(next->run);
      steps_.erase(next);
      return job;
    }
    // Nobody tells when a step becomes ready.
    if (steps_.empty())
      wake_.wait(lock);
    else
      wake_.wait_for(lock, look_again);
  }
}

void ContextThread::loop(std::promise<DeviceInfo> started) {
  own = this;
  std::unique_ptr<EglContext> context;
  try {
    context = std::make_unique<EglContext>();
    started.set_value(context->info());
  } catch (...) {
    started.set_exception(std::current_exception());
    return;
  }
  while (Job job = next_job()) {
    job();
    job = nullptr;
    collect_gl_errors();
  }
  companions_.clear();
}

void ContextThread::collect_gl_errors() {
  for (GLenum error = glGetError(); error != GL_NO_ERROR; error = glGetError()) {
    const std::lock_guard lock(mutex_);
    gl_errors_.emplace_back(error_name(error));
  }
}

std::vector<std::string> ContextThread::take_gl_errors() {
  run([] {});  // whatever was posted before has been looked at once this returns
  run([] {});
  const std::lock_guard lock(mutex_);
  return std::exchange(gl_errors_, {});
}

}  // namespace mesograin::gl
