// Links are sent once for a solution; with each sum go what is sent, there, and what is answered, back.
#include "render/device_sums.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/error.h"
#include "gl/buffer.h"
#include "gl/context_thread.h"
#include "gl/program.h"
#include "render/device_layout.h"
#include "render/program_shelf.h"

namespace mesograin::render {
namespace {

// As shaders/passes/sum_links.comp has them.
constexpr std::size_t answering_a_group = 64;
constexpr std::size_t numbers_of_first = 3;
constexpr std::size_t numbers_of_second = 5;

// OpenGL 4.5 has room for at least so many.
constexpr std::size_t most_groups = 65'535;

// Fewer are summed in milliseconds by the processor's cores.
constexpr std::size_t fewest_of_automatic = 1'000'000;

static_assert(sizeof(heap::Link) == 16 && std::is_trivially_copyable_v<heap::Link>);

/// each(i) for i below `count`, many a piece.
template <typename Each>
void for_many(std::size_t count, const transport::Effort& effort, const Each& each) {
  constexpr std::size_t at_once = 4096;
  transport::run_pieces(effort, (count + at_once - 1) / at_once, [&](std::size_t piece) {
    for (std::size_t i = piece * at_once; i < std::min(count, (piece + 1) * at_once); ++i) each(i);
  });
}

void write_numbers(const heap::Coefficients& of, bool fine, glm::vec4* numbers) {
  std::copy(of.channels.begin(), of.channels.end(), numbers);
  if (!fine) return;
  const heap::SecondOrders::Numbers* const second = of.second.get();
  for (std::size_t i = 0; i < numbers_of_second; ++i)
    numbers[numbers_of_first + i] =
        second == nullptr ? glm::vec4(0.0F) : glm::vec4((*second)[0][i], (*second)[1][i], (*second)[2][i], 0.0F);
}

void read_numbers(const glm::vec4* numbers, bool fine, heap::Coefficients& into) {
  std::copy_n(numbers, numbers_of_first, into.channels.begin());
  if (!fine) {
    into.second = {};
    return;
  }
  heap::SecondOrders::Numbers& second = into.second.made();
  for (std::size_t i = 0; i < numbers_of_second; ++i)
    for (std::size_t channel = 0; channel < second.size(); ++channel)
      second[channel][i] = numbers[numbers_of_first + i][static_cast<int>(channel)];
}

std::vector<std::uint32_t> first_links(const heap::Links& links) {
  std::vector<std::uint32_t> first = {0};
  first.reserve(links.of.size() + 1);
  for (const std::vector<heap::Link>& of : links.of)
    first.push_back(first.back() + static_cast<std::uint32_t>(of.size()));
  return first;
}

std::size_t nodes_of(const heap::Links& links) { return links.of.size() - links.seats->answering(); }

/// By number: where what tells it is, and of one that shares its place in the cell.
std::vector<glm::uvec2> senders_of(const heap::Links& links) {
  constexpr int middle = 128;
  const heap::Seats& seats = *links.seats;
  std::vector<glm::uvec2> senders(seats.grains() + nodes_of(links));
  for (std::uint32_t number = 0; number < senders.size(); ++number) {
    if (number >= seats.grains() || !seats.shares(number)) {
      senders[number] = {seats.seat(number), 0U};
      continue;
    }
    std::uint32_t place = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      place |= static_cast<std::uint32_t>(seats.place_in_cell(number)[axis] + middle) << (8 * axis);
    senders[number] = {static_cast<std::uint32_t>(seats.first_of_cell(number)), place};
  }
  return senders;
}

std::vector<glm::vec4> received_of(const heap::Change& change) {
  std::vector<glm::vec4> received;
  received.reserve(change.received.size());
  for (const glm::vec3& one : change.received) received.emplace_back(one, 0.0F);
  return received;
}

void require_no_error() {
  if (const GLenum error = glGetError(); error != GL_NO_ERROR) throw Error("GL error {:#x} in a sum.", error);
}

/// What the device holds of a solution. Lives on its context's thread.
class LinksOnDevice {
 public:
  LinksOnDevice(const heap::Links& links, const heap::Change* change, std::size_t numbers, const gl::Program& program,
                const transport::Effort& effort)
      : program_(program),
        groups_((links.of.size() + answering_a_group - 1) / answering_a_group),
        links_(room(links.count() * sizeof(heap::Link))),
        first_links_(stored(first_links(links))),
        sent_(room((nodes_of(links) + links.seats->told()) * numbers * sizeof(glm::vec4))),
        answers_(room(links.of.size() * numbers * sizeof(glm::vec4))) {
    if (groups_ > most_groups) throw Error("More grains send light to each other than the device can sum for.");
    if (links.seats->shared()) senders_ = stored(senders_of(links));
    if (change != nullptr) received_ = stored(received_of(*change));
    send(links, effort);
    require_no_error();
  }

  void sum(const std::vector<glm::vec4>& sent, std::vector<glm::vec4>& answers) {
    sent_.write(0, sent.data(), sent.size() * sizeof(glm::vec4));
    program_.use();
    links_.bind_storage(layout::LINKS_BINDING);
    first_links_.bind_storage(layout::FIRST_LINKS_BINDING);
    sent_.bind_storage(layout::SENT_BINDING);
    answers_.bind_storage(layout::ANSWERS_BINDING);
    if (senders_) senders_->bind_storage(layout::SENDERS_BINDING);
    if (received_) received_->bind_storage(layout::RECEIVED_BINDING);
    glDispatchCompute(static_cast<GLuint>(groups_), 1, 1);
    answers_.read(answers.data(), answers.size() * sizeof(glm::vec4));
    require_no_error();
  }

 private:
  /// So many bytes, if a shader can read that many.
  static std::size_t room(std::size_t bytes) {
    GLint64 most = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    if (bytes > static_cast<std::size_t>(most)) throw Error("The device's shaders read {} bytes at most.", most);
    return bytes;
  }

  template <typename Value>
  static gl::Buffer stored(const std::vector<Value>& values) {
    room(values.size() * sizeof(Value));
    return gl::Buffer(values);
  }

  /// Many at once, but not all, which would be as much memory again.
  void send(const heap::Links& links, const transport::Effort& effort) {
    constexpr std::size_t at_once = std::size_t{1} << 18U;
    std::vector<heap::Link> some;
    std::size_t sent = 0;
    const auto flush = [&] {
      if (effort.stop != nullptr && *effort.stop) throw transport::Stopped{};
      links_.write(sent * sizeof(heap::Link), some.data(), some.size() * sizeof(heap::Link));
      sent += some.size();
      some.clear();
    };
    for (const std::vector<heap::Link>& of : links.of) {
      some.insert(some.end(), of.begin(), of.end());
      if (some.size() >= at_once) flush();
    }
    flush();
  }

  const gl::Program& program_;
  std::size_t groups_;
  gl::Buffer links_;
  gl::Buffer first_links_;
  gl::Buffer sent_;
  gl::Buffer answers_;
  std::optional<gl::Buffer> senders_;
  std::optional<gl::Buffer> received_;
};

/// Of the context's thread: what goes with it, at the latest.
struct SumsOnDevice {
  ProgramShelf programs;
  std::map<const heap::Sums*, LinksOnDevice> of;
};

class DeviceSums final : public heap::Sums {
 public:
  DeviceSums(const heap::Links& links, const heap::Change* change, const transport::Effort& effort)
      : links_(links), change_(change), thread_(gl::ContextThread::beside()) {
    thread_->run([&] {
      auto& [programs, of] = thread_->companion<SumsOnDevice>();
      std::vector<std::string> defines;
      if (fine()) defines.emplace_back("FINE");
      if (links.seats->shared()) defines.emplace_back("SHARED");
      if (change != nullptr) defines.emplace_back("CHANGED");
      const gl::Program& program =
          programs.find(fmt::format("sum_links {}", fmt::join(defines, " ")),
                        {{GL_COMPUTE_SHADER, gl::ShaderSource({"passes/sum_links.comp"}, defines)}});
      of.try_emplace(this, links, change, numbers(), program, effort);
    });
  }
  DeviceSums(const DeviceSums&) = delete;
  DeviceSums& operator=(const DeviceSums&) = delete;

  ~DeviceSums() override {
    try {
      thread_->post([thread = thread_.get(), self = this] { thread->companion<SumsOnDevice>().of.erase(self); });
    } catch (const std::exception&) { /* it went with the context */
    }
  }

  void gather(const heap::Field& sent, heap::Field& answer, const transport::Effort& effort) override {
    const std::size_t each = numbers();
    sent_.resize(each * sent.size());
    for_many(sent.size(), effort, [&](std::size_t i) { write_numbers(sent[i], fine(), &sent_[each * i]); });
    const std::size_t count = links_.of.size();
    answers_.resize(each * count);
    thread_->run([&] { thread_->companion<SumsOnDevice>().of.at(this).sum(sent_, answers_); });
    answer.resize(count);
    for_many(count, effort, [&](std::size_t i) {
      read_numbers(&answers_[each * i], fine() && links_.fine[i], answer[i]);
      if (change_ != nullptr && !change_->answered.empty()) answer[i].scale(change_->answered[links_.seats->number(i)]);
    });
  }

 private:
  bool fine() const { return !links_.fine.empty(); }
  std::size_t numbers() const { return numbers_of_first + (fine() ? numbers_of_second : 0); }

  const heap::Links& links_;
  const heap::Change* change_;
  std::shared_ptr<gl::ContextThread> thread_;
  std::vector<glm::vec4> sent_;
  std::vector<glm::vec4> answers_;
};

}  // namespace

heap::MakeSums make_sums(Summing by) {
  const bool hardware = by == Summing::automatic && gl::ContextThread::instance().device_info().hardware;
  if (by != Summing::device && !hardware) return {};
  const std::size_t fewest = by == Summing::device ? 1 : fewest_of_automatic;
  return [fewest](const heap::Links& links, const heap::Change* change,
                  const transport::Effort& effort) -> std::unique_ptr<heap::Sums> {
    if (links.count() < fewest) return nullptr;
    return std::make_unique<DeviceSums>(links, change, effort);
  };
}

}  // namespace mesograin::render
