// Samples of a picture until a budget is spent: so many, until noise is small enough, or for so long.
#pragma once

#include <optional>
#include <string>

#include "render/view.h"
#include "tool/progress.h"

namespace mesograin::tool {

struct Budget {
  int samples = 64;
  std::optional<double> error;    ///< instead: the share of its light that a pixel's noise may be
  std::optional<double> seconds;  ///< instead: from the start of `progress`
};

/// Draws them, and shows how far they are unless `quiet`. Returns what came of it beside samples and seconds, such as
/// "noise 2.1 %", or nothing. Throws Error as View does.
std::string draw(render::View& view, const Budget& budget, Progress& progress, bool quiet);

}  // namespace mesograin::tool
