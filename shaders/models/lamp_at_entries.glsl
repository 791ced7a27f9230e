// A lamp that is so near that each place where light comes in has it from another side, at another distance. The light's map shows the grain as a
// parallel light has it, from the middle: what the lamp gives at a place of that map counts over what such a light gives there.
// Not physical: what the lamp sees of the grain and the parallel light does not, beyond the edge of a hollow, stays dark.
#include "lights/light.glsl"
#include "lights/near.glsl"
#include "models/body_light.glsl"
#include "models/interface.glsl"
#include "models/light_map.glsl"
#include "models/lit_surface.glsl"
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
float lamp_entries = 0.0;   // and how much where it enters tells of what is scattered more than once: in balls nothing

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

#ifdef LIGHTS_ABOUT
// Grains whose sphere is as large as this, over how far they reach, are balls: in those walks tell more of a lamp than diffusion does.
const float LEAST_ROUND = 0.85;
const float ROUND = 0.95;

// Samples that tell what a lamp does over what a parallel light does: a ratio of fewer is off by more than a hundredth or two.
const int LEAST_TAPS_OF_LAMP = 16;

// How much of the grain is a ball.
float ball_share() { return smoothstep(LEAST_ROUND, ROUND, body.radius / grain_reach); }

void look_about(DeviceLight lamp, vec3 middle, vec2 lamp_random, SurfacePoint point, vec3 to_middle, inout LightSample light) {
  lamp_about_index = light.index;
  lamp_about = LampAbout(lamp, lamp_random, middle, to_middle, vec3(0.0));
  lamp_near = nearness(lamp, middle, 0.0, grain_unit * grain_reach, true);
  if (ball_share() > 0.0) look_in_ball(lamp, middle, lamp_random, point, light);
}

// Before the light is shaded: what enters is told over what a parallel light does that comes along the map's axis.
void turn_to_entries(inout LightSample light, LightFrame frame) {
  if (light.index != lamp_about_index) lamp_near = 0.0;
  lamp_entries = lamp_near * (1.0 - ball_share());
  lamp_about.turned = frame.z_axis - lamp_about.to_middle;
  light.to_light = normalize(mix(light.to_light, frame.z_axis, lamp_entries));
}
#endif
