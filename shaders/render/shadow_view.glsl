// From where a shadow map is seen, as a buffer holds it: the same struct in C++ (native/render/device_layout.h).

struct ShadowView {
  mat4 to_map;  // from the place amid the scene to [0, 1]^2, before the division by w
  vec4 eye;     // xyz: the place of the light if w is 1, the direction towards it if w is 0
  vec4 texel;   // x: its width, at distance 1 if eye.w is 1; y: by how much rounding may move a surface
};
