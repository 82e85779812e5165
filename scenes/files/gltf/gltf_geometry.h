#pragma once
#include <vector>

#include "scenes/scene.h"

namespace trueshade {

/// What a scene draws, as geometry that an object of another scene stands for: a mesh a material, in the order in which
/// the materials are first drawn.
struct GltfGeometry {
  struct Part {
    Mesh mesh;
    uint32_t material;  ///< index into `materials`
  };
  std::vector<Part> parts;
  std::vector<Material> materials;
  std::vector<Texture> textures;  ///< that the materials read
};

/// Takes a scene's instances together, in its world space at its time: f64, rounded once. An instance that stands where
/// its mesh is keeps its bits; one that mirrors has its triangles' corners turned round. Streams that only some meshes
/// have are filled as the renderer reads absent ones: 0, colours 1.
GltfGeometry geometry_of(Scene&& scene);

}  // namespace trueshade
