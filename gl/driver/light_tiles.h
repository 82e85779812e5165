#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// Lights by tile, as a clever user of OpenGL bins them on the CPU: a tile's list leaves out lights that reach nothing
/// between its least and greatest depth, and, where only faces that look at a light are lit, those that none looks at.
struct LightTiles {
  int tile = 32, columns = 0, rows = 0;  ///< pixels a side; tiles, row 0 at the bottom
  std::vector<uint32_t> first, count;    ///< a tile: where its records start, in lights, and how many
  std::vector<float> records;            ///< copies of light_records(), a tile's together, in light order
};

/// `depth`: the stored depths, row 0 at the bottom, width * height; those equal to clear_depth hold no surface.
/// `normals`: RGBA halves in the same order, or none.
LightTiles light_tiles(const Scene& scene, const Pipeline& pipeline, std::span<const float> depth,
                       std::span<const uint16_t> normals, int tile);

}  // namespace trueshade::oracle
