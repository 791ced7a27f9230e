// Sums, of each grain and node of walls that answers, what light it sends out because of what others send it, over its links in their order
// (heap::Links::gather): so the sum is the same whenever it is taken.
//
// What is chosen at compile time:
//   FINE      some are told to order 2
//   SHARED    grains that lie deep share the numbers of a cell
//   CHANGED   materials are others than where the links were found
#include "render/bindings.glsl"

const int GROUP = 64;  // that answer
layout(local_size_x = GROUP) in;

// As heap::Link: from whom, where it is sent, where it leaves, and its weight.
layout(std430, binding = LINKS_BINDING) readonly buffer Links { uvec4 links[]; };

// Of each that answers; last, how many links there are.
layout(std430, binding = FIRST_LINKS_BINDING) readonly buffer FirstLinks { uint first_links[]; };

// Red, green and blue (xyz: the slope over the normal, w: the mean), then rgb of each number of the second order, if any.
layout(std430, binding = SENT_BINDING) readonly buffer Sent { vec4 sent[]; };
layout(std430, binding = ANSWERS_BINDING) writeonly buffer Answers { vec4 answers[]; };

#ifdef FINE
const uint NUMBERS = 8u;
#else
const uint NUMBERS = 3u;
#endif

#ifdef SHARED
// Of each grain and node: x: which of what is sent tells it, or is the first that tells its cell; y: of one that shares, where in the cell it is
// (heap/seats.h): of three numbers of 8 bits, 128 is the middle; of others 0.
layout(std430, binding = SENDERS_BINDING) readonly buffer Senders { uvec2 senders[]; };
#endif

#ifdef CHANGED
// As heap::Change: rgb.
layout(std430, binding = RECEIVED_BINDING) readonly buffer Received { vec4 received[]; };
#endif

// As heap::PackedPlace::whole.
vec3 place_of(uint bits) { return 1.6 / 511.0 * (vec3(bits & 1023u, (bits >> 10u) & 1023u, (bits >> 20u) & 1023u) - 511.0); }

// As heap::PackedWeight::whole.
vec3 weight_of(uint bits) {
  if (bits == 0u) return vec3(0.0);
  return uintBitsToFloat(((bits >> 24u) + 127u - 128u - 8u) << 23u) * vec3(bits & 255u, (bits >> 8u) & 255u, (bits >> 16u) & 255u);
}

vec3 first_order_at(uint first, vec3 normal) {
  vec4 basis = vec4(normal, 1.0);
  return vec3(dot(sent[first], basis), dot(sent[first + 1u], basis), dot(sent[first + 2u], basis));
}

#ifdef FINE
const float ROOT = sqrt(3.0);

// As heap::second_order.
float[5] second_order(vec3 p) {
  return float[5](ROOT * p.x * p.y, ROOT * p.y * p.z, ROOT * p.z * p.x, 0.5 * ROOT * (p.x * p.x - p.y * p.y),
                  p.z * p.z - 0.5 * (p.x * p.x + p.y * p.y));
}
#endif

// As heap::Seats::light_at.
vec3 light_at(uint from, vec3 normal) {
#ifdef SHARED
  uvec2 sender = senders[from];
  uint first = NUMBERS * sender.x;
  if (sender.y != 0u) {
    vec3 in_cell = sqrt(3.0) / 127.0 * (vec3(sender.y & 255u, (sender.y >> 8u) & 255u, sender.y >> 16u) - 128.0);
    return first_order_at(first, normal) + in_cell.x * first_order_at(first + NUMBERS, normal) +
           in_cell.y * first_order_at(first + 2u * NUMBERS, normal) + in_cell.z * first_order_at(first + 3u * NUMBERS, normal);
  }
#else
  uint first = NUMBERS * from;
#endif
  vec3 light = first_order_at(first, normal);
#ifdef FINE
  float basis[5] = second_order(normal);
  for (uint i = 0u; i < 5u; ++i) light += basis[i] * sent[first + 3u + i].rgb;
#endif
  return light;
}

void main() {
  uint self = gl_GlobalInvocationID.x;
  if (self + 1u >= uint(first_links.length())) return;
  vec4 red = vec4(0.0), green = vec4(0.0), blue = vec4(0.0);
#ifdef FINE
  vec3 second[5] = vec3[5](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
#endif
  for (uint i = first_links[self]; i < first_links[self + 1u]; ++i) {
    uvec4 link = links[i];
    vec3 light = weight_of(link.w) * light_at(link.x, place_of(link.y));
#ifdef CHANGED
    light *= received[link.x].rgb;
#endif
    vec3 leaves_at = place_of(link.z);
    vec4 basis = vec4(3.0 * leaves_at, 1.0);
    red += light.r * basis;
    green += light.g * basis;
    blue += light.b * basis;
#ifdef FINE
    float more[5] = second_order(leaves_at);
    for (int j = 0; j < 5; ++j) second[j] += 5.0 * more[j] * light;
#endif
  }
  uint first = NUMBERS * self;
  answers[first] = red;
  answers[first + 1u] = green;
  answers[first + 2u] = blue;
#ifdef FINE
  for (uint i = 0u; i < 5u; ++i) answers[first + 3u + i] = vec4(second[i], 0.0);
#endif
}
