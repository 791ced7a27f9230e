// Radiance of one surface point towards the viewer, summed over the lights. The renderer appends the model's file and
// defines its choices.

#include "models/interface.glsl"

struct DirectionalLight {
  vec4 to_light;    // xyz
  vec4 irradiance;  // rgb
};

layout(std430, binding = 0) readonly buffer Lights { DirectionalLight lights[]; };

uniform vec4 viewer;  // xyz: the pinhole in grain space if w is 1, the direction towards the viewer if w is 0

in vec3 grain_position;
in vec3 grain_normal;

out vec4 radiance;

void main() {
  SurfacePoint point;
  point.position = grain_position;
  point.to_viewer = normalize(viewer.xyz - viewer.w * grain_position);
  point.normal = normalize(grain_normal);

  // The side that is seen is the side that is lit, so that open meshes have two. On a closed grain's silhouette a back
  // face can win the depth test against the front face beside it; its normal is at grazing and must not be turned.
  const float grazing = -0.1;
  float cosine = dot(point.normal, point.to_viewer);
  if (!gl_FrontFacing && cosine < grazing) {
    point.normal = -point.normal;
    cosine = -cosine;
  }

  // Near a silhouette the interpolated normal can point away from the viewer although the surface does not.
  const float least_cosine = 1e-4;
  if (cosine < least_cosine) point.normal = normalize(point.normal + (least_cosine - cosine) * point.to_viewer);

  vec3 sum = vec3(0.0);
  for (int i = 0; i < light_count; ++i)
    sum += evaluate_model(point, LightSample(lights[i].to_light.xyz, lights[i].irradiance.rgb, i));
  radiance = vec4(sum, 1.0);
}
