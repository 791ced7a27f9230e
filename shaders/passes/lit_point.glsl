// Radiance of one surface point towards the viewer, summed over the lights. The renderer appends the model's file and
// defines its choices.

#include "models/interface.glsl"

struct DirectionalLight {
  vec4 to_light;    // xyz; w: angle of the disc it is drawn from
  vec4 irradiance;  // rgb
};

layout(std430, binding = 0) readonly buffer Lights { DirectionalLight lights[]; };

uniform vec4 viewer;  // xyz: the pinhole in grain space if w is 1, the direction towards the viewer if w is 0

vec3 direction_to_viewer(vec3 position) { return normalize(viewer.xyz - viewer.w * position); }

vec3 lit_point(SurfacePoint point) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < light_count; ++i)
    sum += evaluate_model(point, LightSample(lights[i].to_light.xyz, lights[i].irradiance.rgb, i, lights[i].to_light.w));
  return sum;
}
