// The world as the camera sees it, behind everything.

#include "physics/prelude.glsl"
#include "scene/world.glsl"

uniform mat4 clip_to_world;  // directions: the camera stands at the origin
uniform vec2 jitter;         // in normalised device coordinates
uniform vec2 size;           // of the picture, in pixels

out vec4 radiance;

vec3 unproject(vec2 place, float depth) {
  vec4 world = clip_to_world * vec4(place, depth, 1.0);
  return world.xyz / world.w;
}

void main() {
  vec2 place = 2.0 * gl_FragCoord.xy / size - 1.0 - jitter;
  vec3 direction = normalize(unproject(place, 1.0) - unproject(place, -1.0));
  radiance = vec4(seen_of_world(direction), 1.0);
}
