// Rays start where a viewer would look at a grain or a wall, from all sides, go through a grain's table backwards and
// on to what the light came from. Points are those of an additive recurrence, shifted for each grain, so that each
// grain's rays are spread evenly.
#include "heap/links.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <mutex>
#include <numbers>
#include <numeric>
#include <utility>

#include "heap/entered.h"
#include "heap/moves.h"
#include "heap/spread.h"
#include "transport/directions.h"

namespace mesograin::heap {
namespace {

constexpr std::size_t grains_a_piece = 64;
float mean(const glm::vec3& colour) { return (colour.r + colour.g + colour.b) / 3.0F; }

struct Departing {
  glm::vec3 weight;
  glm::vec3 normal;
};

constexpr std::size_t most_numbers = 9;
using Numbers = std::array<double, most_numbers>;

/// What a normal is told by: by four numbers to order 1, by all to order 2.
Numbers numbers_of(const glm::vec3& normal) {
  const SecondOrder second = second_order(normal);
  Numbers numbers{1.0, normal.x, normal.y, normal.z};
  std::copy(second.begin(), second.end(), numbers.begin() + 4);
  return numbers;
}

double product(const Numbers& a, const Numbers& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }

/// What a matrix that is symmetric and positive makes `right` of (elimination), 0 beyond `count`.
Numbers solved_for(std::array<Numbers, most_numbers> matrix, Numbers right, std::size_t count) {
  for (std::size_t row = 0; row < count; ++row)
    for (std::size_t below = row + 1; below < count; ++below) {
      const double factor = matrix[below][row] / matrix[row][row];
      for (std::size_t column = row; column < count; ++column) matrix[below][column] -= factor * matrix[row][column];
      right[below] -= factor * right[row];
    }
  Numbers solved{};
  for (std::size_t row = count; row-- > 0;)
    solved[row] = (right[row] - product(matrix[row], solved)) / matrix[row][row];
  return solved;
}

/// How much of what is seen through a grain is the world, by the place that tells it: the numbers that are nearest to
/// what looks found, which for a grain that stands alone is all, however few they were.
class Opening {
 public:
  /// `left` of `weight` leaves the heap.
  void add(float weight, float left, const glm::vec3& place) {
    const Numbers numbers = numbers_of(place);
    for (std::size_t row = 0; row < most_numbers; ++row) {
      for (std::size_t column = 0; column < most_numbers; ++column)
        moments_[row][column] += static_cast<double>(weight) * numbers[row] * numbers[column];
      found_[row] += static_cast<double>(left) * numbers[row];
    }
    ++looks_;
  }

  /// To order 2 if `fine`, as far as there are enough looks.
  Share share(bool fine) const {
    constexpr std::size_t enough = 6;  // for each number
    Share share;
    if (!(moments_[0][0] > 0.0) || found_[0] == 0.0) return share;
    std::size_t count = fine ? most_numbers : 4;
    while (count > 1 && looks_ < enough * count) count = count > 4 ? 4 : 1;
    Numbers numbers = solved_for(moments_, found_, count);
    const bool sound =
        std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::abs(number) < 4.0; });
    if (!sound) numbers = {found_[0] / moments_[0][0]};
    share.first = glm::vec4(numbers[1], numbers[2], numbers[3], numbers[0]);
    for (std::size_t i = 0; i < share.second.size(); ++i) share.second[i] = static_cast<float>(numbers[4 + i]);
    return share;
  }

 private:
  std::array<Numbers, most_numbers> moments_{};
  Numbers found_{};
  std::size_t looks_ = 0;
};

/// What a place's numbers make of how scattered light is weighed.
float factor_at(const Scattering& scattering, const glm::vec3& place) {
  const SecondOrder second = second_order(place);
  const std::array<float, 9>& even = scattering.even;
  float sum = even[0] + even[1] * place.x + even[2] * place.y + even[3] * place.z;
  for (std::size_t i = 0; i < second.size(); ++i) sum += even[4 + i] * second[i];
  return sum;
}

struct Found {
  std::vector<Link> links;
  Scattering scattering;
  Coefficients direct;
  Coefficients crossed;
  Coefficients scattered;
  Share open;
};

struct Behind {
  std::vector<Link> links;
  Share open;
};

/// By which sums of a place's numbers to weigh what departs so that even light leaves evenly, as far as `count` numbers
/// tell, and comes to 1 in all; 0 where nothing departs. `weight`: of each.
template <typename Weight>
Numbers evening(const std::vector<Departing>& departing, std::size_t count, const Weight& weight) {
  constexpr double least = 0.2;
  std::array<Numbers, most_numbers> moments{};
  for (const Departing& from : departing) {
    const Numbers numbers = numbers_of(from.normal);
    for (std::size_t row = 0; row < count; ++row)
      for (std::size_t column = 0; column < count; ++column)
        moments[row][column] += static_cast<double>(weight(from)) * numbers[row] * numbers[column];
  }
  const double sum = moments[0][0];
  if (!(sum > 0.0)) return {};
  const Numbers even{1.0 / sum};
  const Numbers factors = solved_for(moments, {1.0}, count);
  const bool sound = std::all_of(departing.begin(), departing.end(), [&](const Departing& from) {
    return product(factors, numbers_of(from.normal)) > least * even[0];
  });
  return sound ? factors : even;
}

/// Scales the weights so that a grain in even light sends out just what its table says, as much at every normal as far
/// as `count` numbers tell: which outcomes were drawn and where neither wins light nor turns it.
void balance(std::vector<Departing>& departing, const glm::vec3& albedo, std::size_t count) {
  for (int channel = 0; channel < 3; ++channel) {
    const Numbers factors = evening(departing, count, [&](const Departing& from) { return from.weight[channel]; });
    for (Departing& from : departing)
      from.weight[channel] *= albedo[channel] * static_cast<float>(product(factors, numbers_of(from.normal)));
  }
}

/// How to weigh what was scattered in a clear grain. Few looks tell but few numbers.
Scattering weigh(const std::vector<Departing>& scattered, std::size_t count) {
  constexpr std::size_t enough = 3;  // for each number
  while (count > 1 && scattered.size() < enough * count) count = count > 4 ? 4 : 1;
  const Numbers even = evening(scattered, count, [](const Departing& from) { return mean(from.weight); });
  Scattering weighed;
  for (std::size_t i = 0; i < even.size(); ++i) weighed.even[i] = static_cast<float>(even[i]);
  for (const Departing& from : scattered) weighed.share += from.weight * factor_at(weighed, from.normal);
  return weighed;
}

// Of a node of walls, whose light is the same whatever the normal.
constexpr glm::vec3 nowhere(0.0F);

Link link_to(const Source& source, const glm::vec3& weight, const glm::vec3& leaves_at) {
  const PackedPlace sent_at(source.normal);
  const PackedPlace leaves(leaves_at);
  transport::Random chance(source.number, (std::uint64_t{sent_at.bits()} << 32U) | leaves.bits());
  return {source.number, sent_at, leaves, PackedWeight(weight / source.met, chance.bits())};
}

struct Ending {
  std::optional<Source> source;
  glm::vec3 left{0.0F};
  bool crossed = false;
};

/// A ray that is looked along, and where what it finds leaves a grain, towards whom.
struct Look {
  Ray ray;
  glm::vec3 normal;
  glm::vec3 towards;
  bool refracted = false;  ///< and not scattered
  bool scattered = false;  ///< in a clear grain
};

/// One of many places of a ball, seen from one of many sides, all alike.
struct Seen {
  explicit Seen(const std::array<float, 5>& point)
      : normal(transport::isotropic(point[0], point[1])),
        mu(std::sqrt(point[2])),
        frame(normal, point[4]),
        towards(frame * glm::vec3(-std::sqrt(1.0F - point[2]), 0.0F, mu)) {}

  glm::vec3 normal;
  float mu;
  TurnedFrame frame;
  glm::vec3 towards;
};

/// Of random numbers. A grain in a seat of its own has the same whoever shares; one that answers for others may do so
/// for a cell more than once.
std::uint64_t stream_of(const Space& space, std::size_t answering) {
  constexpr std::uint64_t of_sharing = std::uint64_t{1} << 32U;
  const Seats& seats = *space.seats();
  return answering >= seats.own() && space.of_grain(answering) ? of_sharing + answering : seats.number(answering);
}

/// The rays of a grain through its table, or of a node.
std::vector<Look> looks_from(const Space& space, std::size_t answering, const Rays& rays, std::uint64_t seed) {
  transport::Random random(seed, stream_of(space, answering));
  const Spread spread(random);
  std::vector<Look> looks;
  if (space.of_grain(answering)) {
    const std::uint32_t number = space.seats()->number(answering);
    const Grain& grain = space.grains()[number];
    const GrainTable& table = *space.answering(number).from_viewer;
    const int count = rays.of(answering);
    looks.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      const std::array<float, 5> point = spread.point(i);
      const Seen seen(point);
      const Outcome outcome = table.draw(seen.mu, point[3]);
      const glm::vec3 leaves = space.place(grain, seen.frame * outcome.normal);
      looks.push_back({{leaves, seen.frame * outcome.direction, outcome.weight},
                       seen.normal,
                       seen.towards,
                       outcome.refracted,
                       outcome.scattered && table.is_clear()});
    }
    return looks;
  }
  const Patches::Node& node = space.node(answering);
  const glm::vec3 weight = space.kind(node).from_viewer->albedo() / static_cast<float>(rays.of_node);
  looks.reserve(static_cast<std::size_t>(rays.of_node));
  for (int i = 0; i < rays.of_node; ++i) {
    const std::array<float, 5> point = spread.point(i);
    const WallPlace from = space.place(node, point[0], point[1]);
    const float cosine = std::sqrt(1.0F - point[2]);
    const glm::vec3 direction = TurnedFrame(from.normal, point[3]) * glm::vec3(std::sqrt(point[2]), 0.0F, cosine);
    looks.push_back({{from.place, direction, weight}, nowhere, nowhere});
  }
  return looks;
}

/// Rays straight through a transparent grain.
std::vector<Look> looks_through(const Space& space, std::size_t answering, const Rays& rays, std::uint64_t seed) {
  std::vector<Look> looks;
  const std::uint32_t number = space.seats()->number(answering);
  const GrainTable& table = *space.kind(number).from_viewer;
  if (table.crossing(0.0F) == glm::vec3(0.0F)) return looks;
  transport::Random random(seed, stream_of(space, answering));
  const Spread spread(random);
  const Grain& grain = space.grains()[number];
  const int count = rays.of(answering);
  looks.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const Seen seen(spread.point(i));
    const glm::vec3 leaves = space.place(grain, seen.normal - 2.0F * seen.mu * seen.towards);
    looks.push_back({{leaves, -seen.towards, table.crossing(seen.mu)}, seen.normal, seen.towards});
  }
  return looks;
}

/// Random numbers of one ray's way, so that it is the same whatever the others meet.
transport::Random on_way(std::uint64_t seed, std::uint64_t stream, std::size_t look) {
  return {seed, (stream << 16U) + look};
}

constexpr std::uint64_t ways_seed = 0x5ca1ab1eU;  // more than that of the looks

/// Whether any of these meets a place where a grain was or is that has moved.
bool touched(const Space& space, const Moves& moves, const std::vector<Look>& looks, std::size_t answering,
             std::uint64_t seed) {
  const std::uint64_t stream = stream_of(space, answering);
  for (std::size_t i = 0; i < looks.size(); ++i) {
    const std::optional<float> distance = moves.distance(looks[i].ray.origin, looks[i].ray.direction);
    if (!distance) continue;
    Ray ray = looks[i].ray;
    transport::Random random = on_way(seed + ways_seed, stream, i);
    // What it meets before is as it was.
    if (!space.follow(ray, random) ||
        glm::dot(ray.origin - looks[i].ray.origin, ray.direction) >= *distance * (1.0F - 1e-5F))
      return true;
  }
  return false;
}

Found found_by(const Space& space, std::size_t answering, const std::vector<Look>& looks, bool fine,
               const glm::vec3& radiance, std::uint64_t seed) {
  Found found;
  std::vector<Departing> departing;
  std::vector<Ending> endings(looks.size());
  departing.reserve(looks.size());
  const bool of_grain = space.of_grain(answering);
  const GrainTable* table = of_grain ? space.answering(space.seats()->number(answering)).from_viewer.get() : nullptr;
  const std::uint64_t stream = stream_of(space, answering);
  for (std::size_t i = 0; i < looks.size(); ++i) {
    Ray ray = looks[i].ray;
    transport::Random random = on_way(seed + ways_seed, stream, i);
    departing.push_back({ray.weight, of_grain ? table->seen_place(looks[i].normal, looks[i].towards) : nowhere});
    endings[i].source = space.follow(ray, random);
    endings[i].crossed = ray.crossed;
    // What the way has left of the weight.
    for (int channel = 0; channel < 3; ++channel)
      endings[i].left[channel] =
          departing[i].weight[channel] > 0.0F ? ray.weight[channel] / departing[i].weight[channel] : 0.0F;
  }
  const std::size_t numbers = fine ? most_numbers : 4;
  if (of_grain) balance(departing, table->albedo(), numbers);
  std::vector<Departing> scattered;
  for (std::size_t i = 0; i < looks.size(); ++i)
    if (looks[i].scattered) scattered.push_back(departing[i]);
  if (!scattered.empty()) found.scattering = weigh(scattered, numbers);
  found.links.reserve(static_cast<std::size_t>(
      std::count_if(endings.begin(), endings.end(), [](const Ending& ending) { return ending.source.has_value(); })));
  Opening opening;
  for (std::size_t i = 0; i < departing.size(); ++i) {
    const Departing& from = departing[i];
    const glm::vec3 weight = from.weight * endings[i].left;
    if (looks[i].refracted) opening.add(mean(from.weight), endings[i].source ? 0.0F : mean(weight), from.normal);
    if (endings[i].source) {
      found.links.push_back(link_to(*endings[i].source, weight, from.normal));
      if (looks[i].scattered) std::swap(found.links[found.scattering.links++], found.links.back());
    } else {
      (endings[i].crossed ? found.crossed : found.direct).add(weight * radiance, from.normal, fine);
      if (looks[i].scattered)
        found.scattered.add(weight * radiance * factor_at(found.scattering, from.normal), from.normal, fine);
    }
  }
  found.open = opening.share(fine);
  return found;
}

Behind seen_behind(const Space& space, std::size_t answering, const std::vector<Look>& looks, std::uint64_t seed) {
  const std::uint64_t stream = stream_of(space, answering);
  Behind behind;
  struct Met {
    Source source;
    glm::vec3 weight;
    glm::vec3 look;
  };
  std::vector<Met> met;
  Opening opening;
  glm::vec3 all(0.0F);
  for (std::size_t i = 0; i < looks.size(); ++i) {
    Ray ray = looks[i].ray;
    transport::Random random = on_way(seed + ways_seed, stream, i);
    const glm::vec3 weight = ray.weight;
    all += weight;
    const glm::vec3 look = look_through(looks[i].normal, looks[i].towards);
    const std::optional<Source> source = space.follow(ray, random);
    if (source) met.push_back({*source, ray.weight, look});
    opening.add(mean(weight), source ? 0.0F : mean(ray.weight), look);
  }
  glm::vec3 share(0.0F);
  for (int channel = 0; channel < 3; ++channel)
    if (all[channel] > 0.0F) share[channel] = 1.0F / all[channel];
  behind.links.reserve(met.size());
  for (const Met& one : met) behind.links.push_back(link_to(one.source, share * one.weight, one.look));
  behind.open = opening.share(false);
  return behind;
}

void take(Found found, std::size_t answering, Links& links, Lit& lit) {
  links.of[answering] = std::move(found.links);
  lit.direct[answering] = found.direct;
  lit.crossed[answering] = found.crossed;
  if (answering < links.open.size()) links.open[answering] = found.open;
  if (links.scattered.empty()) return;
  links.scattered[answering] = found.scattering;
  lit.scattered[answering] = found.scattered;
}

constexpr std::uint64_t behind_seed = 2;  // more than an effort's

/// each(i) for i below `count`, many a piece.
template <typename Each>
void for_each(std::size_t count, const transport::Effort& effort, const Each& each) {
  transport::run_pieces(effort, (count + grains_a_piece - 1) / grains_a_piece, [&](std::size_t piece) {
    for (std::size_t i = piece * grains_a_piece; i < std::min(count, (piece + 1) * grains_a_piece); ++i) each(i);
  });
}

}  // namespace

std::size_t Links::count() const {
  std::size_t all = 0;
  for (const std::vector<Link>& links : of) all += links.size();
  return all;
}

namespace {

/// What light sent out by others makes each send out by the first `first(i)` of its links, weighed by `factor(i,
/// place)`.
template <typename First, typename Factor>
void gather_first(const Links& links, const First& first, const Factor& factor, const Field& sent, Field& answer,
                  const transport::Effort& effort, const Change* change) {
  const std::size_t count = links.of.size();
  answer.resize(count);
  constexpr std::size_t at_once = 512;
  transport::run_pieces(effort, (count + at_once - 1) / at_once, [&](std::size_t piece) {
    for (std::size_t i = piece * at_once; i < std::min(count, (piece + 1) * at_once); ++i) {
      Coefficients sum;
      const bool of_fine = !links.fine.empty() && links.fine[i];
      const std::vector<Link>& of = links.of[i];
      for (std::size_t j = 0; j < first(i); ++j) {
        const Link& link = of[j];
        glm::vec3 weight = link.weight.whole();
        if (change != nullptr) weight *= change->received[link.from];
        const glm::vec3 light = links.seats->light_at(sent, link.from, link.sent_at.whole(), !links.fine.empty());
        const glm::vec3 leaves_at = link.leaves_at.whole();
        sum.add(weight * light * factor(i, leaves_at), leaves_at, of_fine);
      }
      if (change != nullptr && !change->answered.empty()) sum = sum * change->answered[links.seats->number(i)];
      answer[i] = sum;
    }
  });
}

}  // namespace

void Links::gather(const Field& sent, Field& answer, const transport::Effort& effort, const Change* change) const {
  gather_first(
      *this, [this](std::size_t i) { return of[i].size(); },
      [](std::size_t /*i*/, const glm::vec3& /*place*/) { return 1.0F; }, sent, answer, effort, change);
  answer = seats->told(std::move(answer));
}

void Links::gather_scattered(const Field& sent, Field& answer, const transport::Effort& effort,
                             const Change* change) const {
  gather_first(
      *this, [this](std::size_t i) { return std::size_t{scattered[i].links}; },
      [this](std::size_t i, const glm::vec3& place) { return factor_at(scattered[i], place); }, sent, answer, effort,
      change);
}

bool Rays::fine(const Space& space, std::size_t answering) const {
  constexpr int least = 64;
  return space.of_grain(answering) && of(answering) >= least &&
         space.answering(space.seats()->number(answering)).from_viewer->is_fine();
}

Deep find_deep(const Space& space, int ways, const transport::Effort& effort) {
  const Rays few{8, 8};
  const std::size_t count = space.size();
  std::vector<std::vector<std::uint32_t>> sees(count);
  std::vector<int> depths(count, ways + 1);
  for_each(count, effort, [&](std::size_t i) {
    const std::vector<Look> looks = looks_from(space, i, few, effort.seed);
    for (std::size_t look = 0; look < looks.size(); ++look) {
      Ray ray = looks[look].ray;
      transport::Random random = on_way(effort.seed + ways_seed, i, look);
      if (const std::optional<Source> source = space.follow(ray, random))
        sees[i].push_back(source->number);
      else
        depths[i] = 0;
    }
  });
  for (int way = 1; way <= ways; ++way)
    for (std::size_t i = 0; i < count; ++i)
      if (depths[i] > way &&
          std::any_of(sees[i].begin(), sees[i].end(), [&](std::uint32_t from) { return depths[from] == way - 1; }))
        depths[i] = way;
  auto deep = std::make_shared<std::vector<bool>>(space.grains().size());
  for (std::size_t i = 0; i < deep->size(); ++i) (*deep)[i] = depths[i] > ways;
  return deep;
}

glm::vec3 look_through(const glm::vec3& normal, const glm::vec3& towards) {
  const float mu = std::max(glm::dot(normal, towards), 0.0F);
  return glm::normalize((2.0F * mu + 1.0F) * towards - normal);
}

void find_ways(const Space& space, const Rays& rays, const Rays& rays_through, const glm::vec3& radiance, Ways& ways,
               const transport::Effort& effort) {
  const std::size_t count = space.size();
  const std::size_t own = space.seats()->own();
  Links& links = ways.links;
  Lit& lit = ways.world;
  for (Links* each : {&links, &ways.behind}) {
    each->of.resize(count);
    each->open.resize(own);
    each->seats = space.seats();
  }
  links.scattered.resize(space.any_clear() ? count : 0);
  links.fine.assign(count, false);
  bool any_fine = false;
  for (std::size_t i = 0; i < count; ++i) any_fine = (links.fine[i] = rays.fine(space, i)) || any_fine;
  if (!any_fine) links.fine.clear();
  lit.direct.resize(count);
  lit.crossed.resize(count);
  lit.scattered.resize(links.scattered.size());
  find_entered(space, rays, radiance, lit.entered, transport::part_of(effort, 0.0, 0.2));
  for_each(count, transport::part_of(effort, 0.2, 0.8), [&](std::size_t i) {
    Found found =
        found_by(space, i, looks_from(space, i, rays, effort.seed), rays.fine(space, i), radiance, effort.seed);
    take(std::move(found), i, links, lit);
  });
  const std::uint64_t seed = effort.seed + behind_seed;
  // What stands behind those that share is seen by nobody.
  for_each(own, transport::part_of(effort, 0.8, 1.0), [&](std::size_t i) {
    Behind found = seen_behind(space, i, looks_through(space, i, rays_through, seed), seed);
    ways.behind.of[i] = std::move(found.links);
    ways.behind.open[i] = found.open;
  });
}

std::size_t renew(const Space& space, const Moves& moves, const Rays& rays, const Rays& rays_through,
                  const glm::vec3& radiance, Ways& ways, const transport::Effort& effort) {
  renew_entered(space, moves, rays, radiance, ways.world.entered, transport::part_of(effort, 0.0, 0.2));
  std::mutex mutex;
  std::vector<std::pair<std::size_t, Found>> found;
  for_each(space.size(), transport::part_of(effort, 0.2, 0.8), [&](std::size_t i) {
    const std::vector<Look> looks = looks_from(space, i, rays, effort.seed);
    const bool moved = space.of_grain(i) && moves.moved(space.seats()->number(i));
    if (!moved && !touched(space, moves, looks, i, effort.seed)) return;
    Found anew = found_by(space, i, looks, rays.fine(space, i), radiance, effort.seed);
    const std::lock_guard lock(mutex);
    found.emplace_back(i, std::move(anew));
  });
  std::vector<std::pair<std::size_t, Behind>> behind;
  const std::uint64_t seed = effort.seed + behind_seed;
  for_each(space.seats()->own(), transport::part_of(effort, 0.8, 1.0), [&](std::size_t i) {
    const std::vector<Look> looks = looks_through(space, i, rays_through, seed);
    if (!moves.moved(space.seats()->number(i)) && !touched(space, moves, looks, i, seed)) return;
    Behind anew = seen_behind(space, i, looks, seed);
    const std::lock_guard lock(mutex);
    behind.emplace_back(i, std::move(anew));
  });
  for (auto& [i, anew] : found) take(std::move(anew), i, ways.links, ways.world);
  for (auto& [i, anew] : behind) {
    ways.behind.of[i] = std::move(anew.links);
    ways.behind.open[i] = anew.open;
  }
  return found.size();
}

}  // namespace mesograin::heap
