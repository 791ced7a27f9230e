// The sums over links, taken elsewhere than on the processor's cores.
#pragma once

#include <functional>
#include <memory>

#include "heap/coefficients.h"
#include "heap/links.h"

namespace mesograin::heap {

/// Over the links that they were made for.
class Sums {
 public:
  Sums() = default;
  Sums(const Sums&) = delete;
  Sums& operator=(const Sums&) = delete;
  virtual ~Sums() = default;

  /// As Links::gather(), but each answers for itself, before Seats tell it. Throws transport::Stopped; std::exception,
  /// where this cannot be: then the processor's cores take them, from there on.
  virtual void gather(const Field& sent, Field& answer, const transport::Effort& effort) = 0;
};

/// Makes them, for links and a change of them, or null, that both outlive them. Throws as Sums::gather(); null: the
/// processor's cores take them.
using MakeSums =
    std::function<std::unique_ptr<Sums>(const Links& links, const Change* change, const transport::Effort& effort)>;

}  // namespace mesograin::heap
