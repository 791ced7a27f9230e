// Posts a view's calls to its frame on the context's thread.
#include "render/view.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <utility>

#include "base/error.h"
#include "gl/context_thread.h"

namespace mesograin::render {
namespace {

// All that lives on the device, so that it goes with the context whoever still holds a view.
struct Device {
  DeviceCache cache;
  std::map<std::uint64_t, Frame> frames;
};

Device& device() { return gl::ContextThread::instance().companion<Device>(); }

Frame& frame(std::uint64_t id) {
  std::map<std::uint64_t, Frame>& frames = device().frames;
  const auto found = frames.find(id);
  if (found == frames.end()) throw Error("This view ended when the renderer was shut down; make a new one.");
  return found->second;
}

std::uint64_t next_id() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

}  // namespace

void View::wait_for_scene() const {
  if (taking_.valid()) taking_.wait();
  if (news_.valid()) news_.wait();
}

// After the samples that were asked for before.
template <typename Change>
auto View::change(Change&& work) {
  wait_for_scene();
  if (under_way_.valid()) under_way_.wait();
  return gl::ContextThread::instance().run(std::forward<Change>(work));
}

View::View(int width, int height, std::uint32_t seed, bool patient)
    : id_(next_id()), width_(width), height_(height), patient_(patient) {
  gl::ContextThread::instance().run([&] {
    Device& here = device();
    here.frames.try_emplace(id_, here.cache, width, height, seed);
  });
}

View::~View() {
  cancel();
  if (!gl::ContextThread::running()) return;
  change([this] {
    device().frames.erase(id_);
    device().cache.prune();
  });
}

void View::resize(int width, int height) {
  change([&] { frame(id_).resize(width, height); });
  if (width != width_ || height != height_) *samples_ = 0;
  width_ = width;
  height_ = height;
}

void View::set_scene(scene::Scene scene) { start_scene(std::move(scene)).get(); }

std::shared_future<void> View::start_scene(scene::Scene scene) {
  validate(scene);
  wait_for_scene();
  if (under_way_.valid()) under_way_.wait();
  auto take = [this, scene = std::move(scene)]() mutable {
    frame(id_).set_scene(std::move(scene));
    computations_ = frame(id_).computations();
    solving_ = frame(id_).solving();
    *samples_ = 0;
  };
  taking_ = gl::ContextThread::instance().post(std::move(take)).share();
  return taking_;
}

void View::set_camera(const scene::Camera& camera) {
  validate(camera);
  change([&] { frame(id_).set_camera(camera); });
  *samples_ = 0;
}

void View::set_moment(const scene::Camera& camera, const scene::Scene* scene) {
  validate(camera);
  if (scene != nullptr) validate(*scene);
  change([&] { frame(id_).set_moment(camera, scene); });
}

void View::set_portions(const std::vector<Portion>& portions) {
  change([&] { frame(id_).set_portions(portions); });
  *samples_ = 0;
}

void View::read_portion(Portion portion, float* pixels) {
  gl::ContextThread::instance().run([&] { frame(id_).read_portion(portion, pixels); });
}

void View::set_bake(const Bake& bake) {
  change([&] {
    frame(id_).set_bake(bake);
    solving_ = frame(id_).solving();
  });
  *samples_ = 0;
}

UvUse View::uv_use() {
  return gl::ContextThread::instance().run([&] { return frame(id_).uv_use(); });
}

void View::set_taps(int taps) {
  if (taps < 1 || taps > 65536) throw Error("taps must be in [1, 65536]; got {}.", taps);
  change([&] { frame(id_).set_taps(taps); });
  *samples_ = 0;
}

bool View::take_news() { return start_news().get(); }

std::shared_future<bool> View::start_news() {
  wait_for_scene();
  if (under_way_.valid()) under_way_.wait();
  auto take = [this] {
    const bool news = frame(id_).take_news();
    if (news) *samples_ = 0;
    return news;
  };
  news_ = gl::ContextThread::instance().post(std::move(take)).share();
  return news_;
}

std::optional<double> View::preparing() const {
  wait_for_scene();
  double sum = 0.0;
  bool final = true;
  for (const auto& computation : computations_) {
    const bool known = computation->news().final;
    sum += known ? 1.0 : computation->progress();
    final = final && known;
  }
  if (solving_ && !solving_->news().final)
    return (sum + solving_->progress()) / static_cast<double>(computations_.size() + 1);
  if (final) return std::nullopt;
  return sum / static_cast<double>(computations_.size());
}

std::vector<std::string> View::awaited() const {
  wait_for_scene();
  std::vector<std::string> kinds;
  if (!std::all_of(computations_.begin(), computations_.end(),
                   [](const auto& computation) { return computation->news().final; }))
    kinds.emplace_back("transport");
  if (solving_ && !solving_->news().final) kinds.emplace_back("exchange");
  return kinds;
}

std::vector<std::string> View::warnings() const {
  wait_for_scene();
  std::vector<std::string> sentences;
  for (const auto& computation : computations_) {
    const std::string unsuitable = computation->news().unsuitable;
    if (unsuitable.empty()) continue;
    const std::string sentence = unsuitable + " It is drawn by model_3.";
    if (std::find(sentences.begin(), sentences.end(), sentence) == sentences.end()) sentences.push_back(sentence);
  }
  const std::string failure = solving_ ? solving_->news().failure : "";
  if (!failure.empty()) sentences.push_back(failure + " Light between grains is left out.");
  return sentences;
}

void View::set_visibility(Visibility visibility) {
  change([&] { frame(id_).set_visibility(visibility); });
  *samples_ = 0;
}

void View::render(int samples) { start(samples).get(); }

std::shared_future<double> View::start(int samples) {
  if (samples < 1) throw Error("A view needs at least one sample to render; got {}.", samples);
  wait_for_scene();
  const auto cancelled = [up_to = cancelled_, number = ++started_] { return *up_to >= number; };
  const auto go_on = [cancelled] { return !cancelled(); };
  std::function<std::optional<double>()> add_sample = [id = id_, done = samples_, go_on, news = patient_,
                                                       left = samples, seconds = 0.0]() mutable {
    if (!go_on()) return std::optional(seconds);
    const auto started = std::chrono::steady_clock::now();
    Frame& target = frame(id);
    if (std::exchange(news, false) && target.take_news()) *done = 0;
    const bool whole = target.add_sample(go_on);
    // Without this the driver would queue samples faster than it draws them, and cancelling would come too late.
    target.finish();
    if (whole) ++*done;
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    return whole && --left > 0 ? std::nullopt : std::optional(seconds);
  };
  const bool earlier = under_way_.valid() && under_way_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
  if (!earlier && (!patient_ || !preparing())) {
    under_way_ = gl::ContextThread::instance().repeat(std::move(add_sample), cancelled).share();
    return under_way_;
  }
  // The context's thread goes on drawing for others meanwhile.
  under_way_ = std::async(std::launch::async, [add_sample = std::move(add_sample), cancelled, before = under_way_,
                                               computations = computations_, solving = solving_]() mutable {
                 if (before.valid()) before.wait();
                 constexpr std::chrono::milliseconds patience(20);
                 const auto known = [&](const auto& computation) {
                   while (!computation->wait(patience))
                     if (cancelled()) return false;
                   return true;
                 };
                 if (!std::all_of(computations.begin(), computations.end(), known) || (solving && !known(solving)))
                   return 0.0;
                 return gl::ContextThread::instance().repeat(std::move(add_sample), cancelled).get();
               }).share();
  return under_way_;
}

void View::cancel() { *cancelled_ = started_.load(); }

void View::read(float* pixels) {
  gl::ContextThread::instance().run([&] { frame(id_).read(pixels); });
}

View::Told View::read_told(float* pixels) {
  return gl::ContextThread::instance().run([&] {
    Frame& target = frame(id_);
    target.read(pixels);
    return Told{target.timings(), target.statistics()};
  });
}

void View::read_surfaces(float* positions, float* normals) {
  change([&] { frame(id_).read_surfaces(positions, normals); });
}

std::vector<PassTiming> View::timings() {
  return gl::ContextThread::instance().run([&] { return frame(id_).timings(); });
}

Statistics View::statistics() {
  return gl::ContextThread::instance().run([&] { return frame(id_).statistics(); });
}

Sent View::sent() {
  return gl::ContextThread::instance().run([] { return device().cache.sent(); });
}

}  // namespace mesograin::render
