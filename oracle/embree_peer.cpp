#include "oracle/embree_peer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "oracle/camera_view.h"
#include "oracle/ray_scene.h"

namespace trueshade::oracle {

/// Rays as an affine function of the pixel, in float: origin = corner + x * right + y * up, and so for the far ends.
struct EmbreePeer::Rays {
  RayScene scene;
  int width, height;
  std::array<float, 3> origin, origin_x, origin_y;  ///< on the near plane
  std::array<float, 3> far, far_x, far_y;           ///< on the far plane
};

namespace {

/// Value at the lower left pixel's centre, and its change per pixel in x and y, of the points of a plane of clip space.
void affine_plane(const View& view, double ndc_z, std::array<float, 3>& at, std::array<float, 3>& dx,
                  std::array<float, 3>& dy) {
  const std::array<double, 3> a = view.world(0.5, 0.5, ndc_z), x = view.world(view.width - 0.5, 0.5, ndc_z),
                              y = view.world(0.5, view.height - 0.5, ndc_z);
  for (size_t k = 0; k < 3; ++k) {
    at[k] = float(a[k]);
    dx[k] = float((x[k] - a[k]) / std::max(1, view.width - 1));
    dy[k] = float((y[k] - a[k]) / std::max(1, view.height - 1));
  }
}

}  // namespace

EmbreePeer::EmbreePeer(const Scene& scene, const Pipeline& pipeline)
    : rays_(new Rays{{scene, false}, pipeline.width, pipeline.height, {}, {}, {}, {}, {}, {}}) {
  const View view = view_of(scene, pipeline);
  affine_plane(view, view.near_z, rays_->origin, rays_->origin_x, rays_->origin_y);
  affine_plane(view, 1.0, rays_->far, rays_->far_x, rays_->far_y);
}

EmbreePeer::~EmbreePeer() = default;

int EmbreePeer::rows() const { return (rays_->height + 3) / 4; }

uint64_t EmbreePeer::trace_row(int row) const {
  const Rays& r = *rays_;
  uint64_t hits = 0;
  for (int column = 0; column < r.width; column += 4) {
    RTCRayHit16 packet;
    for (int i = 0; i < 16; ++i) {
      const float x = float(std::min(column + i % 4, r.width - 1)), y = float(std::min(4 * row + i / 4, r.height - 1));
      std::array<float, 3> origin, direction;
      for (size_t k = 0; k < 3; ++k) {
        origin[k] = r.origin[k] + x * r.origin_x[k] + y * r.origin_y[k];
        direction[k] = r.far[k] + x * r.far_x[k] + y * r.far_y[k] - origin[k];
      }
      packet.ray.org_x[i] = origin[0], packet.ray.org_y[i] = origin[1], packet.ray.org_z[i] = origin[2];
      packet.ray.dir_x[i] = direction[0], packet.ray.dir_y[i] = direction[1], packet.ray.dir_z[i] = direction[2];
      packet.ray.tnear[i] = 0.0f, packet.ray.tfar[i] = 1.0f, packet.ray.time[i] = 0.0f;
      packet.ray.mask[i] = ~0u, packet.ray.flags[i] = 0, packet.ray.id[i] = unsigned(i);
      packet.hit.geomID[i] = packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    r.scene.intersect_coherent(packet);
    for (int i = 0; i < 16; ++i)
      hits += packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID && column + i % 4 < r.width && 4 * row + i / 4 < r.height;
  }
  return hits;
}

}  // namespace trueshade::oracle
