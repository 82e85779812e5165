#pragma once
// What Embree makes of a scene. Seen by those who link Embree alone.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace trueshade::oracle {

/// Owns Embree's trees of one scene: one a mesh, however often it is instanced, and one of instances.
/// Throws Error(out_of_memory) where Embree fails.
class RayScene {
 public:
  /// `robust`: Embree's slower tests that miss no shared edge; what the judge needs and a benchmark does not.
  RayScene(const Scene& scene, bool robust);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  void intersect(RTCRayHit& ray) const;
  /// Sixteen rays that start together and run alike; all lanes are valid.
  void intersect_coherent(RTCRayHit16& rays) const;

 private:
  void add_mesh(const Mesh& mesh, RTCSceneFlags flags);
  void add_instance(const Instance& instance, uint32_t id);

  RTCDevice device_;
  RTCScene top_ = nullptr;
  std::vector<RTCScene> meshes_;
};

}  // namespace trueshade::oracle
