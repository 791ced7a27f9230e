// What is told of a picture's noise, against what the mean of random samples is off.
#include "image/noise_left.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include "expect_error.h"

namespace mesograin::image {
namespace {

constexpr int side = 64;

/// The mean of samples whose noise is as strong as their mean of 1, of pixels that are covered; others are black.
class Samples {
 public:
  Samples() : sums_(static_cast<std::size_t>(side) * side * 4) {}

  ImageView mean(int samples) {
    std::exponential_distribution<double> light(1.0);
    for (; count_ < samples; ++count_)
      for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += i % 4 == 3 ? 1.0 : light(random_);
    mean_.clear();
    for (const double sum : sums_) mean_.push_back(static_cast<float>(sum / count_));
    for (std::size_t i = 0; i < mean_.size() / 2; ++i) mean_[i] = 0.0F;
    return {mean_.data(), side, side, 4};
  }

  /// From the endless mean, 1.
  double relative_l1() const {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = mean_.size() / 2; i < mean_.size(); ++i) {
      if (i % 4 == 3) continue;
      sum += std::abs(mean_[i] - 1.0);
      count += mean_[i];
    }
    return sum / count;
  }

  std::vector<float>& pixels() { return mean_; }

 private:
  std::mt19937 random_{7};
  std::vector<double> sums_;
  std::vector<float> mean_;
  int count_ = 0;
};

TEST(NoiseLeft, IsWhatTheMeanOfRandomSamplesIsOff) {
  Samples samples;
  NoiseLeft noise;
  EXPECT_FALSE(noise.relative_l1());
  noise.note(samples.mean(4), 4);
  EXPECT_FALSE(noise.relative_l1());
  EXPECT_FALSE(noise.samples_for(0.1));
  for (const int count : {8, 16, 19, 40, 160}) {
    noise.note(samples.mean(count), count);
    EXPECT_NEAR(*noise.relative_l1() / samples.relative_l1(), 1.0, 0.06) << count;
  }
  EXPECT_NEAR(*noise.samples_for(0.5 * *noise.relative_l1()), 4 * 160, 1e-6);
  EXPECT_EQ(*noise.samples_for(100.0), 1.0);
}

TEST(NoiseLeft, LeavesOutWhatIsNoNumber) {
  Samples samples;
  NoiseLeft noise;
  noise.note(samples.mean(8), 8);
  noise.note(samples.mean(16), 16);
  const double without = *noise.relative_l1();
  NoiseLeft other;
  Samples again;
  again.mean(8);
  again.pixels()[side * side * 2] = std::numeric_limits<float>::quiet_NaN();
  other.note({again.pixels().data(), side, side, 4}, 8);
  again.mean(16);
  again.pixels()[side * side * 2 + 8] = std::numeric_limits<float>::infinity();
  other.note({again.pixels().data(), side, side, 4}, 16);
  EXPECT_NEAR(*other.relative_l1(), without, 0.01 * without);
}

TEST(NoiseLeft, IsNoneInABlackPicture) {
  const std::vector<float> black(side * side * 4, 0.0F);
  NoiseLeft noise;
  noise.note({black.data(), side, side, 4}, 1);
  noise.note({black.data(), side, side, 4}, 2);
  EXPECT_EQ(*noise.relative_l1(), 0.0);
}

TEST(NoiseLeft, SaysWhatItCannotTake) {
  const std::vector<float> black(side * side * 4, 0.0F);
  NoiseLeft noise;
  noise.note({black.data(), side, side, 4}, 4);
  test::expect_error([&] { noise.note({black.data(), side, side, 4}, 4); }, "got 4 after 4");
  test::expect_error([&] { noise.note({black.data(), side, side / 2, 4}, 8); }, "got 64 x 32 after 64 x 64");
  test::expect_error([&] { noise.note({black.data(), side, side, 3}, 8); }, "got 3");
}

}  // namespace
}  // namespace mesograin::image
