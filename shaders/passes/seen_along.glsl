// The rays that a projection sees along, as render::PixelRays has them.

// Where a pixel begins, near, and ends, far, in homogeneous coordinates from the anchor: what its x and its y, in normalised device coordinates, add
// to what all have.
uniform vec4 along_x;
uniform vec4 along_y;
uniform vec4 near_of_all;
uniform vec4 far_of_all;
uniform vec2 pixel_scale;
uniform vec2 pixel_offset;
uniform vec4 cast_ball;  // of all that can be met: rays begin before it, so that the way there costs no precision

struct SeenAlong {
  vec3 origin;
  vec3 direction;  // unit length
  float farthest;
};

SeenAlong seen_along(vec2 pixel) {
  vec2 place = pixel * pixel_scale + pixel_offset;
  vec4 across = place.x * along_x + place.y * along_y;
  vec4 from = across + near_of_all;
  vec4 to = across + far_of_all;
  vec3 origin = from.xyz / from.w;
  vec3 way = to.xyz / to.w - origin;
  float farthest = length(way);
  vec3 direction = way / farthest;
  float ahead = max(dot(cast_ball.xyz - origin, direction) - cast_ball.w, 0.0);
  return SeenAlong(origin + ahead * direction, direction, farthest - ahead);
}
