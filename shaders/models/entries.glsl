// Where light came into a grain of a heap that leaves it at a place towards the viewer: entries that are equally likely for each bin of how
// light, normal and viewer lie, on the sphere that the grain stands for (native/heap/entries.h). What others leave of a light there is what they
// leave of all that the grain's model makes of it.
#include "render/bindings.glsl"
#include "heap/light_from_grains.glsl"
#include "models/interface.glsl"
#include "models/pixel_random.glsl"
#include "physics/prelude.glsl"
#include "scene/grain.glsl"
#include "scene/shadows.glsl"

// What others leave of the light that is shaded, where it came in; negative where that is not known.
float entered = -1.0;

#if defined(EXCHANGE) && defined(SHADOWS) && (defined(LIGHT_MAPS) || defined(WHOLE_GRAIN))
// As heap::Entries has them.
const int ENTRY_ANGLES = 12;
const int ENTRY_COSINES = 4;
const int ENTRY_AZIMUTHS = 4;
const int ENTRIES_EACH = 32;
// Of a sample: each finds all of a light or nothing, which one alone shows as speckles.
const int ENTRY_LOOKS = 4;

// Of the bins to both sides each as likely as it is near.
int entry_bin(float share, int count, float random) { return clamp(int(floor(share * float(count) + random - 0.5)), 0, count - 1); }

float angle_between(float dot_product, float lengths) { return acos(clamp(dot_product / max(lengths, 1e-10), -1.0, 1.0)) / PI; }

void look_where_light_came_in(SurfacePoint point, LightSample light) {
  entered = -1.0;
  vec4 object = heap_light[grain_instance];
  if (object.w == 0.0) return;
  int kind = int(object.x);
  if (heap_light[kind].w == 0.0) return;
  float cosine = dot(point.normal, light.to_light);
  float angle = angle_between(cosine, 1.0);
  float mu = dot(point.normal, point.to_viewer);
  vec3 light_aside = light.to_light - cosine * point.normal;
  vec3 viewer_aside = point.to_viewer - mu * point.normal;
  float azimuth = angle_between(dot(light_aside, viewer_aside), length(light_aside) * length(viewer_aside));

  vec3 tangential = point.normal - cosine * light.to_light;
  float size = length(tangential);
  vec3 away =
      size > 1e-4 ? tangential / size : normalize(cross(light.to_light, abs(light.to_light.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
  vec3 across = cross(light.to_light, away);
  if (dot(across, point.to_viewer) < 0.0) across = -across;
  float radius = object.z / grain_unit;
  vec3 leaves = point.on_triangle / radius;
  vec3 aside = leaves - dot(leaves, light.to_light) * light.to_light;
  float furthest = max(1.0, length(aside));

  uvec4 bits = pcg4d(uvec4(uvec2(gl_FragCoord.xy), 3u, uint(light.index)));
  entered = 0.0;
  for (int look = 0; look < ENTRY_LOOKS; ++look) {
    uint number = uint(sample_index) * uint(ENTRY_LOOKS) + uint(look);
    vec4 random = vec4(pcg4d(bits + number) >> 8u) * (1.0 / 16777216.0);
    int bin = entry_bin(angle, ENTRY_ANGLES, random.x) * ENTRY_COSINES + entry_bin(mu * mu, ENTRY_COSINES, random.z);
    bin = bin * ENTRY_AZIMUTHS + entry_bin(azimuth, ENTRY_AZIMUTHS, random.y);
    int entry = bin * ENTRIES_EACH + int(low_discrepancy(number, bits.xy).x * float(ENTRIES_EACH));
    vec4 pair = heap_light[kind + 1 + 2 * LOBE_NODES + entry / 2];
    vec2 offset = entry % 2 == 0 ? pair.xy : pair.zw;
    vec3 place = aside + offset.x * away + offset.y * across;
    float reach = length(place);
    if (reach > furthest) place *= furthest / reach;
    place += sqrt(max(1.0 - dot(place, place), 0.0)) * light.to_light;
    entered += light_reaches(light.index, radius * place, -1.0) / float(ENTRY_LOOKS);
  }
}
#endif
