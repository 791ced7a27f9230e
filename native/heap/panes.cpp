// A plane sheet, whose inner reflections are a geometric series (Born and Wolf 1999, section 1.6.4, of incoherent
// light).
#include "heap/panes.h"

#include <algorithm>
#include <cmath>
#include <glm/exponential.hpp>

#include "physics/physics.h"

namespace mesograin::heap {
namespace {

// Of the cosine that light is refracted to.
constexpr float least_squared = 1e-12F;

}  // namespace

Glass glass_of(const scene::Material& material) {
  return {glm::vec3(material.scale * material.sigma_a), static_cast<float>(material.eta)};
}

Sheet sheet(const Glass& glass, float cosine, float straight) {
  const auto reflected = static_cast<float>(physics::fresnel_reflectance(cosine, glass.eta));
  if (!(reflected < 1.0F - 1e-6F)) return {glm::vec3(0.0F), glm::vec3(1.0F)};
  const float refracted =
      std::sqrt(std::max(1.0F - (1.0F - cosine) * (1.0F + cosine) / (glass.eta * glass.eta), least_squared));
  const glm::vec3 left = glm::exp(-straight * cosine / refracted * glass.sigma_a);
  const glm::vec3 series = 1.0F / (1.0F - reflected * reflected * left * left);
  const float in_and_out = (1.0F - reflected) * (1.0F - reflected);
  return {in_and_out * left * series, reflected * (1.0F + in_and_out * left * left * series)};
}

}  // namespace mesograin::heap
