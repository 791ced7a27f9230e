// Radiance of one surface point towards the viewer, summed over the lights. The renderer appends the model's file and
// defines its choices.
//
// What else is chosen at compile time:
//   LIGHTS_AT_PLACE      the place that is shaded draws its own directions of the lights that have a place themselves: an opaque surface at
//                        each point, a translucent instance for all of it
//   NEAR_LIGHTS          lights have a place: the light map of each shows the grain from one direction, but each point has its light from where it is
//   LIGHTS_ABOUT         one of them is so near that it matters where its light comes in; the model looks about itself if it knows the grain inside
//                        and light goes straight there (LAMP_IN_GRAIN)
//   ENTRIES              it looks about by where the light's map shows that light enters (models/lamp_at_entries.glsl)
//   STORED_LIGHTS        of some lights it is stored what they do in the grain (models/stored_lights.glsl)
//   STORED_LAMPS         and of some that have a place
//   CLEAR, WORLD         the model knows what crosses the grain unscattered, and there is a world to be seen through it
//   GATHERED             what is behind some was gathered
//   TOLD                 numbers tell what lights do in the grain, and no model is asked for more than its surface
//   TOGETHER             what the model makes of all lights but for mirroring was summed, and nothing stands in their way
//   WHOLE_GRAIN          the model knows what light does in all of the grain, but not where it enters
//   EMITS                the surface sends out light of its own
//   PORTION              of all that, one thing alone is told (models/portions.glsl)
//   MIRRORS_WORLD        the surface has facets, and there is something to be mirrored
//   MIRRORS_HINDERED     something may stand in the way: it is for a later pass to add
//   SEES_BEHIND          the surface does not refract, and what is seen straight through it is for that pass, too
//   FACETS_ALONE         the surface is of facets alone
//   MIRRORED             the viewer is another surface, a pixel each

#include "physics/prelude.glsl"
#include "physics/fresnel.glsl"
#include "render/bindings.glsl"
#include "render/distant_light.glsl"
#include "lights/light.glsl"
#include "lights/near.glsl"
#include "models/interface.glsl"
#include "models/mirrored_world.glsl"
#include "models/portions.glsl"
#include "scene/grain.glsl"
#include "scene/shadows.glsl"
#include "models/entries.glsl"
#include "models/stored_lights.glsl"
#if (defined(LIGHTS_ABOUT) || defined(STORED_LAMPS)) && defined(WHOLE_GRAIN) && !defined(REFRACTION) && !defined(WALKED)
#define LAMP_IN_GRAIN
void look_about(DeviceLight lamp, vec3 middle, vec2 lamp_random, SurfacePoint point, vec3 to_middle, inout LightSample light);
#elif defined(LIGHTS_ABOUT)
#include "models/light_about.glsl"
#ifdef ENTRIES
void look_about(DeviceLight lamp, vec3 middle, vec2 lamp_random, SurfacePoint point, vec3 to_middle, inout LightSample light);
#endif
#endif
#include "heap/light_from_grains.glsl"
#include "models/pixel_random.glsl"
#include "scene/texturing.glsl"

layout(std430, binding = DISTANT_LIGHTS_BINDING) readonly buffer Lights { DistantLight lights[]; };

#if defined(LIGHTS_AT_PLACE) || defined(NEAR_LIGHTS)
layout(std430, binding = LOCAL_LIGHTS_BINDING) readonly buffer LocalLights { DeviceLight local_lights[]; };
layout(std430, binding = LOCAL_RANDOMS_BINDING) readonly buffer LocalRandoms { vec2 local_randoms[]; };  // where on each light this sample looks
uniform int local_light_count;
uniform int distant_light_count;  // those have their shadows first

vec3 middle_of_grain() {
#ifdef INSTANCED
  return grain_place;
#else
  return vec3(0.0);
#endif
}
#endif

// xyz: the direction towards the viewer if w is 0; if w is 1 the pinhole, in grain space, or for instances from the place amid the scene.
uniform vec4 viewer;

#if defined(EXCHANGE) && !defined(INSTANCED)
uniform vec3 to_settled;  // from the grain to where it stood when light between grains was found
vec3 settled_place() { return grain_place + to_settled; }
#else
vec3 settled_place() { return grain_place; }
#endif

#ifdef MIRRORED
uniform sampler2D mirror_looks;   // xyz: along which each pixel's mirror looks, of unit length
uniform sampler2D mirror_passes;  // as mirrored_passed of shade.frag

vec4 passed_on() { return texelFetch(mirror_passes, ivec2(gl_FragCoord.xy), 0); }
#endif

vec3 direction_to_viewer(vec3 position) {
#ifdef MIRRORED
  return -texelFetch(mirror_looks, ivec2(gl_FragCoord.xy), 0).xyz;
#endif
#ifdef INSTANCED
  position += grain_place;
#endif
  return normalize(viewer.xyz - viewer.w * position);
}

#if defined(INSTANCED) && defined(LIGHT_MAPS)
// To one of the directions for which the prototype has a map.
void turn_to_light_map(inout LightSample light);
#endif

#if defined(SHADOWS) && defined(WHOLE_GRAIN)
uniform float grain_reach;  // no point of the grain is farther than this from the origin, in scene units
#endif

#ifndef LIGHT_MAPS
// What reaches a surface that shows light only where it enters.
vec3 light_reaches_surface(LightSample light, SurfacePoint point) {
#ifdef CAST_SHADOWS
  return light_reaches_pixel(light.index);
#elif defined(SHADOWS) && defined(WHOLE_GRAIN)
  if (entered >= 0.0) return vec3(entered);
  // Light enters about the point, as far as half the grain reaches: where, is another place with every sample.
  vec3 random = 2.0 * vec3(pcg4d(uvec4(uvec2(gl_FragCoord.xy), uint(sample_index), uint(light.index))).xyz >> 8u) * (1.0 / 16777216.0) - 1.0;
  return vec3(light_reaches(light.index, point.on_triangle + 0.5 * grain_reach * random, -1.0));
#elif defined(SHADOWS)
  float cosine = dot(point.normal, light.to_light);
  if (cosine <= 0.0) return vec3(0.0);
  // Within a texel a surface that is steep to the light lies deeper than the texel is wide.
  float rise = 1.0 + 2.0 * sqrt(max((1.0 - cosine) * (1.0 + cosine), 0.0)) / max(cosine, 0.05);
  return vec3(light_reaches(light.index, point.on_triangle, shades_itself != 0 ? rise : -1.0));
#else
  return vec3(1.0);
#endif
}
#endif

#ifdef NEAR_LIGHTS
// What a light that has a place sends to the point itself. to_middle: from the grain's middle to the light; an instance's map is drawn from
// a direction nearby, and the light is taken to lie as far to that side.
void move_to_point(inout LightSample light, vec3 to_middle, SurfacePoint point) {
  int number = light.index - distant_light_count;
  if (number < 0) return;
  LightDraw drawn = draw_light(local_lights[number], middle_of_grain() + point.on_triangle, local_randoms[number]);
  light.itself = drawn.to_light;
  light.to_light = normalize(drawn.to_light + light.to_light - to_middle);
  light.irradiance = drawn.irradiance;
  light.entering = drawn.irradiance;
  light.entering_from = light.to_light;
#ifdef LIGHTS_ABOUT
  look_about(local_lights[number], middle_of_grain(), local_randoms[number], point, to_middle, light);
#endif
}
#endif

vec3 lit_by(SurfacePoint point, Outwards outwards, LightSample light) {
#if defined(EXCHANGE) && defined(SHADOWS) && (defined(LIGHT_MAPS) || defined(WHOLE_GRAIN))
  look_where_light_came_in(point, light);
#endif
#ifdef LIGHT_MAPS
#ifdef NEAR_LIGHTS
  vec3 to_middle = light.to_light;
#endif
#ifdef INSTANCED
  turn_to_light_map(light);
#endif
#ifdef NEAR_LIGHTS
  move_to_point(light, to_middle, point);
#endif
#else
  vec3 reached = light_reaches_surface(light, point);
  light.irradiance *= reached;
  light.entering *= reached;
#endif
  return evaluate_model(point, outwards, light);
}

#ifdef LIGHTS_AT_PLACE
vec3 locally_lit(SurfacePoint point, Outwards outwards) {
#ifdef LIGHT_MAPS
  vec3 place = middle_of_grain();
#else
  vec3 place = middle_of_grain() + point.on_triangle;
#endif
  vec3 sum = vec3(0.0);
  for (int i = 0; i < local_light_count; ++i) {
#ifdef SHADOWS
    // The shadow map shows one point of the light.
    vec2 random = local_randoms[i];
#else
    vec2 random = low_discrepancy_beside_pixel(uint(sample_index), pcg4d(uvec4(uvec2(gl_FragCoord.xy), 2u, uint(i))).xy);
#endif
    LightDraw drawn = draw_light(local_lights[i], place, random);
    LightSample light = parallel_light(drawn.to_light, drawn.irradiance, distant_light_count + i, light_angle(local_lights[i], drawn.reach), i, 0.0);
#ifdef STORED_LAMPS
    look_for_lamp(i);
    if (light_block >= 0) light.entering = local_lights[i].emission.rgb;
#endif
#ifdef LAMP_IN_GRAIN
    look_about(local_lights[i], middle_of_grain(), random, point, light.to_light, light);
#elif defined(LIGHTS_ABOUT) && defined(STORED_LAMPS)
    if (light_block < 0) look_about(local_lights[i], middle_of_grain(), random, point, light.to_light, light);
#elif defined(LIGHTS_ABOUT) && !defined(NEAR_LIGHTS)
    look_about(local_lights[i], middle_of_grain(), random, point, light.to_light, light);
#endif
    sum += lit_by(point, outwards, light);
  }
#ifdef STORED_LAMPS
  light_block = -1;
#endif
  return sum;
}
#endif

#ifdef EMITS
vec3 emitted();
#endif

#if defined(MIRRORS_HINDERED) || defined(SEES_BEHIND)
#define LOOKS_ON
Mirrored mirrored = Mirrored(vec3(0.0), vec3(0.0), vec3(0.0));
#endif

// Of what a look finds through a surface at grazing.
const float LEAST_ENTERING = 1e-3;

vec3 lit_point(SurfacePoint point) {
  Outwards outwards = look_outwards(point);
#if defined(EXCHANGE) && !(defined(FACETS_ALONE) && defined(MIRRORS_WORLD))
  vec3 place = settled_place() + grain_unit * point.on_triangle;
  vec3 sum = portion(EXCHANGE_PORTION, light_from_grains(grain_instance, place, point.normal, point.to_viewer));
#ifdef TOLD
  sum += portion(SUBSURFACE_PORTION, light_entered(grain_instance, point.normal, point.to_viewer));
#endif
#ifdef GATHERED
  if (!looked_through()) sum += portion(TRANSMISSION_PORTION, texelFetch(gathered_lights, ivec2(gl_FragCoord.xy), 0).rgb);
#endif
#else
  vec3 sum = vec3(0.0);
#endif
#ifdef EMITS
  sum += portion(EMISSION_PORTION, emitted());
#endif
#ifdef LIGHTS_AT_PLACE
  if (LIGHTS_TELL) sum += locally_lit(point, outwards);
#endif
#if defined(CLEAR) && (defined(WORLD) || defined(GATHERED))
  vec3 crossing = crossing_light(point, outwards);
#ifdef GATHERED
  // A look that the surface has reflected saw nothing behind.
  if (looked_through()) crossing *= texelFetch(gathered_lights, ivec2(gl_FragCoord.xy), 0).rgb / max(outwards.transmittance, LEAST_ENTERING);
#endif
  sum += portion(TRANSMISSION_PORTION, crossing);
#endif
#ifdef MIRRORS_WORLD
#ifdef MIRRORS_HINDERED
  mirrored = mirrored_world(point, outwards.mu);
  mirrored.radiance = portion(SPECULAR_PORTION, mirrored.radiance);
  mirrored.passed = portion(SPECULAR_PORTION, mirrored.passed);
#else
  sum += portion(SPECULAR_PORTION, mirrored_world(point, outwards.mu).radiance);
#endif
#endif
  if (light_count == 0 || !LIGHTS_TELL) return sum;
#ifdef TOGETHER
  sum += together_lit(point, outwards);
#endif
  // Software renderers run a loop's body once more, masked, to find that a condition at its head has failed: it is at the foot.
  int i = 0;
  do {
#ifdef STORED_LIGHTS
    look_for_sun(i);
#endif
    sum +=
        lit_by(point, outwards, parallel_light(lights[i].to_light.xyz, lights[i].irradiance.rgb, i, lights[i].to_light.w, i, lights[i].irradiance.w));
  } while (++i < light_count);
  return sum;
}
