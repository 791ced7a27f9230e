// A ball of the grain's own medium.
#include "models/light_about_inputs.h"

#include "physics/body/body_medium.h"

namespace mesograin::models {

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
  inputs.uniforms["ball.eta"] = static_cast<float>(physics::body_surface(material).eta);
}

}  // namespace mesograin::models
