// The surface of a body as light meets it: smooth, or of GGX facets, of which one is drawn each time
// (shaders/physics/dielectric.glsl).
#pragma once

#include <glm/vec3.hpp>

#include "transport/random.h"

namespace mesograin::transport {

class Interface {
 public:
  /// `alpha` is GGX's; 0 is smooth.
  explicit Interface(double eta, double alpha = 0.0) : eta_(eta), alpha_(eta > 1.0 ? alpha : 0.0) {}

  bool matched() const { return eta_ == 1.0; }

  double eta() const { return eta_; }

  struct Entry {
    glm::vec3 inwards;
    glm::vec3 mirrored;
    float passed;  ///< of the light
  };

  /// Of light that comes along `direction`; `normal` points out of the body, here and below.
  Entry enter(const glm::vec3& direction, const glm::vec3& normal, Random& random) const;

  struct Reflection {
    glm::vec3 inwards;
    glm::vec3 beyond;  ///< where the rest goes, if there is some
    float reflected;   ///< of the light
  };

  /// Of light that comes from inside, where the interface is not matched.
  Reflection reflect(const glm::vec3& direction, const glm::vec3& normal, Random& random) const;

 private:
  double eta_;
  double alpha_;
};

}  // namespace mesograin::transport
