#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "raster/clusters/clusters.h"
#include "scenes/scene.h"

namespace trueshade {

/// A scene, and the clusters of its meshes where they come from a cache file or went into one.
struct CachedScene {
  Scene scene;
  std::unique_ptr<ClusteredScene> clusters;  ///< null: not made yet
  std::vector<uint8_t> is_wound{};           ///< is_wound_by_normals() of each mesh, with the clusters
  std::string note{};                        ///< why there is no cache file, a sentence without full stop; empty
};

/// The scene `spec` of load_scene() with these limits and parts, from the cache file in `folder` if there is one that
/// was made of the same: the same files by size, times and inode, the same program and libraries, limits not above
/// these. Meshes, clusters and textures are then mapped, and read when they are needed; ClusteredScene::source checks
/// them. Otherwise `load`, which is load_scene() with an ImageDecoder, reads the scene, and the file is made or
/// replaced, whole or not at all. Makes the folder. Error(bad_input) for a folder that other users can write to;
/// Error(io) for one that cannot be made; those of `load`.
CachedScene cached_scene(const std::string& folder, const std::string& spec, const SceneLimits& limits,
                         const SceneParts& parts, const std::function<Scene()>& load);

/// Checks all that a scene's file has, for what reads more than frames do. Error(io).
void check_all(const CachedScene& cached);

}  // namespace trueshade
