// One direction of a light, drawn for the whole grain, as a buffer holds it: the same struct in C++
// (native/render/device_layout.h).

struct DistantLight {
  vec4 to_light;    // xyz; w: angle of the disc it is drawn from
  vec4 irradiance;  // rgb; w: density of such directions, per steradian, if it is the world's, which pixels also look for themselves
};
