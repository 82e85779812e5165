#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "shading/blend/blend_pass.h"
#include "shading/blend/blend-inl.h"
#include "shading/blend/blend_draw-inl.h"
#include "shading/light/fast/light_pairs-inl.h"
#include "shading/light/bounded/bounded_pairs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr size_t kChunkLights = 1024;  // drawn over the whole tile before the next: bounds what lists hold

/// A vector of target pixels in registers, onto which light is added: where a light adds nothing nothing changes, and
/// alpha is not written. kCodes: fixed point, by adding codes (docs/gl_rules.md section 10, point 4), which is exact in
/// float32 and so may be held to the largest code later.
template <bool kCodes>
struct AddedLight {
  const BlendPlan* plan;
  float largest[3];
  VF stored[4];
  hn::Vec<DI> lights;
  uint64_t evaluated = 0;

  AddedLight() = default;
  AddedLight(const BlendPlan& blend_plan, const StoredPixels& pixels) : plan(&blend_plan), lights(pixels.lights) {
    for (int c = 0; c < 4; ++c) stored[c] = pixels.stored[c];
    for (int c = 0; c < 3; ++c) largest[c] = plan->largest(c);
  }

  template <class Terms>
  HWY_INLINE void add(const Terms& terms, const PixelVector& px, const LightTerm& term) {
    const DF d;
    if constexpr (kCodes) {  // a clamped result is clamped again
      for (int c = 0; c < 3; ++c) {
        const VF x = terms.tinted(px, term.color[c], c);
        stored[c] = hn::Add(stored[c], added_code(x, term.adds, hn::Set(d, largest[c])));
      }
    } else {
      VF source[4], next[4] = {stored[0], stored[1], stored[2], stored[3]};
      for (int c = 0; c < 3; ++c) source[c] = terms.finished(px, term.color[c], c);
      source[3] = hn::Zero(d);
      if (plan->sums_values)
        for (int c = 0; c < 3; ++c) next[c] = summed_values(*plan, source[c], stored[c], c);
      else
        blend_out_of_line(*plan, source, next);
      for (int c = 0; c < 3; ++c) stored[c] = hn::IfThenElse(term.adds, next[c], stored[c]);
    }
  }
  HWY_INLINE void settle() {
    static_assert((kMostHits + 1) * 65535 < (1 << 24));
    if constexpr (kCodes)
      for (int c = 0; c < 3; ++c) stored[c] = lesser(stored[c], hn::Set(DF(), largest[c]));
  }
};

/// How the light draws of a frame may be computed.
struct BlendMethod {
  bool adds;             ///< a light that adds 0 changes nothing but alpha
  bool saturates_alpha;  ///< any draw makes alpha 1
  bool codes;            ///< AddedLight<true>
  bool settles;          ///< codes of 8 bits, which bounds may settle
};

// Whether a light is drawn over the image and its fragments out of range are discarded.
inline bool discards(const LightTable& table) {
  return std::any_of(table.row.begin(), table.row.end(), [](const LightRow& row) { return !std::isinf(row.extent2); });
}

inline BlendMethod blend_method(const LightDraws& in, const BlendPlan& plan, const float clear[4]) {
  bool positive = in.model.diffuse == Diffuse::clamped && in.model.falloff != Falloff::linear;
  for (int c = 0; c < 4; ++c) positive = positive && !std::signbit(clear[c]);  // -0 + 0 is 0
  bool rgb = plan.enabled && plan.rgb.term == kAccumulate && !plan.flushes && (plan.unorm() || positive);
  for (size_t c = 0; c < 3; ++c) rgb = rgb && plan.written[c];
  const bool saturates = plan.written[3] && plan.unorm() && plan.alpha.term == kAccumulate &&
                         !in.model.alpha_from_albedo && !discards(in.table);
  const bool adds = rgb && (saturates || !plan.written[3]), codes = plan.adds_codes(0);
  bool settles = in.settles && adds && codes;
  for (int c = 0; c < 3; ++c) settles = settles && plan.largest(c) == 255.0f;
  return {adds, saturates, codes, settles};
}

/// Lights whose geometry may touch the tile, ascending, from `first` on.
inline void touching_lights(const LightDraws& in, const TileRect& rect, uint32_t first, std::vector<uint32_t>& out) {
  const DI di;
  const LightOutlines& o = in.outlines;
  const auto left = hn::Set(di, rect.x), low = hn::Set(di, rect.y);
  const auto right = hn::Set(di, rect.x + rect.size), high = hn::Set(di, rect.y + rect.size);
  out.clear();
  const size_t count = in.lights.size(), lanes = hn::Lanes(di);
  const int32_t *x0 = o.x0.data(), *y0 = o.y0.data(), *x1 = o.x1.data(), *y1 = o.y1.data();
  for (size_t i = 0; i < count; i += lanes) {
    const auto in_x = hn::And(hn::Lt(hn::LoadU(di, x0 + i), right), hn::Gt(hn::LoadU(di, x1 + i), left));
    const auto in_y = hn::And(hn::Lt(hn::LoadU(di, y0 + i), high), hn::Gt(hn::LoadU(di, y1 + i), low));
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(di, hn::And(in_x, in_y), bytes);
    uint64_t bits = 0;
    std::memcpy(&bits, bytes, sizeof bits);
    for (; bits != 0; bits &= bits - 1) {
      const size_t light = i + size_t(std::countr_zero(bits));
      if (light >= first && light < count) out.push_back(uint32_t(light));
    }
  }
}

inline bool touches(const LightOutlines& o, uint32_t light, const TileRect& rect) {
  return o.x0[light] < rect.x + rect.size && o.x1[light] > rect.x && o.y0[light] < rect.y + rect.size &&
         o.y1[light] > rect.y;
}

/// What blend_tile() is given, and what follows from it.
struct TileBlend {
  const LightDraws& in;
  const SurfaceTile& surface;
  const TileRect& rect;
  const float* clear;
  BlendWork& work;
  ColorTile& out;
  LightCounts& counts;
  const AnyTerms terms;
  const BlendPlan plan;
  BlendPlan add_plan;  ///< without alpha
  const BlendMethod method;
  const int32_t* tied = nullptr;  ///< pixels that several fragments share; null where there are none
  TileRegions regions;
  const BlockOrder order;
  RegionCull cull;

  TileBlend(const LightDraws& draws, const SurfaceTile& surface_tile, const TileRect& tile_rect,
            const float clear_color[4], BlendWork& blend_work, ColorTile& out_tile, LightCounts& light_counts)
      : in(draws),
        surface(surface_tile),
        rect(tile_rect),
        clear(clear_color),
        work(blend_work),
        out(out_tile),
        counts(light_counts),
        terms(draws.table, draws.model, AnyShape{shape_of(draws.model, false)}),
        plan(blend_plan(draws.blend, draws.target)),
        add_plan(plan),
        method(blend_method(draws, plan, clear_color)) {
    add_plan.written[3] = false;
    const bool culls = in.culling && method.adds;
    cull = {culls, culls && in.table.cones, culls && !adds_unlit(terms.form.shape)};
    find_regions(surface, blocks(), cull.facing, regions);
  }
  int blocks() const { return rect.size / kBlockSize; }
  int pixels() const { return rect.size * rect.size; }
};

// What covered pixels start from where no light is in the first draw and nothing but light shines: the same everywhere.
void begin_black(const TileBlend& t) {
  const DF d;
  const DI di;
  VF without[4], with[4];
  for (int c = 0; c < 4; ++c) {
    without[c] = encoded_alone(t.plan, hn::Set(d, t.clear[c]), c);
    with[c] = t.in.base ? encoded_alone(t.plan, hn::Set(d, c == 3 ? 1.0f : 0.0f), c) : without[c];
  }
  for (int i = 0; i < t.pixels(); i += int(hn::Lanes(d))) {
    const MF covered = hn::RebindMask(d, hn::MaskFromVec(hn::BitCast(d, hn::Load(di, t.surface.covered + i))));
    for (int c = 0; c < 4; ++c) hn::Store(hn::IfThenElse(covered, with[c], without[c]), d, t.out.plane[c] + i);
  }
}

// What a vector of pixels holds before any light, or after the first.
void begin(const TileBlend& t, int i) {
  const DF d;
  const DI di;
  const AnyTerms& terms = t.terms;
  const PixelVector px = terms.load(t.surface, i);
  VF stored[4], sum[4];
  for (int c = 0; c < 4; ++c) stored[c] = encoded_alone(t.plan, hn::Set(d, t.clear[c]), c);
  if (!hn::AllFalse(d, px.covered)) {
    for (int c = 0; c < 3; ++c) sum[c] = terms.start(t.surface, i, px, c);
    if (t.in.first_base && t.in.table.size() > 0) {
      LightTerm term;
      term_out_of_line(terms, px, t.in.table.row[0], term);
      for (int c = 0; c < 3; ++c) sum[c] = hn::Add(sum[c], hn::IfThenElseZero(term.adds, term.color[c]));
      hn::Store(hn::IfThenElseZero(hn::RebindMask(di, term.lit), hn::Set(di, 1)), di,
                reinterpret_cast<int32_t*>(t.out.light_count) + i);
    }
    for (int c = 0; c < 3; ++c) sum[c] = terms.finished(px, sum[c], c);
    sum[3] = terms.alpha(t.surface, i);
    for (int c = 0; c < 4; ++c) stored[c] = hn::IfThenElse(px.covered, encoded_alone(t.plan, sum[c], c), stored[c]);
  }
  for (int c = 0; c < 4; ++c) hn::Store(stored[c], d, t.out.plane[c] + i);
}

void begin_all(const TileBlend& t) {
  std::fill_n(t.out.light_count, size_t(t.pixels()), 0u);
  const LightModel& m = t.in.model;
  const bool black = !t.in.first_base && !m.emission && m.global_ambient == glm::vec3(0.0f) &&
                     m.order != TermOrder::albedo_last && !m.alpha_from_albedo;
  if (black || !t.in.base) {
    begin_black(t);
    return;
  }
  for (int i = 0; i < t.pixels(); i += int(hn::Lanes(DF()))) begin(t, i);
}

// The lights at work.touching[first, end) as draws.
void list_chunk(const TileBlend& t, size_t first, size_t end) {
  t.work.lights.clear();
  list_draws(t.in, t.rect, std::span<const uint32_t>(t.work.touching).subspan(first, end - first), t.work.counts,
             t.work.lights);
}

// Alpha 1 where any light is drawn, in reach or not: no culled list will do.
void saturate_alpha(const TileBlend& t) {
  const int blocks = t.blocks() * t.blocks();
  uint16_t covered[kMaxTilePixels / kBlockPixels], open[kMaxTilePixels / kBlockPixels];
  covered_bits(t.surface, blocks, covered);
  std::copy_n(covered, blocks, open);
  for (size_t first = 0; first < t.work.touching.size(); first += kChunkLights) {
    list_chunk(t, first, std::min(t.work.touching.size(), first + kChunkLights));
    for (int b = 0; b < blocks; ++b)
      for (size_t k = 0; k < t.work.lights.light.size() && open[b] != 0; ++k)
        open[b] = uint16_t(open[b] & ~cover_of_block(t.work.lights, t.work.lights.light[k], b, t.blocks()));
  }
  for (int i = 0; i < t.pixels(); ++i)
    if (((covered[i / kBlockPixels] & ~open[i / kBlockPixels]) >> (i % kBlockPixels) & 1) != 0)
      t.out.plane[3][i] = t.plan.largest(3);
}

HWY_INLINE void leave_out_tied(const TileBlend& t, PixelVector& px, int i) {
  if (t.tied == nullptr) return;
  const DI di;
  px.covered = hn::And(px.covered, hn::RebindMask(DF(), hn::Eq(hn::LoadU(di, t.tied + i), hn::Zero(di))));
}

template <bool kCodes, class Shape>
void add_to_vector(const TileBlend& t, const LightTerms<Shape>& terms, std::span<const ListedLight> list, int i) {
  PixelVector px = terms.load(t.surface, i);
  leave_out_tied(t, px, i);
  if (hn::AllFalse(DF(), px.covered)) return;
  StoredPixels pixels(t.out, i);
  AddedLight<kCodes> sum(t.add_plan, pixels);
  add_lights(terms, px, list, VectorPlace(t.work.lights, t.blocks(), i), sum);
  for (int c = 0; c < 3; ++c) pixels.stored[c] = sum.stored[c];
  pixels.lights = sum.lights;
  pixels.store(t.out, i);
  t.counts.evaluated_pairs += sum.evaluated * hn::Lanes(DF());
}

// The pixels of a block of a region; `px` where there are any.
template <class Shape>
HWY_INLINE uint16_t load_block(const TileBlend& t, const LightTerms<Shape>& terms, const Region& r, size_t block,
                               PixelVector& px) {
  if (r.covered[block] == 0) return 0;
  const int i = r.block(int(block), t.blocks()) * kBlockPixels;
  px = terms.load(t.surface, i);
  leave_out_tied(t, px, i);
  return uint16_t(mask_bits(px.covered));
}

// The lights of a region, by pairs.
template <bool kCodes, class Shape>
void add_to_region(const TileBlend& t, const LightTerms<Shape>& terms, const Region& r) {
  const DF d;
  RegionPixels<AddedLight<kCodes>> in(r);
  for (size_t k = 0; k < kRegionBlockCount; ++k) {
    in.open[k] = load_block(t, terms, r, k, in.px[k]);
    if (r.covered[k] != 0) in.sum[k] = AddedLight<kCodes>(t.add_plan, StoredPixels(t.out, in.place(k, t.blocks())));
  }
  const BlockPairs pairs(t.work.lights, r, t.cull, t.order, t.blocks(), in.open, t.work.pairs);
  t.counts.evaluated_pairs += add_region_lights(terms, t.work.region.light, pairs, in);
  for (size_t k = 0; k < kRegionBlockCount; ++k) {
    if (r.covered[k] == 0) continue;
    const int i = in.place(k, t.blocks());
    for (int c = 0; c < 3; ++c) hn::Store(in.sum[k].stored[c], d, t.out.plane[c] + i);
    hn::Store(in.sum[k].lights, DI(), reinterpret_cast<int32_t*>(t.out.light_count) + i);
  }
}

// The same where bounds settle codes of 8 bits; false where its surfaces are not such that they do, and nothing is
// added.
template <class Shape>
bool settle_region(const TileBlend& t, const LightTerms<Shape>& terms, const Region& r) {
  const DF d;
  SettledRegion in;
  MF strange = hn::Lt(hn::Zero(d), hn::Zero(d));
  for (size_t k = 0; k < kRegionBlockCount; ++k) {
    in.open[k] = load_block(t, terms, r, k, in.px[k]);
    if (in.open[k] == 0) continue;
    MF plain = plain_surfaces(in.px[k]);
    if constexpr (settles_phong<Shape>()) {
      plain = hn::And(plain, plain_views(in.px[k]));
      in.facing2[k] = twice_facing(in.px[k]);
    }
    strange = hn::Or(strange, hn::AndNot(plain, in.px[k].covered));
  }
  if (!hn::AllFalse(d, strange)) return false;
  const BlockPairs pairs(t.work.lights, r, t.cull, t.order, t.blocks(), in.open, t.work.pairs);
  t.counts.evaluated_pairs += settle_region_lights(terms, t.work.region.light, pairs, in);
  for (size_t k = 0; k < kRegionBlockCount; ++k) {
    if (in.open[k] == 0) continue;
    const int i = r.block(int(k), t.blocks()) * kBlockPixels;
    for (int c = 0; c < 3; ++c) {
      const VF sum = hn::Add(hn::Load(d, t.out.plane[c] + i), in.codes[k].codes(c));
      hn::Store(lesser(sum, hn::Set(d, 255.0f)), d, t.out.plane[c] + i);
    }
    int32_t* const lights = reinterpret_cast<int32_t*>(t.out.light_count) + i;
    hn::Store(hn::Add(hn::Load(DI(), lights), in.codes[k].lit), DI(), lights);
  }
  return true;
}

void draw_every_at(const TileBlend& t, std::span<const ListedLight> list, int i) {
  PixelVector px = t.terms.load(t.surface, i);
  leave_out_tied(t, px, i);
  if (hn::AllFalse(DF(), px.covered)) return;
  draw_every(t.terms, t.plan, t.surface, px, list, VectorPlace(t.work.lights, t.blocks(), i), i, t.out, t.counts);
}

// Codes add up in any order: lights of a kind follow each other, so that kernels need not choose light by light.
void gather_kinds(const LightTable& table, std::vector<uint32_t>& lights) {
  const auto placed = [&](uint32_t i) { return table.row[i].kind == LightKind::placed; };
  const auto coned = [&](uint32_t i) { return table.row[i].kind == LightKind::coned; };
  std::partition(std::partition(lights.begin(), lights.end(), placed), lights.end(), coned);
}

/// The draws of a chunk over all regions, by the terms of one shape.
struct DrawRegions {
  static constexpr unsigned kCompiles = 1 << 0 | 1 << 1 | 1 << 4 | 1 << 5;  // models that presets blend with
  const TileBlend& t;

  template <class Shape>
  void operator()(const Shape& shape) const {
    const LightTerms<Shape> terms(t.in.table, t.in.model, shape);
    for (int n = 0; n < t.regions.count; ++n) {
      const Region& r = t.regions.region[n];
      region_lights(t.work.lights, r, t.blocks(), t.cull, t.work.region);
      t.counts.tested += t.work.lights.light.size();
      if (t.work.region.light.empty()) continue;
      if constexpr (settles_codes<Shape>() || settles_phong<Shape>())
        if (t.method.settles && settle_region(t, terms, r)) continue;
      if constexpr (comes_by_pairs<Shape>())
        if (t.method.adds) {
          t.method.codes ? add_to_region<true>(t, terms, r) : add_to_region<false>(t, terms, r);
          continue;
        }
      for (int k = 0; k < int(kRegionBlockCount); ++k) {
        if (r.covered[k] == 0) continue;
        const int block = r.block(k, t.blocks());
        const std::span<const ListedLight> list =
            block_lights(t.surface, block, t.work.region, t.cull.distance, t.work.block);
        for (int i = block * kBlockPixels; i < (block + 1) * kBlockPixels; i += int(hn::Lanes(DF())))
          draw(terms, list, i);
      }
    }
  }

 private:
  template <class Shape>
  void draw(const LightTerms<Shape>& terms, std::span<const ListedLight> list, int i) const {
    if (!t.method.adds)
      draw_every_at(t, list, i);
    else if (t.method.codes)
      add_to_vector<true>(t, terms, list, i);
    else
      add_to_vector<false>(t, terms, list, i);
  }
};

void blend_tile_simd(const LightDraws& draws, const SurfaceTile& surface, const TiedFragments* tied,
                     const TileRect& rect, const float clear[4], BlendWork& work, ColorTile& out, LightCounts& counts) {
  TileBlend t(draws, surface, rect, clear, work, out, counts);
  begin_all(t);
  if (surface.covered_pixels == 0 && tied == nullptr) return;
  t.tied = tied != nullptr && !tied->tied.empty() ? tied->tied.data() : nullptr;
  const uint32_t first_light = draws.first_base ? 1 : 0;
  const bool reaching = draws.culling && t.method.adds;
  if (t.method.saturates_alpha && t.method.adds) {
    touching_lights(draws, rect, first_light, work.touching);
    saturate_alpha(t);
  }
  if (reaching) {
    counts.tested += reaching_lights(draws.table, draws.groups, t.regions, t.cull, work.bits, work.touching);
    std::erase_if(work.touching,
                  [&](uint32_t light) { return light < first_light || !touches(draws.outlines, light, rect); });
  } else {
    touching_lights(draws, rect, first_light, work.touching);
  }
  counts.tile_pairs += uint64_t(surface.covered_pixels) * work.touching.size();
  if (t.method.adds && t.method.codes && draws.table.cones) gather_kinds(draws.table, work.touching);
  for (size_t first = 0; first < work.touching.size(); first += kChunkLights) {
    list_chunk(t, first, std::min(work.touching.size(), first + kChunkLights));
    with_shape(draws.model, draws.compiled, DrawRegions{t});
  }
  if (t.tied != nullptr) draw_tied(t.terms, t.plan, *tied, first_light, t.pixels(), out, counts);
  counts.lit_pairs += sum_of(out.light_count, t.pixels());
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
