// What is done for an order.
#include "transport/works.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "base/error.h"
#include "transport/digest.h"
#include "transport/text_digest.h"

namespace mesograin::transport {
namespace {

// A quarter of a second on two cores, a few per cent from the final answer. What shows most of few rays is the noise of
// a direction's: fewer directions have more each.
constexpr Quality coarse{.nodes = 1500, .directions = 16, .light_across = 24, .way_across = 6};

// Within a second of two cores', where coarse nodes are so many mean free paths apart that what they tell is farther
// off: some per cent from the final answer, too.
constexpr Quality less_coarse{.nodes = 9000, .directions = 16, .light_across = 48, .way_across = 12};
constexpr double coarse_spacing = 1.25;

// Light takes a quarter of a megabyte of the device's memory for each prototype, a third where channels differ: one
// beside others is as near as alone (docs/shapes.md).
constexpr Quality thin{};

// The terminator of a thick grain is sharp, and what is dark beside it shows the noise of few rays and the lack of
// products: twice the memory.
constexpr Quality thick{
    .light_across = 96, .terms = 48, .shared_terms = 44, .spacing = Spacing::nearer_across, .most_nodes = 8120};

// The light changes within ways that are short beside the grain, and nodes are worth more than products.
constexpr Quality thickest{.nodes = 10500, .light_across = 96, .terms = 16, .shared_terms = 20, .most_nodes = 12200};

// Of the time that the fine answer takes as well: what its rough one takes, and what tracing its grid does.
constexpr double coarse_share = 0.04;

double densest(const StoredMedium& medium) { return std::max({medium.sigma_t.r, medium.sigma_t.g, medium.sigma_t.b}); }

// Mean free paths between nodes from which on a grain counts as thick, and as one of the thickest.
constexpr double thick_spacing = 0.5;
constexpr double thickest_spacing = 1.25;

/// `medium` is per unit of the body.
Quality fine(const Body& body, const StoredMedium& medium) {
  const double spacing = densest(medium) * node_spacing(body, thin);
  return spacing < thick_spacing ? thin : spacing < thickest_spacing ? thick : thickest;
}

// How much denser than densest_told a medium may be that is told as if it were that, and how much one channel, so that
// the others are told at all. A grain that is denser is nearer to photons by model 3 (docs/shapes.md).
constexpr double most_thinned = 1.3;
constexpr double most_thinned_alone = 2.0;

/// Whether so dense a medium is stored, where densest_told() is `told`.
bool is_told(const StoredMedium& medium, double told) {
  const int too_dense =
      (medium.sigma_t.r > told ? 1 : 0) + (medium.sigma_t.g > told ? 1 : 0) + (medium.sigma_t.b > told ? 1 : 0);
  return densest(medium) <= (too_dense <= 1 ? most_thinned_alone : most_thinned) * told;
}

/// Light that begins in a body comes in nowhere.
bool is_inside(const Lamp& lamp, const Body& body) {
  const LampRay ray = lamp.at(glm::dvec3(0.0), glm::dvec2(0.5));
  return ray.reach < body.unit() && body.contains(glm::vec3(body.axes() * ray.to_lamp * (ray.reach / body.unit())));
}

std::string describe_body(const Order& order) {
  Digest shape;
  shape.add_numbers(order.mesh->positions());
  shape.add_numbers(order.mesh->triangles());
  std::string stretch;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) stretch += fmt::format(" {:.9g}", order.stretch[column][row]);
  return fmt::format("computed by: {}\nmesh: {} vertices, {} triangles, {}\nstretch:{}\neta: {}\nalpha: {}\n",
                     text_digest, order.mesh->positions().size(), order.mesh->triangles().size(), shape.name(), stretch,
                     order.medium.eta, order.medium.alpha);
}

std::string describe(const Quality& quality) {
  return fmt::format("nodes: {}, {}, {} at most\ndirections: {}\nrays: {} {}\nterms: {} {}\n", quality.nodes,
                     quality.spacing == Spacing::even ? "even" : "nearer across", quality.most_nodes,
                     quality.directions, quality.light_across, quality.way_across, quality.terms, quality.shared_terms);
}

std::string describe(const StoredMedium& medium) {
  return fmt::format("sigma_t: {} {} {}\nalbedo: {} {} {}\n", medium.sigma_t.r, medium.sigma_t.g, medium.sigma_t.b,
                     medium.albedo.r, medium.albedo.g, medium.albedo.b);
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

std::shared_ptr<const Computation> Works::ask(Order order) {
  auto computation = std::make_shared<Computation>();
  Job job{std::move(order), {}, {}, {}, computation};
  job.about_body = describe_body(job.order);
  remember(job.about_body, computation);
  job.about = job.about_body + describe(job.order.medium) + describe(thin) + describe(thick) + describe(thickest) +
              fmt::format("thick: {} {}\n", thick_spacing, thickest_spacing);
  if (job.order.lamp) job.about += fmt::format("lamp:\n{}", job.order.lamp->about);
  Digest digest;
  digest.add(job.about);
  job.name = digest.name();
  if (std::optional<StoredTransport> kept = cache_.find(job.name, job.about)) {
    computation->tell(std::make_shared<StoredTransport>(std::move(*kept)), {}, true);
    return computation;
  }
  if (job.order.lamp)
    jobs_.add_after_others(std::move(job));
  else
    jobs_.add(std::move(job));
  return computation;
}

void Works::remember(const std::string& about_body, const std::shared_ptr<const Computation>& computation) {
  const std::lock_guard lock(mutex_);
  std::erase_if(asked_, [](const Asked& asked) { return asked.computation.expired(); });
  asked_.push_back({about_body, computation});
}

bool Works::in_use(const std::string& about_body) const {
  const std::lock_guard lock(mutex_);
  return std::any_of(asked_.begin(), asked_.end(), [&](const Asked& asked) {
    return asked.about_body == about_body && !asked.computation.expired();
  });
}

std::shared_ptr<Walks> Works::walks(const Job& job, const Quality& quality, const Effort& effort) {
  std::shared_ptr<Walks> known = shelf_.find(job.about_body, describe(quality));
  if (known) return known;
  // A mesh that is nothing for it is found out by the first of its walks; the others share the body.
  const std::shared_ptr<Walks> other = shelf_.find(job.about_body, describe(coarse));
  const auto body = other ? other->shared_body() : std::make_shared<const Body>(*job.order.mesh, job.order.stretch);
  known = std::make_shared<Walks>(body, Interface(job.order.medium.eta, job.order.medium.alpha), quality, effort);
  shelf_.put(job.about_body, describe(quality), known);
  return known;
}

void Works::work(const Job& job, const std::stop_token& stop) {
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
    const std::shared_ptr<Walks> few = walks(job, coarse, part_of(effort, 0.0, 0.2 * coarse_share));
    const Body& body = few->body();
    StoredMedium medium = job.order.medium;
    medium.sigma_t *= body.unit();
    const Quality quality = fine(body, medium);
    const double told = densest_told(node_spacing(body, quality));
    if (!is_told(medium, told))
      throw Error(
          "Light's transport is stored for grains up to about {:.0f} mean free paths across, in one channel {:.0f}; "
          "this "
          "one has {:.0f}.",
          2.0 * most_thinned * told, 2.0 * most_thinned_alone * told, 2.0 * densest(medium));
    if (job.order.lamp) {
      if (is_inside(*job.order.lamp, body)) {
        tell(nullptr, {}, true);
        return;
      }
      const std::shared_ptr<Walks> many = walks(job, quality, part_of(effort, coarse_share, 2.0 * coarse_share));
      const auto stored = std::make_shared<StoredTransport>(
          compute_transport(*many, medium, *job.order.lamp, part_of(effort, 2.0 * coarse_share, 1.0)));
      cache_.keep(job.name, job.about, *stored);
      tell(stored, {}, true);
      let_go();
      return;
    }
    const Effort quick = part_of(effort, 0.2 * coarse_share, coarse_share);
    const auto tell_first = [&](StoredTransport stored) {
      tell(std::make_shared<StoredTransport>(std::move(stored)), {}, false);
    };
    std::shared_ptr<Walks> many = shelf_.find(job.about_body, describe(quality));
    const bool coarsely_told = densest(medium) <= densest_told(node_spacing(body, coarse));
    if (many && nearly_known(*many, medium)) {
      // A slider that is dragged on: what was traced a moment ago tells it better than coarse walks of its own do.
      if (coarsely_told && nearly_known(*few, medium)) tell_first(recalled_transport(*few, medium, quick));
      if (!known(*many, medium)) tell_first(recalled_transport(*many, medium, quick));
    } else {
      // Told as a thinner one it may be, for nothing is known yet.
      tell_first(compute_transport(*few, medium, quick));
      if (densest(medium) * node_spacing(body, coarse) > coarse_spacing)
        tell_first(compute_transport(*walks(job, less_coarse, quick), medium, quick));
    }
    if (!many) many = walks(job, quality, part_of(effort, coarse_share, 2.0 * coarse_share));
    const auto stored =
        std::make_shared<StoredTransport>(compute_transport(*many, medium, part_of(effort, 2.0 * coarse_share, 1.0)));
    cache_.keep(job.name, job.about, *stored);
    tell(stored, {}, true);
  } catch (const Stopped&) {
    // Nobody waits for it.
  } catch (const std::exception& failure) {
    tell(nullptr, failure.what(), true);
  }
  let_go();
}

bool Works::let_go() {
  shelf_.trim([this](const std::string& about_body) { return in_use(about_body); });
  bytes_of_walks_ = shelf_.bytes();
  return bytes_of_walks_ > WalksShelf::default_limit_of_gone;
}

}  // namespace mesograin::transport
