// An ideally diffuse surface (Lambert 1760): what everything else is measured against.
#include "models/interface.glsl"
#include "models/portions.glsl"
#include "physics/prelude.glsl"

struct Material {
  vec3 reflectance;
};
uniform Material material;

// Nothing depends on the viewer.
Outwards look_outwards(SurfacePoint point) { return Outwards(1.0, 1.0, 1.0); }

vec3 evaluate_model(SurfacePoint point, Outwards outwards, LightSample light) {
  return portion(DIFFUSE_PORTION, material.reflectance * (1.0 / PI) * light.irradiance * max(dot(point.normal, light.to_light), 0.0));
}
