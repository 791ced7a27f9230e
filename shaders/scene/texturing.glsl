// Where on its pictures a surface is, for surfaces that wear any.
//
// What is chosen at compile time:
//   TEXTURED     the material wears pictures
#ifdef TEXTURED
#include "scene/tangent.glsl"

vec2 surface_uv;
vec3 surface_in_mesh;  // the mesh's own axes and origin
vec4 surface_tangent;  // xyz: where u grows, of unit length and across the normal; w: on which side v does; 0 where UVs say nothing

// Changes the point's normal to what the material's pictures make of it.
void put_on(inout SurfacePoint point);

#ifdef INSTANCED
uniform vec3 middle_of_mesh;
vec3 to_mesh(vec3 in_grain) { return inverse(placement_of(grain_instance).linear) * in_grain + middle_of_mesh; }
#else
uniform mat4 grain_to_mesh;
vec3 to_mesh(vec3 in_grain) { return (grain_to_mesh * vec4(in_grain, 1.0)).xyz; }
#endif
#endif
