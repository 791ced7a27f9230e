// One task of the view after the other, each as long as its budget's rounds have it.
#include "tool/drawing.h"

#include <fmt/format.h>

#include <chrono>
#include <future>
#include <thread>
#include <vector>

#include "image/rounds.h"

namespace mesograin::tool {
namespace {

constexpr auto patience = std::chrono::milliseconds(50);

/// A task of some samples, with what is shown meanwhile.
class Drawing {
 public:
  Drawing(render::View& view, Progress& progress, bool quiet) : view_(view), progress_(progress), quiet_(quiet) {}

  void draw(int samples, std::optional<int> target) {
    const std::shared_future<double> done = view_.start(samples);
    while (done.wait_for(patience) != std::future_status::ready) show(target);
    done.get();
  }

  void show(std::optional<int> target) {
    if (!quiet_) progress_.show(view_.samples(), target, view_.preparing());
  }

 private:
  render::View& view_;
  Progress& progress_;
  bool quiet_;
};

std::string draw_to_error(render::View& view, Drawing& drawing, double error) {
  image::UntilError until(error);
  std::vector<float> pixels(static_cast<std::size_t>(view.width()) * static_cast<std::size_t>(view.height()) * 4);
  for (int count = image::UntilError::first; count > 0;) {
    drawing.draw(count, until.target());
    view.read(pixels.data());
    count = until.next({pixels.data(), view.width(), view.height(), 4}, view.samples());
  }
  return fmt::format("noise {:.2g} %", 100.0 * until.noise().value_or(0.0));
}

void draw_for_time(render::View& view, Drawing& drawing, const Progress& progress, double seconds) {
  image::UntilTime until(seconds);
  while (view.preparing() && until.waits_for_light(progress.seconds())) {
    drawing.show(std::nullopt);
    std::this_thread::sleep_for(patience);
    view.take_news();
  }
  view.take_news();
  while (const int count = until.next(view.samples(), progress.seconds()))
    for (int i = 0; i < count && (view.samples() == 0 || !until.is_over(progress.seconds())); ++i)
      drawing.draw(1, std::nullopt);
}

}  // namespace

std::string draw(render::View& view, const Budget& budget, Progress& progress, bool quiet) {
  Drawing drawing(view, progress, quiet);
  if (budget.error) return draw_to_error(view, drawing, *budget.error);
  if (budget.seconds)
    draw_for_time(view, drawing, progress, *budget.seconds);
  else
    drawing.draw(budget.samples, budget.samples);
  return {};
}

}  // namespace mesograin::tool
