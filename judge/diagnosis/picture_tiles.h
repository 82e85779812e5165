#pragma once
// Tiles of a picture that look stale, and the lists of lights that a tiled renderer makes.
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "judge/diagnosis/light_pass.h"
#include "judge/stages/captured_surface.h"
#include "judge/stages/verdict.h"

namespace trueshade::oracle {

/// Tiles of 8, 16, 32 and 64 pixels that are wrong while nearly all others are right, as tiles of an earlier frame are.
class StaleTiles {
 public:
  /// Finds these tiles, for each of the four sides.
  explicit StaleTiles(const StageVerdict& stage);

  /// Whether the pixel is in such a tile of that side (8, 16, 32 or 64).
  bool hold_anything(int side, int x, int y) const;
  /// What it costs to suppose that these tiles of that side are stale: more for many tiles, and for tiles with many
  /// right pixels. There are none where wrong pixels are spread over the picture.
  double cost(int side) const;

 private:
  struct Tiles {
    std::vector<uint8_t> stale;  ///< by tile
    int count = 0;
    double filled = 0;  ///< share of their pixels that are not as they should be
  };
  int width_;
  std::map<int, Tiles> by_side_;
};

/// The bounding boxes of the surfaces in tiles, and the lists of lights that reach these boxes.
class TileLists {
 public:
  /// Makes the boxes of tiles of 8, 16, 32 and 64 pixels, from the captured surface of each pixel.
  TileLists(const CapturedSurface& surfaces, int width, int height);

  static constexpr int kOwn = 8;  ///< as `from`: the pixel's own tile
  /// Whether each light of the pass is in the light list of a tile: its range reaches the tile's box. Lights without a
  /// place or an end are in every list; other lights are in no list of a tile without a surface.
  ///   from: which of the eight neighbours of the pixel's tile, or kOwn; at the picture's edge the tile nearest to it
  ///   most: how many lights a list holds, the first ones
  std::vector<uint8_t> list(const LightPass& pass, int side, int from, int most, int x, int y) const;

 private:
  struct Box {
    std::array<double, 3> low, high;
    bool empty = true;
  };
  int width_, height_;
  std::map<int, std::vector<Box>> boxes_;  ///< by side
};

}  // namespace trueshade::oracle
