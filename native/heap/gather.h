// What a viewer sees of a grain because of what others send, each look by rays of its own: the answer of a grain that
// is seen has more to it than four numbers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "heap/draws.h"
#include "heap/exchange.h"
#include "heap/facet_walk.h"
#include "heap/flights.h"
#include "heap/heap.h"
#include "heap/inner_light.h"
#include "transport/random.h"

namespace mesograin::heap {

class Asking;

class Gather {
 public:
  /// How far light is followed that leaves a grain by way of others.
  enum class Ways {
    short_ones,  ///< to the next, or once more
    whole,       ///< from grain to grain and wall to wall until it ends, where no surface refracts
  };

  /// `light`: the heap's.
  Gather(const std::shared_ptr<const Heap>& heap, std::shared_ptr<const HeapLight> light, Ways ways = Ways::short_ones);

  /// The same of a copy.
  Gather(const Heap& heap, std::shared_ptr<const HeapLight> light, Ways ways = Ways::short_ones)
      : Gather(std::make_shared<const Heap>(heap), std::move(light), ways) {}

  Gather(const Gather&) = delete;
  Gather& operator=(const Gather&) = delete;

  const Heap& heap() const { return heap_; }

  /// To a grain's radius, in the channel that has most of them.
  double mean_free_paths(std::uint32_t grain) const {
    const glm::dvec3& sigma_t = optics(grain).sigma_t;
    return static_cast<double>(space_.grains()[grain].thickness) * std::max({sigma_t.r, sigma_t.g, sigma_t.b});
  }

  const Optics& optics(std::uint32_t grain) const { return heap_.grains.kinds[space_.grains()[grain].kind]; }

  /// The same light in a heap whose grains and walls are where these are, of other materials or under other lights:
  /// what is seen of a grain answers to them at once.
  std::unique_ptr<const Gather> among(std::shared_ptr<const Heap> heap) const;

  /// Radiance that leaves a grain at a normal `towards` a viewer, but for what comes straight from lights: the mean
  /// over `rays` through the grain's table, and what is seen straight through it.
  glm::vec3 look(std::uint32_t grain, const glm::vec3& normal, const glm::vec3& towards, int rays,
                 transport::Random& random) const;

  /// Whether look_at_all() knows this grain: what lights do in it is found by asking for them on the way, which no
  /// surface that refracts allows. The whole grain or none of it: a part by each would show an edge between them.
  bool sees_all(std::uint32_t grain) const;

  /// What follows light from what is seen of a grain.
  struct Walks {
    int number;
    int further = 0;  ///< grains that one of them meets, one after the other, are looked at, too, where a look tells
                      ///< more than numbers
  };

  /// What is seen of a grain, by where it comes from.
  struct All {
    glm::vec3 others{0.0F};     ///< grains and walls, scattered or straight through it
    glm::vec3 straight{0.0F};   ///< of these what is seen straight through it
    glm::vec3 met{1.0F};        ///< of light on the straight way through it, what does not cross
    glm::vec3 scattered{0.0F};  ///< lights and the world, scattered in it
    glm::vec3 steady{0.0F};     ///< what its inner light tells of both
    glm::vec3 world{0.0F};      ///< straight through it
    float film = 0.0F;          ///< the share of a transparent film, which is seen instead; the mean of the channels
  };

  /// The same with what comes straight from lights, and the world behind it. `place`: of the surface that is seen, from
  /// the grain's middle.
  All look_at_all(std::uint32_t grain, const glm::vec3& place, const glm::vec3& normal, const glm::vec3& towards,
                  const Walks& walks, transport::Random& random) const;

  /// The same through its own facets, and past those of others; nothing, where it does not end behind that place.
  std::optional<All> look_at_all(const SeenFacet& seen, const Facets& facets, const Walks& walks,
                                 transport::Random& random) const;

  /// The same by what its neighbours are told of it, lights' share and all, without a walk.
  All look_at_told(std::uint32_t grain, const glm::vec3& place, const glm::vec3& normal, const glm::vec3& towards,
                   transport::Random& random) const;

  /// What others send, by a grain's numbers, but for what is seen straight through it, which a ray finds.
  struct Straight {
    glm::vec3 told;      ///< by its numbers
    glm::vec3 straight;  ///< of others
    float open;          ///< of what crosses the grain, the share that leaves the heap; the mean of the channels
  };
  Straight look_straight(std::uint32_t grain, const glm::vec3& normal, const glm::vec3& towards,
                         transport::Random& random) const;

  /// Whether a polynomial tells the light in a grain well enough: it scatters evenly and is not so thick that light
  /// stays below its surface.
  bool tells_inner_light(std::uint32_t grain) const;

  /// For a look that follows light as far as this does.
  Walks walks(int number, bool once_more) const {
    return {number, ways_ == Ways::whole ? most_followed : once_more ? 1 : 0};
  }

  /// Whether it does of any.
  bool tells_any_inner_light() const;

  /// Adds so many walks that begin all over the surface of such a grain.
  void learn(std::uint32_t grain, const Facets& facets, int walks, transport::Random& random, InnerLight& light) const;

  /// look_at_all() where that is known; nothing, where it does not end behind that place, or at a wall.
  std::optional<All> look_at_all(const SeenFacet& seen, const Facets& facets, const InnerLight& light,
                                 transport::Random& random) const;

  /// Of a heap that exchanges no light: what lights do in the grain that is seen straight through this one.
  glm::vec3 lit_behind(std::uint32_t grain, const glm::vec3& normal, const glm::vec3& towards,
                       transport::Random& random) const;
  glm::vec3 lit_behind(const SeenFacet& seen, const Facets& facets, transport::Random& random) const;

  /// Whether so much crosses this grain, whose surface refracts, that look_into() shows more of it.
  bool sees_into(std::uint32_t grain) const;

  /// Whether that is so of any grain.
  bool sees_into_any() const { return !light_->scattered.empty(); }

  /// Whether a look may find lights, unscattered, that few others do.
  bool finds_by_chance() const { return sees_into_any() && (!heap_.lights.empty() || image_); }

  /// What is seen of a clear grain.
  struct Through {
    glm::vec3 others{0.0F};  ///< of what grains and walls send
    glm::vec3 lights{0.0F};  ///< of the world and the lights, unscattered; of a grain alone, of all that is behind it
    glm::vec3 scattered{0.0F};  ///< of both, scattered in it
    glm::vec3 mirrored{0.0F};   ///< of both, reflected by its surface
    glm::vec3 chance{0.0F};     ///< of lights, unscattered, that few looks meet

    void add(const Through& other) {
      others += other.others;
      lights += other.lights;
      scattered += other.scattered;
      mirrored += other.mirrored;
      chance += other.chance;
    }

    void scale(float by) {
      others *= by;
      lights *= by;
      scattered *= by;
      mirrored *= by;
      chance *= by;
    }
  };

  /// How a clear grain is looked into.
  struct Look {
    Scatterings scatterings;  ///< in this grain; where they end, its numbers tell what others make of them
    bool whole;               ///< no model tells what lights and the world do in it and at its surface
    bool alone = false;       ///< its model tells how much scattering leaves of what crosses it, and the look of what
    float narrowed = 1.0F;    ///< by what the cones that lights are spread over are multiplied
  };

  /// What look() shows, through the grain's own facets and other clear grains that stand behind it, and the world and
  /// the lights that are seen so.
  Through look_into(const SeenFacet& seen, const Facets& facets, const Look& how, transport::Random& random) const;

  /// What is seen straight through a clear grain.
  struct StraightEnd {
    std::optional<Meeting> met;  ///< another or a wall; else the world
    glm::vec3 direction;         ///< its normal; of the world the way towards it
    glm::vec3 radiance;          ///< of the world, else of 1 there, what is left of it on its way
  };

  /// Nothing, where that is not clearly seen.
  std::optional<StraightEnd> straight_end(SeenFacet seen, const Facets& facets) const;

  /// The solid angle, in steradians, of the smallest cone in which looks through clear grains find a light of the
  /// scene, in a picture's first sample.
  float smallest_cone() const;

  /// Look::narrowed of a picture's sample: its bias goes as its noise does, the more samples there are.
  static float narrowed(std::uint32_t sample);

  /// What a clear grain's surface reflects of suns and lamps.
  glm::vec3 highlights(const SeenFacet& seen, const Facets& facets, transport::Random& random) const;

 private:
  /// What so little is left of is not followed on.
  static constexpr float nothing = 1e-3F;
  /// Transparent grains, one behind the other.
  static constexpr int most_crossed = 32;
  /// And grains that a whole way goes by: what is left of light after so many numbers tell.
  static constexpr int most_followed = 512;
  /// Clear grains, one behind the other; the last of them is as its neighbours see it.
  static constexpr int most_looked_into = 12;

  void follow_look(SeenFacet seen, const Facets& facets, const Look& how, transport::Random& random,
                   Through& sum) const;
  /// What was scattered in a clear grain, over the share of light that is.
  struct ScatteredLight {
    glm::vec3 all;
    glm::vec3 of_others;  ///< that grains and walls have sent
  };
  ScatteredLight scattered_in(const SeenFacet& seen) const;
  /// In how wide a cone lights are seen where a look leaves a grain, at the least: its half angle.
  static float spread_of(const Passage& passage, float narrowed);
  /// `spread`: the least half angle of the cone in which a light is seen; `but_drawn`: without those that stand for
  /// surfaces.
  glm::vec3 lights_along(std::uint32_t grain, const Passage& passage, float spread, bool but_drawn,
                         const Facets& facets, transport::Random& random) const;
  /// What leaves a grain's rough facet, from inside, of the lights beyond it. `inwards`: the facet's normal. `rougher`:
  /// so many times, as a facet is taken to be that meets what others have reflected.
  glm::vec3 lights_through(std::uint32_t grain, const Passage& arriving, const glm::vec3& inwards, float rougher,
                           const Facets& facets, transport::Random& random) const;
  /// The same of what the world's image has of them.
  glm::vec3 glare_along(std::uint32_t grain, const Passage& passage, float spread, const Facets& facets,
                        transport::Random& random) const;
  /// What the world sends to the end of a look; but for what glares in its image, unless that is seen `as_it_is`.
  glm::vec3 world_along(const glm::vec3& direction, bool as_it_is) const;
  /// One direction in which the world's image is so bright, as a light of the scene; no light elsewhere.
  lights::LightDraw glare(transport::Random& random) const;
  /// What a clear grain's surface reflects of a light that comes from where it seems `angle` wide.
  glm::vec3 highlight(const SeenFacet& seen, const Facets& facets, const lights::LightDraw& light, double angle) const;
  /// The same of a sun's disc by a surface smooth enough to be a mirror of it: `sun`: its number.
  glm::vec3 mirrored_disc(const SeenFacet& seen, const Facets& facets, std::size_t sun,
                          const glm::vec3& irradiance) const;
  /// What a grain stands for, or null.
  const Pane* pane(std::uint32_t grain) const;
  /// What is met from a grain's surface on, straight through panes, of whose light `left` loses what they reflect and
  /// absorb; only what they absorb if `mirrored`, as if what they reflect saw the same.
  std::optional<Meeting> beyond_panes(std::uint32_t grain, glm::vec3 place, const glm::vec3& direction, bool mirrored,
                                      const Facets& facets, glm::vec3& left) const;
  /// What is left of a light on its way to a grain's surface.
  glm::vec3 passed_towards(std::uint32_t grain, const glm::vec3& place, const glm::vec3& to_light, float reach,
                           const Facets& facets) const;
  /// What is sent along a ray, if it meets anything.
  std::optional<glm::vec3> sent_along(Ray& ray, transport::Random& random) const;
  /// The same by another look at what is met, and so on `further` times in all.
  std::optional<glm::vec3> seen_of_others(Ray& ray, int further, transport::Random& random) const;
  /// What a source sends along a ray that has met it, by more rays from a Lambert grain, by a walk in one that walks
  /// tell: few numbers do not tell how much darker it is where others stand about it.
  glm::vec3 looked_at(const Source& source, const Ray& ray, int further, transport::Random& random) const;
  bool is_lambert(std::uint32_t number) const;
  glm::vec3 sent_by_lambert(std::uint32_t grain, const glm::vec3& normal, int further, transport::Random& random) const;
  /// What a Lambert surface sends from a place of a facet, or of a wall, by a ray to others.
  glm::vec3 sent_by_facet(const Meeting& meeting, const Facets& facets, int further, const Hero& hero,
                          transport::Random& random) const;
  /// What a world without a picture sends to the end of it.
  glm::vec3 even_world(const Ray& ray) const;
  Ray ray_through(std::uint32_t grain, const glm::vec3& normal, const glm::vec3& towards) const;
  /// look_at_all() but for the world behind it, where `through` leaves the heap.
  std::optional<All> look_at_all_but_world(const SeenFacet& seen, const Facets& facets, const Walks& walks,
                                           transport::Random& random, Ray& through) const;
  /// The world or the film, where a straight way through a grain has left the heap.
  void show_what_is_behind(const Ray& through, All& all) const;
  /// One direction of each light, as it comes to a grain.
  std::vector<Asking> asking(std::uint32_t grain, transport::Random& random) const;
  bool is_transparent(std::uint32_t grain) const;
  /// Whether a walk tells what lights do in a grain.
  bool is_lit(std::uint32_t grain) const;
  /// Where a way straight through a grain ends, from a place of its surface or in it; nothing, if there is none.
  std::optional<End> end_across(std::uint32_t grain, const glm::vec3& place, const glm::vec3& direction,
                                const Facets& facets) const;
  /// What is left of light there, of the grain that is seen and of others, which are what of_others_ has.
  glm::vec3 left_across_seen(std::uint32_t grain, const std::optional<End>& end) const;
  glm::vec3 left_across_other(std::uint32_t grain, const std::optional<End>& end) const;
  glm::vec3 left_across(const Optics& optics, std::uint32_t grain, const std::optional<End>& end) const;
  /// Straight to a light from a place in the grain that is seen.
  struct WayOut {
    glm::vec3 place;  ///< of the surface
    float distance;   ///< to there
    glm::vec3 left;   ///< of the light
  };
  /// Nothing, where a wall is in the way. To the light itself, where that is nearer than the surface.
  std::optional<WayOut> way_out(std::uint32_t grain, const glm::vec3& place, const glm::vec3& direction, float reach,
                                const Facets& facets) const;
  /// And on through others, on the way from a grain's surface to a light.
  glm::vec3 passed_between(std::uint32_t grain, glm::vec3 place, const glm::vec3& to_light, float reach,
                           const Facets& facets) const;
  /// What is sent from where a ray has met something.
  glm::vec3 sent_by(const Meeting& meeting, Ray& ray, transport::Random& random) const;
  /// The same by the numbers of what it is.
  glm::vec3 told_by(const Source& source, const Ray& ray) const;
  /// Whether a grain that a walk meets can be walked in. Not what is no grain; nor where what is scattered forwards
  /// counts as crossing, which such a walk would tell again: on whole ways it does not.
  bool is_walked_once_more(std::uint32_t number) const;
  /// Of a transparent grain on the way: what it sends and what crosses it, or one of the two, drawn.
  enum class Crossings { all, drawn };
  /// What lights, the world and others do in a grain, from a place of its surface that a view ray meets, but for what
  /// crosses it straight: the mean of all walks.
  All walked_in(const SeenFacet& seen, const std::optional<End>& across, const Facets& facets, const Walks& walks,
                transport::Random& random, const Hero& hero = {}) const;
  /// The same where its inner light is known.
  All seen_in(const SeenFacet& seen, const End& across, const InnerLight& light, const Facets& facets,
              transport::Random& random) const;
  /// The same in its ball; `place`: from its middle.
  All walked_in(std::uint32_t grain, const glm::vec3& place, const glm::vec3& normal, const glm::vec3& towards,
                const Walks& walks, transport::Random& random) const;
  /// What a grain that a ray has met sends along it, by a walk in its ball.
  glm::vec3 walked_in(const Source& source, const Ray& ray, int further, transport::Random& random) const;
  /// Grains that a view ray meets behind others, of which one is walked in for all.
  struct Behind {
    float met = 0.0F;  ///< the share of light that all of them scatter or absorb
    SeenFacet seen{};
    std::optional<End> across;
    glm::vec3 weight{0.0F};  ///< what is left of light there, over the share that this one does

    /// One more, which so much of light comes to and crosses.
    void add(const SeenFacet& facet, const std::optional<End>& its_end, const glm::vec3& comes,
             const glm::vec3& crosses, transport::Random& random);
    /// How many walks show it where so many show what stands before: the fewer the less it is, and at random none.
    int walks(int before, transport::Random& random);
    /// What they found, for all of them.
    void show(const All& found, All& all) const;
  };
  /// Whether light that is scattered in it is walked with where it stands behind others: what is scattered forwards
  /// counts as crossing to those, but is not seen where light goes straight through.
  bool is_walked_behind(std::uint32_t grain) const;
  /// What others send along a ray from a grain's surface, straight through those that let it; `wall`: what it meets
  /// first, if that is known. Leaves it what weight leaves the heap.
  /// What those send that are walked behind is left out where there is a `behind` for them.
  /// Where crossings are drawn, grains may be looked at, as Walks::further has it.
  glm::vec3 seen_between(std::uint32_t grain, std::optional<Meeting> wall, Crossings crossings, Ray& ray,
                         const Facets& facets, transport::Random& random, Behind* behind = nullptr,
                         int further = 0) const;
  /// The same of whole ways; `sees_what_shines`: walls that do, which lights else stand for. `hero`: of the way so far.
  glm::vec3 followed_on(std::uint32_t grain, std::optional<Meeting> wall, bool sees_what_shines, Ray& ray,
                        const Facets& facets, int further, Hero hero, transport::Random& random) const;

  struct Found;
  Gather(std::shared_ptr<const Heap> heap, std::shared_ptr<const Found> found, Ways ways);

  std::shared_ptr<const Heap> held_;
  const Heap& heap_;  // that is held
  std::shared_ptr<const Found> found_;
  const std::shared_ptr<const HeapLight>& light_;    // of found_
  const Space& space_;                               // of found_
  std::shared_ptr<const lights::WorldLight> image_;  // the world, or null
  std::vector<Draw> draws_;
  scene::Backdrop seen_by_camera_;
  std::vector<lights::DeviceLight> lights_;  // of the heap, its places from the anchor
  Ways ways_;
  std::vector<Optics> of_others_;  // by kind: of grains that are on the way of light
};

}  // namespace mesograin::heap
