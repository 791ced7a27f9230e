// The per-pixel test against several seeds of one reference.
#include "image/significance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "base/error.h"

namespace mesograin::image {
namespace {

// Of tested pixels times pairs of images, below which their kurtosis is a matter of chance.
constexpr double least_pairs = 200.0;

// Sums over squares around every pixel, from running sums along rows and then columns.
std::vector<double> box_sums(const std::vector<double>& values, int width, int height, int radius) {
  const auto at = [width](int x, int y) { return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x; };
  std::vector<double> rows(values.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0.0;
      for (int u = std::max(0, x - radius); u <= std::min(width - 1, x + radius); ++u) sum += values[at(u, y)];
      rows[at(x, y)] = sum;
    }
  std::vector<double> sums(values.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0.0;
      for (int v = std::max(0, y - radius); v <= std::min(height - 1, y + radius); ++v) sum += rows[at(x, v)];
      sums[at(x, y)] = sum;
    }
  return sums;
}

bool all_finite(const std::vector<ImageView>& images, int colours, int x, int y) {
  return std::all_of(images.begin(), images.end(), [&](const ImageView& view) {
    return std::all_of(view.at(x, y), view.at(x, y) + colours, [](float value) { return std::isfinite(value); });
  });
}

struct Moments {
  double mean = 0.0;
  double variance = 0.0;  // of one image, unbiased; 0 for a single one
};

Moments moments(const std::vector<ImageView>& images, int x, int y, int channel) {
  const auto count = static_cast<double>(images.size());
  double sum = 0.0;
  for (const ImageView& image : images) sum += image.at(x, y)[channel];
  const double mean = sum / count;
  double squares = 0.0;
  for (const ImageView& image : images) squares += std::pow(image.at(x, y)[channel] - mean, 2);
  return {mean, images.size() > 1 ? squares / (count - 1.0) : 0.0};
}

// The variance of a mean, and the degrees of freedom with which it is known.
struct Spread {
  double variance = 0.0;
  double degrees_of_freedom = 0.0;
};

// Of the difference of two means: Welch 1947, Satterthwaite 1946.
Spread add(const Spread& a, const Spread& b) {
  const double variance = a.variance + b.variance;
  if (a.variance <= 0.0) return {variance, b.degrees_of_freedom};
  if (b.variance <= 0.0) return {variance, a.degrees_of_freedom};
  return {variance,
          variance * variance /
              (a.variance * a.variance / a.degrees_of_freedom + b.variance * b.variance / b.degrees_of_freedom)};
}

// Noise of one side in one channel. `variances` are of one image in each tested pixel, 0 elsewhere; the sums are over
// the tested pixels of the large and of the small square round each pixel.
struct Noise {
  double count;
  std::vector<double> variances, wide, near;
};

// What both sides of a channel share: how bright each pixel is thought to be, and how many pixels are tested around it.
struct Surroundings {
  std::vector<double> levels, level_sums, neighbours, nearest;
};

// The variance of one image in a pixel, from its surroundings: in proportion to the level, or, at an edge, where noise
// does not follow the level, what the next neighbours have, if it is more.
double pooled_variance(const Noise& noise, const Surroundings& around, std::size_t pixel) {
  const double share =
      around.level_sums[pixel] > 0.0 ? around.levels[pixel] / around.level_sums[pixel] : 1.0 / around.neighbours[pixel];
  return std::max(noise.wide[pixel] * share, noise.near[pixel] / around.nearest[pixel]);
}

// The same without what the pixel itself has: 0 if it stands alone.
double variance_of_others(const Noise& noise, const Surroundings& around, std::size_t pixel) {
  const double own = noise.variances[pixel];
  const double level = around.levels[pixel];
  const double levels_of_others = around.level_sums[pixel] - level;
  if (around.nearest[pixel] < 2.0) return 0.0;
  const double share = levels_of_others > 0.0 ? level / levels_of_others : 1.0 / (around.neighbours[pixel] - 1.0);
  return std::max((noise.wide[pixel] - own) * share, (noise.near[pixel] - own) / (around.nearest[pixel] - 1.0));
}

// The excess kurtosis of one image's noise, at least 0: by how much more often than a normal one it is large. From the
// differences of pairs of images, whose own is half of it, each in units of its neighbours' noise, lest a large one
// widens its own measure. 0 where there are too few pixels to tell.
double excess_kurtosis(const std::vector<ImageView>& images, int channel, const std::vector<double>& tested,
                       const Noise& noise, const Surroundings& around) {
  double squares = 0.0, fourth_powers = 0.0, count = 0.0;
  for (std::size_t pixel = 0; pixel < tested.size(); ++pixel) {
    if (tested[pixel] == 0.0) continue;
    const double variance = 2.0 * variance_of_others(noise, around, pixel);
    if (variance <= 0.0) continue;
    const int x = static_cast<int>(pixel % static_cast<std::size_t>(images.front().width));
    const int y = static_cast<int>(pixel / static_cast<std::size_t>(images.front().width));
    for (std::size_t i = 0; i + 1 < images.size(); i += 2) {
      const double difference = images[i].at(x, y)[channel] - images[i + 1].at(x, y)[channel];
      squares += difference * difference / variance;
      fourth_powers += std::pow(difference * difference / variance, 2);
      count += 1.0;
    }
  }
  if (count < least_pairs || squares <= 0.0) return 0.0;
  return 2.0 * std::max(0.0, fourth_powers * count / (squares * squares) - 3.0);
}

// A t-value and its degrees of freedom.
struct Student {
  double t = 0.0;
  double degrees_of_freedom = 0.0;
};

// The same deviation for noise of an excess kurtosis: Student's t is also the symmetric curve of a given kurtosis
// (Pearson 1916, type VII), so one with the kurtosis of both, scaled to their variance, stands for both.
Student with_tails(const Student& student, double kurtosis) {
  const double own = student.degrees_of_freedom;
  if (kurtosis <= 0.0 || own <= 5.0) return student;
  const double both = 4.0 + 6.0 / (kurtosis + 6.0 / (own - 4.0));
  return {student.t / std::sqrt(own / (own - 2.0) * (both - 2.0) / both), both};
}

// The normal score with nearly the tail of Student's t: Wallace 1959, equation 2.
double normal_score(const Student& student) {
  const double freedom = student.degrees_of_freedom;
  return (8.0 * freedom + 1.0) / (8.0 * freedom + 3.0) *
         std::sqrt(freedom * std::log1p(student.t * student.t / freedom));
}

void check(const std::vector<ImageView>& images, const std::vector<ImageView>& references, const Mask& mask) {
  if (images.empty()) throw Error("A significance test needs at least one image; got none.");
  if (references.size() < 2)
    throw Error("A significance test needs two or more references of independent noise; got {}.", references.size());
  const ImageView& first = images.front();
  for (const std::vector<ImageView>* views : {&images, &references})
    for (const ImageView& view : *views)
      if (view.width != first.width || view.height != first.height || view.channels != first.channels)
        throw Error("Image and references must have one shape; got ({}, {}, {}) and ({}, {}, {}).", first.height,
                    first.width, first.channels, view.height, view.width, view.channels);
  if (mask.width != first.width || mask.height != first.height)
    throw Error("The mask must have the image's size, {} x {}; got {} x {}.", first.width, first.height, mask.width,
                mask.height);
}

// The |score| whose two-sided p-value this is, by bisection: erfc falls.
double score_of(double p_value) {
  double low = 0.0, high = 40.0;
  for (int step = 0; step < 80; ++step) {
    const double middle = 0.5 * (low + high);
    (std::erfc(middle / std::sqrt(2.0)) > p_value ? low : high) = middle;
  }
  return high;
}

}  // namespace

Significance test_significance(const std::vector<ImageView>& images, const std::vector<ImageView>& references,
                               const Mask& mask, const SignificanceOptions& options) {
  check(images, references, mask);
  const int colours = images.front().channels == 4 ? 3 : images.front().channels;
  const int width = images.front().width;
  const int height = images.front().height;
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const auto image_count = static_cast<double>(images.size());
  const auto reference_count = static_cast<double>(references.size());

  std::vector<double> tested(pixels, 0.0);
  double used = 0.0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x;
      if (mask.pixels[pixel] != 0 && all_finite(images, colours, x, y) && all_finite(references, colours, x, y))
        used += tested[pixel] = 1.0;
    }
  if (used == 0.0) throw Error("A significance test needs at least one masked pixel that is finite in every image.");
  Surroundings around;
  around.neighbours = box_sums(tested, width, height, variance_window / 2);
  around.nearest = box_sums(tested, width, height, 1);

  Significance result;
  result.p_value = {width, height, 1, std::vector<float>(pixels, 1.0F)};
  result.score = {width, height, colours, std::vector<float>(pixels * static_cast<std::size_t>(colours), 0.0F)};
  result.pixels = static_cast<std::int64_t>(used);
  result.tests = result.pixels * colours;
  result.threshold = -std::expm1(std::log1p(-options.false_alarm_rate) / static_cast<double>(result.tests));
  result.score_threshold = score_of(result.threshold);

  for (int channel = 0; channel < colours; ++channel) {
    std::vector<double> image_means(pixels, 0.0), image_variances(pixels, 0.0);
    std::vector<double> means(pixels, 0.0), variances(pixels, 0.0);
    double image_noise = 0.0, reference_noise = 0.0;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
      if (tested[pixel] == 0.0) continue;
      const int x = static_cast<int>(pixel % static_cast<std::size_t>(width));
      const int y = static_cast<int>(pixel / static_cast<std::size_t>(width));
      const Moments ours = moments(images, x, y, channel);
      const Moments theirs = moments(references, x, y, channel);
      image_means[pixel] = ours.mean;
      image_variances[pixel] = ours.variance;
      means[pixel] = theirs.mean;
      variances[pixel] = theirs.variance;
      image_noise += ours.variance / image_count;
      reference_noise += theirs.variance / reference_count;
    }
    // The variance of Monte Carlo grows with what is estimated, so neighbours share it in proportion to the level. The
    // level is taken from the side with less noise, commonly the image, which is right if the hypothesis is: on the
    // other side a pixel that came out dark by chance would seem less noisy than it is.
    around.levels = image_noise <= reference_noise ? image_means : means;
    for (double& level : around.levels) level = std::abs(level);
    around.level_sums = box_sums(around.levels, width, height, variance_window / 2);
    const double mean_level = std::accumulate(means.begin(), means.end(), 0.0) / used;
    const auto noise_of = [&](std::vector<double> of_one, double count) {
      std::vector<double> wide = box_sums(of_one, width, height, variance_window / 2);
      std::vector<double> near = box_sums(of_one, width, height, 1);
      return Noise{count, std::move(of_one), std::move(wide), std::move(near)};
    };
    const Noise ours = noise_of(std::move(image_variances), image_count);
    const Noise theirs = noise_of(std::move(variances), reference_count);
    const double our_kurtosis = excess_kurtosis(images, channel, tested, ours, around);
    const double their_kurtosis = excess_kurtosis(references, channel, tested, theirs, around);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
      if (tested[pixel] == 0.0) continue;
      const double difference = image_means[pixel] - means[pixel];
      constexpr double rounding = 1e-6;  // of single precision, on both sides
      const double excess = std::abs(difference) - (options.relative_tolerance + rounding) *
                                                       std::max(std::abs(means[pixel]), std::abs(mean_level));
      if (excess <= 0.0) continue;
      const auto spread_of = [&](const Noise& noise) {
        return Spread{pooled_variance(noise, around, pixel) / noise.count,
                      (noise.count - 1.0) * around.neighbours[pixel]};
      };
      const Spread our_spread = spread_of(ours);
      const Spread their_spread = spread_of(theirs);
      const Spread spread = add(our_spread, their_spread);
      double score = 1e3;
      if (spread.variance > 0.0) {
        // Fourth cumulants of independent noises add, and the excess kurtosis of a mean falls with its count.
        const double kurtosis = (our_kurtosis / image_count * our_spread.variance * our_spread.variance +
                                 their_kurtosis / reference_count * their_spread.variance * their_spread.variance) /
                                (spread.variance * spread.variance);
        score = normal_score(with_tails({excess / std::sqrt(spread.variance), spread.degrees_of_freedom}, kurtosis));
      }
      const double p_value = std::erfc(score / std::sqrt(2.0));
      result.score.pixels[pixel * static_cast<std::size_t>(colours) + static_cast<std::size_t>(channel)] =
          static_cast<float>(std::copysign(score, difference));
      result.p_value.pixels[pixel] = std::min(result.p_value.pixels[pixel], static_cast<float>(p_value));
    }
  }
  result.significant_pixels =
      std::count_if(result.p_value.pixels.begin(), result.p_value.pixels.end(),
                    [&](float p_value) { return static_cast<double>(p_value) < result.threshold; });
  result.differs = result.significant_pixels > 0;
  return result;
}

}  // namespace mesograin::image
