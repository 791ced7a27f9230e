// A shadow map, found by a ray through each texel: the same that shadow.frag draws.
#define LONE_MESHES
#include "passes/seen_along.glsl"
#include "scene/rays.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(rg32f, binding = 0) writeonly uniform image2D nearest;

uniform vec4 eye;  // as in shadows.glsl

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(nearest)))) return;
  SeenAlong along = seen_along(vec2(texel));
  Ray ray = Ray(along.origin, along.direction, along.farthest, NOBODY, 0.0);
  Hit hit = Hit(NOBODY, 0, 0, 0.0, 0.0);
  bool of_instance = meets_instance(ray, hit);
  vec2 met = vec2(-3e38, 0.0);
  if (meets_lone(ray, hit) || of_instance) {
    vec3 place = ray.origin + ray.farthest * ray.direction;
    int known_as = hit.number < instance_count ? hit.number : int(lone_meshes[4 * (hit.number - instance_count) + 3].y);
    met = vec2(eye.w > 0.0 ? -distance(place, eye.xyz) : dot(place, eye.xyz), float(known_as + 1));
  }
  imageStore(nearest, texel, vec4(met, 0.0, 0.0));
}
