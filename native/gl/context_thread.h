// The thread that owns the GL context for life. All GL work is posted to it, but for what has a context beside it;
// nothing else may call GL.
//
// Blender's own context is current on its main thread, where a second one cannot be made current; a thread of our own
// leaves it unharmed.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <type_traits>
#include <typeindex>
#include <utility>
#include <vector>

#include "gl/egl_context.h"

namespace mesograin::gl {

class ContextThread {
 public:
  /// Starts the thread and creates the context on first use. Throws Error if no device offers a context. On the thread
  /// itself it is that thread, while it is being shut down as well.
  static ContextThread& instance();

  /// Another, whose context shares nothing with that one's, for work on the device that neither waits for drawing nor
  /// holds it up. Starts on first use. Throws Error if there is no instance() or no context can be had.
  static std::shared_ptr<ContextThread> beside();

  /// Ends both threads, whoever holds one, and destroys their contexts, so that the driver unloads in order; a later
  /// instance() starts anew.
  static void shut_down();

  /// True while a thread is running; a destructor that runs after shut_down() has nothing left to free.
  static bool running();

  ContextThread(const ContextThread&) = delete;
  ContextThread& operator=(const ContextThread&) = delete;
  ~ContextThread();

  /// Queues `work` and returns at once.
  template <typename Work>
  auto post(Work&& work) -> std::future<std::invoke_result_t<Work>> {
    using Result = std::invoke_result_t<Work>;
    auto task = std::make_shared<std::packaged_task<Result()>>(std::forward<Work>(work));
    std::future<Result> result = task->get_future();
    enqueue(queue_, Job([task] { (*task)(); }));
    return result;
  }

  /// Queues `work` and waits for its result; what it throws is thrown here.
  template <typename Work>
  auto run(Work&& work) {
    return post(std::forward<Work>(work)).get();
  }

  /// Calls `step` on the thread over and over until it returns something, which is the result. Whatever else is posted
  /// goes before the next step of anybody, and a step that is `urgent` by then before those of others. One that is not
  /// `ready` is passed over until it is; both are asked on the thread and must not wait. What a step throws ends it,
  /// and so does shut_down(): the future throws it.
  template <typename Result>
  std::future<Result> repeat(
      std::function<std::optional<Result>()> step, std::function<bool()> urgent,
      std::function<bool()> ready = [] { return true; }) {
    auto repetition = std::make_shared<Repetition<Result>>(
        Repetition<Result>{std::move(step), std::move(urgent), std::move(ready), {}});
    std::future<Result> result = repetition->result.get_future();
    enqueue_step(std::move(repetition));
    return result;
  }

  /// The one object of this type that lives as long as the context and is destroyed on its thread, before the context.
  /// To be called on that thread only.
  template <typename Companion>
  Companion& companion() {
    std::shared_ptr<void>& slot = companions_[typeid(Companion)];
    if (!slot) slot = std::make_shared<Companion>();
    return *static_cast<Companion*>(slot.get());
  }

  const DeviceInfo& device_info() const { return device_info_; }

  /// The GL errors seen since the last call, oldest first, each with the work it was found after.
  std::vector<std::string> take_gl_errors();

 private:
  template <typename Result>
  struct Repetition {
    std::function<std::optional<Result>()> step;
    std::function<bool()> urgent;
    std::function<bool()> ready;
    std::promise<Result> result;
  };

  ContextThread();

  template <typename Result>
  void enqueue_step(std::shared_ptr<Repetition<Result>> repetition) {
    const auto take_step = [this, repetition] {
      try {
        // One that is not ready is taken to be shut down, which the queue says.
        std::optional<Result> result = repetition->ready() ? repetition->step() : std::nullopt;
        if (result)
          repetition->result.set_value(*std::move(result));
        else
          enqueue_step(repetition);
      } catch (...) {
        repetition->result.set_exception(std::current_exception());
      }
    };
    enqueue(steps_, Step{take_step, repetition->urgent, repetition->ready});
  }

  using Job = std::function<void()>;
  struct Step {
    Job run;
    std::function<bool()> urgent;
    std::function<bool()> ready;
  };

  template <typename Each>
  void enqueue(std::deque<Each>& queue, Each work) {
    {
      const std::lock_guard lock(mutex_);
      require_running();
      queue.push_back(std::move(work));
    }
    wake_.notify_one();
  }

  /// Once all is done that was asked for before.
  void end();

  /// Throws Error after shut_down().
  void require_running() const;

  /// Waits for it; empty once all is done that was asked for before shut_down().
  Job next_job();
  void loop(std::promise<DeviceInfo> started);
  void collect_gl_errors();

  DeviceInfo device_info_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Job> queue_;
  std::deque<Step> steps_;  // taken while there is nothing else
  std::vector<std::string> gl_errors_;
  std::map<std::type_index, std::shared_ptr<void>> companions_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace mesograin::gl
