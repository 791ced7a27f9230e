// A lamp that is so near that each place where light comes in has it from another side, at another distance. The light's map shows the grain as a
// parallel light has it, from the middle: what the lamp gives at a place of that map counts over what such a light gives there.
// Not physical: what the lamp sees of the grain and the parallel light does not, beyond the edge of a hollow, stays dark.
#include "lights/light.glsl"
#include "lights/near.glsl"
#include "models/light_map.glsl"
#include "scene/grain.glsl"

struct LampAbout {
  DeviceLight lamp;
  vec2 random;     // which point of it
  vec3 middle;     // where grain space begins
  vec3 to_middle;  // from there to the lamp
  vec3 turned;     // from that direction to the one from which its map shows the grain
};
LampAbout lamp_about;
int lamp_about_index = -1;  // which light it is
float lamp_near = 0.0;      // how much all this counts of the light that is shaded, 0 to 1

// Where the surface is steeper to a light than this cosine, a map tells too little of it.
const float LEAST_COSINE = 0.05;

struct LampThere {
  float irradiance;  // on a plane that faces the lamp, per emission
  vec3 to_lamp;      // in light space
};

LampThere lamp_there(LightFrame frame, vec3 place) {
  vec3 in_grain = mat3(frame.x_axis, frame.y_axis, frame.z_axis) * place;
  LightDraw drawn = draw_light(lamp_about.lamp, lamp_about.middle + grain_unit * in_grain, lamp_about.random);
  vec3 emission = lamp_about.lamp.emission.rgb;
  float irradiance = dot(drawn.irradiance, vec3(1.0)) / max(dot(emission, vec3(1.0)), 1e-30);
  return LampThere(irradiance, to_light_space(frame, normalize(drawn.to_light + lamp_about.turned)));
}

// The light that enters a surface, per emission, over that of a parallel light of irradiance 1, whose cosine is `normal.z`.
float lamp_enters(LampThere there, vec3 normal) { return there.irradiance * max(dot(normal, there.to_lamp), 0.0) / max(normal.z, LEAST_COSINE); }
