// The world as the camera sees it, behind everything.

#include "physics/prelude.glsl"
#include "lights/equirectangular.glsl"

uniform mat4 clip_to_world;  // directions: the camera stands at the origin
uniform vec2 jitter;         // in normalised device coordinates
uniform vec2 size;           // of the picture, in pixels
uniform vec3 world_radiance;
uniform int has_image;
uniform mat3 world_to_image;
uniform sampler2D world_image;

out vec4 radiance;

vec3 unproject(vec2 place, float depth) {
  vec4 world = clip_to_world * vec4(place, depth, 1.0);
  return world.xyz / world.w;
}

void main() {
  vec2 place = 2.0 * gl_FragCoord.xy / size - 1.0 - jitter;
  vec3 direction = normalize(unproject(place, 1.0) - unproject(place, -1.0));
  vec3 colour = has_image != 0 ? textureLod(world_image, equirectangular(world_to_image * direction), 0.0).rgb : vec3(1.0);
  radiance = vec4(world_radiance * colour, 1.0);
}
