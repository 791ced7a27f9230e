// The grain whose surface a pixel shows: where it stands, and, where it is one of an array of instances, how large it is and how it is turned.
//
// What is chosen at compile time:
//   INSTANCED     it is one of an array of instances
//   LIGHT_MAPS    its model reads light maps
//   WHOLE_GRAIN   its model knows what light does in the mesh
#ifdef INSTANCED
#include "scene/instances.glsl"
#endif

int grain_instance;
vec3 grain_place;        // the origin of grain space, in the world's axes, from the place amid the scene
float grain_unit = 1.0;  // of grain space, in the scene's

#if defined(INSTANCED) && (defined(LIGHT_MAPS) || defined(WHOLE_GRAIN))
// Of the grain that the material's tables were made for. An instance is a little larger or smaller: grain space is stretched until it is as
// large.
uniform float typical_scale;
mat3 grain_axes;  // the prototype's own axes in the world's
#ifdef WHOLE_GRAIN
uniform mat3 unstretch;  // what makes an instance's transform a turn
#endif
#endif

#ifndef INSTANCED
uniform vec3 place_of_grain;
#endif

void take_grain(int instance) {
  grain_instance = instance;
#ifdef INSTANCED
  Placement placement = placement_of(instance);
  grain_place = placement.place;
#if defined(LIGHT_MAPS) || defined(WHOLE_GRAIN)
  mat3 turn = placement.linear;
#ifdef WHOLE_GRAIN
  turn = turn * unstretch;
#endif
  grain_axes = mat3(normalize(turn[0]), normalize(turn[1]), normalize(turn[2]));
  grain_unit = pow(abs(determinant(placement.linear)), 1.0 / 3.0) / typical_scale;
#endif
#else
  grain_place = place_of_grain;
#endif
}
