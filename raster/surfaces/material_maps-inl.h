// Applies a material's maps to the surfaces of pixels. Included once per SIMD target. docs/arithmetic.md section 13.
#if defined(TRUESHADE_RASTER_SURFACES_MATERIAL_MAPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_MATERIAL_MAPS_INL_H_
#undef TRUESHADE_RASTER_SURFACES_MATERIAL_MAPS_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_MATERIAL_MAPS_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>
#include <optional>

#include "core/simd/lanes-inl.h"
#include "raster/surfaces/normal_maps-inl.h"
#include "raster/surfaces/surfaces.h"
#include "raster/textures/texture-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The bump frames of a vector of pixels, from the vertices of the pixels' triangles.
struct PixelFrames {
  const VisibleVertices& work;
  int at;                         ///< the first pixel
  const PixelTangents* tangents;  ///< null where no mesh has any

  HWY_INLINE BumpFrame operator()(int, int uv_set, const Vector3& normal) const {
    MapCorner corner[3];
    for (int k = 0; k < 3; ++k) {
      const auto vertex = hn::LoadU(I32(), reinterpret_cast<const int32_t*>(work.corner[k].data()) + at);
      for (int c = 0; c < MapCorner::kValues; ++c)
        corner[k].value[c] =
            hn::PromoteTo(D64(), hn::GatherIndex(D32(), work.stream[MapCorner::stream(c, uv_set)].data(), vertex));
    }
    const TangentFrame of_triangle = tangent_frame(corner);
    return bump_frame(tangents != nullptr ? with_tangents(of_triangle, *tangents) : of_triangle, normal);
  }
};

/// Reads the maps of one material, which has some, for kVectors vectors of pixels, whose loops are one: a vector alone
/// would wait for its own quotients and sums. `at`: the vectors' points in the first set of texture coordinates, then
/// those in the next.
template <int kVectors>
class MapTexels {
 public:
  HWY_INLINE MapTexels(const MaterialMaps& maps, const UvPoint* at, const M64* mine)
      : same_texels_(maps.same_texels), at_(at), mine_(mine) {
    find(first_of(maps));
    if (!same_texels_ || !maps.normal) return;
    for (int h = 0; h < kVectors; ++h) reader_[h].prefetch(*maps.normal);
  }

  HWY_NOINLINE void read(const TextureView& texture, uint32_t channels, V32 rgba[kVectors][4]) {
    if (&texture != found_ && !same_texels_) find(texture);
    for (int h = 0; h < kVectors; ++h) read_texture(texture, reader_[h], mine_[h], rgba[h], channels);
  }

 private:
  static const TextureView& first_of(const MaterialMaps& maps) {
    for (const auto* map : {&maps.color, &maps.specular, &maps.metallic_roughness, &maps.emission, &maps.occlusion})
      if (*map) return **map;
    return *maps.normal;
  }

  HWY_NOINLINE void find(const TextureView& texture) {
    MipChoice mip[kVectors];
    const UvPoint* const at = at_ + texture.uv_set * kVectors;
    choose_mips<kVectors>(texture, at, mip);
    for (int h = 0; h < kVectors; ++h) {
      reader_[h].set(texture, mip[h], at[h].uv, mine_[h]);
      reader_[h].prefetch(texture);
    }
    found_ = &texture;
  }

  const bool same_texels_;
  const UvPoint* const at_;
  const M64* const mine_;
  const TextureView* found_;
  TextureReader reader_[kVectors];
};

/// Keeps channels of texels in planes: channel c in plane `first` + c.
template <int kVectors>
HWY_INLINE void keep_texels(const V32 rgba[kVectors][4], uint32_t channels, const M64* mine, const int* pixel,
                            int first, SurfaceTile& out) {
  const D32 df;
  for (int h = 0; h < kVectors; ++h)
    for (int c = 0; c < 3; ++c) {
      if ((channels >> c & 1) == 0) continue;
      float* const plane = out.plane[first + c] + pixel[h];
      hn::Store(hn::IfThenElse(float_mask(mine[h]), rgba[h][c], hn::Load(df, plane)), df, plane);
    }
}

/// Keeps the texels of the maps that material_values-inl.h multiplies by the material's own values.
template <int kVectors>
HWY_NOINLINE void keep_values(const MaterialMaps& maps, MapTexels<kVectors>& texels, const M64* mine, const int* pixel,
                              SurfaceTile& out) {
  constexpr uint32_t kRedBit = 1, kGreenBlueBits = 6;
  V32 rgba[kVectors][4];
  const auto keep = [&](const std::optional<TextureView>& map, uint32_t channels, int first) {
    if (!map) return;
    texels.read(*map, channels, rgba);
    keep_texels<kVectors>(rgba, channels, mine, pixel, first, out);
  };
  keep(maps.specular, kRgbBits, kSpecular);
  keep(maps.metallic_roughness, kGreenBlueBits, kSpecular);
  keep(maps.emission, kRgbBits, kEmission);
  keep(maps.occlusion, kRedBit, kOcclusion);
}

/// Applies the maps of one material to the lanes `mine` of kVectors vectors, each from a pixel on: the colour is
/// multiplied by the texel, the normal is bent, and the planes of the material receive the texels of the other maps.
/// `frames(h, uv_set, normal)` gives the bump frames of vector h.
template <int kVectors, class Frames>
inline void apply_material(const MaterialMaps& maps, const UvPoint* at, const M64* mine, const int* pixel,
                           const Frames& frames, SurfaceTile& out) {
  const D32 df;
  V32 rgba[kVectors][4];
  MapTexels<kVectors> texels(maps, at, mine);
  if (maps.color) {
    texels.read(*maps.color, kRgbaBits, rgba);
    for (int h = 0; h < kVectors; ++h)
      for (int c = 0; c < 4; ++c) {
        float* const albedo = out.plane[kAlbedo + c] + pixel[h];
        const V32 there = hn::Load(df, albedo);
        hn::Store(hn::IfThenElse(float_mask(mine[h]), hn::Mul(there, rgba[h][c]), there), df, albedo);
      }
  }
  if (maps.values) keep_values<kVectors>(maps, texels, mine, pixel, out);
  if (!maps.normal) return;
  texels.read(*maps.normal, kRgbBits, rgba);
  for (int h = 0; h < kVectors; ++h) {
    V32 n[3], there[3];
    for (int c = 0; c < 3; ++c) n[c] = there[c] = hn::Load(df, out.plane[kNormal + c] + pixel[h]);
    const Vector3 normal{hn::PromoteTo(D64(), n[0]), hn::PromoteTo(D64(), n[1]), hn::PromoteTo(D64(), n[2])};
    bend_normals(frames(h, maps.normal->uv_set, normal), normal, rgba[h], double(maps.normal_scale), n);
    for (int c = 0; c < 3; ++c)
      hn::Store(hn::IfThenElse(float_mask(mine[h]), n[c], there[c]), df, out.plane[kNormal + c] + pixel[h]);
  }
}

/// Applies the maps of the lanes `owned` of kVectors vectors that begin at `pixel`. The first texture coordinates are
/// in the uv planes; `at` has their derivatives and receives them. Behind these are the points in other sets.
template <int kVectors = 1, class Frames>
inline void apply_maps(const SceneMaps& maps, UvPoint* at, const M64* owned, const int* pixel, const Frames& frames,
                       SurfaceTile& out) {
  const D64 d;
  const D32 df;
  const int lanes = int(hn::Lanes(d));
  V64 material[kVectors];  // a double holds every 32-bit number
  uint32_t undone = 0;     // a bit a lane
  for (int h = 0; h < kVectors; ++h) {
    for (int k = 0; k < 2; ++k) at[h].uv[k] = hn::PromoteTo(d, hn::Load(df, out.plane[kUv + k] + pixel[h]));
    material[h] = hn::PromoteTo(d, hn::Load(I32(), reinterpret_cast<const int32_t*>(out.material) + pixel[h]));
    undone |= lane_bits(d, owned[h]) << h * lanes;
  }
  while (undone != 0) {
    const int lane = std::countr_zero(undone);
    const uint32_t first = out.material[pixel[lane / lanes] + lane % lanes];
    M64 mine[kVectors];
    uint32_t here = 0;
    for (int h = 0; h < kVectors; ++h) {
      mine[h] = hn::And(owned[h], hn::Eq(material[h], hn::Set(d, double(first))));
      here |= lane_bits(d, mine[h]) << h * lanes;
    }
    const MaterialMaps& its = maps.material[first - 1];
    if (its.any) apply_material<kVectors>(its, at, mine, pixel, frames, out);
    undone &= ~here;
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
