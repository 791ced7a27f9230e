// A lamp near a grain of stored transport that light enters and leaves straight. What the lamp gives is another irradiance from another direction at
// each place inside: light that was scattered once is told at each place as it is there. Of light that was scattered more often what is stored tells
// that of a parallel light, and walks in the grain how many times as much the lamp's is.
//
// All is told over the lamp's strength, which has its colour.
#include "lights/light.glsl"
#include "lights/near.glsl"
#include "models/interface.glsl"
#include "models/pixel_random.glsl"
#include "models/stored_grid.glsl"
#include "models/stored_lights.glsl"
#include "models/unscattered.glsl"
#include "physics/prelude.glsl"
#include "scene/grain.glsl"

#ifdef LAMP_IN_GRAIN
const int COLLISIONS = 32;              // of all walks of a sample together
const float LEAST_LEFT = 0.02;          // a walk that keeps less ends
const int MOST_PIECES_OF_A_FLIGHT = 3;  // between which it is outside

struct LampAbout {
  DeviceLight lamp;
  vec2 random;        // which point of it
  vec3 middle;        // where grain space begins
  Spectrum parallel;  // the irradiance of the parallel light that would leave as much that was scattered more than once
};
LampAbout about;
int light_about = -1;  // whose number that is

// At a place in the body.
float lamp_irradiance(vec3 place, out vec3 to_lamp) {
  mat3 to_body = grain_to_body();
  LightDraw drawn = draw_light(about.lamp, about.middle + grain_unit / stored.units * (place * to_body), about.random);
  to_lamp = to_body * drawn.to_light;
  return dot(drawn.irradiance, vec3(1.0)) / max(dot(about.lamp.emission.rgb, vec3(1.0)), 1e-30);
}

// What is scattered at a place for the first time: radiance that a mean free path adds.
Spectrum scattered_once(vec3 place, float irradiance, vec3 to_light) {
  return irradiance * SPECTRUM(stored.albedo) / (4.0 * PI) * exp(-SPECTRUM(stored.sigma_t) * way_of_light(place, to_light));
}

Spectrum lamp_scattered_once(vec3 place) {
  vec3 to_lamp;
  float irradiance = lamp_irradiance(place, to_lamp);
  return scattered_once(place, irradiance, to_lamp);
}

vec3 any_direction(vec2 random) {
  float height = 1.0 - 2.0 * random.x;
  float ring = sqrt(max(1.0 - height * height, 0.0));
  return vec3(ring * cos(2.0 * PI * random.y), ring * sin(2.0 * PI * random.y), height);
}

// Moves a place on by a flight through the grain, whose gaps do not count; false where that ends beyond it.
bool flies_to(inout vec3 place, vec3 direction, float flight) {
#ifdef HOLLOW
  for (int piece = 0; piece < MOST_PIECES_OF_A_FLIGHT; ++piece) {
    float way = way_through(place, direction, flight);
    if (way >= flight) break;
    flight -= way;
    place += way * direction;
    float gap = way_to_next_entry(place, direction);
    if (gap < 0.0) return false;
    place += gap * direction;
  }
#endif
  place += flight * direction;
  return distance_at(place) < 0.0;
}

// The irradiance of the parallel light of which as much that was scattered more than once comes back along a ray from `start` as of the lamp.
// `otherwise`: where no walk meets any.
Spectrum worth_of_lamp(vec3 start, vec3 inwards, vec3 to_light, int collisions, float otherwise) {
  uvec4 seed = uvec4(uvec2(gl_FragCoord.xy), 11u, uint(light_about));
  float first_random = low_discrepancy(uint(sample_index), pcg4d(seed).xy).x;
  Spectrum sigma_t = SPECTRUM(stored.sigma_t);
  Spectrum within = max(1.0 - exp(-sigma_t * way_through(start, inwards, FAR)), Spectrum(1e-6));
  Spectrum of_lamp = Spectrum(0.0);
  Spectrum of_parallel = Spectrum(0.0);
  float brightest = otherwise;
  Spectrum left = Spectrum(0.0);
  vec3 place = start;
  vec3 direction = inwards;
  bool begins = true;
  for (int i = 0; i < collisions; ++i) {
    vec4 random = vec4(pcg4d(seed + uvec4(0u, 0u, uint(i) << 8u, uint(sample_index) << 8u)) >> 8u) * (1.0 / 16777216.0);
    Spectrum bound = Spectrum(1.0);
    if (begins) {
      place = start;
      direction = inwards;
      left = Spectrum(1.0);
      // The first flight ends in the grain, and those of all walks are spread over the way through it.
      bound = within;
      random.x = first_random;
      first_random = fract(first_random + 0.61803399);
    }
#ifdef GREY
    float flight = -log(1.0 - random.x * bound) / sigma_t;
    left *= SPECTRUM(stored.albedo) * bound;
#else
    // As one of the channels, drawn for each flight, would fly: all count by how likely they would, together, have done so.
    int channel = min(int(3.0 * random.w), 2);
    float flight = -log(1.0 - random.x * bound[channel]) / sigma_t[channel];
    vec3 density = sigma_t * exp(-sigma_t * flight);
    left *= 3.0 * stored.albedo * density / max(dot(density / bound, vec3(1.0)), 1e-20);
#endif
    if (begins) {
      place += flight * direction;
    } else {
      if (!flies_to(place, direction, flight)) {
        begins = true;
        continue;
      }
      vec3 to_lamp;
      float irradiance = lamp_irradiance(place, to_lamp);
      brightest = max(brightest, irradiance);
      of_lamp += left * scattered_once(place, irradiance, to_lamp);
      of_parallel += left * scattered_once(place, 1.0, to_light);
    }
    direction = any_direction(random.yz);
    begins = largest(left) < LEAST_LEFT;
  }
#ifdef GREY
  return of_parallel > 1e-30 ? min(of_lamp / of_parallel, brightest) : otherwise;
#else
  return mix(vec3(otherwise), min(of_lamp / max(of_parallel, vec3(1e-30)), vec3(brightest)), greaterThan(of_parallel, vec3(1e-30)));
#endif
}

// As models/light_about.glsl has it: `lamp` as seen from `middle`, where grain space begins; `lamp_random`: which point of it.
void look_about(DeviceLight lamp, vec3 middle, vec2 lamp_random, SurfacePoint point, vec3 to_middle, inout LightSample light) {
  light_about = -1;
#ifdef STORED_LAMPS
  bool known = light_block >= 0;
#else
  const bool known = false;
#endif
  float near = known ? 1.0 : nearness(lamp, middle, 0.0, grain_unit / stored.units, true);
  if (near == 0.0) return;
  about.lamp = lamp;
  about.random = lamp_random;
  about.middle = middle;
  light_about = light.index;
  light.entering = lamp.emission.rgb;
  if (known) {
    about.parallel = Spectrum(1.0);
    return;
  }
  mat3 to_body = grain_to_body();
  vec3 start = to_body * point.on_triangle * stored.units;
  vec3 to_lamp;
  vec3 unused;
  // In the shade at the point itself what is stored is least exact: the parallel light comes from where the lamp is to the grain's middle.
  float own = lamp_irradiance(start, to_lamp);
  vec3 from_middle;
  lamp_irradiance(vec3(0.0), from_middle);
  to_lamp = normalize(mix(to_lamp, from_middle, near));
  int collisions = int(float(COLLISIONS) * walks_worth(lamp, middle, grain_unit / stored.units));
  Spectrum worth = worth_of_lamp(start, -(to_body * point.to_viewer), to_lamp, collisions, lamp_irradiance(0.5 * start, unused));
  about.parallel = mix(Spectrum(own), worth, near);
  light.entering_from = transpose(to_body) * to_lamp;
}
#endif
