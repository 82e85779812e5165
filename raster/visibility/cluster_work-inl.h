// One cluster of a tile, and the scratch of drawing it. Included once per SIMD target.
#if defined(TRUESHADE_RASTER_VISIBILITY_CLUSTER_WORK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_CLUSTER_WORK_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_CLUSTER_WORK_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_CLUSTER_WORK_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/triangles/vertex_stage-inl.h"
#include "raster/visibility/alpha_test-inl.h"
#include "raster/visibility/draw_order-inl.h"
#include "raster/visibility/hierarchical_depth-inl.h"
#include "raster/visibility/visibility.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A cluster of a tile's list.
struct ListedCluster {
  const TileDraws& in;
  const TileRect& rect;
  const ListedDraw& draw;
  const Instance& instance;
  const InstanceTransform& transform;
  const GeometryState& state;  ///< with the faces of the instance
  const ClusteredMesh& mesh;
  const Cluster& cluster;

  HWY_INLINE ListedCluster(const TileDraws& draws, const TileRect& tile, const ListedDraw& listed)
      : in(draws),
        rect(tile),
        draw(listed),
        instance(draws.scene.instances[listed.instance]),
        transform(draws.view.instances[listed.instance]),
        state(draws.view.faces.of(listed.instance)),
        mesh(draws.clusters.meshes[instance.mesh]),
        cluster(mesh.clusters[listed.cluster]) {}
};

/// Clip coordinates of a cluster's vertices.
struct ClipVertices {
  alignas(64) float clip[4][kClusterVertices];
};

/// Scratch of a cluster: on the stack of a tile, not of each of its clusters.
struct ClusterWork {
  static constexpr size_t kTriangles = 144;  ///< of vectors that end behind the last triangle
  WindowVertices vertices;
  ClipVertices clip;                         ///< where some vertex needs clipping
  VisibleBlocks visible;                     ///< where none does
  AlphaTest alpha;                           ///< where the cluster's material has one
  alignas(64) uint8_t triangle[kTriangles];  ///< those that are to be drawn
};
static_assert(kClusterTriangles + 16 <= ClusterWork::kTriangles);

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
