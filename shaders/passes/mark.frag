// Gives the depth of what rays have found to what is drawn after it, and to the stencil a bit of the mark of each group of instances.

uniform sampler2D surface_mark;  // as cast_surfaces.comp has it
uniform int bit;                 // of the mark; negative for the depth alone
uniform int first_marked;        // the group whose mark is 1
uniform int most_marked;         // the largest mark

void main() {
  vec2 found = texelFetch(surface_mark, ivec2(gl_FragCoord.xy), 0).xy;
  int mark = int(found.y) - first_marked;
  bool marked = mark > 0 && mark <= most_marked && (mark >> max(bit, 0) & 1) == 1;
  if (found.y == 0.0 || (bit >= 0 && !marked)) discard;
  gl_FragDepth = found.x;
}
