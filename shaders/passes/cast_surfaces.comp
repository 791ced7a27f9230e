// What the camera sees of the instances of a heap, found by a ray through each pixel: the same that surface.frag draws.
//
// What is chosen at compile time:
//   TEXTURED     there are surfaces that wear pictures
#include "passes/curved_surface.glsl"
#include "passes/seen_along.glsl"
#include "scene/rays.glsl"
#ifdef TEXTURED
#include "scene/tangent.glsl"
layout(rgba32f, binding = 3) writeonly uniform image2D surface_coordinates;
#endif

layout(local_size_x = 8, local_size_y = 8) in;

layout(rgba32f, binding = 0) writeonly uniform image2D surface_position;
layout(rgba32f, binding = 1) writeonly uniform image2D surface_normal;
layout(rg32f, binding = 2) writeonly uniform image2D surface_mark;  // x: depth; y: which group of instances, from 1

uniform vec4 clip_depth;  // how deep a place from the anchor is, of the device's depth
uniform vec4 clip_width;

struct Corner {
  vec3 place;
  vec3 normal;
  vec2 uv;
};

Corner corner_of(int triangle, int corner, mat3 linear, mat3 cofactors, float handedness) {
  uint vertex = mesh_corners[3 * triangle + corner];
  vec4 place = mesh_vertices[2u * vertex], normal = mesh_vertices[2u * vertex + 1u];
  return Corner(linear * place.xyz, normalize(handedness * (cofactors * normal.xyz)), vec2(place.w, normal.w));
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(surface_position)))) return;
  SeenAlong along = seen_along(vec2(pixel));
  Ray ray = Ray(along.origin, along.direction, along.farthest, NOBODY, 0.0);
  Hit hit = Hit(NOBODY, 0, 0, 0.0, 0.0);
  vec4 position = vec4(0.0), normal = vec4(0.0), coordinates = vec4(0.0);
  vec2 mark = vec2(1.0, 0.0);
  if (meets_instance(ray, hit)) {
    Placement placement = placement_of(hit.number);
    mat3 linear = placement.linear;
    mat3 cofactors = mat3(cross(linear[1], linear[2]), cross(linear[2], linear[0]), cross(linear[0], linear[1]));
    float handedness = sign(dot(linear[0], cofactors[0]));
    Corner a = corner_of(hit.triangle, 0, linear, cofactors, handedness);
    Corner b = corner_of(hit.triangle, 1, linear, cofactors, handedness);
    Corner c = corner_of(hit.triangle, 2, linear, cofactors, handedness);
    vec3 weights = vec3(1.0 - hit.second - hit.third, hit.second, hit.third);
    vec3 place = weights.x * a.place + weights.y * b.place + weights.z * c.place;
    vec3 turned = weights.x * a.normal + weights.y * b.normal + weights.z * c.normal;
    float offset = weights.x * tangent_plane_offset(a.place, a.normal) + weights.y * tangent_plane_offset(b.place, b.normal) +
                   weights.z * tangent_plane_offset(c.place, c.normal);
    vec3 unit = normalize(turned);
    float rise = dot(on_curved_surface(place, turned, offset) - place, unit);
    vec3 across = cross(b.place - a.place, c.place - a.place);
    float side = handedness * dot(across, ray.direction) < 0.0 ? 1.0 : -1.0;
    position = vec4(place, rise);
    normal = vec4(unit, side * float(hit.number + 1));
    vec4 from_anchor = vec4(place + placement.place, 1.0);
    float depth = 0.5 * dot(clip_depth, from_anchor) / dot(clip_width, from_anchor) + 0.5;
    mark = vec2(clamp(depth, 0.0, 1.0), float(hit.mesh + 1));
#ifdef TEXTURED
    vec2 uv = weights.x * a.uv + weights.y * b.uv + weights.z * c.uv;
    coordinates = vec4(uv, packed_tangent(unit, b.place - a.place, c.place - a.place, b.uv - a.uv, c.uv - a.uv));
#endif
  }
  imageStore(surface_position, pixel, position);
  imageStore(surface_normal, pixel, normal);
  imageStore(surface_mark, pixel, vec4(mark, 0.0, 0.0));
#ifdef TEXTURED
  imageStore(surface_coordinates, pixel, coordinates);
#endif
}
