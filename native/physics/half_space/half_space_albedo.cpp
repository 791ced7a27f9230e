// The same solver as behind model 1's tables, asked for fluxes.
#include "physics/half_space/half_space_albedo.h"

#include "base/error.h"
#include "physics/half_space/dielectric_surface.h"
#include "physics/half_space/half_space.h"
#include "physics/half_space/medium.h"
#include "physics/half_space/refracted_view.h"
#include "physics/physics.h"
#include "physics/quadrature.h"

namespace mesograin::physics {
namespace {

using scene::Boundary;

// The mean over projected solid angle.
template <typename Albedo>
double hemispherical(Albedo albedo) {
  double sum = 0.0;
  for (const QuadratureNode& node : gauss_legendre(48)) {
    const double mu = node.x * node.x;
    sum += 2.0 * mu * 2.0 * node.x * node.weight * albedo(mu);
  }
  return sum;
}

double channel_albedo(const scene::Material& material, int channel, std::optional<double> cosine) {
  const Medium medium = half_space_medium(material, channel);
  switch (material.boundary) {
    case Boundary::lambert_lambert:
      return HalfSpaceInterior(medium).spherical_albedo();
    case Boundary::lambert_refracted: {
      // The light's side is a cosine lobe, whatever its direction.
      const RefractedView view(medium, material.eta, material.roughness);
      return hemispherical([&](double mu) { return view.albedo(mu); });
    }
    default: {
      const HalfSpace half_space(medium, material.boundary == Boundary::dielectric ? material.eta : 1.0);
      const auto albedo = [&](double mu) {
        if (!has_rough_surface(material)) return half_space.albedo(mu);
        return RoughDielectric(material.eta, material.roughness, material.masking).entering(mu) *
               half_space.albedo_inside(refracted_cosine(mu, material.eta));
      };
      return cosine ? albedo(*cosine) : hemispherical(albedo);
    }
  }
}

}  // namespace

glm::dvec3 half_space_albedo(const scene::Material& material, std::optional<double> cosine) {
  scene::validate(material);
  if (cosine && !(*cosine > 0.0 && *cosine <= 1.0))
    throw Error("cosine must lie above 0 and be at most 1; got {}.", *cosine);
  return {channel_albedo(material, 0, cosine), channel_albedo(material, 1, cosine),
          channel_albedo(material, 2, cosine)};
}

}  // namespace mesograin::physics
