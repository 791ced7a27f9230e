// A pixel of the grain as the camera sees it.

#include "passes/curved_surface.glsl"
#include "passes/lit_point.glsl"

in vec3 grain_position;
in vec3 grain_normal;
in float grain_plane_offset;

out vec4 radiance;

void main() {
  SurfacePoint point;
  point.position = on_curved_surface(grain_position, grain_normal, grain_plane_offset);
  point.to_viewer = direction_to_viewer(grain_position);
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

  radiance = vec4(lit_point(point), 1.0);
}
