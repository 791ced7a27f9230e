// A stack of orders and the thread that works them off.
#include "transport/works.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "base/error.h"
#include "transport/digest.h"
#include "transport/text_digest.h"

namespace mesograin::transport {
namespace {

// About a third of a second, a few per cent from the final answer.
constexpr Quality coarse{.nodes = 1500, .light_across = 20, .way_across = 8};

// Half a megabyte of the device's memory for each prototype.
Quality fine(const StoredMedium& medium) {
  Quality quality;
  if (!medium.grey()) quality.nodes = 9000;
  return quality;
}

// Drawing goes first where there are few cores.
constexpr int background_niceness = 5;

// Mean free paths between nodes beyond which the light just below the surface is not resolved.
constexpr double widest_spacing = 1.5;

std::string describe(const Order& order) {
  Digest shape;
  shape.add_numbers(order.mesh->positions());
  shape.add_numbers(order.mesh->triangles());
  std::string stretch;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) stretch += fmt::format(" {:.9g}", order.stretch[column][row]);
  const StoredMedium& medium = order.medium;
  const Quality quality = fine(medium);
  return fmt::format(
      "computed by: {}\nmesh: {} vertices, {} triangles, {}\nstretch:{}\nsigma_t: {} {} {}\nalbedo: {} {} {}\n"
      "eta: {}\nnodes: {}\nrays: {} {}\n",
      text_digest, order.mesh->positions().size(), order.mesh->triangles().size(), shape.name(), stretch,
      medium.sigma_t.r, medium.sigma_t.g, medium.sigma_t.b, medium.albedo.r, medium.albedo.g, medium.albedo.b,
      medium.eta, quality.nodes, quality.light_across, quality.way_across);
}

}  // namespace

News Computation::news() const {
  const std::lock_guard lock(mutex_);
  return news_;
}

bool Computation::wait(std::chrono::milliseconds patience) const {
  std::unique_lock lock(mutex_);
  return told_.wait_for(lock, patience, [this] { return news_.final; });
}

void Computation::tell(std::shared_ptr<const StoredTransport> stored, std::string unsuitable, bool final) {
  {
    const std::lock_guard lock(mutex_);
    news_ = {news_.number + 1, std::move(stored), std::move(unsuitable), final};
  }
  told_.notify_all();
}

Works& Works::instance() {
  static Works works;
  return works;
}

Works::~Works() {
  thread_.request_stop();
  wake_.notify_all();
}

std::shared_ptr<const Computation> Works::ask(Order order) {
  auto computation = std::make_shared<Computation>();
  Job job{std::move(order), {}, {}, computation};
  job.about = describe(job.order);
  Digest digest;
  digest.add(job.about);
  job.name = digest.name();
  if (std::optional<StoredTransport> kept = cache_.find(job.name, job.about)) {
    computation->tell(std::make_shared<StoredTransport>(std::move(*kept)), {}, true);
    return computation;
  }
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(std::move(job));
    if (!thread_.joinable()) thread_ = std::jthread([this](const std::stop_token& stop) { loop(stop); });
  }
  wake_.notify_all();
  return computation;
}

void Works::loop(const std::stop_token& stop) {
  // Of this thread and those that it starts.
  if (::nice(background_niceness) < 0) { /* then it competes with drawing */
  }
  while (true) {
    Job job;
    {
      std::unique_lock lock(mutex_);
      if (!wake_.wait(lock, stop, [this] { return !jobs_.empty(); })) return;
      job = std::move(jobs_.back());
      jobs_.pop_back();
    }
    work(job, stop);
  }
}

void Works::work(const Job& job, const std::stop_token& stop) const {
  std::atomic<bool> given_up{false};
  const auto tell = [&](std::shared_ptr<const StoredTransport> stored, std::string unsuitable, bool final) {
    if (const std::shared_ptr<Computation> computation = job.computation.lock())
      computation->tell(std::move(stored), std::move(unsuitable), final);
  };
  Effort effort;
  effort.stop = &given_up;
  effort.progress = [&](double share) {
    const std::shared_ptr<Computation> computation = job.computation.lock();
    if (computation) computation->progress_ = share;
    if (!computation || stop.stop_requested()) given_up = true;
  };
  try {
    effort.progress(0.0);
    if (given_up) return;
    const Body body(*job.order.mesh, job.order.stretch);
    StoredMedium medium = job.order.medium;
    medium.sigma_t *= body.unit();
    const Quality quality = fine(medium);
    const double densest = std::max({medium.sigma_t.r, medium.sigma_t.g, medium.sigma_t.b});
    if (densest * node_spacing(body, quality) > widest_spacing)
      throw Error(
          "Light's transport is stored for grains up to about {:.0f} mean free paths across; this one has {:.0f}.",
          2.0 * widest_spacing / node_spacing(body, quality), 2.0 * densest);
    if (densest * node_spacing(body, coarse) <= widest_spacing)
      tell(std::make_shared<StoredTransport>(compute_transport(body, medium, coarse, effort)), {}, false);
    const auto stored = std::make_shared<StoredTransport>(compute_transport(body, medium, quality, effort));
    cache_.keep(job.name, job.about, *stored);
    tell(stored, {}, true);
  } catch (const Stopped&) {
    return;
  } catch (const std::exception& failure) {
    tell(nullptr, failure.what(), true);
  }
}

}  // namespace mesograin::transport
