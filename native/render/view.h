// The renderer as other threads see it: an image of a scene, through a camera or unwrapped, that gets better with every
// sample.
#pragma once

#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gl/egl_context.h"
#include "render/frame.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace mesograin::render {

/// A picture as it was read, with what is told of the same samples.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<float> pixels;  ///< as View::read() fills them; none before it was read
  std::vector<PassTiming> timings;
  Statistics statistics;
};

/// May be used from any thread, by one at a time, except cancel() and samples(), which may be called at any time.
/// Every call posts to the context's thread, which draws started samples one by one: what reads this view, and all that
/// is asked of others, comes in between them, what changes this view after the last. What is called start_... only
/// posts, if nothing that was started before is under way, and so do the constructor and the destructor: the context's
/// thread may be held for a minute by a program that it compiles for somebody else. Throws Error for what cannot be
/// drawn, always before anything changes; what keeps a view from being made is thrown by the first call that waits.
class View {
 public:
  /// Light's transport in meshes and light between grains are computed for seconds, elsewhere. A patient view draws
  /// nothing before they are known; another draws what is known, and take_news() tells when it is more.
  View(int width, int height, std::uint32_t seed = 0, bool patient = true);
  ~View();
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  void resize(int width, int height);

  /// Restarts the accumulation. Meshes and materials already on the device are not sent again.
  void set_scene(scene::Scene scene);

  /// As set_scene(), without waiting; the future is ready when the view has it. Whatever else is asked of the view
  /// until then waits for that, but for cancel() and samples().
  std::shared_future<void> start_scene(scene::Scene scene);

  /// Restarts the accumulation and sends nothing.
  void set_camera(const scene::Camera& camera);

  /// As resize() and set_camera(), without waiting; as start_scene().
  std::shared_future<void> start_camera(const scene::Camera& camera, int width, int height);

  /// Another moment of the exposure: what set_scene() took elsewhere, if a scene is given, seen through this camera.
  /// Samples from now on are added to those before. Light between grains stays each grain's own as it was found for
  /// set_scene(). Throws Error for a scene of other things, and for a bake.
  /// Without waiting; as start_camera().
  std::shared_future<void> start_moment(const scene::Camera& camera, std::optional<scene::Scene> scene);

  /// Has these told beside the picture from now on, each by about the cost of its own shading. Restarts the
  /// accumulation. A bake has none. Without waiting; as start_camera().
  std::shared_future<void> start_portions(std::vector<Portion> portions);

  /// The mean of one of them, as read(). Throws Error if it is not told.
  void read_portion(Portion portion, float* pixels);

  /// Instead of what the camera sees, until the next set_scene(): the texture of some instances, unwrapped at their UVs
  /// with v upwards, the scene's other instances left out. Restarts the accumulation. Throws Error for instances that
  /// the scene does not have or that have no UVs.
  void set_bake(const Bake& bake);

  /// How the unwrapping being baked uses the texture. Throws Error if nothing is being baked.
  UvUse uv_use();

  /// How many light map samples model 3 takes for one pixel and sample, over all lights (default 16). Restarts the
  /// accumulation. Throws Error unless it is in [1, 65536].
  void set_taps(int taps);

  /// Takes in what has become known of the scene since; if anything has, restarts the accumulation. Returns whether it
  /// did.
  bool take_news();

  /// As take_news(), without waiting; whatever else is asked of the view until then waits for that, as for a scene.
  std::shared_future<bool> start_news();

  /// The share that is done of what the scene's picture waits for; nothing if all is known.
  std::optional<double> preparing() const;

  /// What that is: "transport" in meshes, "exchange" of light between grains; nothing if all is known.
  std::vector<std::string> awaited() const;

  /// One sentence for each thing that is not drawn by the model asked for.
  std::vector<std::string> warnings() const;

  /// How it is found what is seen of arrays. Restarts the accumulation. Throws Error where rays cannot be cast.
  void set_visibility(Visibility visibility);

  /// Who sums where light between grains is solved from now on: of scenes that are set.
  void set_summing(Summing by);

  /// Whether light is followed less closely into grains of arrays that are seen small, or into all as closely as it
  /// can be. Restarts the accumulation.
  void set_levels(bool by_size);

  /// Adds `samples` to the mean and returns when they are drawn.
  void render(int samples);

  /// As render(), without waiting; the future is ready when the samples are drawn or were cancelled, and holds the
  /// seconds that they took. A `picture` is read after the last of them, and is not if they were cancelled.
  std::shared_future<double> start(int samples, std::shared_ptr<Picture> picture = nullptr);

  /// Ends each start() and render() under way after its current sample; without one it does nothing.
  void cancel();

  /// Samples in the mean so far.
  int samples() const { return shared_->samples; }

  int width() const { return shared_->width; }
  int height() const { return shared_->height; }

  /// Fills (height, width, 4) floats: linear RGB premultiplied by coverage, and coverage; first row at the top, which
  /// in a bake is v = 1.
  void read(float* pixels);

  /// As read(), without waiting: the picture is read when the future is ready.
  std::shared_future<void> start_read(std::shared_ptr<Picture> picture);

  /// What rays through the pixels' middles meet, whatever the samples so far: (height, width, 4) floats, where in the
  /// world, and 1, or 0 where they meet nothing; and (height, width, 3), the normal on the side that is seen. First row
  /// at the top. Throws Error for a bake.
  void read_surfaces(float* positions, float* normals);

  /// Milliseconds of each pass of the last sample, in the order they ran; empty before the first.
  std::vector<PassTiming> timings();

  /// What of the arrays the last sample took the trouble of.
  Statistics statistics();

  /// What all views together have sent to the device so far.
  static Sent sent();

 private:
  /// What the context's thread writes; outlives the view where work that it began is under way.
  struct Shared {
    std::atomic<int> width;
    std::atomic<int> height;
    std::atomic<int> samples = 0;
    std::atomic<std::uint64_t> cancelled = 0;  ///< how many of those started are to end
    // The thread's until a scene that is being taken is.
    std::vector<std::shared_ptr<const transport::Computation>> computations;
    std::shared_ptr<const heap::Solving> solving;  ///< null where no light goes from grain to grain
  };

  std::uint64_t id_;
  bool patient_;
  std::shared_ptr<Shared> shared_;
  std::shared_future<void> made_;
  std::shared_future<void> taking_;       // a scene; not valid before the first
  std::shared_future<void> changing_;     // by a camera, a moment or portions; not valid before the first
  std::shared_future<bool> news_;         // being taken in; not valid before the first
  std::shared_future<double> under_way_;  // what was started last; not valid before
  std::atomic<std::uint64_t> started_ = 0;

  template <typename Work>
  auto post(Work&& work);
  template <typename Work>
  auto ask(Work&& work);
  template <typename Change>
  auto change(Change&& work);
  void wait_for_scene() const;
  void wait_for_changes() const;
};

}  // namespace mesograin::render
