// Books that remember when they were last taken off the shelf.
#include "render/program_shelf.h"

#include <algorithm>

namespace mesograin::render {

const gl::Program& ProgramShelf::find(const std::string& name, const std::vector<gl::Stage>& stages) {
  auto found = books_.find(name);
  if (found == books_.end()) {
    found = books_.emplace(name, Book{gl::Program(name, stages), sample_}).first;
    ++compiled_;
  }
  found->second.used = sample_;
  return found->second.program;
}

void ProgramShelf::begin_sample() {
  ++sample_;
  while (books_.size() > limit_) {
    const auto oldest = std::min_element(books_.begin(), books_.end(), [](const auto& first, const auto& second) {
      return first.second.used < second.second.used;
    });
    if (oldest->second.used + in_use > sample_) return;
    books_.erase(oldest);
  }
}

}  // namespace mesograin::render
