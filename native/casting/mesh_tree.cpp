// Hands a mesh's triangles to Embree.
#include "casting/mesh_tree.h"

#include <cstring>
#include <glm/geometric.hpp>
#include <vector>

#include "base/error.h"
#include "casting/device.h"

namespace mesograin::casting {

RTCDevice embree_device() {
  // Never released: Blender ends in no order that one could rely on.
  static RTCDevice device = [] {
    RTCDevice made = rtcNewDevice("set_affinity=0");
    const bool wide = made != nullptr && rtcGetDeviceProperty(made, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0;
    return wide ? made : nullptr;
  }();
  return device;
}

bool available() { return embree_device() != nullptr; }

MeshTree::MeshTree(const scene::Mesh& mesh)
    : half_(0.5 * (glm::dvec3(mesh.upper()) - glm::dvec3(mesh.lower()))), scene_(nullptr) {
  RTCDevice device = embree_device();
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                           mesh.positions().size());
  void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3),
                                          mesh.triangles().size());
  if (vertices == nullptr || indices == nullptr) {
    rtcReleaseGeometry(geometry);
    throw Error("A mesh of {} triangles does not fit into memory for casting rays at it; simplify it.",
                mesh.triangles().size());
  }
  const glm::dvec3 middle = 0.5 * (glm::dvec3(mesh.lower()) + glm::dvec3(mesh.upper()));
  std::vector<glm::vec3> centred;
  centred.reserve(mesh.positions().size());
  for (const glm::vec3& position : mesh.positions()) centred.emplace_back(glm::dvec3(position) - middle);
  std::memcpy(vertices, centred.data(), centred.size() * sizeof(glm::vec3));
  std::memcpy(indices, mesh.triangles().data(), mesh.triangles().size() * sizeof(glm::uvec3));
  rtcCommitGeometry(geometry);
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  scene_ = scene;
}

MeshTree::~MeshTree() { rtcReleaseScene(static_cast<RTCScene>(scene_)); }

}  // namespace mesograin::casting
