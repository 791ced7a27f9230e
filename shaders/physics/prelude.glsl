// The words of the physics text on the GPU: single precision. native/physics/physics.h gives the same words in double.
#define real float
#define real2 vec2
#define real3 vec3
#define real4 vec4
#define pure
#define OUT(type) out type

const real PI = 3.14159265358979323846;
