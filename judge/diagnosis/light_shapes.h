#pragma once
// Where a ray from the eye meets the mesh that a light is drawn as. These meshes are closed and convex, so a ray enters
// and leaves each of them once at most: by a front and by a back face, if these lie before the eye.
#include <optional>
#include <vector>

#include "judge/diagnosis/triple.h"
#include "scenes/pipeline/light_mesh.h"

namespace trueshade::oracle {

/// A ray: the point origin + t direction for each t.
struct Ray {
  Triple3 origin, direction;
};

/// The t of a ray at which it enters a mesh, and at which it leaves it; below 0 behind the origin.
struct Crossing {
  double enters, leaves;
};

/// A light's mesh, centred at the origin, as the planes of its faces.
class ConvexMesh {
 public:
  /// Triangles of one flat face become one plane.
  explicit ConvexMesh(const LightMesh& mesh);
  /// Where the line of a ray crosses the mesh; nothing where it misses. For speed, a ray that begins outside the mesh's
  /// circumsphere and crosses its insphere gets the places where it crosses the insphere.
  std::optional<Crossing> crossed_by(const Ray& ray) const;

 private:
  struct Face {
    Triple3 normal;  ///< outward, of unit length
    double offset;   ///< of the face's plane from the origin, along its normal
  };
  std::vector<Face> faces_;
  double inner_ = 0, outer_ = 0;  ///< radii of spheres about the origin, in the mesh and about it; inner_ 0: none is
};

/// The meshes that a pipeline's lights are drawn as.
class LightShapes {
 public:
  /// Makes the unit mesh of each extent that is drawn as a mesh.
  explicit LightShapes(const LightVolumes& volumes);
  /// How many fragments of the light's mesh cover the pixel that the ray goes through: 0 to 2, counted as under depth
  /// clamp, and without what snapping to the window's grid moves. 0 where the light's range is not above 0.
  ///   extent: the light's drawn_extent(), one that is drawn as a mesh
  int fragments(const Light& light, LightExtent extent, const Ray& ray) const;

 private:
  CullFace culled_;
  std::vector<ConvexMesh> meshes_;  ///< in the order of kMeshExtents
};

}  // namespace trueshade::oracle
