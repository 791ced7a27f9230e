// The curved surface that a mesh's vertex normals tell of. Light knows a facet from a curve: a chord through the grain, or a ray that grazes
// it, shows every edge where the flat triangles are taken at their word.

// What a vertex adds for its triangle: interpolate it beside position and normal.
float tangent_plane_offset(vec3 position, vec3 normal) { return dot(normal, position); }

// Half way from the flat triangle to the tangent planes of its corners, sum b_i n_i (p_i - p), which is exact for every quadric to second
// order in the triangle's size (Phong tessellation, Boubekeur and Alexa 2008, equation 3, with alpha = 1/2). Flat triangles with normals of
// their own stay flat. `normal` is interpolated between the corners' unit vectors; where those nearly cancel no curve is known.
vec3 on_curved_surface(vec3 position, vec3 normal, float plane_offset) {
  float rise = 0.5 * (plane_offset - dot(position, normal));
  return position + normal * (rise / max(dot(normal, normal), 0.25));
}
