// Model 3: the surface integral. Light that entered anywhere leaves here by a kernel over the distance (multiple scattering), and light is
// scattered once on the way that the view ray takes through the grain; both by a few samples of each light's map, drawn where they count.
// Not physical: distances are straight through the grain, so a concave one is crossed where light would have to go round.
//
// What is chosen at compile time (physics::model_3_inputs):
//   REFRACTION           a dielectric interface: Fresnel on both ways, refracted directions
//   BEAM_SHIFT           the kernel depends on the cosine at which light enters, and acts from below the point that it reaches
//   SINGLE_SCATTERING    `refracted_light`: first-order scattering is not in the kernel
#include "models/dielectric.glsl"
#include "models/interface.glsl"
#include "models/light_map.glsl"
#include "models/pixel_random.glsl"
#include "physics/prelude.glsl"
#include "physics/elementary.glsl"
#include "physics/fresnel.glsl"
#include "physics/henyey_greenstein.glsl"

struct Body {
  float radius;  // of the sphere with the grain's mean chord; the unit of every length below
  float even_factor;  // light that is even inside leaves as factor times the transmittance
  float exit_slope;
  float exit_factor;  // diffused light leaves as factor (1 + slope mu') times the transmittance, mu' inside
  float eta;
  vec3 sigma_s;
  vec3 sigma_t;
  float absolute_g;
  float one_minus_absolute_g;
  float sign_g;
};
uniform Body body;

struct Sampling {
  float shortest;
  float step;
  float largest_depth;
  float least_mu;
  float diffused;  // the distance beyond which light is
  float beam;      // mean way before a beam scatters or leaves
};
uniform Sampling sampling;

// Columns: distance; rows: cosine inside, at entry. See physics::KernelTables.
uniform sampler2D kernel;
uniform sampler2D kernel_inverse;
#ifdef SINGLE_SCATTERING
uniform sampler2D refracted_light;
#endif

uniform int taps;  // for one pixel and sample, over all lights
uniform float grain_reach;  // no point of the grain is farther than this from the origin, in scene units

// d(t)/d(s) of t = s sqrt(1 - s^2/4) at s = 1.
const float SLOPE_AT_ONE = 0.57735026919;

// Two coordinates of point `index` of the R2 sequence (Roberts 2018) from `offset`, exact for any index.
vec2 low_discrepancy(uint index, uvec2 offset) {
  uvec2 bits = uvec2(3242174889u, 2447445414u) * index + offset;
  return vec2(bits >> 8u) * (1.0 / 16777216.0);
}

vec4 at_nodes(sampler2D table, vec2 coordinate) {
  vec2 size = vec2(textureSize(table, 0));
  return texture(table, (coordinate * (size - 1.0) + 0.5) / size);
}

float row_of(float mu) { return clamp((mu - sampling.least_mu) / (1.0 - sampling.least_mu + 1e-6), 0.0, 1.0); }

vec4 kernel_at(float distance, float row) {
  float column = log(1.0 + distance / sampling.shortest) / sampling.step;
  return at_nodes(kernel, vec2(column / float(textureSize(kernel, 0).x - 1), row));
}

// Where light that entered at `position` acts from, on the surface. In the sphere that fits, its beam's mean point lies below the point that
// is turned about the centre by this much.
vec3 beam_shift(vec3 normal, float mu, float mu_refracted) {
  // The part of the refracted direction that lies along the surface: Snell keeps it, over eta.
  vec3 along = (mu * normal - vec3(0.0, 0.0, 1.0)) / body.eta;
  vec3 side = sampling.beam * along;
  float below = max(1.0 - sampling.beam * mu_refracted, 0.3);
  float cosine = below * inversesqrt(below * below + dot(side, side));
  return side * (cosine / below) - (1.0 - cosine) * normal;
}

// Where a point at `ring` from the one under the light, in direction `azimuth` along the surface (0 is downhill), is seen from the light:
// as on the unit sphere for near points, and on towards any distance, for a grain may be flatter than that. `area`: of the projection, over
// that on a plane of rings.
vec2 seen_from_light(float ring, float azimuth, float cosine, float sine, out float area) {
  // A chord of the unit sphere, along the tangent.
  float near = min(ring, 1.0);
  float arm = sqrt(1.0 - 0.25 * near * near);
  float along = near * arm + (ring - near) * SLOPE_AT_ONE;
  area = ring < 1.0 ? 1.0 - 0.5 * ring * ring : along * SLOPE_AT_ONE / ring;

  float downhill = along * cos(azimuth);
  float level = along * sin(azimuth);
  float across;
  if (downhill > 0.0) {
    float bend = sine / cosine * downhill;
    float shrink = inversesqrt(1.0 + bend);
    across = cosine * downhill * shrink;
    area *= cosine * (1.0 + 0.5 * bend) * shrink * shrink * shrink;
  } else {
    // Uphill it turns towards the light until it faces it.
    float bent = min(-downhill, (1.0 - cosine) / max(sine, 1e-4));
    across = downhill + bent - (cosine + 0.5 * sine * bent) * bent;
    area *= cosine + sine * bent;
  }
  return vec2(across - 0.5 * sine * level * level, level);
}

// Radiance per irradiance, before it leaves through the interface, of light scattered many times. `near_lobe` and `far_lobe` turn exitance
// into it: light from afar arrives diffused, light from nearby has its last scattering just below the surface and looks even.
vec3 multiple_scattering(int light, vec3 position, vec3 normal, float near_lobe, float far_lobe, int count, uint first, uvec2 offset) {
  float mu_here = clamp(normal.z, 0.0, 1.0);
  float mu_here_refracted = refracted_cosine(mu_here, body.eta);
  // One row to sample from: between rows the distances and their density would not belong together.
  float last_row = float(textureSize(kernel_inverse, 0).y - 1);
  float row_here = last_row > 0.0 ? round(row_of(mu_here_refracted) * last_row) / last_row : 0.0;

  // Distances are drawn as for a plane that faces the light, half as high above as the lit surface: no lit point of a sphere is nearer than
  // that plane's, so no sample weighs more than it should.
  LightMapTexel here = light_map_at(light, position.xy * body.radius);
  float height = here.lit ? 0.5 * max(here.position.z / body.radius - position.z, 0.0) : 0.0;

  // How the surface looks from the light: narrower by |cosine| across its tilt, and bent as on the sphere.
  float tilt = length(normal.xy);
  vec2 across = tilt > 1e-4 ? normal.xy / tilt : vec2(1.0, 0.0);
  float narrowest = max(abs(normal.z), 0.05);
  vec2 centre = position.xy;
#ifdef BEAM_SHIFT
  if (normal.z > 0.0) centre -= beam_shift(normal, mu_here, mu_here_refracted).xy;
#endif

  // Distances end where the grain does.
  float rim = length(position.xy) + grain_reach / body.radius;
  float widest = max(2.0 * rim, 3.0 * rim / (narrowest + sqrt(narrowest * narrowest + 2.0 * tilt * rim)));
  float depth_here = height > 0.0 ? kernel_at(height, row_here).a : 0.0;
  float within = -expm1(depth_here - kernel_at(sqrt(height * height + widest * widest), row_here).a);

  vec3 sum = vec3(0.0);
  for (int i = 0; i < count; ++i) {
    vec2 random = low_discrepancy(first + uint(i), offset);
    // The driver's log errs near 1, where it only moves a sample by a thousandth of its small distance.
    float depth = depth_here - log(1.0 - random.x * within);
    vec2 drawn = at_nodes(kernel_inverse, vec2(sqrt(min(depth / sampling.largest_depth, 1.0)), row_here)).xy;
    float ring = sqrt(max(drawn.x * drawn.x - height * height, 0.0));
    float azimuth = 2.0 * PI * random.y;
    float area;
    vec2 spread = seen_from_light(ring, azimuth, narrowest, tilt, area);
    LightMapTexel entry = light_map_at(light, (centre + spread.x * across + spread.y * vec2(-across.y, across.x)) * body.radius);
    if (!entry.lit) continue;
    float mu = entry.normal.z;
    float mu_refracted = refracted_cosine(mu, body.eta);
#ifdef REFRACTION
    float transmittance = surface_transmittance(mu, mu_refracted);
#else
    const float transmittance = 1.0;
#endif
    vec3 from = entry.position / body.radius;
#ifdef BEAM_SHIFT
    from += beam_shift(entry.normal, mu, mu_refracted);
#endif
    float way = distance(from, position);
    float lobe = mix(near_lobe, far_lobe, way * way / (way * way + sampling.diffused * sampling.diffused));
    sum += lobe * transmittance * area / max(drawn.y, 1e-30) * kernel_at(way, row_of(mu_refracted)).rgb;
  }
  return sum * (exp(-depth_here) * within / float(max(count, 1)));
}

#ifdef SINGLE_SCATTERING
// Radiance inside, just below the surface, per irradiance: light that was scattered once on the view ray's way through the grain.
vec3 single_scattering(int light, vec3 position, vec3 normal, vec3 to_viewer, float mu_o, int count, uint first, uvec2 offset) {
  float mu_o_refracted = refracted_cosine(mu_o, body.eta);
  vec3 inwards = (mu_o * normal - to_viewer) / body.eta - mu_o_refracted * normal;

  // No farther than through the ball that holds the grain.
  float reach = grain_reach / body.radius;
  float along = dot(position, inwards);
  float longest = -along + sqrt(max(along * along + reach * reach - dot(position, position), 0.0));

  // On a lit plane the light's way in grows in proportion to the way out.
  float mu_i = normal.z;
  vec3 rate = mu_i > 0.0 ? body.sigma_t * (1.0 + mu_o_refracted / max(refracted_cosine(mu_i, body.eta), 0.05)) : vec3(0.0);

  // What each channel's exponential leaves of the way, over the way itself.
  vec3 thickness = rate * longest;
  vec3 mean_way = longest * vec3(mean_attenuation(thickness.r), mean_attenuation(thickness.g), mean_attenuation(thickness.b));

  vec3 sum = vec3(0.0);
  for (int i = 0; i < count; ++i) {
    vec2 random = low_discrepancy(first + uint(i), offset);
    // One channel's distribution at a time, the mean of all three as the density.
    vec2 chosen = random.y < 1.0 / 3.0 ? vec2(rate.r, mean_way.r) : random.y < 2.0 / 3.0 ? vec2(rate.g, mean_way.g) : vec2(rate.b, mean_way.b);
    float kept = chosen.x * chosen.y;
    float t = kept < 1e-2 ? random.x * longest : -log(1.0 - random.x * kept) / chosen.x;
    vec3 densities = exp(-rate * t) / mean_way;
    vec3 point = position + t * inwards;
    LightMapTexel entry = light_map_at(light, point.xy * body.radius);
    float above = entry.position.z / body.radius - point.z;
    if (!entry.lit || point.z * body.radius < entry.exit_depth || above < -light_map_tolerance(light, entry.normal) / body.radius) continue;

    // The place in the unit sphere that has this normal above it, at this depth.
    float tilt = length(entry.normal.xy);
    float depth = clamp(above, 0.0, 2.0 * entry.normal.z);
    float z = entry.normal.z - depth;
    vec3 lighting = at_nodes(refracted_light, vec2(min(tilt * inversesqrt(max((1.0 - z) * (1.0 + z), 1e-8)), 1.0), 0.5 + 0.5 * z)).rgb;
    float way_in = lighting.y * depth + max(above - depth, 0.0);
    vec3 direction = vec3(lighting.z * (tilt > 1e-6 ? entry.normal.xy / tilt : vec2(1.0, 0.0)),
                          -sqrt(max((1.0 - lighting.z) * (1.0 + lighting.z), 0.0)));
    vec3 turn = direction + body.sign_g * inwards;
    float phase = henyey_greenstein(0.5 * dot(turn, turn), body.absolute_g, body.one_minus_absolute_g);
    sum += lighting.x * phase * exp(-body.sigma_t * (t + way_in)) / ((densities.r + densities.g + densities.b) / 3.0);
  }
  return body.sigma_s * sum / float(max(count, 1));
}
#endif

vec3 evaluate_model(SurfacePoint point, LightSample light) {
  vec3 position = to_light_space(light.index, point.position) / body.radius;
  vec3 normal = to_light_space(light.index, point.normal);
  vec3 to_viewer = to_light_space(light.index, point.to_viewer);
  float mu_o = clamp(dot(normal, to_viewer), 0.0, 1.0);
  float mu_o_refracted = refracted_cosine(mu_o, body.eta);
#ifdef REFRACTION
  float transmittance = surface_transmittance(mu_o, mu_o_refracted);
#else
  const float transmittance = 1.0;
#endif

  int share = max(taps / max(light_count, 1), 2);
#ifdef SINGLE_SCATTERING
  int single_share = max(share / 4, 1);
#else
  int single_share = 0;
#endif
  int multiple_share = share - single_share;
  // The sequence goes on from sample to sample; only its offset differs from pixel to pixel.
  uvec4 offset = pcg4d(uvec4(uvec2(gl_FragCoord.xy), 0u, uint(light.index)));

  vec3 radiance = transmittance * multiple_scattering(light.index, position, normal, body.even_factor,
                                                      body.exit_factor * (1.0 + body.exit_slope * mu_o_refracted), multiple_share,
                                                      uint(sample_index * multiple_share), offset.xy);
#ifdef SINGLE_SCATTERING
  vec3 inside = single_scattering(light.index, position, normal, to_viewer, mu_o, single_share, uint(sample_index * single_share), offset.zw);
  radiance += transmittance / (body.eta * body.eta) * inside;
#endif
  radiance *= light.irradiance;
#ifdef SPECULAR
  LightMapTexel lit = light_map_at(light.index, position.xy * body.radius);
  radiance += light_map_visibility(light.index, lit, position * body.radius, normal.z) * specular_reflection(point, light);
#endif
  return radiance;
}
