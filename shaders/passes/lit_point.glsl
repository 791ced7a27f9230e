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
  if (light_count == 0) return sum;
  Outwards outwards = look_outwards(point);
  // Software renderers run a loop's body once more, masked, to find that a condition at its head has failed: it is at the foot.
  int i = 0;
  do {
    LightSample light = LightSample(lights[i].to_light.xyz, lights[i].irradiance.rgb, i, lights[i].to_light.w);
    sum += evaluate_model(point, outwards, light);
  } while (++i < light_count);
  return sum;
}
