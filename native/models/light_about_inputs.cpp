// A ball of the grain's own medium.
#include "models/light_about_inputs.h"

#include "physics/body/body_medium.h"

namespace mesograin::models {
namespace {

// Of all walks of a sample together: from so many on, what is seen of a spot's edge is no longer off by their number. A
// walk meets light that comes in by a cosine lobe where it leaves, not at each collision.
constexpr int collisions = 32;
constexpr int collisions_by_cosine = 128;

}  // namespace

void add_light_about(const scene::Material& material, double radius, MaterialInputs& inputs) {
  const std::array<physics::BodyMedium, 3> media = physics::body_media(material, radius);
  glm::vec3 sigma_s;
  glm::vec3 sigma_t;
  for (int channel = 0; channel < 3; ++channel) {
    sigma_s[channel] = static_cast<float>(media[channel].reduced_sigma_s());
    sigma_t[channel] = static_cast<float>(media[channel].reduced_sigma_t());
  }
  inputs.uniforms["ball.radius"] = static_cast<float>(radius);
  inputs.uniforms["ball.sigma_s"] = sigma_s;
  inputs.uniforms["ball.sigma_t"] = sigma_t;
  const physics::BodySurface surface = physics::body_surface(material);
  inputs.uniforms["ball.eta"] = static_cast<float>(surface.eta);
  inputs.uniforms["ball.cosine_entry"] = surface.cosine_entry ? 1 : 0;
  inputs.uniforms["ball.cosine_exit"] = surface.cosine_exit ? 1 : 0;
  inputs.uniforms["ball.collisions"] = surface.cosine_entry ? collisions_by_cosine : collisions;
}

}  // namespace mesograin::models
