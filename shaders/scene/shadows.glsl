// What other objects leave of a light. Each light has a picture of the scene from where it stands, which tells for every direction how near
// the nearest surface is and whose it is. An object is told from its neighbours by its number, so that grains that touch neither shade
// themselves nor let light through between them.
//
// What is chosen at compile time:
//   SHADOWS       there is something that may stand in the light
//   CAST_SHADOWS  rays have found for each pixel which lights reach the surface; there are no such pictures
#include "render/bindings.glsl"
#include "render/shadow_view.glsl"
#include "scene/grain.glsl"

#ifdef CAST_SHADOWS
uniform usampler2D lights_that_reach;  // a bit each, of each channel

vec3 light_reaches_pixel(int light) { return vec3((texelFetch(lights_that_reach, ivec2(gl_FragCoord.xy), 0).rgb >> uint(light)) & 1u); }
#elif defined(SHADOWS)
layout(std430, binding = SHADOW_VIEWS_BINDING) readonly buffer ShadowViews { ShadowView shadow_views[]; };

// x: how near to the light, growing towards it; y: number of the instance, from 1.
uniform sampler2DArray shadow_maps;

// Whether a part of the grain may stand in the light of another, where that is not known by other means.
uniform int shades_itself;

#ifdef INSTANCED
int number_in_shadows() { return grain_instance; }
#else
uniform int object_number;
int number_in_shadows() { return object_number; }
#endif

// `place`: in grain space; `rise`: how far the grain's own surface may lie above it, in texels; negative: it does not shade itself.
float light_reaches(int light, vec3 place, float rise) {
  ShadowView view = shadow_views[light];
  vec3 from_anchor = grain_place + grain_unit * place;
  vec4 at = view.to_map * vec4(from_anchor, 1.0);
  vec2 size = vec2(textureSize(shadow_maps, 0).xy);
  vec2 texel = floor(at.xy / max(at.w, 1e-30) * size);
  if (at.w <= 0.0 || any(lessThan(texel, vec2(0.0))) || any(greaterThanEqual(texel, size))) return 1.0;
  vec2 nearest = texelFetch(shadow_maps, ivec3(ivec2(texel), light), 0).xy;
  float nearness = view.eye.w > 0.0 ? -distance(from_anchor, view.eye.xyz) : dot(from_anchor, view.eye.xyz);
  float tolerance = view.texel.y;
  if (int(nearest.y) == number_in_shadows() + 1) {
    if (rise < 0.0) return 1.0;
    tolerance += rise * view.texel.x * (view.eye.w > 0.0 ? -nearness : 1.0);
  }
  return nearest.x > nearness + tolerance ? 0.0 : 1.0;
}
#endif
