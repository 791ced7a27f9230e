// Where prototypes' transport is computed: on a thread of its own, coarsely first, given up when nobody waits any more,
// and not at all if it was computed before. What rays found in a mesh is kept for its next medium.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "scene/mesh.h"
#include "transport/backlog.h"
#include "transport/stored_transport.h"
#include "transport/transport_cache.h"
#include "transport/walks_shelf.h"

namespace mesograin::transport {

/// What is to be computed. `medium` is per scene unit here.
struct Order {
  scene::MeshPointer mesh;
  glm::dmat3 stretch{1.0};
  StoredMedium medium;
  std::shared_ptr<const Lamp> lamp = nullptr;  ///< null: for parallel light from anywhere. Nothing is told of one that
                                               ///< is in the body
};

/// What is known so far.
struct News {
  int number = 0;                                 ///< grows with everything new
  std::shared_ptr<const StoredTransport> stored;  ///< the best so far, or null
  std::string unsuitable;  ///< one sentence, if this mesh or medium is nothing for stored transport
  bool final = false;
};

/// One order under way, for as long as somebody holds it. May be asked from any thread.
class Computation {
 public:
  News news() const;

  /// The share that is done.
  double progress() const { return progress_; }

  /// Whether all is known, after waiting this long at most.
  bool wait(std::chrono::milliseconds patience) const;

 private:
  friend class Works;

  void tell(std::shared_ptr<const StoredTransport> stored, std::string unsuitable, bool final);

  mutable std::mutex mutex_;
  mutable std::condition_variable told_;
  News news_;
  std::atomic<double> progress_{0.0};
};

class Works {
 public:
  /// The one that all share; its thread starts with the first order.
  static Works& instance();

  /// How long after the last work walks of bodies that are in no scene any more are let go of, again and again while
  /// there are many: an artist may but look at something else for a moment.
  static constexpr std::chrono::milliseconds default_pause{5000};

  explicit Works(TransportCache cache = TransportCache(), std::chrono::milliseconds pause = default_pause)
      : cache_(std::move(cache)),
        jobs_([this](const Job& job, const std::stop_token& stop) { work(job, stop); }, [this] { return let_go(); },
              pause) {}
  Works(const Works&) = delete;
  Works& operator=(const Works&) = delete;

  /// Returns at once, all being known already if it was kept. The order that came last is worked on first, but those of
  /// lamps after all others.
  std::shared_ptr<const Computation> ask(Order order);

  /// Bytes of the walks that are kept for other media, as of the last order that was done or let go of.
  std::size_t bytes_of_walks() const { return bytes_of_walks_; }

 private:
  struct Job {
    Order order;
    std::string name;
    std::string about;
    std::string about_body;  // what its walks depend on, besides their quality
    std::weak_ptr<Computation> computation;
  };

  /// A body whose transport was asked for; it is in a scene for as long as the computation is held.
  struct Asked {
    std::string about_body;
    std::weak_ptr<const Computation> computation;
  };

  void remember(const std::string& about_body, const std::shared_ptr<const Computation>& computation);
  bool in_use(const std::string& about_body) const;
  void work(const Job& job, const std::stop_token& stop);
  std::shared_ptr<Walks> walks(const Job& job, const Quality& quality, const Effort& effort);

  /// Of walks that are too many by now; tells whether later more may be.
  bool let_go();

  TransportCache cache_;
  mutable std::mutex mutex_;
  std::vector<Asked> asked_;
  WalksShelf shelf_;  // of the thread
  std::atomic<std::size_t> bytes_of_walks_{0};
  Backlog<Job> jobs_;
};

}  // namespace mesograin::transport
