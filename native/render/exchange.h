// Light from grain to grain in a view: solved beside the device's thread when grains, materials or lights have changed,
// and then four numbers a channel for each seat that shaders add to what the lights do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "heap/gather.h"
#include "heap/solving.h"
#include "render/content.h"
#include "render/device_sums.h"
#include "render/levels.h"
#include "render/told_light.h"
#include "scene/scene.h"

namespace mesograin::render {

struct Range {
  double least;
  double most;
};

/// What the grains of one surface are made of, over all of them and all channels.
struct Stuff {
  heap::Surface surface;
  Range thickness;  ///< mean free paths to the radius of the ball that stands for a grain; 0 of what is opaque
  Range albedo;     ///< of one scattering, or reflectance of what is opaque
  Range g;
  Range eta;
};

/// How many grains are shown by which means, where rays find what is seen, and told to others.
struct Means {
  std::size_t walked = 0;       ///< light is followed from what is seen of them, and no model asked
  std::size_t looked_into = 0;  ///< clear ones, through their facets, and no model asked
  std::size_t modelled = 0;     ///< by their model, and what others send by a few numbers
  std::size_t sharing = 0;      ///< of all these, those that lie so deep that they share numbers
};

/// What is drawn of light between grains.
struct ExchangeStatistics {
  std::size_t grains = 0;         ///< that send light to each other
  std::size_t others = 0;         ///< objects that do not
  std::size_t kinds = 0;          ///< of grains, by material and size
  std::size_t links = 0;          ///< ways of light between grains
  int steps = 0;                  ///< of the solution
  float residual = 0.0F;          ///< that they left, of what lights do
  bool summed_on_device = false;  ///< all their sums over links
  double milliseconds = 0.0;      ///< that the solution took
  bool final = true;              ///< no better one is under way
  heap::Parts parts;              ///< found anew so far
  bool balls = true;              ///< all grains are about as round as a sphere
  bool gathered = false;          ///< rays of the last sample found more of what is seen of some grains than is solved
  Means means;
  SeenByLevel levels;  ///< in the last sample
  std::vector<Stuff> stuff;
};

class Exchange {
 public:
  Exchange() = default;
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

  /// Takes what a view draws, and begins to solve if anything has changed that light depends on. Until more is known,
  /// what was known before is drawn.
  void set(DeviceCache& cache, const Content& content, const scene::Scene& scene);

  /// Who sums, where something is solved from now on.
  void set_summing(Summing by) { summing_ = by; }

  /// Whether any light goes from grain to grain.
  bool any() const { return solving_ != nullptr && solving_->heap().exchanges; }

  /// Whether that tells what goes straight through grains: of those that are in no array rays do, each to where it
  /// ends.
  bool tells_straight() const { return any() && !solving_->heap().straight_elsewhere; }

  /// Whether light goes through glass that is thin all over.
  bool any_panes() const { return any() && !solving_->heap().grains.panes.empty(); }

  /// Whether more will become known, after which other things may be asked of models than now.
  bool awaits_more() const { return solving_ != nullptr && !solving_->news().final; }

  /// Takes in what has become known since. Returns whether anything has.
  bool take_news();

  /// What a picture waits for; null where no light goes from grain to grain, and none is followed into them.
  std::shared_ptr<const heap::Solving> solving() const { return solving_; }

  ExchangeStatistics statistics() const;

  /// Makes it what shaders/heap/light_from_grains.glsl and light_of_walls.glsl read.
  void bind() const { told_.bind(); }

  /// What gathers light for each pixel, or for those that show clear grains; null where it is not to be.
  const std::shared_ptr<const heap::Gather>& gather() const { return gather_; }
  bool gathers_all() const { return gathers_; }

  /// Whether what others send to this grain is gathered, if not for all: it is opaque and a lamp is close by.
  bool gathers_for(std::uint32_t grain) const { return !about_lamps_.empty() && about_lamps_[grain]; }

  /// Whether of this grain, whose numbers tell what others send, a ray finds what is seen straight through it.
  bool looks_straight(std::uint32_t grain) const {
    const heap::Grains& grains = solving_->heap().grains;
    return looks_straight_ && grains.kinds[grains.grains[grain].kind].followed();
  }

  /// Whether nothing else is gathered of any.
  bool looks_straight_alone() const { return looks_straight_ && !gather_->sees_into_any(); }

  /// Whether numbers tell what light of the lights and the world has entered the instances of such a unit of arrays.
  bool tells_entered(std::size_t unit) const { return unit < tells_entered_.size() && tells_entered_[unit]; }

  /// Whether it is followed into any grain that is seen.
  bool follows() const { return gathers_ || follows_; }

  /// Whether it is followed all the way, where no surface refracts.
  bool follows_paths() const { return follows_paths_; }

  /// Whether all grains are about as round as a sphere.
  bool balls() const { return balls_; }

  /// Whether all light of the object of this number is gathered, and no model is asked; `traced`: rays can be followed
  /// through all of the content.
  bool gathers_all_of(std::size_t number, bool traced) const;

  /// Of objects, by their numbers.
  const std::vector<RoleInHeap>& roles() const { return roles_; }

 private:
  /// What is drawn.
  struct Known {
    std::shared_ptr<const heap::Heap> heap;
    std::shared_ptr<const heap::HeapLight> light;
    int number;                                ///< of the news
    std::shared_ptr<const heap::Heap> lit_by;  ///< whose lights and world they are, not weaker or stronger

    const heap::Grains& grains() const { return heap->grains; }
  };

  void send();
  bool keep_up();
  void find_gather();
  void find_whole();
  void find_tells_entered();
  void count_means();

  Summing summing_ = Summing::automatic;
  bool balls_ = true;
  std::vector<RoleInHeap> roles_;
  bool gathers_ = false;
  bool follows_paths_ = false;
  bool follows_ = false;  // light into what is seen of an array's grains, where that is cheap
  bool looks_straight_ = false;
  bool shows_more_ = false;  // gathering, of some grains
  std::vector<bool> about_lamps_;
  Means means_;
  std::shared_ptr<const heap::Gather> gather_;
  std::vector<std::pair<std::size_t, std::size_t>> alike_;  // objects of one unit: the first, and after the last
  std::vector<bool> tells_entered_;                         // of these units
  std::vector<bool> whole_;  // of objects, where clear ones are looked into: no model is asked of their unit
  std::shared_ptr<const heap::Solving> solving_;
  std::optional<Known> known_;
  ToldLight told_;
};

}  // namespace mesograin::render
