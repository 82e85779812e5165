#pragma once
// A second judge of visibility: Embree's rays through the pixel centres, and the true geometry in double around the
// pixels where it and an image disagree.
#include <cstdint>
#include <span>
#include <vector>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

inline constexpr uint32_t kNoInstance = 0xffffffffu;

struct RayHit {
  uint32_t instance = kNoInstance;  ///< index into Scene::instances; kNoInstance: the ray leaves through the far plane
  uint32_t primitive = 0;           ///< triangle in the mesh
  float distance = 0;               ///< from the ray's origin, scene units
  double depth = 1;                 ///< window z of the point hit, before the depth range
  double offset = 0;                ///< pixels from the centre to where the float ray passes at the hit
};

/// First hit from the near plane to the far plane through each pixel centre; row 0 is the bottom of the picture.
/// Rays start at the centre of projection where the camera has one, at the near plane otherwise. Both faces are hit.
/// Memory: Embree's tree a mesh, however often it is instanced. Throws Error(out_of_memory) where Embree fails.
std::vector<RayHit> embree_visibility(const Scene& scene, const Pipeline& pipeline);

/// How far the snap to 1/256 pixel may move an edge: half a subpixel in x and in y, and float clip coordinates; pixels.
inline constexpr double kEdgeReach = 1.0 / 256;
/// What Embree adds: its tests are float, relative to the triangle's distance from the ray's origin; pixels.
inline constexpr double kEmbreeReach = 1.0 / 64;

struct UnexplainedPixel {
  int x = 0, y = 0;                 ///< y up
  uint32_t instance = kNoInstance;  ///< of the image
  uint32_t expected = kNoInstance;  ///< Embree's
  double depth = 0, expected_depth = 0;
};

struct VisibilityReport {
  uint64_t pixels = 0;
  uint64_t disagreements = 0;      ///< another instance, or a depth more than 2^-20 off
  uint64_t embree_mistakes = 0;    ///< of those: Embree's hit is not among the possible surfaces within kEmbreeReach
  uint64_t unexplained_count = 0;  ///< of those: the image's surface is not among the possible surfaces within kEdgeReach
  std::vector<UnexplainedPixel> unexplained;  ///< the first 16
};

/// Judges an image. A pixel is explained when its instance and depth are those of a triangle that reaches within
/// kEdgeReach of the pixel's centre and is not behind one that covers the centre by more than that (by more than both
/// triangles' depth changes over kEdgeReach); the clear value, when no triangle covers the centre by more than that.
///   instances: kNoInstance where nothing is drawn; depths: window z before the depth range; both row 0 at the bottom
/// For depth_func less, no face culling, no depth clamp, the whole image as viewport.
VisibilityReport judge_visibility(const Scene& scene, const Pipeline& pipeline, std::span<const RayHit> hits,
                                  std::span<const uint32_t> instances, std::span<const double> depths);

}  // namespace trueshade::oracle
