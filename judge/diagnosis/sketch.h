#pragma once
// Draws meshes at a few pixels, in doubles and without textures. For estimates, which are judged afterwards.
#include <span>
#include <vector>

#include "judge/diagnosis/disagreement.h"
#include "judge/diagnosis/expected_planes.h"

namespace trueshade::oracle {

/// What is seen at a few pixels of a picture, as far as it is drawn.
class Sketch {
 public:
  /// Keeps the places of the pixels. Call clear() before draw().
  Sketch(std::span<const SampledPixel> pixels, const Pipeline& pipeline);

  /// Sets all pixels to the clear depth and no surface.
  void clear(const Pipeline& pipeline);
  /// Draws `mesh` with the instance's transform and material over what is drawn already, by the pipeline's depth test
  /// and culling. Sets object, depth, position and normal of the pixels where it is seen. Call it in the order of
  /// submission.
  void draw(const Scene& scene, const Pipeline& pipeline, const Mesh& mesh, uint32_t instance);
  /// What each pixel shows, in the order of the constructor's pixels.
  std::span<const PlaneValues> pixels() const { return values_; }

 private:
  struct Vertex {
    std::array<double, 4> clip;
    std::array<double, 3> position, normal;
  };
  struct Faces {
    int culled = 0;  ///< the sign of the area that is not drawn
    int turned = 0;  ///< the sign of the area whose normals are turned round
  };
  void draw_triangle(const std::array<const Vertex*, 3>& v, const Faces& faces, const GeometryState& state,
                     double object);
  void cover(size_t pixel, const std::array<double, 3>& weights, const std::array<const Vertex*, 3>& v, double turn,
             const GeometryState& state, double object);

  struct Place {
    double x, y;  ///< window pixels, y up
    uint32_t index;
  };
  std::vector<std::vector<Place>> rows_;  ///< by y up
  std::vector<PlaneValues> values_;
  std::vector<Vertex> vertices_;
  Viewport viewport_;
  UnitNormals unit_normals_ = UnitNormals::vertex;
};

}  // namespace trueshade::oracle
