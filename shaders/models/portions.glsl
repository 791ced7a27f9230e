// What the light of a picture is made of. A program that is compiled with one of these as PORTION tells that one alone; together they are the
// picture. The same numbers in C++ (native/render/portion.h).
#ifndef PORTION
#define PORTION -1
#endif

const int DIFFUSE_PORTION = 0;            // lights, once off a surface that is no grain's
const int SPECULAR_PORTION = 1;           // lights and the world in facets
const int SUBSURFACE_PORTION = 2;         // lights, scattered in a grain
const int SINGLE_SCATTERING_PORTION = 3;  // of that, once, where a model tells it apart
const int TRANSMISSION_PORTION = 4;       // the world through a grain, unscattered
const int EXCHANGE_PORTION = 5;           // what grains and walls send each other
const int EMISSION_PORTION = 6;           // light of a surface's own
const int ENVIRONMENT_PORTION = 7;        // the world behind everything
const int NORMAL_PORTION = 8;             // no light, and no part of the picture: the normal

const bool LIGHTS_TELL = PORTION <= SINGLE_SCATTERING_PORTION;

vec3 portion(int which, vec3 radiance) { return PORTION < 0 || which == PORTION ? radiance : vec3(0.0); }
