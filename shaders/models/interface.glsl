// What every model is given and gives: one signature, so that a pass can call any of them.
// All vectors are unit length and in camera space.

struct SurfacePoint {
  vec3 position;
  vec3 normal;
  vec3 to_viewer;
};

struct LightSample {
  vec3 to_light;
  vec3 irradiance;  // linear RGB, on a plane that faces the light
};

// Radiance that leaves the point towards the viewer because of this light; the cosine on the light's side is inside.
vec3 evaluate_model(SurfacePoint point, LightSample light);
