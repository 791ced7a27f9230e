// Numbers are written a piece at a time: of a million grains, all of them at once would be there twice.
#include "render/told_light.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "render/device_layout.h"

namespace mesograin::render {
namespace {

const glm::vec4 darkness(-1.0F, 0.0F, 0.0F, 0.0F);

class Writer {
 public:
  /// `first`: of the buffer's numbers.
  Writer(gl::Buffer& buffer, std::size_t first) : buffer_(buffer), written_(first) {}
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { write(); }

  void add(const glm::vec4& number) {
    constexpr std::size_t most_waiting = std::size_t{1} << 16U;
    waiting_.push_back(number);
    if (waiting_.size() == most_waiting) write();
  }

  void add(const heap::Coefficients& coefficients) {
    for (const glm::vec4& channel : coefficients.channels) add(channel);
  }

  /// Of the number that is added next.
  std::size_t place() const { return written_ + waiting_.size(); }

 private:
  void write() {
    buffer_.write(written_ * sizeof(glm::vec4), waiting_.data(), waiting_.size() * sizeof(glm::vec4));
    written_ += waiting_.size();
    waiting_.clear();
  }

  gl::Buffer& buffer_;
  std::size_t written_;
  std::vector<glm::vec4> waiting_;
};

/// What grains of each kind make of the light that comes.
struct Kinds {
  std::vector<glm::vec4> numbers;
  std::vector<std::size_t> first;  ///< of each kind

  void add(const heap::GrainTable& table, const heap::Optics& optics) {
    first.push_back(numbers.size());
    // What is not transparent lets nothing through.
    const std::vector<glm::vec2>& offsets = table.came_in().offsets();
    numbers.emplace_back(optics.transparent() ? glm::vec3(optics.sigma_t) : glm::vec3(1e30F),
                         offsets.empty() ? 0.0F : table.seen_place_scale());
    for (const heap::GrainTable::Leaving* leaving : {&table.leaving(), &table.entered()}) {
      const std::size_t begin = numbers.size();
      for (const glm::vec3& node : leaving->lobe) numbers.emplace_back(node, 0.0F);
      numbers[begin].w = leaving->by.x;
      numbers[begin + 1].w = leaving->by.y;
    }
    for (std::size_t pair = 0; pair < offsets.size(); pair += 2) numbers.emplace_back(offsets[pair], offsets[pair + 1]);
  }
};

/// Where a seat's numbers are.
struct Place {
  std::uint32_t first;
  std::uint32_t second_order;  ///< 0: there is none
};

class Telling {
 public:
  Telling(const heap::HeapLight& light, const heap::Grains& grains, const std::vector<RoleInHeap>& roles)
      : light_(light), seats_(*light.seats), grains_(grains), roles_(roles) {
    const std::vector<heap::Kind>& seen = heap::seen_kinds(light);
    for (std::size_t kind = 0; kind < seen.size(); ++kind)
      kinds_.add(*seen[kind].from_light, heap::seen_among_others(grains.kinds[kind]));
  }

  std::size_t bytes() const { return count() * sizeof(glm::vec4); }

  /// Returns where the walls' nodes are.
  std::size_t tell(gl::Buffer& numbers) {
    const std::size_t nodes_begin = tell_light(numbers);
    tell_objects(numbers);
    return nodes_begin;
  }

 private:
  std::size_t count() const {
    const std::size_t of_seat = 7 + (light_.entered.empty() ? 0 : 8);
    constexpr std::size_t of_term = 3;
    std::size_t of_second_order = 0;
    for (std::size_t seat = 0; seat < seats_.own(); ++seat)
      if (light_.answer[seat].second.get() != nullptr) of_second_order += light_.open[seat].second.size();
    return roles_.size() + kinds_.numbers.size() + of_seat * seats_.own() + of_second_order +
           of_term * (seats_.told() - seats_.own()) + light_.patches.nodes().size();
  }

  std::size_t tell_light(gl::Buffer& numbers) {
    Writer writer(numbers, roles_.size());
    for (const glm::vec4& number : kinds_.numbers) writer.add(number);
    places_.reserve(seats_.own());
    for (std::uint32_t seat = 0; seat < seats_.own(); ++seat) tell_seat(seat, writer);
    cells_begin_ = writer.place();
    for (std::size_t term = seats_.own(); term < seats_.told(); ++term) writer.add(light_.answer[term]);
    const std::size_t nodes_begin = writer.place();
    for (std::size_t node = 0; node < light_.patches.nodes().size(); ++node) {
      const auto& channels = light_.answer[seats_.told() + node].channels;
      writer.add({channels[0].w, channels[1].w, channels[2].w, 0.0F});
    }
    return nodes_begin;
  }

  void tell_seat(std::uint32_t seat, Writer& writer) {
    places_.push_back({static_cast<std::uint32_t>(writer.place()), 0});
    writer.add(light_.answer[seat]);
    writer.add(light_.behind[seat]);
    writer.add(light_.open[seat].first);
    if (!light_.entered.empty()) tell_entered(light_.entered[seat].whole(), writer);
    const heap::SecondOrders::Numbers* second = light_.answer[seat].second.get();
    if (second == nullptr) return;
    places_.back().second_order = static_cast<std::uint32_t>(writer.place());
    const heap::SecondOrder& open = light_.open[seat].second;
    for (std::size_t i = 0; i < open.size(); ++i)
      writer.add({(*second)[0][i], (*second)[1][i], (*second)[2][i], open[i]});
  }

  static void tell_entered(const heap::Coefficients& entered, Writer& writer) {
    writer.add(entered);
    const heap::SecondOrders::Numbers& of = *entered.second.get();
    for (std::size_t i = 0; i < of[0].size(); ++i) writer.add({of[0][i], of[1][i], of[2][i], 0.0F});
  }

  void tell_objects(gl::Buffer& numbers) const {
    Writer writer(numbers, 0);
    for (const RoleInHeap& role : roles_) {
      // A grain that has just come is dark for a moment.
      if (role.grain && *role.grain < grains_.grains.size())
        writer.add(grain(*role.grain));
      else if (role.wall && *role.wall < grains_.walls.size())
        writer.add({kind(grains_.walls[*role.wall].kind), *role.wall, 0.0F, 0.0F});
      else
        writer.add(darkness);
    }
  }

  float kind(std::uint32_t number) const { return static_cast<float>(roles_.size() + kinds_.first[number]); }

  glm::vec4 grain(std::uint32_t number) const {
    const heap::Grain& of = grains_.grains[number];
    if (!seats_.shares(number)) {
      const Place& place = places_[seats_.seat(number)];
      return {kind(of.kind), static_cast<float>(place.second_order), of.radius, static_cast<float>(place.first)};
    }
    std::uint32_t place = 0;
    for (int axis = 0; axis < 3; ++axis)
      place |= static_cast<std::uint32_t>(128 + seats_.place_in_cell(number)[static_cast<std::size_t>(axis)])
               << (8 * axis);
    const std::size_t cell = cells_begin_ + 3 * (seats_.first_of_cell(number) - seats_.own());
    return {kind(of.kind), static_cast<float>(place), of.radius, -static_cast<float>(cell)};
  }

  const heap::HeapLight& light_;
  const heap::Seats& seats_;
  const heap::Grains& grains_;
  const std::vector<RoleInHeap>& roles_;
  Kinds kinds_;
  std::vector<Place> places_;  // of seats of one grain
  std::size_t cells_begin_ = 0;
};

}  // namespace

void ToldLight::tell(const heap::HeapLight& light, const heap::Grains& grains, const std::vector<RoleInHeap>& roles) {
  Telling telling(light, grains, roles);
  // A device may keep one that is gone for as long as it could read it.
  if (!numbers_ || numbers_->bytes() != telling.bytes()) numbers_.emplace(telling.bytes());
  const std::size_t nodes_begin = telling.tell(*numbers_);
  tells_entered_ = !light.entered.empty();
  walls_.emplace(light.patches.packed(static_cast<std::uint32_t>(nodes_begin)));
}

void ToldLight::tell_darkness(std::size_t objects) {
  tells_entered_ = false;
  numbers_.emplace(objects * sizeof(glm::vec4));
  Writer writer(*numbers_, 0);
  for (std::size_t object = 0; object < objects; ++object) writer.add(darkness);
  walls_.emplace(heap::Patches().packed(0));
}

void ToldLight::bind() const {
  if (!numbers_ || !walls_) return;  // there was no memory for them, which was said
  numbers_->bind_storage(layout::HEAP_LIGHT_BINDING);
  walls_->bind_storage(layout::WALL_LIGHT_BINDING);
}

}  // namespace mesograin::render
