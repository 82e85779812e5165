#include "judge/diagnosis/picture_tiles.h"

#include <algorithm>
#include <cmath>

#include "core/threads/parallel_for.h"

namespace trueshade::oracle {

namespace {

constexpr int kLeastTile = 8;
constexpr int kNeighbours[9][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}, {0, 0}};

bool is_left_out(const StageVerdict& stage, int x, int y) {
  return stage.classes[size_t(y) * size_t(stage.width) + size_t(x)] == PixelClass::left_out;
}

/// Whether a pixel is a violation, or stored as another legal neighbour.
bool is_odd(const StageVerdict& stage, int x, int y) {
  const PixelClass c = stage.classes[size_t(y) * size_t(stage.width) + size_t(x)];
  return c == PixelClass::violation || c == PixelClass::store_2;
}

/// Whether of the pixels just outside these tiles far fewer are odd than of those just inside.
bool ends_sharply(const StageVerdict& stage, const std::vector<uint8_t>& tiles, int side) {
  constexpr int kBand = 2;
  const int across = (stage.width + side - 1) / side;
  const auto in = [&](int x, int y) { return tiles[size_t(y / side) * size_t(across) + size_t(x / side)] != 0; };
  double odd[2] = {}, all[2] = {};
  for (int y = 0; y < stage.height; ++y)
    for (int x = 0; x < stage.width; ++x) {
      if (is_left_out(stage, x, y)) continue;
      const bool here = in(x, y);
      const bool at_border = in(std::max(x - kBand, 0), y) != here || in(x, std::max(y - kBand, 0)) != here ||
                             in(std::min(x + kBand, stage.width - 1), y) != here ||
                             in(x, std::min(y + kBand, stage.height - 1)) != here;
      if (at_border) odd[here ? 1 : 0] += is_odd(stage, x, y) ? 1 : 0, ++all[here ? 1 : 0];
    }
  return 4 * odd[0] * all[1] <= odd[1] * all[0];
}

}  // namespace

/// A tile stands out if two fifths of its pixels or more are odd. None does if a tenth of all other pixels is odd too,
/// or if too many tiles stand out: more than a tenth of all (or three, of a small picture), or more than a quarter.
StaleTiles::StaleTiles(const StageVerdict& stage) : width_(stage.width) {
  for (const int side : {8, 16, 32, 64}) {
    const int across = (stage.width + side - 1) / side, down = (stage.height + side - 1) / side;
    std::vector<int> odd_in(size_t(across) * size_t(down)), all_in(odd_in.size());
    for (int y = 0; y < stage.height; ++y)
      for (int x = 0; x < stage.width; ++x) {
        if (is_left_out(stage, x, y)) continue;
        const size_t tile = size_t(y / side) * size_t(across) + size_t(x / side);
        odd_in[tile] += is_odd(stage, x, y) ? 1 : 0, ++all_in[tile];
      }
    Tiles& tiles = by_side_[side];
    tiles.stale.resize(odd_in.size());
    double odd_stale = 0, all_stale = 0, odd_other = 0, all_other = 0;
    for (size_t i = 0; i < odd_in.size(); ++i) {
      const bool stale = all_in[i] > 0 && 5 * odd_in[i] >= 2 * all_in[i];
      tiles.stale[i] = stale ? 1 : 0, tiles.count += stale ? 1 : 0;
      (stale ? odd_stale : odd_other) += odd_in[i], (stale ? all_stale : all_other) += all_in[i];
    }
    if (10 * odd_other > all_other || size_t(10 * tiles.count) > std::max<size_t>(odd_in.size(), 30) ||
        size_t(4 * tiles.count) > odd_in.size() || !ends_sharply(stage, tiles.stale, side)) {
      std::fill(tiles.stale.begin(), tiles.stale.end(), 0);
      tiles.count = 0;
    }
    tiles.filled = tiles.count > 0 ? odd_stale / all_stale : 0;
  }
}

bool StaleTiles::hold_anything(int side, int x, int y) const {
  const size_t across = size_t((width_ + side - 1) / side);
  return by_side_.at(side).stale[size_t(y / side) * across + size_t(x / side)] != 0;
}

double StaleTiles::cost(int side) const {
  const Tiles& tiles = by_side_.at(side);
  return 0.02 + 0.004 * tiles.count + 0.05 * (1 - tiles.filled);
}

TileLists::TileLists(const CapturedSurface& surfaces, int width, int height) : width_(width), height_(height) {
  const auto across = [&](int side) { return (width + side - 1) / side; };
  const auto boxes = [&](int side) {
    return std::vector<Box>(size_t(across(side)) * size_t((height + side - 1) / side));
  };
  std::vector<Box>& least = boxes_[kLeastTile] = boxes(kLeastTile);
  parallel_for((height + kLeastTile - 1) / kLeastTile, 0, [&](int row) {
    for (int y = row * kLeastTile; y < std::min((row + 1) * kLeastTile, height); ++y)
      for (int x = 0; x < width; ++x) {
        if (!surfaces.covered(x, y)) continue;
        Box& box = least[size_t(row) * size_t(across(kLeastTile)) + size_t(x / kLeastTile)];
        const ShadedSurface s = surfaces.at(x, y);
        for (size_t k = 0; k < 3; ++k) {
          const double v = s.position[k].value;
          box.low[k] = box.empty ? v : std::min(box.low[k], v), box.high[k] = box.empty ? v : std::max(box.high[k], v);
        }
        box.empty = false;
      }
  });
  for (int side = 2 * kLeastTile; side <= 64; side *= 2) {
    std::vector<Box>& larger = boxes_[side] = boxes(side);
    for (size_t i = 0; i < least.size(); ++i) {
      const Box& from = least[i];
      if (from.empty) continue;
      const int tx = int(i) % across(kLeastTile) * kLeastTile / side,
                ty = int(i) / across(kLeastTile) * kLeastTile / side;
      Box& to = larger[size_t(ty) * size_t(across(side)) + size_t(tx)];
      for (size_t k = 0; k < 3; ++k) {
        to.low[k] = to.empty ? from.low[k] : std::min(to.low[k], from.low[k]);
        to.high[k] = to.empty ? from.high[k] : std::max(to.high[k], from.high[k]);
      }
      to.empty = false;
    }
  }
}

/// The first lights whose range reaches the box of the tile that the pixel's list is from.
std::vector<uint8_t> TileLists::list(const LightPass& pass, int side, int from, int most, int x, int y) const {
  const int across = (width_ + side - 1) / side, down = (height_ + side - 1) / side;
  const int* step = kNeighbours[from];
  const int tx = std::clamp(x / side + step[0], 0, across - 1), ty = std::clamp(y / side + step[1], 0, down - 1);
  const Box& box = boxes_.at(side)[size_t(ty) * size_t(across) + size_t(tx)];
  std::vector<uint8_t> listed(pass.lights.size());
  for (size_t i = 0; i < listed.size() && most > 0; ++i) {
    const Light& light = pass.lights[i];
    const double range = double(light.range) * pass.fault.range;
    if (!is_placed(light.type) || std::isinf(range)) {
      listed[i] = 1, --most;
      continue;
    }
    double squared = 0;
    for (int k = 0; k < 3; ++k) {
      const double p = double(light.position[k]);
      const double outside = std::max({0.0, box.low[size_t(k)] - p, p - box.high[size_t(k)]});
      squared += outside * outside;
    }
    listed[i] = !box.empty && squared < range * range ? 1 : 0;
    most -= listed[i];
  }
  return listed;
}

}  // namespace trueshade::oracle
