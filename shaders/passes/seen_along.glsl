// The rays that a projection sees along, as render::PixelRays has them.

// Where a pixel begins and ends, near and far, in homogeneous coordinates from the anchor: of a pixel's x and y, in normalised device coordinates,
// and of neither.
uniform vec4 near_x, near_y, near_of_all;
uniform vec4 far_x, far_y, far_of_all;
uniform vec2 pixel_scale, pixel_offset;
uniform vec4 cast_ball;  // of all that can be met: rays begin before it, so that the way there costs no precision

struct SeenAlong {
  vec3 origin;
  vec3 direction;  // unit length
  float farthest;
};

SeenAlong seen_along(vec2 pixel) {
  vec2 place = pixel * pixel_scale + pixel_offset;
  vec4 from = place.x * near_x + place.y * near_y + near_of_all;
  vec4 to = place.x * far_x + place.y * far_y + far_of_all;
  vec3 origin = from.xyz / from.w;
  vec3 way = to.xyz / to.w - origin;
  float farthest = length(way);
  vec3 direction = way / farthest;
  float ahead = max(dot(cast_ball.xyz - origin, direction) - cast_ball.w, 0.0);
  return SeenAlong(origin + ahead * direction, direction, farthest - ahead);
}
