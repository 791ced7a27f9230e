// A node of a tree over boxes, with the boxes of its two children. Lower corners' w: which node a child is; of a leaf, minus one minus the first
// thing in it. Upper corners' w: how many things are in a leaf, of meshes' trees; which mesh stands there, of a scene's. All are whole numbers.
const int MOST_DEPTH_OF_SCENE = 44;  // no way from the root to a leaf has more nodes
const int MOST_DEPTH_OF_MESH = 30;

struct TreeNode {
  vec4 first_lower;
  vec4 first_upper;
  vec4 second_lower;
  vec4 second_upper;
};
