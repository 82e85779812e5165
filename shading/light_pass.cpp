#include "shading/light_pass.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/light_pass.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <limits>

#include "shading/specular-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<DF>;
using VF = hn::Vec<DF>;
using MF = hn::Mask<DF>;

HWY_INLINE VF dot3(const VF a[3], const VF b[3]) {
  return hn::Add(hn::Add(hn::Mul(a[0], b[0]), hn::Mul(a[1], b[1])), hn::Mul(a[2], b[2]));
}

/// 1 / sqrt(l2), or 0 for a zero vector.
HWY_INLINE VF inverse_length(VF l2) {
  const DF d;
  return hn::IfThenElseZero(hn::Gt(l2, hn::Zero(d)), hn::Div(hn::Set(d, 1.0f), hn::Sqrt(l2)));
}

/// What the lights of one vector of pixels have in common.
struct PixelVector {
  MF covered;
  VF p[3], n[3], v[3], albedo[3];
};

HWY_INLINE PixelVector load_pixels(const SurfaceTile& s, int i, const LightModel& model, const float eye[3]) {
  const DF d;
  PixelVector out;
  out.covered = hn::RebindMask(d, hn::MaskFromVec(hn::BitCast(d, hn::Load(DI(), s.covered + i))));
  for (int c = 0; c < 3; ++c) {
    out.p[c] = hn::Load(d, s.plane[kPosition + c] + i);
    out.n[c] = hn::Load(d, s.plane[kNormal + c] + i);
    out.albedo[c] = hn::Load(d, s.plane[kAlbedo + c] + i);
    out.v[c] = hn::Sub(hn::Set(d, eye[c]), out.p[c]);
  }
  const VF toward = inverse_length(dot3(out.v, out.v));
  for (int c = 0; c < 3; ++c) out.v[c] = hn::Mul(out.v[c], toward);
  if (model.renormalize) {
    const VF unit = inverse_length(dot3(out.n, out.n));
    for (int c = 0; c < 3; ++c) out.n[c] = hn::Mul(out.n[c], unit);
  }
  return out;
}

/// pow(max(N.H, 0), shininess) by way of its square where the exponent is even.
HWY_INLINE VF specular_term(const PixelVector& px, const VF l[3], const LightModel& model, const Exponent& exponent) {
  const DF d;
  VF h[3];
  for (int c = 0; c < 3; ++c) h[c] = hn::Add(l[c], px.v[c]);
  const VF h2 = dot3(h, h), nh = dot3(px.n, h), zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const VF t = hn::IfThenElseZero(hn::Gt(nh, zero), nh);
  const VF quotient = exponent.squared ? hn::Div(hn::Mul(t, t), h2) : hn::Div(t, hn::Sqrt(h2));
  VF x = hn::IfThenElseZero(hn::Gt(h2, zero), quotient);
  if (model.renormalize) x = hn::IfThenElse(hn::Gt(x, one), one, x);
  return rounded_power(x, exponent);
}

/// Adds one light to the sums of a vector of pixels.
struct LightAdder {
  const LightTable& lights;
  const LightModel& model;
  const Exponent exponent;
  LightCounts& counts;
  uint32_t* light_count;  ///< per pixel, of the tile

  HWY_INLINE void ambient(const PixelVector& px, size_t light, VF sum[3]) const {
    const DF d;
    for (int c = 0; c < 3; ++c)
      sum[c] =
          hn::Add(sum[c], hn::IfThenElseZero(px.covered, hn::Mul(px.albedo[c], hn::Set(d, lights.color[c][light]))));
  }

  HWY_INLINE void add(const PixelVector& px, size_t light, int at, VF sum[3]) {
    const DF d;
    const DI di;
    const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    if (lights.type[light] == LightType::ambient) return ambient(px, light, sum);
    const bool directional = lights.type[light] == LightType::directional;
    VF to_light[3];
    for (int c = 0; c < 3; ++c) {
      const VF place = hn::Set(d, lights.position[c][light]);
      to_light[c] = directional ? place : hn::Sub(place, px.p[c]);
    }
    const VF d2 = dot3(to_light, to_light), raw_nl = dot3(px.n, to_light);
    const MF in_range = directional ? px.covered : hn::And(px.covered, hn::Lt(d2, hn::Set(d, lights.cut2[light])));
    const MF lit = hn::And(in_range, hn::Gt(raw_nl, zero));
    const MF adds = model.specular_masked ? lit : in_range;
    if (hn::AllFalse(d, adds)) return;

    VF falloff = one, nl = raw_nl;
    if (!directional) {
      const VF distance = hn::Sqrt(d2);
      const VF inverse = hn::IfThenElseZero(hn::Gt(d2, zero), hn::Div(one, distance));
      nl = hn::Mul(raw_nl, inverse);
      for (int c = 0; c < 3; ++c) to_light[c] = hn::Mul(to_light[c], inverse);
      falloff = falloff_at(distance, light);
    }
    const VF c = hn::IfThenElseZero(hn::Gt(nl, zero), nl);
    const VF s = specular_term(px, to_light, model, exponent);
    for (int k = 0; k < 3; ++k) {
      const VF color = hn::Set(d, lights.color[k][light]), ks = hn::Set(d, model.specular_color[k]);
      VF term;
      if (model.order == TermOrder::factored) {
        term = hn::Mul(hn::Add(hn::Mul(px.albedo[k], c), hn::Mul(ks, s)), hn::Mul(color, falloff));
      } else {
        const VF diffuse = hn::Mul(hn::Mul(hn::Mul(c, px.albedo[k]), color), falloff);
        term = hn::Add(diffuse, hn::Mul(hn::Mul(hn::Mul(color, s), ks), falloff));
      }
      sum[k] = hn::Add(sum[k], hn::IfThenElseZero(adds, term));
    }
    counts.evaluated_pairs += hn::Lanes(d);
    counts.lit_pairs += hn::CountTrue(d, lit);
    const auto one_more = hn::IfThenElseZero(hn::RebindMask(di, lit), hn::Set(di, 1));
    int32_t* count = reinterpret_cast<int32_t*>(light_count) + at;
    hn::Store(hn::Add(hn::Load(di, count), one_more), di, count);
  }

  HWY_INLINE VF falloff_at(VF distance, size_t light) const {
    const DF d;
    const VF one = hn::Set(d, 1.0f);
    if (model.falloff == Falloff::linear_range) {
      const VF f = hn::Sub(one, hn::Div(distance, hn::Set(d, lights.range[light])));
      return hn::IfThenElseZero(hn::Gt(f, hn::Zero(d)), f);
    }
    const VF linear = hn::Add(one, hn::Mul(hn::Set(d, lights.k1[light]), distance));
    return hn::Div(one, hn::Add(linear, hn::Mul(hn::Mul(hn::Set(d, lights.k2[light]), distance), distance)));
  }
};

/// Box of the covered pixels' positions: the very floats that the lights are tested against.
struct Box {
  float low[3], high[3];
  int pixels;
};

Box surface_box(const SurfaceTile& s, const int* block, int blocks) {
  const DF d;
  const DI di;
  const VF inf = hn::Set(d, std::numeric_limits<float>::infinity());
  VF low[3] = {inf, inf, inf}, high[3] = {hn::Neg(inf), hn::Neg(inf), hn::Neg(inf)};
  Box box{};
  for (int b = 0; b < blocks; ++b) {
    for (int i = block[b] * kBlockPixels; i < (block[b] + 1) * kBlockPixels; i += int(hn::Lanes(d))) {
      const MF covered = hn::MaskFromVec(hn::BitCast(d, hn::Load(di, s.covered + i)));
      box.pixels += int(hn::CountTrue(d, covered));
      for (int c = 0; c < 3; ++c) {
        const VF p = hn::Load(d, s.plane[kPosition + c] + i);
        low[c] = hn::IfThenElse(hn::And(covered, hn::Lt(p, low[c])), p, low[c]);
        high[c] = hn::IfThenElse(hn::And(covered, hn::Gt(p, high[c])), p, high[c]);
      }
    }
  }
  alignas(64) float lane[HWY_MAX_BYTES / sizeof(float)];
  for (int c = 0; c < 3; ++c) {
    hn::Store(low[c], d, lane);
    box.low[c] = *std::min_element(lane, lane + hn::Lanes(d));
    hn::Store(high[c], d, lane);
    box.high[c] = *std::max_element(lane, lane + hn::Lanes(d));
  }
  return box;
}

// Lights that may reach the box, ascending. Dropped only if the least squared distance, with slack for its six
// roundings, is past the light's cut: then the kernel's own d2 is past it at every pixel. A light without a cut is
// never dropped: to pixels whose positions are infinite (a half plane overflowed) every distance is, and ambient light
// is there too.
template <class Candidate>
void reaching_lights(const LightTable& lights, const Box& box, size_t count, const Candidate& candidate,
                     std::vector<uint32_t>& out) {
  for (size_t k = 0; k < count; ++k) {
    const uint32_t light = candidate(k);
    float d2 = 0.0f;
    for (int c = 0; c < 3; ++c) {
      const float place = lights.position[c][light];
      const float gap = std::max(std::max(box.low[c] - place, place - box.high[c]), 0.0f);
      d2 += gap * gap;
    }
    const float cut2 = lights.cut2[light];
    if (cut2 == std::numeric_limits<float>::infinity() || !(d2 * (1.0f - 0x1p-20f) >= cut2)) out.push_back(light);
  }
}

// The whole table against one box, a vector of lights at a time.
void reaching_lights_of_scene(const LightTable& lights, const Box& box, std::vector<uint32_t>& out) {
  const DF d;
  const size_t lanes = hn::Lanes(d);
  const VF zero = hn::Zero(d), slack = hn::Set(d, 1.0f - 0x1p-20f),
           inf = hn::Set(d, std::numeric_limits<float>::infinity());
  alignas(64) float reach[HWY_MAX_BYTES / sizeof(float)];
  for (size_t i = 0; i < lights.size(); i += lanes) {
    VF d2 = zero;
    for (int c = 0; c < 3; ++c) {
      const VF place = hn::LoadU(d, &lights.position[c][i]);
      const VF below = hn::Sub(hn::Set(d, box.low[c]), place), above = hn::Sub(place, hn::Set(d, box.high[c]));
      const VF outside = hn::IfThenElse(hn::Gt(below, above), below, above);
      const VF gap = hn::IfThenElseZero(hn::Gt(outside, zero), outside);
      d2 = hn::Add(d2, hn::Mul(gap, gap));
    }
    const VF cut2 = hn::LoadU(d, &lights.cut2[i]);
    const MF out_of_reach = hn::And(hn::Ge(hn::Mul(d2, slack), cut2), hn::Lt(cut2, inf));
    if (hn::AllTrue(d, out_of_reach)) continue;
    hn::Store(hn::IfThenElse(out_of_reach, zero, hn::Set(d, 1.0f)), d, reach);
    for (size_t k = 0; k < lanes && i + k < lights.size(); ++k)
      if (reach[k] != 0.0f) out.push_back(uint32_t(i + k));
  }
}

void light_block(const SurfaceTile& surface, int block, const std::vector<uint32_t>& list, LightAdder& adder,
                 const float eye[3], const float clear[4], ColorTile& out) {
  const DF d;
  for (int i = block * kBlockPixels; i < (block + 1) * kBlockPixels; i += int(hn::Lanes(d))) {
    const PixelVector px = load_pixels(surface, i, adder.model, eye);
    VF sum[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    if (!hn::AllFalse(d, px.covered))
      for (const uint32_t light : list) adder.add(px, light, i, sum);
    for (int c = 0; c < 3; ++c)
      hn::Store(hn::IfThenElse(px.covered, sum[c], hn::Set(d, clear[c])), d, out.plane[c] + i);
    const VF alpha = adder.model.alpha_from_albedo ? hn::Load(d, surface.plane[kAlbedo + 3] + i) : hn::Set(d, 1.0f);
    hn::Store(hn::IfThenElse(px.covered, alpha, hn::Set(d, clear[3])), d, out.plane[3] + i);
  }
}

constexpr int kRegionBlocks = 4;  // a region is 16x16 pixels

// Blocks of the region whose first block is (bx, by); returns how many.
int region_blocks(int blocks, int bx, int by, int out[kRegionBlocks * kRegionBlocks]) {
  int count = 0;
  for (int y = by; y < std::min(by + kRegionBlocks, blocks); ++y)
    for (int x = bx; x < std::min(bx + kRegionBlocks, blocks); ++x) out[count++] = y * blocks + x;
  return count;
}

void light_tile_simd(const SurfaceTile& surface, int tile, const LightTable& lights, const LightModel& model,
                     const float eye[3], const float clear[4], bool culling, LightLists& work, ColorTile& out,
                     LightCounts& counts) {
  const int blocks = tile / kBlockSize;
  std::fill_n(out.light_count, size_t(tile) * size_t(tile), 0u);
  int all_blocks[kMaxTilePixels / kBlockPixels];
  for (int i = 0; i < blocks * blocks; ++i) all_blocks[i] = i;
  work.tile.clear();
  if (culling) {
    reaching_lights_of_scene(lights, surface_box(surface, all_blocks, blocks * blocks), work.tile);
  } else {
    for (uint32_t i = 0; i < lights.size(); ++i) work.tile.push_back(i);
  }
  counts.tile_pairs += uint64_t(surface.covered_pixels) * work.tile.size();

  LightAdder adder{lights, model, exponent_of_shininess(model.shininess), counts, out.light_count};
  for (int by = 0; by < blocks; by += kRegionBlocks) {
    for (int bx = 0; bx < blocks; bx += kRegionBlocks) {
      int block[kRegionBlocks * kRegionBlocks];
      const int count = region_blocks(blocks, bx, by, block);
      const std::vector<uint32_t>* list = &work.tile;
      if (culling) {
        work.region.clear();
        const Box box = surface_box(surface, block, count);
        if (box.pixels > 0)
          reaching_lights(
              lights, box, work.tile.size(), [&](size_t k) { return work.tile[k]; }, work.region);
        list = &work.region;
      }
      for (int i = 0; i < count; ++i) light_block(surface, block[i], *list, adder, eye, clear, out);
    }
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trueshade {
HWY_EXPORT(light_tile_simd);

void light_tile(const SurfaceTile& surface, int tile, const LightTable& lights, const LightModel& model,
                const float eye[3], const float clear[4], bool culling, LightLists& work, ColorTile& out,
                LightCounts& counts) {
  HWY_DYNAMIC_DISPATCH(light_tile_simd)(surface, tile, lights, model, eye, clear, culling, work, out, counts);
}
}  // namespace trueshade
#endif  // HWY_ONCE
