// What a lamp nearby gives where light comes in that leaves at a point: every such place has a direction, a distance and a spot's cone of its
// own. Light is followed backwards, by walks in the ball that stands for the grain, to what reaches each of its collisions unscattered, of the
// lamp and of a parallel light: their ratio is the irradiance of the parallel light that would leave as much.
// Not physical: the grain is a ball, of the similar medium that scatters isotropically; light that comes in is not refracted.
//
// What is chosen at compile time: SINGLE_MARCHED (the model tells light that was scattered once by itself, along the light map).
#include "lights/light.glsl"
#include "lights/near.glsl"
#include "models/interface.glsl"
#include "models/pixel_random.glsl"
#include "physics/prelude.glsl"
#include "physics/fresnel.glsl"
#include "scene/grain.glsl"

struct Ball {
  float radius;  // in grain space
  vec3 sigma_s;  // per radius
  vec3 sigma_t;
  float eta;
};
uniform Ball ball;

// Of all walks of a sample together: from 32 on, what is seen of a spot's edge is no longer off by their number.
const int COLLISIONS = 32;
const float LEAST_LEFT = 0.02;  // a walk that keeps less ends

// How far a place in the ball is from its surface; lengths are in radii from here on.
float way_out(vec3 place, vec3 direction) {
  float along = dot(place, direction);
  return max(sqrt(max(along * along + 1.0 - dot(place, place), 0.0)) - along, 0.0);
}

// The share of light from a direction that reaches a place unscattered.
vec3 unscattered_share(vec3 place, vec3 to_light) {
  float way = way_out(place, to_light);
  vec3 share = exp(-ball.sigma_t * way);
  if (ball.eta == 1.0) return share;
  float cosine = clamp(dot(place + way * to_light, to_light), 0.0, 1.0);
  return share * fresnel_transmittance(cosine, refracted_cosine(cosine, ball.eta), ball.eta);
}

// Where the parallel light is in the shade of the ball, what the model makes of it is no measure: the lamp then counts as bright as anywhere.
// A channel that nothing scatters has the light of the point itself.
vec3 worth(vec3 of_lamp, vec3 of_parallel, vec3 brightest, vec3 own) {
  return mix(own, min(of_lamp / max(of_parallel, vec3(1e-30)), brightest), vec3(greaterThan(of_parallel, vec3(1e-30))));
}

// `lamp` as seen from `middle`, where grain space begins; `lamp_random`: which point of it; `to_middle`: from there to the lamp.
// Instances are shown from directions nearby instead, whose mean is told.
void look_about(DeviceLight lamp, vec3 middle, vec2 lamp_random, SurfacePoint point, vec3 to_middle, inout LightSample light) {
  float near = nearness(lamp, middle, 0.0, ball.radius * grain_unit);
  if (near == 0.0) return;
  vec3 to_light = draw_light(lamp, middle + grain_unit * point.on_triangle, lamp_random).to_light;
  float mu = clamp(dot(point.normal, point.to_viewer), 0.0, 1.0);
  vec3 inwards = (mu * point.normal - point.to_viewer) / ball.eta - refracted_cosine(mu, ball.eta) * point.normal;
  float first_way = way_out(point.normal, inwards);
  vec3 centre = point.position - ball.radius * point.normal;
  uvec4 seed = uvec4(uvec2(gl_FragCoord.xy), 11u, uint(light.index));
  float first_random = low_discrepancy(uint(sample_index), pcg4d(seed).xy).x;

  vec3 lamp_all = vec3(0.0);
  vec3 lamp_once = vec3(0.0);
  vec3 parallel_all = vec3(0.0);
  vec3 parallel_once = vec3(0.0);
  vec3 place = point.normal;
  vec3 direction = inwards;
  vec3 left = vec3(1.0);
  vec3 brightest = light.irradiance;
  bool begins = true;
  for (int i = 0; i < COLLISIONS; ++i) {
    vec4 random = vec4(pcg4d(seed + uvec4(0u, 0u, uint(i) << 8u, uint(sample_index) << 8u)) >> 8u) * (1.0 / 16777216.0);
    // As one of the channels, drawn for each flight, would fly: all count by how likely they would, together, have done so.
    float channel = 3.0 * random.w;
    float sigma_t = max(ball.sigma_t[min(int(channel), 2)], 1e-9);
    float flight;
    if (begins) {
      // The first ends in the ball, and those of all walks are spread over the way through it.
      place = point.normal;
      direction = inwards;
      left = vec3(1.0);
      flight = min(-log(1.0 - first_random * (1.0 - exp(-sigma_t * first_way))) / sigma_t, first_way);
      first_random = fract(first_random + 0.61803399);
    } else {
      flight = -log(1.0 - random.x) / sigma_t;
      float way = way_out(place, direction);
      if (flight > way) {
        place += way * direction;
        float cosine = clamp(dot(place, direction), 0.0, 1.0);
        begins = fract(channel) >= fresnel_reflectance(cosine, 1.0 / ball.eta);
        direction -= 2.0 * cosine * place;
        continue;
      }
    }
    place += flight * direction;
    vec3 passed = exp(-ball.sigma_t * flight);
    left *= 3.0 * ball.sigma_s * passed / max(dot(ball.sigma_t, passed), 1e-20);
    LightDraw drawn = draw_light(lamp, middle + grain_unit * (centre + ball.radius * place), lamp_random);
    brightest = max(brightest, drawn.irradiance);
    vec3 lamp_here = left * drawn.irradiance * unscattered_share(place, drawn.to_light);
#ifdef SINGLE_MARCHED
    if (begins) {
      lamp_once += lamp_here;
      parallel_once += left * unscattered_share(place, to_middle);
    } else
#endif
    {
      lamp_all += lamp_here;
      parallel_all += left * unscattered_share(place, to_light);
    }
    float height = 1.0 - 2.0 * random.y;
    float ring = sqrt(max(1.0 - height * height, 0.0));
    direction = vec3(ring * cos(2.0 * PI * random.z), ring * sin(2.0 * PI * random.z), height);
    begins = max(left.r, max(left.g, left.b)) < LEAST_LEFT;
  }
  light.entering = mix(light.irradiance, worth(lamp_all, parallel_all, brightest, light.irradiance), near);
#ifdef SINGLE_MARCHED
  light.entering_once = worth(lamp_once, parallel_once, brightest, light.irradiance);
#endif
}
