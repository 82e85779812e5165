#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// The lights of each tile, binned on the CPU as a good OpenGL renderer would. A tile's list leaves out lights that
/// reach nothing between its least and greatest depth; where only surfaces that face a light are lit, also lights that
/// no surface faces.
struct LightTiles {
  int tile = 32, columns = 0, rows = 0;  ///< pixels a side; tiles, row 0 at the bottom
  std::vector<uint32_t> first, count;    ///< of each tile: where its records start, counted in lights, and how many it
                                         ///< has
  std::vector<float> records;            ///< copies of light_records(), a tile's together, in light order
};

/// Bins the scene's lights.
///   depth:   the stored depths, row 0 at the bottom, width * height; those equal to clear_depth hold no surface
///   normals: RGBA halves in the same order; or empty: not known
///   tile:    pixels a side
LightTiles light_tiles(const Scene& scene, const Pipeline& pipeline, std::span<const float> depth,
                       std::span<const uint16_t> normals, int tile);

}  // namespace trueshade::oracle
