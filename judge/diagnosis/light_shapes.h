#pragma once
// Where a ray from the eye meets the mesh that a light is drawn as. These meshes are closed and convex, so a ray enters
// and leaves each of them once at most: by a front and by a back face, if these lie before the eye.
#include <optional>
#include <vector>

#include "judge/diagnosis/triple.h"
#include "scenes/pipeline/light_mesh.h"

namespace trueshade::oracle {

/// A ray from an origin; places on it are counted in lengths of the direction.
struct Ray {
  Triple3 origin, direction;
};

/// Where a ray enters a mesh and where it leaves it; below 0 behind the origin.
struct Crossing {
  double enters, leaves;
};

/// A light's mesh about the origin, as its faces' planes.
class ConvexMesh {
 public:
  /// Joins triangles of one flat face.
  explicit ConvexMesh(const LightMesh& mesh);
  /// Where the line of a ray crosses the mesh; nothing where it misses. Of a ray that also crosses the sphere within
  /// the mesh, and begins outside the sphere about it, the places are those of the sphere within.
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
  /// Makes the mesh of each extent that is one.
  explicit LightShapes(const LightVolumes& volumes);
  /// How many fragments of the light's mesh the pixel has that shows the ray's direction: as under depth clamp, without
  /// what the grid of the window's vertices moves. 0 to 2; 0 where the light's range is not above 0.
  ///   extent: of the light's drawn_extent(), a mesh
  int fragments(const Light& light, LightExtent extent, const Ray& ray) const;

 private:
  CullFace culled_;
  std::vector<ConvexMesh> meshes_;  ///< in the order of kMeshExtents
};

}  // namespace trueshade::oracle
