// The world as it is seen in a direction.
#include "lights/equirectangular.glsl"

uniform vec3 world_radiance;
uniform int has_image;
uniform mat3 world_to_image;
uniform sampler2D world_image;

// `radiance` is multiplied by a picture of all directions, if there is one.
vec3 radiance_around(vec3 radiance, int with_image, mat3 to_image, sampler2D image, vec3 direction) {
  if (with_image == 0) return radiance;
  return radiance * textureLod(image, equirectangular(to_image * direction), 0.0).rgb;
}

vec3 seen_of_world(vec3 direction) { return radiance_around(world_radiance, has_image, world_to_image, world_image, direction); }

// Of the world's directions in a sample, by how bright it is, per steradian: the image's luminance times this, or without an image this.
uniform float world_density;

float drawn_density_of_world(vec3 direction) {
  if (has_image == 0) return world_density;
  vec2 size = vec2(textureSize(world_image, 0));
  ivec2 texel = ivec2(clamp(equirectangular(world_to_image * direction) * size, vec2(0.0), size - 1.0));
  return world_density * dot(world_radiance * texelFetch(world_image, texel, 0).rgb, vec3(0.2126, 0.7152, 0.0722));
}
