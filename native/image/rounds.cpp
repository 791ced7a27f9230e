// Both go on by what the samples so far have told, and by a few times as many at most: what they told may be wrong.
#include "image/rounds.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace mesograin::image {
namespace {

constexpr int least_for_error = 2 * UntilError::first;  // of fewer samples noise is not believed
constexpr int most = 1 << 24;                           // that single precision counts

}  // namespace

UntilError::UntilError(double error) : error_(error), target_(least_for_error) {
  if (!(std::isfinite(error) && error > 0.0))
    throw Error("An error to render to must be a share above 0; got {}.", error);
}

int UntilError::next(const ImageView& picture, int samples) {
  noise_.note(picture, samples);
  if (const std::optional<double> needed = noise_.samples_for(error_); needed && samples >= least_for_error) {
    if (*needed <= samples || samples >= most) return 0;
    target_ = static_cast<int>(std::min(std::ceil(*needed), static_cast<double>(most)));
  }
  // Of a few late samples noise is not known.
  return std::max({first, samples / 4, std::min(target_, 2 * samples) - samples});
}

UntilTime::UntilTime(double seconds) : seconds_(seconds) {
  if (!(std::isfinite(seconds) && seconds > 0.0))
    throw Error("A time to render for must be above 0 seconds; got {}.", seconds);
}

int UntilTime::next(int samples, double now) {
  if (samples == 0) return 1;
  if (is_over(now) || samples >= most) return 0;
  if (first_samples_ == 0) {
    first_samples_ = samples;
    first_now_ = now;
    return 1;
  }
  const double each = (now - first_now_) / (samples - first_samples_);
  const double fit = std::min((seconds_ - now) / std::max(each, 1e-9), 2.0 * samples);
  return static_cast<int>(fit);
}

}  // namespace mesograin::image
