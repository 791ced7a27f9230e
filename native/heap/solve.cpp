// BiCGSTAB (van der Vorst 1992, "Bi-CGSTAB: a fast and smoothly converging variant of Bi-CG"), each channel with
// numbers of its own: where grains are white it needs a tenth of the sweeps of Gauss and Seidel, and its steps are sums
// over links in any order, so that threads change nothing.
#include "heap/solve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <glm/common.hpp>
#include <memory>
#include <utility>

namespace mesograin::heap {
namespace {

constexpr int most_steps = 400;

// What is left goes up and down; where it has not come lower for so long, as in the deepest of white heaps, whose few
// rays make light of nothing in places, it will not.
constexpr int most_in_vain = 40;

// Of D: numbers of 24 bits leave as much.
constexpr float least_left = 1e-6F;

glm::dvec3 product(const Field& a, const Field& b) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < a.size(); ++i) sum += glm::dvec3(product(a[i], b[i]));
  return sum;
}

// a += factor b
void add(Field& a, const glm::dvec3& factor, const Field& b) {
  const glm::vec3 by(factor);
  for (std::size_t i = 0; i < a.size(); ++i) a[i].add(b[i], by);
}

// a = b + factor a
void scale_and_add(Field& a, const glm::dvec3& factor, const Field& b) {
  const glm::vec3 by(factor);
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i].scale(by);
    a[i].add(b[i], glm::vec3(1.0F));
  }
}

// 0 where there is nothing left to divide.
glm::dvec3 ratio(const glm::dvec3& over, const glm::dvec3& under) {
  glm::dvec3 result(0.0);
  for (int channel = 0; channel < 3; ++channel) {
    const double value = over[channel] / under[channel];
    if (std::isfinite(value)) result[channel] = value;
  }
  return result;
}

/// G.
class Gathering {
 public:
  Gathering(const Links& links, const Change* change, const MakeSums& make_sums, const transport::Effort& effort)
      : links_(links), change_(change), effort_(effort) {
    if (!make_sums) return;
    try {
      sums_ = make_sums(links, change, effort);
    } catch (const std::exception&) { /* the processor can */
    }
  }

  void operator()(const Field& sent, Field& answer) {
    if (sums_ && take_sums(sent, answer))
      answer = links_.seats->told(std::move(answer));
    else
      links_.gather(sent, answer, effort_, change_);
  }

  bool by_sums() const { return sums_ != nullptr; }

 private:
  bool take_sums(const Field& sent, Field& answer) {
    try {
      sums_->gather(sent, answer, effort_);
    } catch (const std::exception&) {
      sums_.reset();
    }
    return by_sums();
  }

  const Links& links_;
  const Change* change_;
  const transport::Effort& effort_;
  std::unique_ptr<Sums> sums_;
};

/// What is left falls by about as much with each step.
double share_done(float begun, float left, float enough) {
  return std::clamp(std::log(begun / std::max(left, enough)) / std::log(begun / enough), 0.0F, 1.0F);
}

}  // namespace

Solved solve(const Links& links, const Change* change, const Field& direct, Field guess, const Goal& goal,
             const transport::Effort& effort, const MakeSums& make_sums) {
  Solved solved;
  if (guess.size() != direct.size()) guess = direct;
  solved.sent = std::move(guess);
  transport::Effort quiet = effort;
  quiet.progress = {};
  Gathering gather(links, change, make_sums, quiet);
  // a - G a
  const auto apply = [&](const Field& of, Field& result) {
    gather(of, result);
    scale_and_add(result, glm::dvec3(-1.0), of);
  };
  const glm::dvec3 size = product(direct, direct);
  Field residual, product_p, product_s;
  apply(solved.sent, residual);
  scale_and_add(residual, glm::dvec3(-1.0), direct);
  const Field shadow = residual;
  Field search = residual;
  glm::dvec3 rho = product(shadow, residual);
  const auto left = [&] {
    const glm::dvec3 squared = ratio(product(residual, residual), size);
    return static_cast<float>(std::sqrt(std::max({squared.r, squared.g, squared.b})));
  };
  solved.residual = left();
  const float enough =
      goal.share < 1.0F ? std::clamp(goal.share * solved.residual, least_left, goal.tolerance) : goal.tolerance;
  const float begun = solved.residual;
  Field best = solved.sent;
  float least = begun;
  int best_step = 0;
  while (solved.residual > enough && solved.steps < std::min(most_steps, best_step + most_in_vain)) {
    apply(search, product_p);
    const glm::dvec3 alpha = ratio(rho, product(shadow, product_p));
    add(residual, -alpha, product_p);
    apply(residual, product_s);
    const glm::dvec3 omega = ratio(product(product_s, residual), product(product_s, product_s));
    add(solved.sent, alpha, search);
    add(solved.sent, omega, residual);
    add(residual, -omega, product_s);
    const glm::dvec3 next = product(shadow, residual);
    const glm::dvec3 beta = ratio(next * alpha, rho * omega);
    rho = next;
    // search = residual + beta (search - omega product)
    add(search, -omega, product_p);
    scale_and_add(search, beta, residual);
    ++solved.steps;
    solved.residual = left();
    if (solved.residual < least) {
      least = solved.residual;
      best_step = solved.steps;
      if (least > enough) best = solved.sent;
    }
    if (effort.progress) effort.progress(share_done(begun, solved.residual, enough));
  }
  if (solved.steps > best_step) {
    solved.sent = std::move(best);
    apply(solved.sent, residual);
    scale_and_add(residual, glm::dvec3(-1.0), direct);
    solved.residual = left();
  }
  solved.left = std::move(residual);
  solved.summed_on_device = gather.by_sums();
  return solved;
}

}  // namespace mesograin::heap
