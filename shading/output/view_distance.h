#pragma once
#include <glm/vec3.hpp>

#include "raster/surfaces/surfaces.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// What the plane `Z` holds: the distance of the stored position along the view axis (docs/views.md).
class ViewDistance {
 public:
  ViewDistance(const Scene& scene, const Pipeline& pipeline);

  /// Of a tile's pixels; of those without a surface it means nothing. Needs FpScope.
  void measure(const SurfaceTile& surface, int pixels, float* out) const;

 private:
  glm::vec3 axis_, eye_;
};

}  // namespace trueshade
