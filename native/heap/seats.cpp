// Cells are found by their places, however far apart grains lie; how far they lie below open ones is told by ways from
// cell to cell.
#include "heap/seats.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <map>
#include <queue>
#include <unordered_map>
#include <utility>

#include "transport/effort.h"

namespace mesograin::heap {
namespace {

// Of a cell, in a heap that is packed as balls fall. Of fewer its numbers would tell too little.
constexpr double grains_a_cell = 16.0;
constexpr std::size_t fewest_in_cell = 8;
constexpr double packing = 0.6;

// So many cells below those where grains begin to share, eight are one: of what lies there less is seen, and light
// changes the less from place to place.
constexpr float below_cells = 3.0F;

// Of the slopes' own mean square, so that a few grains in one plane have none across it.
constexpr double ridge = 0.01;

std::uint64_t key_of(const glm::ivec3& at) {
  constexpr int most_cells = 1 << 20;
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis)
    key = key << 21U | static_cast<std::uint64_t>(std::clamp(at[axis], -most_cells, most_cells - 1) + most_cells);
  return key;
}

/// Of root mean square: a few stones in sand do not make its cells large.
double typical_radius(const std::vector<Grain>& grains) {
  double squares = 0.0;
  for (const Grain& grain : grains) squares += static_cast<double>(grain.radius) * static_cast<double>(grain.radius);
  return std::sqrt(squares / static_cast<double>(std::max(grains.size(), std::size_t{1})));
}

/// x of matrix x = right, for a matrix that is symmetric and positive (elimination).
template <std::size_t count>
std::array<double, count> solved(std::array<std::array<double, count>, count> matrix, std::array<double, count> right) {
  for (std::size_t row = 0; row < count; ++row)
    for (std::size_t below = row + 1; below < count; ++below) {
      const double factor = matrix[below][row] / matrix[row][row];
      for (std::size_t column = row; column < count; ++column) matrix[below][column] -= factor * matrix[row][column];
      right[below] -= factor * right[row];
    }
  std::array<double, count> result{};
  for (std::size_t row = count; row-- > 0;) {
    double left = right[row];
    for (std::size_t column = row + 1; column < count; ++column) left -= matrix[row][column] * result[column];
    result[row] = left / matrix[row][row];
  }
  return result;
}

}  // namespace

class Seats::Builder {
 public:
  Builder(const std::vector<Grain>& grains, float length) : grains_(grains), length_(length) {
    for (std::uint32_t i = 0; i < grains.size(); ++i) {
      const glm::ivec3 at(glm::clamp(glm::floor(grains[i].middle / length), -1e9F, 1e9F));
      const auto [found, added] = numbers_.try_emplace(key_of(at), static_cast<std::uint32_t>(places_.size()));
      if (added) {
        places_.push_back(at);
        members_.emplace_back();
      }
      members_[found->second].push_back(i);
    }
    depths_.assign(places_.size(), std::numeric_limits<float>::max());
  }

  /// How many cells each lies below the nearest open one, by ways from cell to cell (Dijkstra 1959, "A note on two
  /// problems in connexion with graphs").
  void find_depths(const std::function<bool(std::uint32_t)>& open) {
    using Waiting = std::pair<float, std::uint32_t>;
    std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> waiting;
    for (std::uint32_t cell = 0; cell < places_.size(); ++cell)
      if (at_the_edge(cell) && std::any_of(members_[cell].begin(), members_[cell].end(), open)) {
        depths_[cell] = 0.0F;
        waiting.emplace(0.0F, cell);
      }
    while (!waiting.empty()) {
      const auto [depth, cell] = waiting.top();
      waiting.pop();
      if (depth > depths_[cell]) continue;
      each_neighbour(cell, [&, from = depth](std::uint32_t next, float far) {
        if (!(from + far < depths_[next])) return;
        depths_[next] = from + far;
        waiting.emplace(depths_[next], next);
      });
    }
  }

  void fill(Seats& seats, int cells_below, bool eights) const {
    std::vector<std::uint32_t> order(places_.size());
    for (std::uint32_t cell = 0; cell < order.size(); ++cell) order[cell] = cell;
    // What lies side by side is told side by side.
    std::sort(order.begin(), order.end(),
              [this](std::uint32_t a, std::uint32_t b) { return key_of(places_[a]) < key_of(places_[b]); });
    const auto is_shared = [&](std::uint32_t cell) {
      return depths_[cell] >= static_cast<float>(cells_below) && members_[cell].size() >= fewest_in_cell;
    };
    seats.seats_.resize(grains_.size());
    for (const std::uint32_t cell : order) {
      if (is_shared(cell)) continue;
      for (const std::uint32_t grain : members_[cell]) {
        seats.seats_[grain].seat = static_cast<std::uint32_t>(seats.answering_.size());
        seats.answering_.push_back(grain);
      }
    }
    seats.own_ = seats.answering_.size();
    std::map<std::uint64_t, std::vector<std::uint32_t>> blocks;  // of cells, in the order of `order`
    for (const std::uint32_t cell : order) blocks[key_of(places_[cell] >> 1)].push_back(cell);
    for (const auto& [key, cells] : blocks) {
      const bool one = eights && std::all_of(cells.begin(), cells.end(), [&](std::uint32_t cell) {
                         return is_shared(cell) && depths_[cell] >= static_cast<float>(cells_below) + below_cells;
                       });
      if (one) {
        std::vector<std::uint32_t> members;
        for (const std::uint32_t cell : cells)
          members.insert(members.end(), members_[cell].begin(), members_[cell].end());
        add_cell(seats, std::move(members), glm::vec3(2 * (places_[cells.front()] >> 1) + 1) * length_, 2.0F * length_);
        continue;
      }
      for (const std::uint32_t cell : cells)
        if (is_shared(cell)) add_cell(seats, members_[cell], (glm::vec3(places_[cell]) + 0.5F) * length_, length_);
    }
  }

 private:
  /// Which half, half of that and so on along the three axes in turn, so that parts one after the other lie near.
  static unsigned part_of_cell(const glm::vec3& from_middle, float length) {
    glm::vec3 left = from_middle;
    float half = 0.5F * length;
    unsigned part = 0;
    for (int level = 0; level < 2; ++level) {
      half *= 0.5F;
      for (int axis = 0; axis < 3; ++axis) {
        const bool upper = left[axis] >= 0.0F;
        part = 2 * part + (upper ? 1U : 0U);
        left[axis] += upper ? -half : half;
      }
    }
    return part;
  }

  bool at_the_edge(std::uint32_t cell) const {
    int neighbours = 0;
    each_neighbour(cell, [&](std::uint32_t /*next*/, float /*far*/) { ++neighbours; });
    return neighbours < 26;
  }

  template <typename Each>
  void each_neighbour(std::uint32_t cell, const Each& each) const {
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          if (x == 0 && y == 0 && z == 0) continue;
          const auto found = numbers_.find(key_of(places_[cell] + glm::ivec3(x, y, z)));
          if (found != numbers_.end()) each(found->second, std::sqrt(static_cast<float>(x * x + y * y + z * z)));
        }
  }

  /// `length`: of its sides.
  void add_cell(Seats& seats, std::vector<std::uint32_t> members, const glm::vec3& middle, float length) const {
    // Of every part of the cell about as many answer for it: a fit to places side by side tells nothing of the others.
    std::stable_sort(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
      return part_of_cell(grains_[a].middle - middle, length) < part_of_cell(grains_[b].middle - middle, length);
    });
    double all = 0.0;
    std::vector<double> until;
    for (const std::uint32_t grain : members) {
      Seat& seat = seats.seats_[grain];
      seat.seat = in_cell | static_cast<std::uint32_t>(seats.cells_.size());
      const glm::vec3 from_middle = 2.0F / length * (grains_[grain].middle - middle);
      for (int axis = 0; axis < 3; ++axis)
        seat.within[static_cast<std::size_t>(axis)] =
            static_cast<std::int8_t>(std::lround(side * std::clamp(from_middle[axis], -1.0F, 1.0F)));
      const auto radius = static_cast<double>(grains_[grain].radius);
      until.push_back(all += radius * radius);
    }
    // Each the likelier the larger its surface is (systematic resampling, as in grain_table.cpp).
    std::array<Terms, samples_each> of_samples{};
    std::array<std::array<double, terms>, terms> moments{};
    std::size_t member = 0;
    for (std::size_t sample = 0; sample < samples_each; ++sample) {
      while (member + 1 < until.size() && until[member] * samples_each <= (static_cast<double>(sample) + 0.5) * all)
        ++member;
      const std::uint32_t grain = members[member];
      seats.answering_.push_back(grain);
      const Terms of = of_samples[sample] = terms_of(seats.seats_[grain]);
      for (std::size_t row = 0; row < terms; ++row)
        for (std::size_t column = 0; column < terms; ++column)
          moments[row][column] += static_cast<double>(of[row]) * static_cast<double>(of[column]) / samples_each;
    }
    for (std::size_t term = 1; term < terms; ++term) moments[term][term] += ridge;
    Cell made{};
    for (std::size_t sample = 0; sample < samples_each; ++sample) {
      std::array<double, terms> right{};
      for (std::size_t term = 0; term < terms; ++term)
        right[term] = static_cast<double>(of_samples[sample][term]) / samples_each;
      const std::array<double, terms> fit = solved(moments, right);
      for (std::size_t term = 0; term < terms; ++term) made[sample][term] = static_cast<float>(fit[term]);
    }
    seats.cells_.push_back(made);
  }

  const std::vector<Grain>& grains_;
  float length_;
  std::unordered_map<std::uint64_t, std::uint32_t> numbers_;
  std::vector<glm::ivec3> places_;
  std::vector<std::vector<std::uint32_t>> members_;
  std::vector<float> depths_;
};

Seats::Seats(const std::vector<Grain>& grains, int cells_below, bool eights,
             const std::function<bool(std::uint32_t)>& open)
    : Seats(grains.size()) {
  const double radius = typical_radius(grains);
  if (!(radius > 0.0)) return;
  constexpr double ball = 4.18879;
  Builder builder(grains, static_cast<float>(radius * std::cbrt(grains_a_cell * ball / packing)));
  builder.find_depths(open);
  Seats found(grains.size());
  builder.fill(found, cells_below, eights);
  if (found.shared()) *this = std::move(found);
}

Field Seats::told(Field answers) const {
  if (!shared()) return answers;
  Field result(answers.size() - answering() + told());
  std::copy_n(answers.begin(), own_, result.begin());
  constexpr std::size_t cells_a_piece = 1024;
  transport::run_pieces({}, (cells_.size() + cells_a_piece - 1) / cells_a_piece, [&](std::size_t piece) {
    for (std::size_t cell = piece * cells_a_piece; cell < std::min(cells_.size(), (piece + 1) * cells_a_piece); ++cell)
      for (std::size_t sample = 0; sample < samples_each; ++sample)
        for (std::size_t term = 0; term < terms; ++term)
          result[own_ + terms * cell + term].add(answers[own_ + samples_each * cell + sample],
                                                 glm::vec3(cells_[cell][sample][term]));
  });
  std::copy(answers.begin() + static_cast<std::ptrdiff_t>(answering()), answers.end(),
            result.begin() + static_cast<std::ptrdiff_t>(told()));
  return result;
}

Coefficients Seats::of(const Field& told, std::uint32_t number) const {
  if (number >= grains_ || !shares(number)) return told[seat(number)];
  const Terms terms = terms_of(seats_[number]);
  const std::size_t first = first_of_cell(seats_[number]);
  Coefficients sum;
  for (std::size_t term = 0; term < terms.size(); ++term) sum.add(told[first + term], glm::vec3(terms[term]));
  return sum;
}

}  // namespace mesograin::heap
