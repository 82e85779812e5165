#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

// What `trueshade info` says of a scene, as values, as text and as JSON.
namespace trueshade {

/// A box along the axes of the world.
struct WorldBox {
  glm::dvec3 least, most;
};

/// The least box around all vertices of triangles that are drawn, in f64, without a ground of ours. Of more than
/// 100 million corners a box around the boxes of meshes, which may be larger. Nothing where nothing is drawn.
std::optional<WorldBox> drawn_box(const Scene& scene);

/// Of `render SCENE -o picture.png` in bytes, as --max-memory is held against it.
struct RenderMemory {
  uint64_t process = 0;            ///< what is in memory with the scene
  std::optional<uint64_t> needed;  ///< beside it; nothing of a picture that is drawn in bands, as high as memory allows
  uint64_t limit = 0;
};

/// Counts of a map's materials, in the order of maps_of().
using MapUses = std::array<uint64_t, kMaterialMaps>;

struct SceneFacts {
  std::string hash;  ///< of the scene at time 0
  std::optional<WorldBox> box;
  uint64_t triangles = 0, vertices = 0;                       ///< stored, over all meshes
  std::vector<std::pair<std::string_view, uint64_t>> lights;  ///< how many of each type that there is
  std::vector<MapUses> textures;                              ///< of each texture
  int width = 0, height = 0;                                  ///< of the picture that `memory` is of
  RenderMemory memory;
};

/// Of a scene as it was loaded, which is brought to the time in seconds.
SceneFacts facts_of(Scene& scene, const Pipeline& pipeline, double time);

/// Rows that are read at a glance: lists end after some rows with how many more there are.
std::string facts_text(const SceneFacts& facts, const Scene& scene);
/// All of it, as one JSON object (docs/scenes.md).
std::string facts_json(const SceneFacts& facts, const Scene& scene);

/// A row of what info prints: a name, and from column 22 on its value.
std::string info_row(const std::string& name, const std::string& value);

}  // namespace trueshade
