// Where each storage buffer is bound: the same numbers in C++ (native/render/device_layout.h).

const int DISTANT_LIGHTS_BINDING = 0;
const int LIGHT_FRAMES_BINDING = 1;
const int INSTANCES_BINDING = 2;
const int SELECTED_BINDING = 3;
const int LIGHT_MAP_LAYERS_BINDING = 4;
const int SHADOW_VIEWS_BINDING = 5;
const int LOCAL_LIGHTS_BINDING = 6;
const int LOCAL_RANDOMS_BINDING = 7;
const int HEAP_LIGHT_BINDING = 8;
const int WALL_LIGHT_BINDING = 9;
const int TREE_BINDING = 10;
const int MESH_TREES_BINDING = 11;
const int MESH_CORNERS_BINDING = 12;
const int MESH_VERTICES_BINDING = 13;
const int PLACED_MESHES_BINDING = 14;
const int LONE_MESHES_BINDING = 15;

// Where links are summed, nothing else is bound.
const int LINKS_BINDING = 0;
const int FIRST_LINKS_BINDING = 1;
const int SENT_BINDING = 2;
const int ANSWERS_BINDING = 3;
const int SENDERS_BINDING = 4;
const int RECEIVED_BINDING = 5;
