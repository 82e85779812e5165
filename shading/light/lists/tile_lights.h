#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "raster/light_geometry/light_outlines.h"
#include "shading/light/light_table.h"

namespace trueshade {

/// A light that may reach some pixels, with what tells which, and which of them its geometry covers.
struct ListedLight {
  const LightRow* light;
  float position[3], cut2;  ///< the row's
  uint32_t first;           ///< of its edges or masks in the TileLights
  int16_t crossing;         ///< edges that its cover is inside of; 0: all pixels; kMasked: a mask a block
  bool has_position;        ///< its kind is not `other`
  static constexpr int16_t kMasked = -1;
};
static_assert(sizeof(ListedLight) == 32 && kMostOutlineCorners < 32768);

/// Lights of the tile at work, in scene order, a light as often as it is drawn; side by side what tells whether they
/// reach a box. Kept between tiles to save allocation.
struct TileLights {
  std::vector<ListedLight> light;
  std::vector<float> position[3], cut2;  ///< read by whole vectors: never shorter than `light` and 16 more
  std::vector<TileEdge> edges;
  std::vector<uint16_t> masks;  ///< blocks of a tile, a mask each

  void clear() {
    light.clear();
    edges.clear();
    masks.clear();
  }
  /// A light of the table. One without a position reaches everything: no comparison with its NaN drops it.
  static ListedLight listed(const LightTable& table, uint32_t i, uint32_t first = 0, int16_t crossing = 0) {
    const float x = table.position[0][i];
    return {&table.row[i], {x, table.position[1][i], table.position[2][i]}, table.cut2[i], first, crossing, x == x};
  }
  void add(const LightTable& table, uint32_t i, uint32_t first = 0, int16_t crossing = 0) {
    add(listed(table, i, first, crossing));
  }
  void add(const ListedLight& listed) {
    const size_t i = light.size();
    light.push_back(listed);
    if (cut2.size() < i + 17) {
      for (auto& stream : position) stream.resize(2 * i + 64);
      cut2.resize(2 * i + 64);
    }
    for (int c = 0; c < 3; ++c) position[c][i] = listed.position[c];
    cut2[i] = listed.cut2;
  }
};

/// Of a tile's block, `blocks` of them a row: pixels that the light's geometry covers, bit by bit.
inline unsigned cover_of_block(const TileLights& lights, const ListedLight& listed, int block, int blocks) {
  if (listed.crossing == 0) return 0xFFFF;
  if (listed.crossing == ListedLight::kMasked) return lights.masks[listed.first + size_t(block)];
  return block_mask(std::span(lights.edges).subspan(listed.first, size_t(listed.crossing)), block % blocks * kBlockSize,
                    block / blocks * kBlockSize);
}

}  // namespace trueshade
