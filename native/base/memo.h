// What was made last, for those who ask for the same again.
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <future>
#include <list>
#include <memory>
#include <mutex>
#include <utility>

namespace mesograin {

/// Holds the few values that were asked for last, by their keys. May be asked from any thread: who asks for one that
/// another thread makes at the time waits for that.
template <typename Key, typename Value>
class Memo {
 public:
  using Pointer = std::shared_ptr<const Value>;

  explicit Memo(std::size_t most) : most_(most) {}

  /// What `make` returns, and is called for only if it is not held. What it throws is thrown to all who wait for it.
  template <typename Make>
  Pointer get(const Key& key, Make&& make) {
    std::promise<Pointer> promise;
    {
      std::unique_lock lock(mutex_);
      const auto known =
          std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.key == key; });
      if (known != entries_.end()) {
        entries_.splice(entries_.begin(), entries_, known);
        const std::shared_future<Pointer> value = known->value;
        lock.unlock();
        return value.get();
      }
      entries_.push_front({key, promise.get_future().share()});
      if (entries_.size() > most_) entries_.pop_back();
    }
    try {
      Pointer value = std::make_shared<const Value>(make());
      promise.set_value(value);
      return value;
    } catch (...) {
      promise.set_exception(std::current_exception());
      const std::lock_guard lock(mutex_);
      entries_.remove_if([&](const Entry& entry) { return entry.key == key; });
      throw;
    }
  }

 private:
  struct Entry {
    Key key;
    std::shared_future<Pointer> value;
  };

  std::size_t most_;
  std::mutex mutex_;
  std::list<Entry> entries_;  // that asked for last first
};

}  // namespace mesograin
