// Texture lookups for vectors of pixels. Included once per SIMD target. docs/arithmetic.md section 13.
#if defined(TRUESHADE_RASTER_TEXTURES_TEXTURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_TEXTURES_TEXTURE_INL_H_
#undef TRUESHADE_RASTER_TEXTURES_TEXTURE_INL_H_
#else
#define TRUESHADE_RASTER_TEXTURES_TEXTURE_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/textures/fast/texel_quads-inl.h"  // fast path
#include "raster/textures/mip_levels-inl.h"
#include "raster/textures/texel_reader-inl.h"
#include "raster/textures/texture.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The reader that lookups use: TexelReader, unless a fast path stands in for it.
struct GeneralLookups {
  using Reader = TexelReader;
};
struct Lookups : GeneralLookups {
  using Reader = QuadReader;  // fast path
};
using TextureReader = Lookups::Reader;

/// The channels wanted of the lanes in `valid`; other lanes mean nothing.
HWY_INLINE void read_texture(const TextureView& texture, const TextureReader& reader, M64 valid, V32 rgba[4],
                             uint32_t channels) {
  V64 value[4];
  reader.read(texture, valid, channels, value);
  // A texel of -0 becomes +0, as it does where a neighbour of weight 0 is added to it: a lane does not depend on
  // whether other lanes of its vector blend levels.
#pragma GCC unroll 4
  for (int c = 0; c < 4; ++c)
    if ((channels >> c & 1) != 0) rgba[c] = hn::DemoteTo(D32(), hn::Add(value[c], hn::Zero(D64())));
}

/// The same from texture coordinates and their derivatives.
inline void sample(const TextureView& texture, const UvPoint& at, M64 valid, V32 rgba[4], uint32_t channels) {
  MipChoice mip;
  choose_mips<1>(texture, &at, &mip);
  TextureReader reader;
  reader.set(texture, mip, at.uv, valid);
  read_texture(texture, reader, valid, rgba, channels);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
