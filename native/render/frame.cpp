// The order of a sample's passes, and what of the last one still holds for the next.
#include "render/frame.h"

#include <utility>

#include "base/error.h"
#include "render/passes/told_units.h"
#include "render/passes/uv_count.h"
#include "render/sequence.h"
#include "render/stencil.h"

namespace mesograin::render {
namespace {

// How many directions of the world light one sample.
constexpr int world_directions = 4;

// How long shading may go on without a question whether it should, in milliseconds.
constexpr double longest_strip = 40.0;

// Sets the lens' sequence apart from others of the same seed.
constexpr std::uint32_t lens_seed = 0x30000U;

}  // namespace

Frame::Frame(DeviceCache& cache, int width, int height, std::uint32_t seed, bool patient)
    : cache_(cache),
      size_(width, height),
      seed_(seed),
      patient_(patient),
      targets_(std::make_unique<Targets>(width, height, false)) {
  shade_.set_taps(default_taps);
}

void Frame::resize(int width, int height) {
  if (glm::ivec2(width, height) == size_) return;
  targets_ = std::make_unique<Targets>(width, height, content_->textured());
  size_ = {width, height};
  for (auto& [portion, told] : portions_) told.sum = std::make_unique<Sum>(width, height);
  forget_view();
}

void Frame::set_scene(scene::Scene scene) {
  content_ = std::make_unique<Content>(cache_, scene, std::move(*content_));
  lighting_.set(scene);
  stored_lights_.set(*content_, lighting_);
  exchange_.set(cache_, *content_, scene);
  scene_ = std::move(scene);
  unwrapping_.reset();
  forget_content();
  cache_.prune();
}

void Frame::set_camera(const scene::Camera& camera) {
  camera_ = camera;
  forget_view();
}

void Frame::set_moment(const scene::Camera& camera, const scene::Scene* scene) {
  if (unwrapping_) throw Error("A bake has no moments: set a scene first.");
  if (scene != nullptr) {
    content_->place(*scene);
    arrays_.forget_content();
    shadows_.forget_content();
  }
  camera_ = camera;
  forget_what_is_seen();
}

void Frame::set_bake(const Bake& bake) {
  if (bake.instances.empty()) throw Error("A bake needs at least one instance; got none.");
  for (const std::size_t instance : bake.instances) {
    if (instance >= scene_.instances.size())
      throw Error("A bake's instances must be among the scene's {}, counted from 0; got {}.", scene_.instances.size(),
                  instance);
    if (scene_.instances[instance].mesh->uvs().empty())
      throw Error("Baking needs UVs, and the mesh of instance {} has none: unwrap it first.", instance);
  }
  content_ = std::make_unique<Content>(cache_, scene_, std::move(*content_), bake.instances);
  stored_lights_.set(*content_, lighting_);
  exchange_.set(cache_, *content_, scene_);
  unwrapping_ = Unwrapping{{}, bake.view_from};
  for (const std::size_t instance : bake.instances) unwrapping_->draws.push_back(content_->draw_of(instance));
  forget_content();
}

UvUse Frame::uv_use() {
  if (!unwrapping_) throw Error("The use of UVs is known of a bake only: call set_bake first.");
  return count_uv_use(begin_sample([] { return true; }, false));
}

void Frame::set_taps(int taps) {
  shade_.set_taps(taps);
  samples_ = 0;
}

void Frame::set_visibility(Visibility visibility) {
  arrays_.set(visibility);
  forget_view();
}

void Frame::set_levels(bool by_size) {
  levels_ = by_size;
  samples_ = 0;
}

std::vector<std::shared_ptr<const transport::Computation>> Frame::computations() const {
  std::vector<std::shared_ptr<const transport::Computation>> all = content_->computations(cache_);
  for (auto& computation : stored_lights_.computations()) all.push_back(std::move(computation));
  return all;
}

bool Frame::take_news() {
  cache_.take_news();
  const bool by_lights = stored_lights_.take_news();
  const bool lit = exchange_.take_news() || by_lights;
  if (content_->version() == version_ && !lit) return false;
  version_ = content_->version();
  content_->take_news();
  more_known_ = more_known_ || samples_ > 0;
  samples_ = 0;
  return true;
}

void Frame::forget_what_is_seen() {
  arrays_.forget_view();
  shadows_.forget_view();
}

void Frame::forget_view() {
  forget_what_is_seen();
  more_known_ = false;
  samples_ = 0;
}

void Frame::forget_content() {
  version_ = content_->version();
  if (targets_->coordinates.has_value() != content_->textured())
    targets_ = std::make_unique<Targets>(size_.x, size_.y, content_->textured());
  arrays_.forget_content();
  shadows_.forget_content();
  more_known_ = false;
  samples_ = 0;
}

scene::Camera Frame::pinhole() const { return {camera_.world_to_camera, camera_.camera_to_clip, {}}; }

scene::Camera Frame::seen_through(std::uint32_t index) const {
  return camera_.lens ? camera_.through(camera_.lens->place(scrambled_point(index, seed_ + lens_seed))) : camera_;
}

Sample Frame::begin_sample(const GoOn& go_on, bool hurried) {
  cache_.begin_sample();
  const auto index = static_cast<std::uint32_t>(added_to());
  const bool cast = arrays_.casts(*content_);
  const bool traced = arrays_.traces(*content_, hurried);
  const bool gathers = !unwrapping_ && exchange_.gather() != nullptr && (exchange_.gathers_all() || traced);
  Sample sample{.cache = cache_,
                .content = *content_,
                .lighting = lighting_,
                .stored_lights = stored_lights_,
                .exchange = exchange_,
                .targets = *targets_,
                .camera = unwrapping_ ? pinhole() : seen_through(index),
                .unwrapping = unwrapping_ ? &*unwrapping_ : nullptr,
                .size = size_,
                .index = index,
                .seed = seed_,
                // Uniform over the pixel: the box filter, one pixel wide.
                .jitter = glm::vec2((2.0 * r2_point(index, seeded_offset(seed_)) - 1.0) / glm::dvec2(size_)),
                .lights = lighting_.sample(index, seed_, world_directions),
                .cast = cast,
                .device_rays = arrays_.casts_on_device(*content_),
                .traced = traced,
                .gathers = gathers,
                .denoises = scene_.denoise,
                .levels = levels_ && traced && gathers && exchange_.any() && !exchange_.gathers_all(),
                .awaited = patient_ || index != 0 ? Awaited::no
                           : more_known_          ? Awaited::more_known
                                                  : Awaited::changed,
                .learns = !patient_ && cast && gathers && exchange_.follows() && !exchange_.follows_paths() &&
                          exchange_.gather()->tells_any_inner_light(),
                .pixels_at_once = pixels_at_once_,
                .go_on = go_on};
  sample.near_lamps = near_lamps(sample);
  if (unwrapping_) return sample;
  if (levels_ && (cast || sample.device_rays)) sample.told = told_units(sample);
  // Of what light goes between it is known otherwise what is seen behind.
  const bool behind = !exchange_.tells_straight() && content_->any_shows_behind();
  sample.straight_through = (behind || exchange_.any_panes()) && traced;
  sample.mirrors = arrays_.mirrors(*content_, traced, lighting_.world().shines(), behind,
                                   [&](std::size_t unit) { return sample.tells(unit) || sample.asks_model(unit); });
  if (sample.mirrors == Mirrors::hindered && !targets_->mirror)
    targets_->mirror.emplace(targets_->sample, targets_->depth);
  return sample;
}

bool Frame::add_sample(const GoOn& go_on, bool hurried) {
  if (looks_through_lens()) forget_what_is_seen();
  hurried = hurried && samples_ == 0 && arrays_.casts_on_device(*content_);
  const Sample sample = begin_sample(go_on, hurried);
  arrays_.prepare(sample);
  content_->complete(cache_,
                     [&](std::size_t unit) { return sample.asks_model(unit) ? &sample.material(unit) : nullptr; });
  timers_.light_maps.start();
  if (!light_maps_.run(sample, arrays_)) return false;
  timers_.light_maps.stop();
  timers_.shade.start();
  if (!(unwrapping_ ? draw_unwrapped(sample) : draw_seen(sample))) return false;
  timers_.shade.stop();
  if (!mirror_.run(sample, arrays_, surfaces_, shadows_, shade_)) return false;
  subpixels_.smooth(sample);
  timers_.accumulate.start();
  accumulate_.run(*targets_, targets_->sum, added_to() == 0);
  timers_.accumulate.stop();
  if (!add_portions(sample)) return false;
  timed_ = true;
  pixels_at_once_ = longest_strip / timers_.shade.milliseconds() * static_cast<double>(size_.x) * size_.y;
  samples_ = added_to() + 1;
  hurried_ = hurried;
  return true;
}

bool Frame::draw_seen(const Sample& sample) {
  for (std::size_t first = 0; first < content_->units() || first == 0; first += most_in_stencil) {
    if (first == 0) timers_.surfaces.start();
    if (!surfaces_.run(sample, arrays_, first)) return false;
    if (first == 0) {
      timers_.surfaces.stop();
      if (!update_shadows(sample) || !gather_.run(sample, arrays_, surfaces_) ||
          !subpixels_.look(sample, arrays_, surfaces_))
        return false;
      // Rays are not the device's work.
      if (sample.cast) timers_.shade.start();
      told_grains_ = told_grains(sample, surfaces_);
      shade_.clear(sample);
    }
    if (!shade_.shade_seen(sample, shadows_, gather_, first)) return false;
  }
  return true;
}

bool Frame::add_portions(Sample sample) {
  if (unwrapping_) return true;
  const std::size_t units = content_->units();
  for (auto& [portion, told] : portions_) {
    if (added_to() == 0) told.samples = 0;
    sample.portion = portion;
    shade_.clear(sample);
    for (std::size_t first = 0; first < units || first == 0; first += most_in_stencil) {
      // The last of them is what the surfaces show already, unless what is mirrored took their place.
      if ((units > most_in_stencil || mirror_.ran()) && !surfaces_.run(sample, arrays_, first)) return false;
      if (!shade_.shade_seen(sample, shadows_, gather_, first)) return false;
    }
    const bool looks_on = portion == Portion::specular || portion == Portion::transmission;
    if (looks_on && !mirror_.run(sample, arrays_, surfaces_, shadows_, shade_)) return false;
    subpixels_.smooth(sample);
    accumulate_.run(*targets_, *told.sum, told.samples == 0);
    ++told.samples;
  }
  return true;
}

void Frame::set_portions(const std::vector<Portion>& portions) {
  portions_.clear();
  for (const Portion portion : portions) portions_[portion].sum = std::make_unique<Sum>(size_.x, size_.y);
  samples_ = 0;
}

void Frame::read_portion(Portion portion, float* pixels) {
  const auto found = portions_.find(portion);
  if (found == portions_.end())
    throw Error("The portion '{}' is not told: ask for it with set_portions before the samples.",
                portion_names[static_cast<std::size_t>(portion)]);
  const int samples = samples_ == 0 ? 0 : found->second.samples;
  if (samples == 0)
    std::fill_n(pixels, static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) * 4, 0.0F);
  else
    accumulate_.read(*targets_, *found->second.sum, samples, pixels);
}

bool Frame::draw_unwrapped(const Sample& sample) {
  if (!update_shadows(sample)) return false;
  shade_.clear(sample);
  shade_.shade_unwrapped(sample, shadows_);
  return true;
}

bool Frame::update_shadows(const Sample& sample) {
  timers_.shadows.start();
  const bool whole = shadows_.run(sample, arrays_, surfaces_);
  timers_.shadows.stop();
  return whole;
}

void Frame::finish() const { glFinish(); }

void Frame::read(float* pixels) {
  if (samples_ == 0)
    std::fill_n(pixels, static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) * 4, 0.0F);
  else
    accumulate_.read(*targets_, targets_->sum, samples_, pixels);
}

void Frame::read_surfaces(float* positions, float* normals) {
  if (unwrapping_)
    throw Error("A bake has no view whose surfaces could be read: set a camera and a scene without bake.");
  const GoOn to_the_end = [] { return true; };
  Sample sample = begin_sample(to_the_end, true);
  sample.jitter = glm::vec2(0.0F);
  sample.camera = pinhole();
  if (looks_through_lens()) arrays_.forget_view();
  arrays_.prepare(sample);
  surfaces_.run(sample, arrays_, 0);
  render::read_surfaces(sample, positions, normals);
}

std::vector<PassTiming> Frame::timings() const {
  if (!timed_) return {};
  std::vector<PassTiming> passes;
  if (light_maps_.maps_drawn() > 0) passes.push_back({"light_maps", timers_.light_maps.milliseconds()});
  double shade = timers_.shade.milliseconds();
  if (arrays_.casts(*content_)) {
    passes.push_back({"surfaces", surfaces_.milliseconds()});
    if (shadows_.ran()) passes.push_back({"shadows", shadows_.milliseconds()});
  } else if (arrays_.casts_on_device(*content_)) {
    passes.push_back({"surfaces", timers_.surfaces.milliseconds()});
    if (shadows_.ran()) passes.push_back({"shadows", timers_.shadows.milliseconds()});
    for (const PassTiming& before : passes)
      if (before.pass != "light_maps") shade -= before.milliseconds;
  } else if (shadows_.ran()) {
    // The shadows are drawn once it is known what is seen, and so amid the rest.
    const double shadows = timers_.shadows.milliseconds();
    passes.push_back({"shadow_maps", shadows});
    shade -= shadows;
  }
  if (mirror_.ran()) passes.push_back({"mirror", mirror_.milliseconds()});
  if (gather_.ran()) passes.push_back({"gather", gather_.milliseconds()});
  if (subpixels_.ran()) passes.push_back({"subpixels", subpixels_.milliseconds()});
  passes.push_back({"shade", shade});
  passes.push_back({"accumulate", timers_.accumulate.milliseconds()});
  return passes;
}

Statistics Frame::statistics() const {
  Statistics result;
  if (exchange_.any()) {
    result.exchange = exchange_.statistics();
    result.exchange->gathered = samples_ > 0 && gather_.ran();
    if (result.exchange->gathered) result.exchange->levels = gather_.levels();
    if (samples_ > 0) result.exchange->levels.surfaces = told_grains_;
  }
  if (content_->instances() == nullptr) return result;
  result.instances = content_->instances()->count();
  if (samples_ == 0 || unwrapping_) return result;
  if (arrays_.casts(*content_)) {
    result.cast = result.instances;
    result.seen = surfaces_.instances_seen();
  } else if (arrays_.casts_on_device(*content_)) {
    result.cast = result.instances;
  } else {
    result.drawn = arrays_.selection()->selection.instances.size();
  }
  return result;
}

}  // namespace mesograin::render
