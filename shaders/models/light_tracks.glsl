// Light that nothing has scattered yet, inside one prototype, as rays leave it there (passes/trace_light.comp): how much of it there is in each
// cell of a lattice, and one of the rays that told so, drawn by how much it told. With every sample the rays are others, and the lattice lies
// elsewhere: pictures take the mean.
//
// What is chosen at compile time, besides what stored_grid.glsl names:
//   TOGETHER             all lights share the cells: each counts by its irradiance
#include "models/pixel_random.glsl"
#include "models/stored_grid.glsl"
#include "physics/prelude.glsl"

const int RAYS_ACROSS = 64;
const int PIECES = 8;        // of a ray: as many times it is met inside, reflected
const int CELLS_A_NODE = 2;  // along each side
const float TRACK_UNIT =
    16384;  // counts of a cell through which light of irradiance 1 passes; a flat grain's edge may gather thousands of times as much
const float LEAST_INSIDE = 0.05;  // of a cell: the light in less of it is hardly ever asked for

ivec3 cells() { return CELLS_A_NODE * ivec3(stored.last_node) + 1; }

vec3 cell_side() { return 1.0 / (float(CELLS_A_NODE) * stored.nodes_a_unit); }

// Where the lattice begins, in cells before the first node (R3, the sequence that low_discrepancy has in two dimensions: Roberts 2018).
vec3 lattice_shift() { return vec3((uvec3(3518319155u, 2882110345u, 2360945575u) * uint(sample_index)) >> 8u) * (1.0 / 16777216.0); }

// Its texel; each light has lattices behind one another, unless they share one.
ivec3 cell_texel(ivec3 cell, int light) {
#ifdef TOGETHER
  return cell;
#else
  return ivec3(cell.xy, cell.z + light * cells().z);
#endif
}

ivec3 cell_at(vec3 place) { return clamp(ivec3(floor((place - stored.lower) / cell_side() + lattice_shift())), ivec3(0), cells() - 1); }

// How much of a cell is inside the grain, whose surface is a plane there.
float share_inside(ivec3 cell) {
  vec3 side = cell_side();
  vec3 middle = stored.lower + (vec3(cell) + 0.5 - lattice_shift()) * side;
  vec3 in_box = clamp(middle, stored.lower, stored.lower + stored.last_node / stored.nodes_a_unit);
  float above = distance_at(in_box) + length(middle - in_box);
  float thickness = (side.x + side.y + side.z) / 3.0;
  return clamp(0.5 - above / thickness, LEAST_INSIDE, 1.0);
}

// What of the light's loss on its way its tracks tell: as much as in the medium that loses least, the similar one.
float tracked_sigma_t() { return min(stored.sigma_t.r, min(stored.sigma_t.g, stored.sigma_t.b)); }

// Each piece is three texels: where it begins and how far light has come till there; where it goes; TOGETHER: the light's irradiance over what it
// counts in the cells, and its density (render/distant_light.glsl).
const int TEXELS_A_PIECE = 3;

ivec3 piece_texel(int ray, int piece, int light) { return ivec3(ray % RAYS_ACROSS, ray / RAYS_ACROSS, TEXELS_A_PIECE * (light * PIECES + piece)); }

// Who left a track, in the lower bits of what is kept of the one that was drawn.
const int WHO_BITS = 19;

uint who(int ray, int piece, int light) { return uint(ray | piece << 12 | light << 15); }

ivec3 texel_of(uint who) { return piece_texel(int(who & 0xfffu), int(who >> 12u & 7u), int(who >> 15u & 15u)); }
