// The exchange solved again and again while a heap changes: what a change does not touch is kept, and a solution begins
// from the one before.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "heap/exchange.h"
#include "heap/links.h"
#include "heap/sums.h"

namespace mesograin::heap {

/// Lives on one thread.
class Solver {
 public:
  Solver() = default;

  /// `sent` may be a solution for other lights, materials or places.
  explicit Solver(Field sent) : sent_(std::move(sent)) {}

  /// Throws transport::Stopped; what was found until then is kept. `make_sums`: as for heap::solve().
  HeapLight solve(const std::shared_ptr<const Heap>& shared, const Quality& quality, const transport::Effort& effort,
                  const MakeSums& make_sums = {});

  /// The same of a copy.
  HeapLight solve(const Heap& heap, const Quality& quality, const transport::Effort& effort,
                  const MakeSums& make_sums = {}) {
    return solve(std::make_shared<const Heap>(heap), quality, effort, make_sums);
  }

 private:
  /// What grains are made of, and as rays meet them.
  struct Matter {
    explicit Matter(std::shared_ptr<const Grains> of) : held(std::move(of)), grains(*held) {}

    std::shared_ptr<const Grains> held;
    const Grains& grains;
    int walks = 0;  ///< of each interval of their tables
    std::vector<Kind> kinds;
    std::vector<Kind> seen;              ///< what is seen of each, if any is something else to others; else empty
    int cells_below = 0;                 ///< the surface, from where on grains share seats; 0: none do
    bool eights = false;                 ///< of Seats
    std::shared_ptr<const Seats> seats;  ///< where they do; those of a matter before, or found when rays are traced
    std::shared_ptr<const std::vector<Grain>> seated;  ///< where grains were when they were found
    std::optional<Neighbourhood> neighbourhood;        ///< that of a matter before, if grains are where they were
    std::optional<Space> space;                        ///< of this; made when rays are traced
  };

  /// What was found of grains by rays.
  struct Traced {
    std::shared_ptr<const Matter> matter;
    Rays rays;
    Rays rays_through;
    Ways ways;  ///< in a world whose radiance is 1
  };

  /// What one light, or a world that is an image, does.
  struct Source {
    Heap light;  ///< without grains
    std::shared_ptr<const Matter> matter;
    Rays rays;
    Lit lit;
  };

  struct Direct {
    Lit lit;        ///< as Seats tell it
    Field crossed;  ///< of that, what is no even world's
  };

  void take_seats(const Matter& of, Matter& by) const;
  void find_matter(const std::shared_ptr<const Heap>& heap, const Quality& quality, const transport::Effort& effort);
  const Space& space();
  Deep find_deep(const transport::Effort& effort);

  /// Puts what is seen of grains in the place of what they are to others.
  void show_seen(const Heap& heap, HeapLight& light, const transport::Effort& effort) const;

  /// As fine as memory allows.
  Quality within_memory(const Quality& quality);

  /// What was sent before, in the seats that there are now.
  Field guess() const;
  /// Whether what rays find now takes the place of what they found with `other`, seat by seat: of so many there is no
  /// memory for both.
  bool is_refined(const Matter& other);
  void find_ways(const Quality& quality, const transport::Effort& effort);
  Direct find_direct(const Heap& heap, const Quality& quality, const transport::Effort& effort);
  const Source& find_source(Heap light, const Quality& quality, const transport::Effort& effort);

  /// Whether what was found with `other` and this many rays serves.
  bool serves(const std::shared_ptr<const Matter>& other, int rays, int wanted, const Quality& quality) const;

  /// From `other` to what there is now; nothing where its rays tell nothing of that.
  std::optional<Change> change_from(const Matter& other) const;
  /// Of what enters the grain in a seat, how much more it sends out than one of that matter.
  glm::vec3 more_entered(const Matter& other, std::size_t seat) const;
  std::optional<Moves> moves_from(const Matter& other);

  std::shared_ptr<Matter> matter_;
  std::optional<Traced> traced_;
  std::vector<Source> sources_;
  SharedField sent_;
  std::shared_ptr<const Seats> sent_seats_;
  Field left_;  ///< that this leaves of its equations
  Parts parts_;
};

}  // namespace mesograin::heap
