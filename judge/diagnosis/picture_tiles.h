#pragma once
// Tiles of a picture: those that stand out, and the lists of lights that tiles have.
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "judge/diagnosis/light_pass.h"
#include "judge/stages/captured_surface.h"
#include "judge/stages/verdict.h"

namespace trueshade::oracle {

/// Tiles of 8, 16, 32 and 64 pixels that are not as they should be, where nearly all others are.
class StaleTiles {
 public:
  /// Finds the tiles that stand out, of each side.
  explicit StaleTiles(const StageVerdict& stage);

  /// Whether the pixel is in a tile of that side, which is 8, 16, 32 or 64, that stands out.
  bool hold_anything(int side, int x, int y) const;
  /// What it costs to suppose that the tiles of that side which stand out are stale: more for many tiles, and for tiles
  /// that are mostly as they should be. Nothing stands out where pixels everywhere are not as they should be.
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

/// Boxes about the surfaces of tiles, of which lists of lights are made.
class TileLists {
 public:
  /// Makes the boxes of tiles of 8, 16, 32 and 64 pixels, from the surface of each pixel.
  TileLists(const CapturedSurface& surfaces, int width, int height);

  static constexpr int kOwn = 8;  ///< as `from`: the pixel's own tile
  /// Whether each light of the pass is in the list of the tile beside the pixel's: lights whose range reaches its box.
  /// Lights without a place or an end are in every list, others in none of a tile without a surface.
  ///   from: which of its eight neighbours, or kOwn; at the picture's edge the tile nearest to it
  ///   most: lights that a list holds, the first ones
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
