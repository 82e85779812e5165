#include "oracle/ray_scene.h"

#include <algorithm>

#include "core/error.h"

namespace trueshade::oracle {

namespace {

[[noreturn]] void fail() {
  throw Error(ErrorKind::out_of_memory, "embree", "building its tree failed", "give it more memory or a smaller scene");
}

}  // namespace

RayScene::RayScene(const Scene& scene, bool robust) : device_(rtcNewDevice(nullptr)) {
  if (device_ == nullptr) fail();
  top_ = rtcNewScene(device_);
  rtcSetSceneFlags(top_, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
  const RTCSceneFlags mesh_flags = robust ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT : RTC_SCENE_FLAG_NONE;
  for (const Mesh& mesh : scene.meshes) add_mesh(mesh, mesh_flags);
  for (uint32_t i = 0; i < scene.instances.size(); ++i) add_instance(scene.instances[i], i);
  rtcCommitScene(top_);
  if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) fail();
}

RayScene::~RayScene() {
  rtcReleaseScene(top_);
  for (const RTCScene mesh : meshes_) rtcReleaseScene(mesh);
  rtcReleaseDevice(device_);
}

void RayScene::intersect(RTCRayHit& ray) const {
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect1(top_, &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(top_, &context, &ray);
#endif
}

void RayScene::intersect_coherent(RTCRayHit16& rays) const {
  alignas(64) int valid[16];
  std::fill(std::begin(valid), std::end(valid), -1);
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect16(valid, top_, &rays, &arguments);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid, top_, &context, &rays);
#endif
}

void RayScene::add_mesh(const Mesh& mesh, RTCSceneFlags flags) {
  const RTCScene scene = rtcNewScene(device_);
  meshes_.push_back(scene);
  rtcSetSceneFlags(scene, flags);
  const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), mesh.vertex_count()));
  auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(uint32_t), mesh.triangle_count()));
  if (vertices == nullptr || indices == nullptr) fail();
  for (size_t v = 0; v < mesh.vertex_count(); ++v)
    for (size_t k = 0; k < 3; ++k) vertices[3 * v + k] = mesh.position[k][v];
  std::copy(mesh.indices.begin(), mesh.indices.end(), indices);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
}

void RayScene::add_instance(const Instance& instance, uint32_t id) {
  const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, meshes_[instance.mesh]);
  float columns[12];
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 3; ++r) columns[3 * c + r] = instance.world_from_object[c][r];
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(top_, geometry, id);
  rtcReleaseGeometry(geometry);
}

}  // namespace trueshade::oracle
