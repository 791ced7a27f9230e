// Rays through the instances of a heap and through what stands alone, followed on the device: a tree over all instances, whose leaves are the meshes'
// trees. A mesh is met as coarse as the picture allows, or in full.
//
// What is chosen at compile time:
//   OCCLUSION     it is only asked whether anything is met
//   LONE_MESHES   what stands alone is met too
#include "render/tree_node.glsl"
#include "scene/instances.glsl"

layout(std430, binding = TREE_BINDING) readonly buffer Tree { TreeNode tree[]; };
layout(std430, binding = MESH_TREES_BINDING) readonly buffer MeshTrees { TreeNode mesh_trees[]; };
layout(std430, binding = MESH_CORNERS_BINDING) readonly buffer MeshCorners { uint mesh_corners[]; };     // three a triangle
layout(std430, binding = MESH_VERTICES_BINDING) readonly buffer MeshVertices { vec4 mesh_vertices[]; };  // two each; see casting::FlatMesh

// First of each mesh that stands somewhere: x: where its levels of detail begin in this list; y: how many it has; z: no point is farther from its
// middle; w: 1 if a part of it may stand in another's light. Then of each level, the finest first: x: its tree's root; y: how far it is from the
// mesh, of the mesh's extent.
layout(std430, binding = PLACED_MESHES_BINDING) readonly buffer PlacedMeshes { vec4 placed_meshes[]; };

// Three rows of its transform as of an instance; then x: the radius of its ball; y: the number by which shadows know it; z: 1 if a part of it may
// stand in another's light; w: which of the placed meshes it is.
layout(std430, binding = LONE_MESHES_BINDING) readonly buffer LoneMeshes { vec4 lone_meshes[]; };

uniform int instance_count;
uniform int lone_count;
uniform vec4 detail_depth;        // how deep in the picture a place is, from the anchor
uniform float detail_pixels;      // how many a length of one takes at depth one
uniform float most_detail_error;  // in pixels

const float NEVER = 1e30;
const int NOBODY = -1;

struct Ray {
  vec3 origin;
  vec3 direction;
  float farthest;  // in lengths of the direction
  int from;        // by which number shadows know what it starts from, or nobody
  float own;       // if positive it can meet that too, but no nearer than this
};

struct Hit {
  int number;    // of the instance; those of what stands alone follow; or nobody
  int mesh;      // which of the placed ones
  int triangle;  // of the meshes'
  float second;  // barycentric coordinates: of its second corner
  float third;
};

// The inverse of an instance's transform.
struct ToMesh {
  mat3 turn;
  vec3 place;
};

// Nodes, and instances as minus one minus their numbers, above the mesh of each. The trees of the scene and of a mesh are walked one inside the
// other. An NVIDIA H200 takes 1.6 times as long where this is shared memory, and four times as long where it also holds how far away each is.
const int MOST_WAITING = MOST_DEPTH_OF_SCENE + 1 + MOST_DEPTH_OF_MESH;
int waiting[MOST_WAITING];

void put_off(int what, inout int top) { waiting[top++] = what; }

int take(inout int top) { return waiting[--top]; }

float apart_from_zero(float value) { return abs(value) > 1e-30 ? value : (value < 0.0 ? -1e-30 : 1e-30); }

vec3 inverse_of(vec3 direction) { return 1.0 / vec3(apart_from_zero(direction.x), apart_from_zero(direction.y), apart_from_zero(direction.z)); }

// Where a ray enters a box; NEVER if it does not between these distances. It leaves a little later than rounding would have it (Ize, "Robust BVH Ray
// Traversal", 2013).
float entry(vec3 lower, vec3 upper, vec3 origin, vec3 inverse_direction, float near, float far) {
  vec3 a = (lower - origin) * inverse_direction, b = (upper - origin) * inverse_direction;
  vec3 first = min(a, b), last = max(a, b);
  float enters = max(max(first.x, first.y), max(first.z, near));
  float leaves = min(min(last.x, last.y), min(last.z, far)) * 1.0000004;
  return enters <= leaves ? enters : NEVER;
}

// The tests of the three edges agree between triangles that share one, so that no ray slips through (Davidovic et al., "3D Rasterization: A Bridge
// between Rasterization and Ray Casting", 2012).
bool meets_triangle(int triangle, vec3 origin, vec3 direction, float near, inout float far, inout Hit hit) {
  uint first = 3u * uint(triangle);
  vec3 a = mesh_vertices[2u * mesh_corners[first]].xyz - origin;
  vec3 b = mesh_vertices[2u * mesh_corners[first + 1u]].xyz - origin;
  vec3 c = mesh_vertices[2u * mesh_corners[first + 2u]].xyz - origin;
  vec3 along_ca = c - a, along_ab = a - b, along_bc = b - c;
  float of_b = dot(cross(along_ca, c + a), direction);
  float of_c = dot(cross(along_ab, a + b), direction);
  float of_a = dot(cross(along_bc, b + c), direction);
  if (min(min(of_a, of_b), of_c) < 0.0 && max(max(of_a, of_b), of_c) > 0.0) return false;
  vec3 normal = cross(along_ab, along_ca);
  float slope = dot(normal, direction);
  if (slope == 0.0) return false;
  float distance_along = dot(normal, a) / slope;
  if (!(distance_along > near && distance_along < far)) return false;
  far = distance_along;
  float sum = of_a + of_b + of_c;
  hit.triangle = triangle;
  hit.second = of_b / sum;
  hit.third = of_c / sum;
  return true;
}

// `waiting` is free from `top` on.
bool meets_mesh(int root, vec3 origin, vec3 direction, float near, inout float far, inout Hit hit, int top) {
  vec3 inverse_direction = inverse_of(direction);
  bool met = false;
  int bottom = top;
  int node = root;
  while (true) {
    TreeNode of = mesh_trees[node];
    float first = entry(of.first_lower.xyz, of.first_upper.xyz, origin, inverse_direction, near, far);
    float second = entry(of.second_lower.xyz, of.second_upper.xyz, origin, inverse_direction, near, far);
    for (int i = 0; i < 2; ++i) {
      int which = int(i == 0 ? of.first_lower.w : of.second_lower.w);
      if ((i == 0 ? first : second) >= NEVER || which >= 0) continue;
      int count = int(i == 0 ? of.first_upper.w : of.second_upper.w);
      for (int j = 0; j < count; ++j)
        if (meets_triangle(j - which - 1, origin, direction, near, far, hit)) {
          met = true;
#ifdef OCCLUSION
          return true;
#endif
        }
    }
    bool into_first = first < NEVER && of.first_lower.w >= 0.0, into_second = second < NEVER && of.second_lower.w >= 0.0;
    if (into_first && into_second) {
      bool first_is_nearer = first <= second;
      put_off(int(first_is_nearer ? of.second_lower.w : of.first_lower.w), top);
      node = int(first_is_nearer ? of.first_lower.w : of.second_lower.w);
    } else if (into_first || into_second) {
      node = int(into_first ? of.first_lower.w : of.second_lower.w);
    } else {
      if (top == bottom) return met;
      node = take(top);
    }
  }
}

ToMesh to_mesh(mat3 linear, vec3 place) {
  vec3 a = vec3(linear[0].x, linear[1].x, linear[2].x), b = vec3(linear[0].y, linear[1].y, linear[2].y),
       c = vec3(linear[0].z, linear[1].z, linear[2].z);
  vec3 bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  return ToMesh(mat3(bc, ca, ab) / dot(a, bc), place);
}

// A bound of how much a length grows.
float largest_stretch(mat3 linear) {
  mat3 squared = transpose(linear) * linear;
  vec3 sums = abs(squared[0]) + abs(squared[1]) + abs(squared[2]);
  return sqrt(max(sums.x, max(sums.y, sums.z)));
}

// As render::Details chooses it.
int root_of(int mesh, mat3 linear, vec3 place) {
  vec4 placed = placed_meshes[mesh];
  int first = int(placed.x);
  float depth = dot(detail_depth.xyz, place) + detail_depth.w;
  float across = depth > 0.0 ? 2.0 * placed.z * largest_stretch(linear) * detail_pixels / depth : 1e6;
  int level = int(placed.y) - 1;
  while (level > 0 && placed_meshes[first + level].y * across > most_detail_error) --level;
  return int(placed_meshes[first + level].x);
}

bool meets_placed(int number, int known_as, int mesh, mat3 linear, vec3 place, inout Ray ray, inout Hit hit, int top) {
  float near = 0.0;
  if (known_as == ray.from) {
    near = ray.own;
    if (!(near > 0.0)) return false;
  }
  ToMesh inside = to_mesh(linear, place);
  if (!meets_mesh(root_of(mesh, linear, place), inside.turn * (ray.origin - place), inside.turn * ray.direction, near, ray.farthest, hit, top))
    return false;
  hit.number = number;
  hit.mesh = mesh;
  return true;
}

// Moves the ray's end to what it meets first.
bool meets_instance(inout Ray ray, inout Hit hit) {
  vec3 inverse_direction = inverse_of(ray.direction);
  bool met = false;
  int top = 0;
  int node = 0;
  int mesh = 0;  // of an instance
  while (true) {
    if (node < 0) {
      int number = -node - 1;
      Placement placement = placement_of(number);
      if (meets_placed(number, number, mesh, placement.linear, placement.place, ray, hit, top)) {
        met = true;
#ifdef OCCLUSION
        return true;
#endif
      }
    } else {
      TreeNode of = tree[node];
      float first = entry(of.first_lower.xyz, of.first_upper.xyz, ray.origin, inverse_direction, 0.0, ray.farthest);
      float second = entry(of.second_lower.xyz, of.second_upper.xyz, ray.origin, inverse_direction, 0.0, ray.farthest);
      if (first < NEVER || second < NEVER) {
        bool into_first = first <= second;
        node = int(into_first ? of.first_lower.w : of.second_lower.w);
        mesh = int(into_first ? of.first_upper.w : of.second_upper.w);
        if (max(first, second) < NEVER) {
          int later = int(into_first ? of.second_lower.w : of.first_lower.w);
          if (later < 0) put_off(int(into_first ? of.second_upper.w : of.first_upper.w), top);
          put_off(later, top);
        }
        continue;
      }
    }
    if (top == 0) return met;
    node = take(top);
    if (node < 0) mesh = take(top);
  }
}

#ifdef LONE_MESHES
mat3 linear_of(vec4 x, vec4 y, vec4 z) { return transpose(mat3(x.xyz, y.xyz, z.xyz)); }

bool meets_lone(inout Ray ray, inout Hit hit) {
  bool met = false;
  for (int lone = 0; lone < lone_count; ++lone) {
    vec4 x = lone_meshes[4 * lone], y = lone_meshes[4 * lone + 1], z = lone_meshes[4 * lone + 2], about = lone_meshes[4 * lone + 3];
    if (meets_placed(instance_count + lone, int(about.y), int(about.w), linear_of(x, y, z), vec3(x.w, y.w, z.w), ray, hit, 0)) {
      met = true;
#ifdef OCCLUSION
      return true;
#endif
    }
  }
  return met;
}
#endif
