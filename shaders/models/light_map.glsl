// What a light sees of the grain: the first surface it meets, and where it would leave the grain again.
//
// Each light has a light space: grain space turned so that z points towards the light. Its map is an orthographic
// picture of the grain from there, so equal texels are equal projected areas: a sum over texels already holds the
// cosine on the light's side.
#include "models/interface.glsl"

struct LightFrame {
  vec3 x_axis;  // of light space, in grain space
  vec3 y_axis;
  vec3 z_axis;  // towards the light
  vec2 centre;  // of the map
  float texel_width;
  float resolution;  // texels on a side
};

// Software renderers read a storage buffer number by number: only what cannot be told from the rest is here.
struct StoredLightFrame {
  vec4 x_axis;  // w: texel width
  vec4 map;     // xy: centre; z: resolution
};
layout(std430, binding = 1) readonly buffer LightFrames { StoredLightFrame light_frames[]; };

// Per texel: z of the first front face, its normal's x and y, z of the first back face; all in light space.
uniform sampler2DArray light_maps;

struct LightMapTexel {
  bool lit;          // false where the light passes the grain by; nothing else is then defined
  vec3 position;     // light space, on the tangent plane at exactly the coordinates asked for
  vec3 normal;       // light space, z > 0
  float exit_depth;  // z of the first back face behind it
};

// A light's frame, to be read once: the functions below take it from there.
LightFrame light_frame(LightSample light) {
  vec4 x_axis = light_frames[light.index].x_axis;
  vec3 map = light_frames[light.index].map.xyz;
  return LightFrame(x_axis.xyz, cross(light.to_light, x_axis.xyz), light.to_light, map.xy, x_axis.w, map.z);
}

vec3 to_light_space(LightFrame frame, vec3 vector) {
  return vec3(dot(frame.x_axis, vector), dot(frame.y_axis, vector), dot(frame.z_axis, vector));
}

float light_map_texel_width(LightFrame frame) { return frame.texel_width; }

// How far a surface that makes this cosine with the light may lie from its own tangent plane in the map, along z: what is nearer than this
// is the same surface.
float light_map_tolerance(LightFrame frame, float cosine) {
  return light_map_texel_width(frame) * (1.0 + 2.0 * sqrt(max(1.0 - cosine * cosine, 0.0)) / max(cosine, 0.05));
}

LightMapTexel light_map_at(LightFrame frame, int light, vec2 xy) {
  vec2 in_texels = (xy - frame.centre) / frame.texel_width + 0.5 * frame.resolution;
  vec2 texel = clamp(floor(in_texels), 0.0, frame.resolution - 1.0);
  vec4 stored = texelFetch(light_maps, ivec3(ivec2(texel), light), 0);

  LightMapTexel result;
  result.lit = stored.x > -1e30;
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
