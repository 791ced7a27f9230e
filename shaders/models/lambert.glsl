// An ideally diffuse surface (Lambert 1760): what everything else is measured against.
#include "models/interface.glsl"
#include "physics/prelude.glsl"

struct Material {
  vec3 reflectance;
};
uniform Material material;

vec3 evaluate_model(SurfacePoint point, LightSample light) {
  return material.reflectance * (1.0 / PI) * light.irradiance * max(dot(point.normal, light.to_light), 0.0);
}
