// The world as it is seen in a direction.
#include "lights/equirectangular.glsl"

uniform vec3 world_radiance;
uniform int has_image;
uniform mat3 world_to_image;
uniform sampler2D world_image;

vec3 seen_of_world(vec3 direction) {
  vec3 colour = has_image != 0 ? textureLod(world_image, equirectangular(world_to_image * direction), 0.0).rgb : vec3(1.0);
  return world_radiance * colour;
}
