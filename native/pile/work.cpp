// One thread a pile.
#include "pile/work.h"

#include <utility>

namespace mesograin::pile {

Work::Work(Grains grains, Ground ground, Walls walls, double friction, std::uint64_t seed)
    : thread_([this, grains = std::move(grains), ground = std::move(ground), walls, friction, seed] {
        try {
          pile_ = settle(grains, ground, walls, friction, seed, [this](double share) {
            share_ = share;
            return !cancelled_;
          });
        } catch (...) {
          error_ = std::current_exception();
        }
        done_ = true;
      }) {}

Work::~Work() {
  cancel();
  if (thread_.joinable()) thread_.join();
}

const Pile& Work::result() {
  if (thread_.joinable()) thread_.join();
  if (error_) std::rethrow_exception(error_);
  return pile_;
}

}  // namespace mesograin::pile
