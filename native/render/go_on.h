// How a sample under way is ended.
#pragma once

#include <functional>

namespace mesograin::render {

/// Asked between parts of the work; false ends a sample unfinished.
using GoOn = std::function<bool()>;

}  // namespace mesograin::render
