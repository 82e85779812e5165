#include "shading/output/view_distance.h"

#include <cmath>

#include "raster/view.h"

namespace trueshade {
namespace {

/// Unit vector along which distance from the eye grows in depth: what divides x and y in a perspective, else z.
glm::vec3 view_axis(const Scene& scene, const Pipeline& pipeline) {
  const Matrix4 m = clip_from_world(scene.camera, 1.0, clip_range(pipeline.geometry));
  for (const size_t row : {size_t(3), size_t(2)}) {
    const double x = m[row], y = m[4 + row], z = m[8 + row], length2 = (x * x + y * y) + z * z;
    if (!(length2 > 0.0)) continue;
    const double inverse = 1.0 / std::sqrt(length2);
    return {float(x * inverse), float(y * inverse), float(z * inverse)};
  }
  return glm::vec3(0.0f);
}

}  // namespace

ViewDistance::ViewDistance(const Scene& scene, const Pipeline& pipeline)
    : axis_(view_axis(scene, pipeline)), eye_(scene.camera.eye) {}

void ViewDistance::measure(const SurfaceTile& surface, int pixels, float* __restrict out) const {
  const float *const x = surface.plane[kPosition], *const y = surface.plane[kPosition + 1],
                     *const z = surface.plane[kPosition + 2];
  for (int first = 0; first < pixels; first += kBlockPixels)
    for (int i = first; i < first + kBlockPixels; ++i)
      out[i] = (axis_.x * (x[i] - eye_.x) + axis_.y * (y[i] - eye_.y)) + axis_.z * (z[i] - eye_.z);
}

}  // namespace trueshade
