// A ray a pixel, along the direction that its program drew; what it meets is another surface that is shaded, once more,
// and may show what stands behind itself.
#include "render/passes/mirror_pass.h"

#include <chrono>

#include "render/stencil.h"

namespace mesograin::render {
namespace {

// Of thin grains that stand one behind the other the last of so many shows the world.
constexpr std::size_t most_in_line = 8;

}  // namespace

MirrorPass::MirrorPass()
    : program_("mirror", gl::ShaderSource({"passes/full_screen.vert"}, {}),
               gl::ShaderSource({"passes/mirror.frag"}, {})) {}

bool MirrorPass::run(const Sample& sample, const ArrayVisibility& arrays, SurfacePass& surfaces, ShadowPass& shadows,
                     ShadePass& shade) {
  ran_ = sample.mirrors == Mirrors::hindered;
  if (!ran_) return true;
  const auto start = std::chrono::steady_clock::now();
  const SeenSurfaces first = surfaces.seen(sample);
  const MirrorTargets* through = &*sample.targets.mirror;
  const FoundSurfaces* before = nullptr;
  for (std::size_t layer = 0; layer < most_in_line; ++layer) {
    std::vector<glm::vec4>& looks = looks_[layer % 2];
    looks.resize(static_cast<std::size_t>(sample.size.x) * static_cast<std::size_t>(sample.size.y));
    through->shade.read(&looks.front().x, 2);
    const SeenSurfaces seen = before == nullptr ? first
                                                : SeenSurfaces{before->positions(), before->normals(), sample.size,
                                                               glm::vec4(0.0F), &looks_[(layer + 1) % 2]};
    if (!cast_.cast(arrays.tree(), sample.content, sample.exchange, sample.lighting, seen, looks, layer, sample.go_on))
      return false;
    before = &cast_.found();
    const std::vector<PixelBox> boxes = before->boxes(sample.size, sample.content.units());
    const MirrorTargets* onwards = nullptr;
    if (layer + 1 < most_in_line && any_goes_on(sample, boxes)) onwards = &targets_behind(sample.targets, *through);
    if (!add(sample, arrays, {*through, onwards}, boxes, looks, shadows, shade)) return false;
    if (onwards == nullptr) break;
    through = onwards;
  }
  glFinish();
  milliseconds_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return true;
}

bool MirrorPass::any_goes_on(const Sample& sample, const std::vector<PixelBox>& boxes) {
  if (sample.exchange.tells_straight()) return false;
  for (std::size_t unit = 0; unit < boxes.size(); ++unit)
    if (boxes[unit].first != boxes[unit].end && sample.content.shows_behind(unit)) return true;
  return false;
}

const MirrorTargets& MirrorPass::targets_behind(Targets& targets, const MirrorTargets& through) {
  if (!targets.behind) targets.behind.emplace(targets.sample, targets.depth);
  const MirrorTargets& other = &through == &*targets.mirror ? *targets.behind : *targets.mirror;
  other.clear();
  return other;
}

bool MirrorPass::add(const Sample& sample, const ArrayVisibility& arrays, const MirroredBy& by,
                     const std::vector<PixelBox>& boxes, const std::vector<glm::vec4>& looks, ShadowPass& shadows,
                     ShadePass& shade) {
  FoundSurfaces& found = cast_.found();
  found.upload(sample.targets, 0);
  const scene::World& around = sample.lighting.world();
  if (around.shines() || around.backdrop || around.film_transparent) add_world(sample, by.through);
  if (boxes.empty()) return true;
  const SeenSurfaces seen{found.positions(), found.normals(), sample.size, glm::vec4(0.0F), &looks};
  if (!shadows.run_mirrored(sample, arrays, seen)) return false;
  for (std::size_t first = 0; first < boxes.size(); first += most_in_stencil) {
    if (first > 0) found.upload(sample.targets, first);
    if (!shade.shade_mirrored(sample, shadows, by, boxes, first)) return false;
  }
  return true;
}

void MirrorPass::add_world(const Sample& sample, const MirrorTargets& through) {
  sample.targets.shade.bind();
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  program_.use();
  program_.set("mirrored_radiance", through.radiance);
  program_.set("surface_normal", sample.targets.normal);
  full_screen_.draw();
}

}  // namespace mesograin::render
