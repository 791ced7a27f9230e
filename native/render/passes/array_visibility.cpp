// Chooses between drawing arrays and casting rays at them, and keeps what either needs until the view changes.
#include "render/passes/array_visibility.h"

#include <algorithm>

#include "base/error.h"
#include "gl/context_thread.h"

namespace mesograin::render {
namespace {

bool reads_light_maps(const Sample& sample) {
  const std::vector<InstanceGroup>& groups = sample.content.instances()->groups();
  for (std::size_t unit = 0; unit < groups.size(); ++unit)
    if (groups[unit].material->light_maps() && sample.asks_model(unit)) return true;
  return false;
}

}  // namespace

void ArrayVisibility::set(Visibility visibility) {
  if ((visibility == Visibility::cast || visibility == Visibility::device_rays) && !casting::available())
    throw Error("Rays cannot be cast on this machine: Embree needs AVX.");
  visibility_ = visibility;
  forget_view();
}

bool ArrayVisibility::casts(const Content& content) const {
  if (content.instances() == nullptr) return false;
  return visibility_ == Visibility::cast ||
         (visibility_ == Visibility::automatic && !gl::ContextThread::instance().device_info().hardware &&
          casting::available());
}

bool ArrayVisibility::casts_on_device(const Content& content) const {
  if (!DeviceRays::suit(content) || !casting::available()) return false;
  return visibility_ == Visibility::device_rays ||
         (visibility_ == Visibility::automatic && gl::ContextThread::instance().device_info().hardware);
}

bool ArrayVisibility::traces(const Content& content, bool hurried) const {
  return casts(content) || (content.instances() == nullptr && casting::available()) ||
         (casts_on_device(content) && !hurried);
}

Mirrors ArrayVisibility::mirrors(const Content& content, bool traced, bool world, bool behind,
                                 const std::function<bool(std::size_t unit)>& asks) const {
  if (behind && traced) return Mirrors::hindered;
  if (!content.facets(asks)) return Mirrors::none;
  if (!content.hinders_mirrors()) return world ? Mirrors::unhindered : Mirrors::none;
  return traced ? Mirrors::hindered : Mirrors::none;
}

void ArrayVisibility::prepare(const Sample& sample) {
  if ((sample.cast || sample.looks_into_facets() || sample.mirrors == Mirrors::hindered) && !tree_)
    tree_ = std::make_unique<CastContent>(sample.cache, sample.content);
  const Instances* instances = sample.content.instances();
  if (sample.device_rays) {
    if (!device_rays_) device_rays_ = std::make_unique<DeviceRays>(sample.cache, sample.content);
    device_rays_->meet_in_full(sample.sees_in_full());
  }
  if (instances == nullptr || selection_) return;
  // Light maps are as fine as the largest grain in the picture.
  if (!(sample.cast || sample.device_rays) || reads_light_maps(sample))
    selection_ = std::make_unique<DeviceSelection>(
        instances->select(anchor_to_clip(sample.content, sample.camera), sample.size.x, sample.size.y));
}

void ArrayVisibility::forget_content() {
  tree_.reset();
  device_rays_.reset();
  selection_.reset();
}

}  // namespace mesograin::render
