// What surfaces of facets mirror of the world, where nothing stands in the way.
#include "scene/shadows.glsl"

uniform sampler2D mirrored_radiance;

out vec4 radiance;

void main() { radiance = vec4(texelFetch(mirrored_radiance, ivec2(gl_FragCoord.xy), 0).rgb * light_reaches_pixel(0), 0.0); }
