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

void fill(Picture& picture, Frame& from) {
  picture.width = from.width();
  picture.height = from.height();
  picture.pixels.resize(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height) * 4);
  from.read(picture.pixels.data());
  picture.timings = from.timings();
  picture.statistics = from.statistics();
}

template <typename Result>
bool is_over(const std::shared_future<Result>& future) {
  return !future.valid() || future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

void View::wait_for_scene() const {
  if (taking_.valid()) taking_.wait();
  if (news_.valid()) news_.wait();
}

void View::wait_for_changes() const {
  wait_for_scene();
  if (changing_.valid()) changing_.wait();
  if (under_way_.valid()) under_way_.wait();
}

template <typename Work>
auto View::post(Work&& work) {
  return gl::ContextThread::instance().post([made = made_, work = std::forward<Work>(work)]() mutable {
    made.get();
    return work();
  });
}

template <typename Work>
auto View::ask(Work&& work) {
  return post(std::forward<Work>(work)).get();
}

// After the samples that were asked for before.
template <typename Change>
auto View::change(Change&& work) {
  wait_for_changes();
  return ask(std::forward<Change>(work));
}

View::View(int width, int height, std::uint32_t seed, bool patient)
    : id_(next_id()), patient_(patient), shared_(std::make_shared<Shared>()) {
  shared_->width = width;
  shared_->height = height;
  made_ = gl::ContextThread::instance()
              .post([=, id = id_] {
                Device& here = device();
                here.frames.try_emplace(id, here.cache, width, height, seed, patient);
              })
              .share();
}

View::~View() {
  cancel();
  if (!gl::ContextThread::running()) return;
  gl::ContextThread::instance().post([id = id_] {
    device().frames.erase(id);
    device().cache.prune();
  });
}

void View::resize(int width, int height) {
  change([&] {
    frame(id_).resize(width, height);
    if (width == shared_->width && height == shared_->height) return;
    shared_->width = width;
    shared_->height = height;
    shared_->samples = 0;
  });
}

void View::set_scene(scene::Scene scene) { start_scene(std::move(scene)).get(); }

std::shared_future<void> View::start_scene(scene::Scene scene) {
  validate(scene);
  wait_for_changes();
  auto take = [id = id_, shared = shared_, scene = std::move(scene)]() mutable {
    frame(id).set_scene(std::move(scene));
    shared->computations = frame(id).computations();
    shared->solving = frame(id).solving();
    shared->samples = 0;
  };
  taking_ = post(std::move(take)).share();
  return taking_;
}

void View::set_camera(const scene::Camera& camera) {
  validate(camera);
  change([&] { frame(id_).set_camera(camera); });
  shared_->samples = 0;
}

std::shared_future<void> View::start_camera(const scene::Camera& camera, int width, int height) {
  validate(camera);
  wait_for_changes();
  auto take = [=, id = id_, shared = shared_] {
    frame(id).resize(width, height);
    frame(id).set_camera(camera);
    shared->width = width;
    shared->height = height;
    shared->samples = 0;
  };
  changing_ = post(std::move(take)).share();
  return changing_;
}

std::shared_future<void> View::start_moment(const scene::Camera& camera, std::optional<scene::Scene> scene) {
  validate(camera);
  if (scene) validate(*scene);
  wait_for_changes();
  auto take = [=, id = id_, scene = std::move(scene)] { frame(id).set_moment(camera, scene ? &*scene : nullptr); };
  changing_ = post(std::move(take)).share();
  return changing_;
}

std::shared_future<void> View::start_portions(std::vector<Portion> portions) {
  wait_for_changes();
  auto take = [id = id_, shared = shared_, portions = std::move(portions)] {
    frame(id).set_portions(portions);
    shared->samples = 0;
  };
  changing_ = post(std::move(take)).share();
  return changing_;
}

void View::read_portion(Portion portion, float* pixels) {
  ask([&] { frame(id_).read_portion(portion, pixels); });
}

void View::set_bake(const Bake& bake) {
  change([&] {
    frame(id_).set_bake(bake);
    shared_->computations = frame(id_).computations();
    shared_->solving = frame(id_).solving();
  });
  shared_->samples = 0;
}

UvUse View::uv_use() {
  return ask([&] { return frame(id_).uv_use(); });
}

void View::set_taps(int taps) {
  if (taps < 1 || taps > 65536) throw Error("taps must be in [1, 65536]; got {}.", taps);
  change([&] { frame(id_).set_taps(taps); });
  shared_->samples = 0;
}

bool View::take_news() { return start_news().get(); }

std::shared_future<bool> View::start_news() {
  wait_for_changes();
  auto take = [id = id_, shared = shared_] {
    const bool news = frame(id).take_news();
    if (news) shared->samples = 0;
    return news;
  };
  news_ = post(std::move(take)).share();
  return news_;
}

std::optional<double> View::preparing() const {
  wait_for_scene();
  double sum = 0.0;
  bool final = true;
  for (const auto& computation : shared_->computations) {
    const bool known = computation->news().final;
    sum += known ? 1.0 : computation->progress();
    final = final && known;
  }
  if (shared_->solving && !shared_->solving->news().final)
    return (sum + shared_->solving->progress()) / static_cast<double>(shared_->computations.size() + 1);
  if (final) return std::nullopt;
  return sum / static_cast<double>(shared_->computations.size());
}

std::vector<std::string> View::awaited() const {
  wait_for_scene();
  std::vector<std::string> kinds;
  if (!std::all_of(shared_->computations.begin(), shared_->computations.end(),
                   [](const auto& computation) { return computation->news().final; }))
    kinds.emplace_back("transport");
  if (shared_->solving && !shared_->solving->news().final) kinds.emplace_back("exchange");
  return kinds;
}

std::vector<std::string> View::warnings() const {
  wait_for_scene();
  std::vector<std::string> sentences;
  for (const auto& computation : shared_->computations) {
    const std::string unsuitable = computation->news().unsuitable;
    if (unsuitable.empty()) continue;
    const std::string sentence = unsuitable + " It is drawn by model_3.";
    if (std::find(sentences.begin(), sentences.end(), sentence) == sentences.end()) sentences.push_back(sentence);
  }
  const std::string failure = shared_->solving ? shared_->solving->news().failure : "";
  if (!failure.empty()) sentences.push_back(failure + " Light between grains is left out.");
  return sentences;
}

void View::set_levels(bool by_size) {
  change([&] { frame(id_).set_levels(by_size); });
}

void View::set_visibility(Visibility visibility) {
  change([&] { frame(id_).set_visibility(visibility); });
  shared_->samples = 0;
}

void View::set_summing(Summing by) {
  change([&] { frame(id_).set_summing(by); });
}

void View::render(int samples) { start(samples).get(); }

std::shared_future<double> View::start(int samples, std::shared_ptr<Picture> picture) {
  if (samples < 1) throw Error("A view needs at least one sample to render; got {}.", samples);
  wait_for_scene();
  const auto cancelled = [shared = shared_, number = ++started_] { return shared->cancelled >= number; };
  const auto go_on = [cancelled] { return !cancelled(); };
  std::function<std::optional<double>()> add_sample = [id = id_, made = made_, shared = shared_, go_on,
                                                       picture = std::move(picture), news = patient_,
                                                       patient = patient_, left = samples, seconds = 0.0]() mutable {
    if (!go_on()) return std::optional(seconds);
    const auto started = std::chrono::steady_clock::now();
    made.get();
    Frame& target = frame(id);
    if (std::exchange(news, false) && target.take_news()) shared->samples = 0;
    const bool whole = target.add_sample(go_on, !patient && left == 1);
    // Without this the driver would queue samples faster than it draws them, and cancelling would come too late.
    target.finish();
    if (whole) shared->samples = target.samples();
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    if (whole && --left > 0) return std::optional<double>();
    if (whole && picture) fill(*picture, target);
    return std::optional(seconds);
  };
  std::function<bool()> ready = [before = under_way_] { return is_over(before); };
  if (patient_ && preparing())
    ready = [ready, cancelled, computations = shared_->computations, solving = shared_->solving] {
      const auto known = [](const auto& each) { return each->wait(std::chrono::milliseconds(0)); };
      return ready() && (cancelled() || (std::all_of(computations.begin(), computations.end(), known) &&
                                         (!solving || known(solving))));
    };
  under_way_ = gl::ContextThread::instance().repeat(std::move(add_sample), cancelled, std::move(ready)).share();
  return under_way_;
}

void View::cancel() { shared_->cancelled = started_.load(); }

void View::read(float* pixels) {
  ask([&] { frame(id_).read(pixels); });
}

std::shared_future<void> View::start_read(std::shared_ptr<Picture> picture) {
  return post([id = id_, picture = std::move(picture)] { fill(*picture, frame(id)); }).share();
}

void View::read_surfaces(float* positions, float* normals) {
  change([&] { frame(id_).read_surfaces(positions, normals); });
}

std::vector<PassTiming> View::timings() {
  return ask([&] { return frame(id_).timings(); });
}

Statistics View::statistics() {
  return ask([&] { return frame(id_).statistics(); });
}

Sent View::sent() {
  return gl::ContextThread::instance().run([] { return device().cache.sent(); });
}

}  // namespace mesograin::render
