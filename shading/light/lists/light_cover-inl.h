// Which pixels of a vector a listed light's geometry covers. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_LIGHT_LISTS_LIGHT_COVER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_LIGHT_LISTS_LIGHT_COVER_INL_H_
#undef TRUESHADE_SHADING_LIGHT_LISTS_LIGHT_COVER_INL_H_
#else
#define TRUESHADE_SHADING_LIGHT_LISTS_LIGHT_COVER_INL_H_
#endif

#include <hwy/highway.h>

#include "shading/light/light_term-inl.h"
#include "shading/light/lists/tile_lights.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

alignas(64) inline constexpr int32_t kColumnOfPixel[kBlockPixels] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
alignas(64) inline constexpr int32_t kRowOfPixel[kBlockPixels] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

/// Where a vector of pixels is in its tile.
struct VectorInTile {
  const TileLights& lights;
  int block, pixel;  ///< the first pixel's: block of the tile, pixel of the block
  hn::Vec<DI> column, row;

  VectorInTile(const TileLights& tile_lights, int blocks, int at)
      : lights(tile_lights), block(at / kBlockPixels), pixel(at % kBlockPixels) {
    const DI di;
    column = hn::Add(hn::LoadU(di, kColumnOfPixel + pixel), hn::Set(di, block % blocks * kBlockSize));
    row = hn::Add(hn::LoadU(di, kRowOfPixel + pixel), hn::Set(di, block / blocks * kBlockSize));
  }

  /// Pixels that the light's geometry covers, of those given.
  HWY_INLINE MF covered(const ListedLight& listed, MF pixels) const {
    const DF d;
    const DI di;
    if (HWY_LIKELY(listed.crossing == 0)) return pixels;
    if (listed.crossing == ListedLight::kMasked) {
      const unsigned shifted = unsigned(lights.masks[listed.first + size_t(block)]) >> pixel;
      const uint8_t bytes[8] = {uint8_t(shifted), uint8_t(shifted >> 8)};
      return hn::And(pixels, hn::LoadMaskBits(d, bytes));
    }
    const TileEdge* edge = lights.edges.data() + listed.first;
    for (int32_t k = 0; k < listed.crossing; ++k) {
      const auto inside = hn::Add(hn::Add(hn::Mul(column, hn::Set(di, edge[k].across)), hn::Set(di, edge[k].at)),
                                  hn::Mul(row, hn::Set(di, edge[k].up)));
      pixels = hn::And(pixels, hn::RebindMask(d, hn::Gt(inside, hn::Set(di, -1))));
    }
    return pixels;
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
