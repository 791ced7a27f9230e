// What a lamp nearby gives where light comes in that leaves at a point: every such place has a direction, a distance and a spot's cone of its
// own. Light is followed backwards, by walks in the ball that stands for the grain, to what reaches each of its collisions unscattered, of the
// lamp and of a parallel light: their ratio is the irradiance of the parallel light that would leave as much.
// Not physical: the grain is a ball, of the similar medium that scatters isotropically; light that comes in is not refracted.
//
// What is chosen at compile time: SINGLE_MARCHED (the model tells light that was scattered once by itself, along the light map), WHOLE_GRAIN (it
// knows more of the grain's shape than the normal) and ENTRIES (it looks about itself, and asks for the ball where that stands for the grain).
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
  int cosine_entry;  // not 0: light spreads by a cosine lobe as it enters
  int cosine_exit;   // not 0: and as it leaves
  int collisions;    // of all walks of a sample together
};
uniform Ball ball;

const float LEAST_LEFT = 0.02;  // a walk that keeps less ends

// What was found of light that leaves at the point.
struct Found {
  vec3 of_lamp;
  vec3 of_parallel;
};

// A lamp as a grain has it around.
struct Around {
  DeviceLight lamp;
  vec2 random;      // which point of it
  vec3 middle;      // where grain space begins
  vec3 centre;      // of the ball, in grain space
  vec3 to_light;    // of the parallel light
  vec3 irradiance;  // of the brightest place so far
};

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

vec3 isotropic(vec2 random) {
  float height = 1.0 - 2.0 * random.x;
  float ring = sqrt(max(1.0 - height * height, 0.0));
  return vec3(ring * cos(2.0 * PI * random.y), ring * sin(2.0 * PI * random.y), height);
}

LightDraw lamp_at(inout Around around, vec3 place) {
  LightDraw drawn = draw_light(around.lamp, around.middle + grain_unit * (around.centre + ball.radius * place), around.random);
  around.irradiance = max(around.irradiance, drawn.irradiance);
  return drawn;
}

// What comes in by a cosine lobe at the other end of a way through the ball.
Found entering_by_cosine(inout Around around, vec3 place, vec3 direction) {
  float way = way_out(place, direction);
  vec3 entry = place + way * direction;
  vec3 share = exp(-ball.sigma_t * way);
  LightDraw drawn = lamp_at(around, entry);
  return Found(share * drawn.irradiance * max(dot(entry, drawn.to_light), 0.0), share * max(dot(entry, around.to_light), 0.0));
}

// Where the parallel light is in the shade of the ball, what the model makes of it is no measure: the lamp then counts as bright as anywhere.
// A channel that nothing scatters has the light of the point itself.
vec3 worth(Found found, vec3 brightest, vec3 own) {
  return mix(own, min(found.of_lamp / max(found.of_parallel, vec3(1e-30)), brightest), vec3(greaterThan(found.of_parallel, vec3(1e-30))));
}

// `lamp` as seen from `middle`, where grain space begins; `lamp_random`: which point of it.
void look_in_ball(DeviceLight lamp, vec3 middle, vec2 lamp_random, SurfacePoint point, inout LightSample light) {
  float near = nearness(lamp, middle, 0.0, ball.radius * grain_unit, false);
  if (near == 0.0) return;
  float mu = clamp(dot(point.normal, point.to_viewer), 0.0, 1.0);
  vec3 inwards = (mu * point.normal - point.to_viewer) / ball.eta - refracted_cosine(mu, ball.eta) * point.normal;
#if defined(WHOLE_GRAIN) || defined(SINGLE_MARCHED)
  // Of a grain with facets the ball lies between where the point's normal has it and where the grain's middle does: beside a facet that lies
  // aslant it would else be half out of the grain. The inner side of a ring has the middle before it.
  vec3 from_middle = point.position * inversesqrt(max(dot(point.position, point.position), 1e-30));
  vec3 outwards = normalize(point.normal + max(dot(point.normal, from_middle), 0.0) * from_middle);
#else
  vec3 outwards = point.normal;  // by which models that sum no surface tell light from shade
#endif
  vec3 to_light = draw_light(lamp, middle + grain_unit * point.on_triangle, lamp_random).to_light;
  Around around = Around(lamp, lamp_random, middle, point.position - ball.radius * outwards, to_light, light.irradiance);
  uvec4 seed = uvec4(uvec2(gl_FragCoord.xy), 11u, uint(light.index));
  float first_random = low_discrepancy(uint(sample_index), pcg4d(seed).xy).x;

  Found all = Found(vec3(0.0), vec3(0.0));
  vec3 place = outwards;
  vec3 direction = inwards;
  vec3 left = vec3(1.0);
  bool begins = true;
  for (int i = 0; i < ball.collisions; ++i) {
    uvec4 numbers = uvec4(0u, 0u, uint(i) << 8u, uint(sample_index) << 8u);
    vec4 random = vec4(pcg4d(seed + numbers) >> 8u) * (1.0 / 16777216.0);
    // As one of the channels, drawn for each flight, would fly: all count by how likely they would, together, have done so.
    float channel = 3.0 * random.w;
    float sigma_t = max(ball.sigma_t[min(int(channel), 2)], 1e-9);
    float flight;
    if (begins) {
      place = outwards;
      direction = inwards;
      left = vec3(1.0);
      // The normal and any direction, added, lie by a cosine lobe.
      if (ball.cosine_exit != 0)
        direction = normalize(0.999 * isotropic(vec2(pcg4d(seed + numbers + uvec4(1u, 0u, 0u, 0u)).xy >> 8u) * (1.0 / 16777216.0)) - place);
      float first_way = way_out(place, direction);
      if (ball.cosine_entry != 0) {
        Found straight = entering_by_cosine(around, place, direction);
        vec3 scattered = max(1.0 - exp(-ball.sigma_t * first_way), vec3(1e-6));
        all = Found(all.of_lamp + straight.of_lamp / scattered, all.of_parallel + straight.of_parallel / scattered);
      }
      // The first ends in the ball, and those of all walks are spread over the way through it.
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
    direction = isotropic(random.yz);
    if (ball.cosine_entry != 0) {
      Found scattered = entering_by_cosine(around, place, direction);
      all = Found(all.of_lamp + left * scattered.of_lamp, all.of_parallel + left * scattered.of_parallel);
    } else {
#ifdef SINGLE_MARCHED
      if (!begins)
#endif
      {
        LightDraw drawn = lamp_at(around, place);
        vec3 lamp_here = left * drawn.irradiance * unscattered_share(place, drawn.to_light);
        all = Found(all.of_lamp + lamp_here, all.of_parallel + left * unscattered_share(place, to_light));
      }
    }
    begins = max(left.r, max(left.g, left.b)) < LEAST_LEFT;
  }
  light.entering = mix(light.irradiance, worth(all, around.irradiance, light.irradiance), near);
}

#ifndef ENTRIES
// `to_middle`: from there to the lamp. Instances are shown from directions nearby instead, whose mean is told.
void look_about(DeviceLight lamp, vec3 middle, vec2 lamp_random, SurfacePoint point, vec3 to_middle, inout LightSample light) {
  look_in_ball(lamp, middle, lamp_random, point, light);
}
#endif
