// Whether a light reaches what the camera sees, a bit of each pixel, found by a ray from there to the light.
#define OCCLUSION
#define LONE_MESHES
#include "scene/rays.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(r32ui, binding = 0) uniform uimage2D reached;
uniform sampler2D surface_position;
uniform sampler2D surface_normal;
uniform sampler2D surface_mark;  // of instances, as cast_surfaces.comp has it

uniform int light;    // which, of those whose bits are told together; the first begins anew
uniform vec4 eye;     // as in shadows.glsl
uniform vec4 viewer;  // its place from the anchor and 1, or the direction towards it and 0

// Of a grain's radius: how far from its own surface a ray begins that may meet it again.
const float CLEAR_OF_ITSELF = 1e-4;

struct Shaded {
  vec4 ball;
  int known_as;
  bool itself;  // it may stand in its own light
};

Shaded shaded_of(int number, int mesh) {
  if (number < instance_count) {
    Placement placement = placement_of(number);
    vec4 placed = placed_meshes[mesh];
    return Shaded(vec4(placement.place, placed.z * largest_stretch(placement.linear)), number, placed.w > 0.0);
  }
  int lone = 4 * (number - instance_count);
  vec4 about = lone_meshes[lone + 3];
  vec3 middle = vec3(lone_meshes[lone].w, lone_meshes[lone + 1].w, lone_meshes[lone + 2].w);
  return Shaded(vec4(middle, about.x), int(about.y), about.z > 0.0);
}

// As render::lit_place has it. False, and no ray, if it does not leave the surface.
bool sets_off(vec4 position, vec4 facing, Shaded shaded, out Ray ray) {
  vec3 normal = facing.xyz;
  vec3 place = shaded.ball.xyz + position.xyz;
  vec3 to_viewer = normalize(viewer.xyz - viewer.w * place);
  float cosine = dot(normal, to_viewer);
  const float grazing = -0.1, least_cosine = 1e-4;
  if (facing.w < 0.0 && cosine < grazing) {
    normal = -normal;
    cosine = -cosine;
  }
  if (cosine < least_cosine) normal = normalize(normal + (least_cosine - cosine) * to_viewer);
  float clearance = 0.0;
  if (shaded.itself) {
    clearance = CLEAR_OF_ITSELF * shaded.ball.w;
    place += 2.0 * max(position.w, 0.0) * facing.xyz + clearance * normal;
  }
  vec3 along = eye.w > 0.0 ? eye.xyz - place : eye.xyz;
  ray = Ray(place, along, eye.w > 0.0 ? 1.0 : 1e30, shaded.known_as, clearance / length(along));
  return dot(along, normal) > 0.0;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(reached)))) return;
  uint before = light == 0 ? 0u : imageLoad(reached, pixel).x;
  vec4 facing = texelFetch(surface_normal, pixel, 0);
  bool reaches = false;
  if (facing.w != 0.0) {
    int mesh = int(texelFetch(surface_mark, pixel, 0).y) - 1;
    Shaded shaded = shaded_of(int(abs(facing.w)) - 1, mesh);
    Ray ray;
    Hit hit = Hit(NOBODY, 0, 0, 0.0, 0.0);
    reaches = sets_off(texelFetch(surface_position, pixel, 0), facing, shaded, ray) && !meets_instance(ray, hit) && !meets_lone(ray, hit);
  }
  imageStore(reached, pixel, uvec4(before | (reaches ? 1u << uint(light) : 0u), 0u, 0u, 0u));
}
