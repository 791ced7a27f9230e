// A pixel of a grain all of whose light was gathered: no model is asked.

#include "models/portions.glsl"

uniform sampler2D gathered;            // what grains and walls send
uniform sampler2D gathered_lights;     // lights and the world, seen through it; w: the share of a transparent film
uniform sampler2D gathered_scattered;  // lights and the world, scattered in it
uniform sampler2D gathered_mirrored;   // and at its surface

out vec4 radiance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 sum = portion(EXCHANGE_PORTION, texelFetch(gathered, pixel, 0).rgb);
  vec4 through = texelFetch(gathered_lights, pixel, 0);
  sum += portion(TRANSMISSION_PORTION, through.rgb);
  sum += portion(SUBSURFACE_PORTION, texelFetch(gathered_scattered, pixel, 0).rgb);
  sum += portion(SPECULAR_PORTION, texelFetch(gathered_mirrored, pixel, 0).rgb);
  radiance = vec4(sum, 1.0 - through.w);
}
