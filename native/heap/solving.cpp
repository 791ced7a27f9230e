// Who is told of a heap's light, and when it is given up.
#include "heap/solving.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace mesograin::heap {
namespace {

// A quick answer takes about a tenth of the time.
constexpr double quick_share = 0.1;

/// Whether one may be shown in the light of the other: grains are told by their numbers.
bool alike(const Heap& a, const Heap& b) {
  if (a.exchanges != b.exchanges || a.straight_elsewhere != b.straight_elsewhere) return false;
  return std::max(a.grains.grains.size(), b.grains.grains.size()) <=
         2 * std::min(a.grains.grains.size(), b.grains.grains.size());
}

}  // namespace

News Solving::news() const {
  const std::lock_guard lock(mutex_);
  return news_;
}

bool Solving::lit() const {
  const std::lock_guard lock(mutex_);
  return news_.heap == heap_;
}

bool Solving::wait(std::chrono::milliseconds patience) const {
  std::unique_lock lock(mutex_);
  return told_.wait_for(lock, patience, [this] { return news_.final; });
}

void Solving::tell(News news) {
  {
    const std::lock_guard lock(mutex_);
    std::swap(news_, news);
  }
  told_.notify_all();
}

Solvers& Solvers::instance() {
  static Solvers solvers;
  return solvers;
}

std::shared_ptr<const Solving> Solvers::ask(Heap heap, const std::shared_ptr<const Solving>& before,
                                            MakeSums make_sums) {
  const std::lock_guard lock(mutex_);
  std::erase_if(held_, [](const std::weak_ptr<Solving>& one) { return one.expired(); });
  for (const std::weak_ptr<Solving>& one : held_)
    if (std::shared_ptr<Solving> same = one.lock(); same && same->heap() == heap) return same;
  const std::shared_ptr<Line> line = before ? before->line_ : std::make_shared<Line>();
  News known;
  if (before && alike(before->heap(), heap)) known = before->news();
  known.final = false;
  known.failure.clear();
  auto solving = std::make_shared<Solving>(std::make_shared<const Heap>(std::move(heap)), line, std::move(known),
                                           std::move(make_sums));
  line->latest = solving;
  held_.push_back(solving);
  waiting_.add(solving);
  return solving;
}

Neighbourhood Solvers::neighbourhood_of(const Grains& grains) {
  std::vector<std::shared_ptr<const Solving>> all;
  {
    const std::lock_guard lock(mutex_);
    for (const std::weak_ptr<Solving>& one : held_)
      if (std::shared_ptr<const Solving> solving = one.lock()) all.push_back(std::move(solving));
  }
  for (const std::shared_ptr<const Solving>& one : all) {
    const News known = one->news();
    if (known.light && known.light->neighbourhood && same_places(known.heap->grains, grains))
      return *known.light->neighbourhood;
  }
  return Neighbourhood(grains);
}

bool Solvers::has_heir(const Line& line, const Heap& heap) {
  const std::lock_guard lock(mutex_);
  const std::shared_ptr<Solving> latest = line.latest.lock();
  return latest && alike(latest->heap(), heap);
}

void Solvers::tell(const std::weak_ptr<Solving>& of, const Line& line, News news) {
  const std::shared_ptr<Solving> solving = of.lock();
  std::shared_ptr<Solving> latest;
  // While it is being told nothing takes its place.
  const std::lock_guard lock(mutex_);
  latest = line.latest.lock();
  if (latest && latest != solving && !latest->lit() && alike(latest->heap(), *news.heap)) {
    News outdated = news;
    outdated.final = false;
    latest->tell(std::move(outdated));
  }
  if (solving) solving->tell(std::move(news));
}

void Solvers::work(const std::weak_ptr<Solving>& of, const std::stop_token& stop) {
  std::atomic<bool> given_up{false};
  std::shared_ptr<const Heap> heap;
  std::shared_ptr<Line> line;
  MakeSums make_sums;
  if (const std::shared_ptr<Solving> solving = of.lock()) {
    heap = solving->heap_;
    line = solving->line_;
    make_sums = solving->make_sums_;
  } else {
    return;
  }
  const auto solve = [&](const Quality& quality, const transport::Effort& part, bool final) {
    auto light = std::make_shared<const HeapLight>(line->solver.solve(heap, quality, part, make_sums));
    tell(of, *line, {++told_, std::move(light), heap, final});
  };
  bool coarse = true;  // what is found now
  transport::Effort effort;
  effort.stop = &given_up;
  effort.progress = [&](double share) {
    const std::shared_ptr<Solving> solving = of.lock();
    if (solving) solving->progress_ = share;
    const bool wanted = solving || (coarse && has_heir(*line, *heap));
    if (!wanted || stop.stop_requested()) given_up = true;
  };
  try {
    if (!heap->exchanges) {
      auto light = std::make_shared<HeapLight>(light_alone(*heap, effort));
      light->neighbourhood = neighbourhood_of(heap->grains);
      tell(of, *line, {++told_, std::move(light), heap, true});
      return;
    }
    solve(coarse_for(heap->grains.grains.size()), transport::part_of(effort, 0.0, quick_share), false);
    if (of.expired()) return;
    coarse = false;
    solve(quality_for(heap->grains.grains.size()), transport::part_of(effort, quick_share, 1.0), true);
  } catch (const transport::Stopped&) {
    return;
  } catch (const std::exception& failure) {
    if (const std::shared_ptr<Solving> solving = of.lock()) solving->tell({.final = true, .failure = failure.what()});
  }
}

}  // namespace mesograin::heap
