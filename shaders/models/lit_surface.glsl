// What models that sum over the lit surface know of it: a point as a light's map sees it, how places are drawn, and where the map is too coarse to
// tell the grain from the sphere that fits it.
#include "models/body_light.glsl"
#include "models/entries.glsl"
#include "models/light_map.glsl"

uniform float grain_reach;  // no point of the grain is farther than this from the origin, in scene units

// A point of the grain as a light sees it: in light space, over the grain's radius.
struct Seen {
  LightFrame frame;
  int map;
  BodyFit fit;
  vec3 position;
  vec3 fit_normal;  // of the sphere that fits
};

// Points of the low-discrepancy sequence: how many, from which on, and what turns them.
struct Draws {
  int count;
  uint first;
  uvec2 offset;
};

// Single samples that found much where little was expected would stand out as dots for thousands of frames.
const float MOST_A_SAMPLE_COUNTS = 64.0;

// How far the surface at a place is the sphere that fits, 0 or 1 or between them, for all that a light map can tell: at the terminator a texel
// is as deep as it is long, and the silhouette has corners that light would show. Else a grain whose mean free path is less than a texel
// would find its own light too far away. `from_axis`: how far the place lies from the sphere's axis along the light; `cosine`: of its normal.
float is_sphere(LightFrame frame, LightMapTexel mapped, float height, float from_axis, float radius, float cosine) {
  float texel = light_map_texel_width(frame) / body.radius;
  float apart =
      mapped.lit ? abs(height - mapped.position.z / body.radius) / (light_map_tolerance(frame, cosine) / body.radius) : (radius - from_axis) / texel;
  return 1.0 - smoothstep(1.0, 2.0, apart);
}

// Where it is known where light came in, once for all taps, none asks for itself.
float light_reaches_tap(LightFrame frame, vec3 position) { return entered >= 0.0 ? 1.0 : light_reaches_entry(frame, position); }
