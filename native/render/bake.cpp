// Names of a bake's choices, and what is said of its UVs.
#include "render/bake.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.h"

namespace mesograin::render {

ViewFrom parse_view_from(std::string_view name) {
  const auto found = std::find(view_from_names.begin(), view_from_names.end(), name);
  if (found == view_from_names.end())
    throw Error("view_from must be one of {}; got '{}'.", fmt::join(view_from_names, ", "), name);
  return static_cast<ViewFrom>(found - view_from_names.begin());
}

std::vector<std::string> warnings(const UvUse& use) {
  if (use.texels == 0)
    throw Error(
        "The UVs cover the middle of no texel: unwrap the mesh into the unit square, or bake a larger texture.");
  std::vector<std::string> sentences;
  if (use.overlapping > 0)
    sentences.push_back(
        fmt::format("UVs overlap in {} of {} texels, which show the first of the triangles there: unwrap the mesh "
                    "without overlaps.",
                    use.overlapping, use.texels));
  if (use.triangles_outside > 0)
    sentences.push_back(
        fmt::format("{} triangles reach out of the unit square of UVs and are cut off there: move their UVs into it.",
                    use.triangles_outside));
  return sentences;
}

}  // namespace mesograin::render
