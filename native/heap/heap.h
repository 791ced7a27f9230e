// A heap and the light on it: what the exchange is solved for.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "heap/coefficients.h"
#include "heap/grain_table.h"
#include "heap/grains.h"
#include "heap/patches.h"
#include "heap/seats.h"
#include "scene/light.h"
#include "scene/world.h"

namespace mesograin::heap {

struct Heap {
  Grains grains;
  glm::dvec3 anchor{0.0};  ///< where the grains' places are told from
  std::vector<scene::Light> lights;
  scene::World world;
  bool exchanges = true;  ///< else no grain answers what another sends
  /// What comes from outside the heap straight through one grain is told elsewhere, and so is what is seen through it.
  bool straight_elsewhere = false;

  bool operator==(const Heap&) const = default;
};

/// What the grains of one kind do to light.
struct Kind {
  std::shared_ptr<const GrainTable> from_light;
  std::shared_ptr<const GrainTable> from_viewer;
};

/// `walks` for each interval of a table, or fewer where kinds are many.
std::vector<Kind> kinds_of(const std::vector<Optics>& optics, int walks, const transport::Effort& effort);

/// Whether grains of any kind are clear.
bool any_clear(const std::vector<Kind>& kinds);
/// The same of turbid ones.
bool any_turbid(const std::vector<Kind>& kinds);

/// A straight line between grains, with what is left of its weight.
struct Ray {
  glm::vec3 origin;  ///< of one that was followed: where it has come to
  glm::vec3 direction;
  glm::vec3 weight;
  bool crossed = false;         ///< whether it has gone straight through a grain, or a pane has mirrored it
  std::uint32_t from = nobody;  ///< the grain that it leaves by a surface which is not its ball's
};

/// What sends out the light that a ray looks for: a grain at a normal, or a node of the walls' patches.
struct Source {
  std::uint32_t number;  ///< of all that sends out light: grains, then nodes
  glm::vec3 normal;      ///< GrainTable::seen_place(); 0 of a node
  glm::vec3 met;         ///< GrainTable::met() of its kind
  glm::vec3 facing;      ///< its surface's normal, where it was met
};

/// A place on a wall.
struct WallPlace {
  glm::vec3 place;  ///< just before its surface
  glm::vec3 normal;
};

/// The grids on its walls.
Patches patches_about(const Grains& grains);

/// The heap as rays go through it.
class Space {
 public:
  Space(const Grains& grains, const std::vector<Kind>& kinds, std::shared_ptr<const Seats> seats = nullptr);

  /// With grids that are known, and `neighbourhood`, if that is.
  Space(const Grains& grains, const std::vector<Kind>& kinds, std::shared_ptr<const Seats> seats, Patches patches,
        const std::optional<Neighbourhood>& neighbourhood);

  /// From now on what they send out is told by these; else each grain has a seat of its own.
  void seat(std::shared_ptr<const Seats> seats) { seats_ = std::move(seats); }
  const std::shared_ptr<const Seats>& seats() const { return seats_; }

  /// From now on grains answer as these do, which are for each kind what is seen of it, and send what their own do.
  void answer_as(const std::vector<Kind>& seen) { seen_ = &seen; }

  const std::vector<Grain>& grains() const { return grains_; }
  const Kind& kind(std::uint32_t grain) const { return kinds_[grains_[grain].kind]; }
  const Kind& answering(std::uint32_t grain) const { return (*seen_)[grains_[grain].kind]; }
  const Kind& kind(const Patches::Node& node) const { return kinds_[walls_[node.wall].kind]; }
  const Patches& patches() const { return patches_; }
  const Neighbourhood& neighbourhood() const { return neighbourhood_; }

  bool any_clear() const { return heap::any_clear(kinds_); }
  /// Of how many seats it is told what enters a turbid grain there: those of one grain each, if any is turbid.
  std::size_t told_entered() const { return heap::any_turbid(kinds_) ? seats_->own() : 0; }

  /// Of all that answers: grains in their seats, then nodes.
  std::size_t size() const { return seats_->answering() + patches_.nodes().size(); }

  bool of_grain(std::size_t answering) const { return answering < seats_->answering(); }
  const Patches::Node& node(std::size_t answering) const { return patches_.nodes()[answering - seats_->answering()]; }

  /// Whether light reaches far from a grain's surface: out of the heap, or to what stands as far away.
  bool is_open(std::uint32_t grain, float far) const;

  /// A place for which a node stands, `u` and `v` in [0, 1): the likelier the nearer.
  WallPlace place(const Patches::Node& node, float u, float v) const;

  /// Just outside a grain's surface, on this side of walls that the ball dips into.
  glm::vec3 place(const Grain& grain, const glm::vec3& normal) const {
    return this_side(grain.middle, grain.middle + grain.radius * (1.0F + 1e-4F) * normal);
  }

  /// `to`, or just before the wall that stands between it and `from`.
  glm::vec3 this_side(const glm::vec3& from, const glm::vec3& to) const;

  /// On to the grain or wall that it meets; nothing if it leaves the heap. Where a grain lets a part straight through,
  /// one of the two ways is taken at random.
  std::optional<Source> follow(Ray& ray, transport::Random& random) const;

  /// What sends out light where a ray has met something; nothing, and no weight, where that is not known. `ray` has
  /// come there.
  std::optional<Source> source(const Meeting& meeting, Ray& ray, transport::Random& random) const;

  /// What of light on its way straight through a grain crosses it, if the caller knows what else it does there.
  using Crossed = std::function<std::optional<glm::vec3>(const Meeting& meeting, const Ray& ray)>;

  /// Radiance that comes against `ray`'s direction because of what grains and walls send out, straight through those
  /// that let it; but for what grains send of which `crossed` knows. Leaves it what weight leaves the heap.
  glm::vec3 seen_along(Ray& ray, const Field& sent, transport::Random& random, const Crossed& crossed = {}) const;

  /// What is left of light that comes from `reach` away, against `ray`'s direction, straight through all in between.
  /// Does not change its weight.
  glm::vec3 passed(Ray& ray, float reach) const;

  /// What panes leave of light that goes straight on for so long; `mirrored`: with what they reflect, as if that saw
  /// the same.
  glm::vec3 passed_panes(const glm::vec3& origin, const glm::vec3& direction, float reach, bool mirrored) const;

 private:
  /// Whether a ray meets a pane before it has gone so far: then it has been mirrored there, or come through, one of the
  /// two at random.
  bool meets_pane(Ray& ray, float far, transport::Random& random) const;

  /// To where it leaves the grain that it met.
  void cross(Ray& ray, const Meeting& meeting, float cosine) const;

  const std::vector<Grain>& grains_;
  const std::vector<Wall>& walls_;
  const std::vector<Pane>& panes_;
  const std::vector<Kind>& kinds_;
  const std::vector<Kind>* seen_ = &kinds_;
  std::shared_ptr<const Seats> seats_;
  Patches patches_;
  Neighbourhood neighbourhood_;
};

}  // namespace mesograin::heap
