// What a light sees of the grain: the first surface it meets, and where it would leave the grain again.
//
// Each light has a light space: grain space turned so that z points towards the light. Its map is an orthographic
// picture of the grain from there, so equal texels are equal projected areas: a sum over texels already holds the
// cosine on the light's side.
//
// Instances of one prototype share maps, drawn in the prototype's own axes from directions all around it; of the three nearest to the light's
// each sample takes one, so that their mean is as from between them (render::LightMapAtlas).
#include "render/bindings.glsl"
#include "render/stored_light_frame.glsl"
#include "models/interface.glsl"
#include "scene/grain.glsl"
#include "models/entries.glsl"
#include "scene/shadows.glsl"
#include "models/pixel_random.glsl"

struct LightFrame {
  vec3 x_axis;  // of light space, in grain space
  vec3 y_axis;
  vec3 z_axis;  // towards the light
  vec2 centre;  // of the map
  float texel_width;
  float resolution;  // texels on a side
  float scale;       // what the map's lengths are multiplied by
  int light;
};

layout(std430, binding = LIGHT_FRAMES_BINDING) readonly buffer LightFrames { StoredLightFrame light_frames[]; };

// Per texel: z of the first front face, its normal's x and y, z of the first back face; all in light space.
uniform sampler2DArray light_maps;

struct LightMapTexel {
  bool lit;          // false where the light passes the grain by; nothing else is then defined
  vec3 position;     // light space, on the tangent plane at exactly the coordinates asked for
  vec3 normal;       // light space, z > 0
  float exit_depth;  // z of the first back face behind it
};

#ifdef INSTANCED
// By node of the grid of directions: the layer of its map, or -1.
layout(std430, binding = LIGHT_MAP_LAYERS_BINDING) readonly buffer LightMapLayers { int light_map_layers[]; };

const int DIRECTIONS_HALF = 8;  // as render::LightMapDirections::half

// To [-1, 1]^2; the lower half is folded over the edges (Meyer et al., "On Floating-Point Normal Vectors", 2010).
vec2 octahedral(vec3 direction) {
  direction /= abs(direction.x) + abs(direction.y) + abs(direction.z);
  vec2 signs = vec2(direction.x < 0.0 ? -1.0 : 1.0, direction.y < 0.0 ? -1.0 : 1.0);
  return direction.z < 0.0 ? (1.0 - abs(direction.yx)) * signs : direction.xy;
}

// The octahedron's vertex at a node of one of its map's quarters.
vec3 octahedron_at(vec2 node) {
  vec2 flat_place = node / float(DIRECTIONS_HALF);
  float height = 1.0 - flat_place.x - flat_place.y;
  return vec3(height < 0.0 ? 1.0 - flat_place.yx : flat_place, height);
}

// Of a triangle's corners on a face of the octahedron, each as likely as the place is near it and as long as it is: the mean of their unit
// vectors is the direction itself.
void turn_to_light_map(inout LightSample light) {
  vec2 along = octahedral(normalize(light.to_light * grain_axes));
  vec2 place = abs(along) * float(DIRECTIONS_HALF);
  vec2 low = min(floor(place), float(DIRECTIONS_HALF - 1));
  vec2 within = place - low;
  bool beyond = within.x + within.y > 1.0;
  vec2 first = low + (beyond ? vec2(1.0) : vec2(0.0));
  vec2 second = low + vec2(1.0, 0.0);
  vec2 third = low + vec2(0.0, 1.0);
  vec2 shares = beyond ? 1.0 - within.yx : within;
  vec3 weights =
      vec3(1.0 - shares.x - shares.y, shares) * vec3(length(octahedron_at(first)), length(octahedron_at(second)), length(octahedron_at(third)));
  float random = low_discrepancy_beside_pixel(uint(sample_index), pcg4d(uvec4(uint(grain_instance), uint(light.index), 2u, 0u)).xy).x;
  random *= weights.x + weights.y + weights.z;
  vec2 chosen = random < weights.x ? first : random < weights.x + weights.y ? second : third;
  ivec2 node = DIRECTIONS_HALF + ivec2(chosen) * ivec2(along.x < 0.0 ? -1 : 1, along.y < 0.0 ? -1 : 1);
  int layer = light_map_layers[node.y * (2 * DIRECTIONS_HALF + 1) + node.x];
  light.map = max(layer, 0);
  light.to_light = normalize(grain_axes * light_frames[light.map].z_axis.xyz);
}
#endif

// A light's frame, to be read once: the functions below take it from there.
LightFrame light_frame(LightSample light) {
  vec4 x_axis = light_frames[light.map].x_axis;
  vec3 map = light_frames[light.map].map.xyz;
  vec3 z_axis = light.to_light;
#if defined(NEAR_LIGHTS) && defined(INSTANCED)
  z_axis = normalize(grain_axes * light_frames[light.map].z_axis.xyz);
#elif defined(NEAR_LIGHTS)
  z_axis = light_frames[light.map].z_axis.xyz;
#endif
#ifdef INSTANCED
  vec3 x_in_grain = normalize(grain_axes * x_axis.xyz);
  return LightFrame(x_in_grain, cross(z_axis, x_in_grain), z_axis, typical_scale * map.xy, typical_scale * x_axis.w, map.z, typical_scale,
                    light.index);
#else
  return LightFrame(x_axis.xyz, cross(z_axis, x_axis.xyz), z_axis, map.xy, x_axis.w, map.z, 1.0, light.index);
#endif
}

vec3 to_light_space(LightFrame frame, vec3 vector) { return vec3(dot(frame.x_axis, vector), dot(frame.y_axis, vector), dot(frame.z_axis, vector)); }

float light_map_texel_width(LightFrame frame) { return frame.texel_width; }

// How far a surface that makes this cosine with the light may lie from its own tangent plane in the map, along z: what is nearer than this
// is the same surface.
float light_map_tolerance(LightFrame frame, float cosine) {
  return light_map_texel_width(frame) * (1.0 + 2.0 * sqrt(max(1.0 - cosine * cosine, 0.0)) / max(cosine, 0.05));
}

LightMapTexel light_map_at(LightFrame frame, int map, vec2 xy) {
  vec2 in_texels = (xy - frame.centre) / frame.texel_width + 0.5 * frame.resolution;
  vec2 texel = clamp(floor(in_texels), 0.0, frame.resolution - 1.0);
  vec4 stored = texelFetch(light_maps, ivec3(ivec2(texel), map), 0);

  LightMapTexel result;
  result.lit = stored.x > -1e30;
#ifdef INSTANCED
  stored.xw *= frame.scale;
#endif
  float height = sqrt(max(1.0 - dot(stored.yz, stored.yz), 1e-4));
  result.normal = vec3(stored.yz, height);
  // Within half a texel the surface is its tangent plane; near the silhouette that plane runs away and is cut short.
  vec2 offset = (in_texels - texel - 0.5) * frame.texel_width;
  float rise = clamp(-dot(stored.yz, offset) / height, -4.0 * frame.texel_width, 4.0 * frame.texel_width);
  result.position = vec3(xy, stored.x + rise);
  result.exit_depth = stored.w;
  return result;
}

// How much of the light reaches the surface at `position` (light space), whose normal makes this cosine with it, 0 to 1: another part of the
// grain may stand in it, but what is thinner than `clear` hides little. `first` is the map there; it holds one tangent plane a texel, so a
// point is its own occluder by as much.
float light_map_visibility(LightFrame frame, LightMapTexel first, vec3 position, float cosine, float clear) {
  float above = first.lit ? max(first.position.z - position.z, 0.0) : 0.0;
  float own = light_map_tolerance(frame, first.normal.z);
  return cosine > 0.0 ? 1.0 - smoothstep(own, 2.0 * own + clear, above) : 0.0;
}

// What other objects leave of the light at `position` (light space), where it meets the grain.
float light_reaches_entry(LightFrame frame, vec3 position) {
#ifdef SHADOWS
  // Where it shades itself, it is of several materials: light enters one of them, on a surface that may be steep.
  return light_reaches(frame.light, mat3(frame.x_axis, frame.y_axis, frame.z_axis) * position, shades_itself != 0 ? 8.0 : -1.0);
#else
  return 1.0;
#endif
}
