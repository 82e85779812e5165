#pragma once
// Where a ray from the eye meets the mesh that a light is drawn as. These meshes are closed and convex, so a ray enters
// and leaves each of them once at most: by a front and by a back face, if these lie before the eye.
#include <optional>
#include <vector>

#include "judge/diagnosis/triple.h"
#include "scenes/pipeline/light_mesh.h"

namespace trueshade::oracle {

/// From an origin, in lengths of the direction.
struct Ray {
  Triple3 origin, direction;
};
struct Crossing {
  double enters, leaves;
};

/// A light's mesh about the origin, as its faces' planes.
class ConvexMesh {
 public:
  explicit ConvexMesh(const LightMesh& mesh);
  std::optional<Crossing> crossed_by(const Ray& ray) const;

 private:
  struct Face {
    Triple3 normal;  ///< outward, of unit length
    double offset;   ///< of the face's plane from the origin, along its normal
  };
  std::vector<Face> faces_;
  double inner_ = 0, outer_ = 0;  ///< radii of spheres about the origin, in the mesh and about it; inner_ 0: none is
};

/// The meshes of a pipeline's lights.
class LightShapes {
 public:
  explicit LightShapes(const LightVolumes& volumes);
  /// How many fragments of the light's mesh the pixel has that shows the ray's direction: as under depth clamp, without
  /// what the grid of the window's vertices moves.
  ///   extent: of the light's drawn_extent(), a mesh
  int fragments(const Light& light, LightExtent extent, const Ray& ray) const;

 private:
  CullFace culled_;
  std::vector<ConvexMesh> meshes_;  ///< in the order of kMeshExtents
};

}  // namespace trueshade::oracle
