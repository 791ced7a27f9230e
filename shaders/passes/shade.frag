// Radiance of one surface point towards the viewer, summed over the lights. The renderer appends the model's file and
// defines its choices.

#include "models/interface.glsl"

struct DirectionalLight {
  vec4 to_light;    // xyz, camera space
  vec4 irradiance;  // rgb
};

layout(std430, binding = 0) readonly buffer Lights { DirectionalLight lights[]; };

uniform int light_count;
uniform int orthographic;

in vec3 camera_position;
in vec3 camera_normal;

out vec4 radiance;

void main() {
  SurfacePoint point;
  point.position = camera_position;
  point.to_viewer = orthographic != 0 ? vec3(0.0, 0.0, 1.0) : normalize(-camera_position);
  point.normal = normalize(gl_FrontFacing ? camera_normal : -camera_normal);

  // Near a silhouette the interpolated normal can point away from the viewer although the surface does not. Models may
  // count on dot(normal, to_viewer) > 0.
  const float least_cosine = 1e-4;
  float cosine = dot(point.normal, point.to_viewer);
  if (cosine < least_cosine) point.normal = normalize(point.normal + (least_cosine - cosine) * point.to_viewer);

  vec3 sum = vec3(0.0);
  for (int i = 0; i < light_count; ++i)
    sum += evaluate_model(point, LightSample(lights[i].to_light.xyz, lights[i].irradiance.rgb));
  radiance = vec4(sum, 1.0);
}
