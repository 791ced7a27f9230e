// Light from grain to grain in a view: solved beside the device's thread when grains, materials or lights have changed,
// and then four numbers a channel for each object that shaders add to what the lights do.
#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <optional>

#include "gl/buffer.h"
#include "heap/exchange.h"
#include "render/content.h"
#include "render/surfaces.h"
#include "scene/scene.h"

namespace mesograin::render {

class Exchange {
 public:
  Exchange() = default;
  ~Exchange();
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

  /// Takes what a view draws, and begins to solve if anything has changed that light depends on.
  void set(const Content& content, const scene::Scene& scene);

  /// Whether any light goes from grain to grain.
  bool any() const { return heap_.has_value(); }

  /// Waits for the solution. False if it is not to `go_on`: the solution is not given up for it.
  bool wait(const GoOn& go_on);

  /// Milliseconds that the last call of wait() found to have gone into a new solution; 0 if there was none.
  double milliseconds() const { return milliseconds_; }

  /// Makes it what shaders/heap/light_from_grains.glsl reads.
  void bind() const { device_->bind_storage(8); }

 private:
  struct Solved {
    heap::HeapLight light;
    double milliseconds;
  };

  void stop();
  void send(const heap::HeapLight& light);

  std::optional<heap::Heap> heap_;
  std::vector<std::optional<std::uint32_t>> grain_of_;  // the grain that an object is, by its number
  std::atomic<bool> stop_{false};
  std::future<Solved> solving_;
  heap::Field sent_;
  std::optional<gl::Buffer> device_;
  double milliseconds_ = 0.0;
};

}  // namespace mesograin::render
