// What cannot be told of a light map from the rest, as a buffer holds it, since software renderers read a buffer number by number: the same
// struct in C++ (native/render/device_layout.h).

struct StoredLightFrame {
  vec4 x_axis;  // w: texel width
  vec4 map;     // xy: centre; z: resolution
  vec4 z_axis;  // towards the light that the map was drawn for
};
