// What every model is given and gives: the same signatures, so that a pass can call any of them.
// All vectors are in grain space: the world's axes, the scene's unit, the origin in the middle of the grain.

struct SurfacePoint {
  vec3 position;
  vec3 normal;       // unit length
  vec3 to_viewer;    // unit length; dot(normal, to_viewer) > 0
  vec3 on_triangle;  // the position before the surface was curved
};

struct LightSample {
  vec3 to_light;       // unit length
  vec3 irradiance;     // linear RGB, on a plane that faces the light
  int index;           // which light this is
  float angle;         // of the disc that to_light is drawn from, edge to edge, in radians
  int map;             // its light map
  float density;       // of the directions drawn of it, all together, per steradian; 0 if no facet looks for it by itself
  vec3 entering;       // irradiance of the parallel light that is worth what comes in elsewhere and leaves at the point
  vec3 entering_from;  // the direction towards that parallel light, of models that know the grain inside; to_light, but where a lamp is near
  vec3 itself;         // the direction towards it where to_light is that of an instance's map, drawn from nearby; to_light elsewhere
};

// Of a light that is the same for all of the grain.
LightSample parallel_light(vec3 to_light, vec3 irradiance, int index, float angle, int map, float density) {
  return LightSample(to_light, irradiance, index, angle, map, density, irradiance, to_light, to_light);
}

// What the point and its viewer make of it, before any light.
struct Outwards {
  float mu;             // cosine between normal and viewer, 0 to 1
  float mu_refracted;   // inside
  float transmittance;  // of the surface, for light that comes from inside
};

uniform int light_count;

#ifdef FILM_TRANSPARENT
vec3 film_seen = vec3(0.0);  // what the pixel shows of the film's background; of alpha the mean of the channels is lacking, as in Cycles
#endif

// Once for all lights.
Outwards look_outwards(SurfacePoint point);

// Radiance that leaves the point towards the viewer because of this light; the cosine on the light's side is inside.
vec3 evaluate_model(SurfacePoint point, Outwards outwards, LightSample light);

// That because of all lights together, but for what the surface mirrors of them; of models that are compiled TOGETHER, whose evaluate_model tells
// that alone.
vec3 together_lit(SurfacePoint point, Outwards outwards);

// Radiance of the world that comes through the grain unscattered; of models that define CLEAR.
vec3 crossing_light(SurfacePoint point, Outwards outwards);
