// Names of a bake's choices.
#include "render/bake.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "scene/error.h"

namespace mesograin::render {

ViewFrom parse_view_from(std::string_view name) {
  const auto found = std::find(view_from_names.begin(), view_from_names.end(), name);
  if (found == view_from_names.end())
    throw Error("view_from must be one of {}; got '{}'.", fmt::join(view_from_names, ", "), name);
  return static_cast<ViewFrom>(found - view_from_names.begin());
}

}  // namespace mesograin::render
