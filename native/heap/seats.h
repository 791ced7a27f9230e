// Which numbers tell what a grain sends out: its own, or, deep in a heap of many, those of a cell of a lattice, in
// which light is linear. A few of the cell's grains answer for all; their answers' best fit are the cell's numbers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "heap/coefficients.h"
#include "heap/grains.h"

namespace mesograin::heap {

/// Who answers: first the grains that have a seat of their own, then those that answer for the cells. What is told: of
/// each such seat its numbers, then of each cell those of its middle and how they grow along three axes. After either
/// may come more, which Seats leave as they are.
class Seats {
 public:
  /// Each grain has its own, in their order.
  explicit Seats(std::size_t grains) : grains_(grains), own_(grains) {}

  /// Grains share that lie as many cells or more below those `open` ones from which light leaves the heap. `eights`:
  /// far below these, eight cells are one. How light grows along one so wide is told by its own light most of all, with
  /// the noise of few rays: of grains that send out nearly all that comes to them, that grows without end.
  Seats(const std::vector<Grain>& grains, int cells_below, bool eights,
        const std::function<bool(std::uint32_t grain)>& open);

  bool shared() const { return !cells_.empty(); }

  std::size_t grains() const { return grains_; }

  /// How many have their own.
  std::size_t own() const { return own_; }

  std::size_t answering() const { return own_ + samples_each * cells_.size(); }
  std::size_t told() const { return own_ + terms * cells_.size(); }

  /// Of those that answer; of what comes after them as if it came after all grains.
  std::uint32_t number(std::size_t answering_one) const {
    if (!shared()) return static_cast<std::uint32_t>(answering_one);
    return answering_one < answering_.size() ? answering_[answering_one]
                                             : static_cast<std::uint32_t>(grains_ + answering_one - answering_.size());
  }

  bool shares(std::uint32_t grain) const { return shared() && (seats_[grain].seat & in_cell) != 0; }

  /// Of a grain that has its own, or of what comes after all grains.
  std::uint32_t seat(std::uint32_t number) const {
    if (!shared()) return number;
    return number < grains_ ? seats_[number].seat : static_cast<std::uint32_t>(told() + number - grains_);
  }

  /// Of a grain that shares: where its cell's numbers begin.
  std::size_t first_of_cell(std::uint32_t grain) const { return first_of_cell(seats_[grain]); }

  /// And its place in the cell, from the middle: so many times the square root of 3 over 127, along each axis, is what
  /// the cell's second to fourth numbers are multiplied by.
  const std::array<std::int8_t, 3>& place_in_cell(std::uint32_t grain) const { return seats_[grain].within; }

  /// What those that answer make known, as it is told.
  Field told(Field answers) const;

  /// What is told of a grain, or of what comes after all.
  Coefficients of(const Field& told, std::uint32_t number) const;

  /// The same at a normal, to order 1 where it is shared; where nothing is told, nothing.
  glm::vec3 light_at(const Field& told, std::uint32_t number, const glm::vec3& normal, bool fine) const {
    if (told.empty()) return glm::vec3(0.0F);
    if (number < grains_ && shares(number)) return shared_light_at(told, number, normal);
    const Coefficients& own = told[seat(number)];
    return fine ? own.at(normal) : own.first_at(normal);
  }

 private:
  static constexpr std::size_t samples_each = 12;
  static constexpr std::size_t terms = 4;
  static constexpr float side = 127.0F;                // of a place within its cell, from the middle
  static constexpr std::uint32_t in_cell = 1U << 31U;  // the rest is the cell's number

  using Terms = std::array<float, terms>;

  struct Seat {
    std::uint32_t seat = 0;
    std::array<std::int8_t, 3> within{};  // its cell, from the middle
  };

  /// How much of what each of those that answer for it makes known is in its numbers.
  using Cell = std::array<Terms, samples_each>;

  class Builder;

  static Terms terms_of(const Seat& seat) {
    // Of mean square 1 in a cell.
    constexpr float scale = 1.7320508F / side;
    return {1.0F, scale * static_cast<float>(seat.within[0]), scale * static_cast<float>(seat.within[1]),
            scale * static_cast<float>(seat.within[2])};
  }

  std::size_t first_of_cell(const Seat& seat) const { return own_ + terms * (seat.seat & ~in_cell); }

  glm::vec3 shared_light_at(const Field& told, std::uint32_t grain, const glm::vec3& normal) const {
    const Terms terms = terms_of(seats_[grain]);
    const Coefficients* const of_cell = &told[first_of_cell(seats_[grain])];
    glm::vec3 sum(0.0F);
    for (std::size_t term = 0; term < terms.size(); ++term) sum += terms[term] * of_cell[term].first_at(normal);
    return sum;
  }

  std::size_t grains_;
  std::size_t own_;
  std::vector<Seat> seats_;
  std::vector<std::uint32_t> answering_;
  std::vector<Cell> cells_;
};

}  // namespace mesograin::heap
