#include "shading/blend_pass.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/blend_pass.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>

#include "raster/outline-inl.h"
#include "shading/blend-inl.h"
#include "shading/light_lists-inl.h"
#include "shading/light_sum-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr size_t kChunkLights = 1024;  // drawn over the whole tile before the next: bounds what lists hold
constexpr int32_t kFromOutline = -1, kEverywhere = -2;

/// Pixels of one vector that draws cover, by the masks of the vector's block.
struct CoverageOfVector {
  const RegionMasks* masks;
  int block;        ///< in the region
  int first_pixel;  ///< in the block

  HWY_INLINE unsigned bits(size_t k) const { return masks[k].block[block]; }
  HWY_INLINE MF at(size_t k) const {
    const unsigned shifted = bits(k) >> first_pixel;
    const uint8_t bytes[8] = {uint8_t(shifted), uint8_t(shifted >> 8)};
    return hn::LoadMaskBits(DF(), bytes);
  }
};

HWY_NOINLINE void blend_out_of_line(const BlendPlan& plan, const VF source[4], VF stored[4]) {
  blend_vectors(plan, source, stored);
}

/// A vector of target pixels in registers, onto which light is added: where a light adds nothing nothing changes, and
/// alpha is not written. kCodes: fixed point, by adding codes (DESIGN, settled 4).
template <bool kCodes>
struct AddedLight {
  const BlendPlan& plan;
  const CoverageOfVector cover;
  VF stored[4];
  hn::Vec<DI> lights;
  uint64_t evaluated;

  HWY_INLINE void limit(size_t k, LightTerm& term) const {
    if (cover.bits(k) == 0xFFFF) return;
    const MF drawn = cover.at(k);
    term.adds = hn::And(term.adds, drawn);
    term.lit = hn::And(term.lit, drawn);
  }
  template <class Terms>
  HWY_INLINE void add(const Terms& terms, const PixelVector& px, const LightTerm& term) {
    const DF d;
    VF next[4] = {stored[0], stored[1], stored[2], stored[3]}, source[4];
    for (int c = 0; c < 3; ++c) source[c] = terms.finished(px, term.color[c], c);
    source[3] = hn::Zero(d);
    if constexpr (kCodes) {
      for (int c = 0; c < 3; ++c)
        next[c] = lesser(hn::Add(stored[c], unorm_code(source[c], plan.largest(c))), hn::Set(d, plan.largest(c)));
    } else {
      blend_out_of_line(plan, source, next);
    }
    for (int c = 0; c < 3; ++c) stored[c] = hn::IfThenElse(term.adds, next[c], stored[c]);
  }
};

/// How the light draws of a frame may be computed.
struct BlendMethod {
  bool adds;             ///< a light that adds 0 changes nothing but alpha
  bool saturates_alpha;  ///< any draw makes alpha 1
  bool codes;            ///< AddedLight<true>
};

inline BlendMethod blend_method(const LightDraws& in, const BlendPlan& plan, const float clear[4]) {
  bool positive = in.model.diffuse == Diffuse::clamped && in.model.falloff != Falloff::linear;
  for (int c = 0; c < 4; ++c) positive = positive && !std::signbit(clear[c]);  // -0 + 0 is 0
  bool rgb = plan.enabled && plan.rgb.term == kAccumulate && !plan.flushes && (plan.unorm() || positive);
  for (size_t c = 0; c < 3; ++c) rgb = rgb && plan.written[c];
  const bool saturates =
      plan.written[3] && plan.unorm() && plan.alpha.term == kAccumulate && !in.model.alpha_from_albedo;
  return {rgb && (saturates || !plan.written[3]), saturates, plan.adds_codes(0)};
}

/// Covered pixels of each block of a tile, bit by bit.
inline void covered_bits(const SurfaceTile& surface, int blocks, uint16_t* bits) {
  for (int b = 0; b < blocks; ++b) {
    unsigned mask = 0;
    for (int i = 0; i < kBlockPixels; ++i) mask |= unsigned(surface.covered[b * kBlockPixels + i] & 1) << i;
    bits[b] = uint16_t(mask);
  }
}

/// Lights whose geometry may touch the tile, ascending, from `first` on.
inline void touching_lights(const LightDraws& in, const TileRect& rect, uint32_t first, std::vector<uint32_t>& out) {
  const DI di;
  const LightOutlines& o = in.outlines;
  const auto left = hn::Set(di, rect.x), low = hn::Set(di, rect.y);
  const auto right = hn::Set(di, rect.x + rect.size), high = hn::Set(di, rect.y + rect.size);
  alignas(64) int32_t touch[HWY_MAX_BYTES / sizeof(int32_t)];
  out.clear();
  const size_t count = in.lights.size(), lanes = hn::Lanes(di);
  for (size_t i = 0; i < count; i += lanes) {
    const auto in_x = hn::And(hn::Lt(hn::LoadU(di, &o.x0[i]), right), hn::Gt(hn::LoadU(di, &o.x1[i]), left));
    const auto in_y = hn::And(hn::Lt(hn::LoadU(di, &o.y0[i]), high), hn::Gt(hn::LoadU(di, &o.y1[i]), low));
    const auto both = hn::And(in_x, in_y);
    if (hn::AllFalse(di, both)) continue;
    hn::Store(hn::VecFromMask(di, both), di, touch);
    for (size_t k = 0; k < lanes && i + k < count; ++k)
      if (touch[k] != 0 && i + k >= first) out.push_back(uint32_t(i + k));
  }
}

/// One tile's light draws with terms of one shape.
template <class Shape>
class TileBlender {
 public:
  TileBlender(const LightDraws& draws, const Shape& shape, const SurfaceTile& surface, const TileRect& rect,
              const float clear[4], BlendWork& work, ColorTile& out, LightCounts& counts)
      : in_(draws),
        terms_(draws.table, draws.model, shape),
        surface_(surface),
        rect_(rect),
        clear_(clear),
        work_(work),
        out_(out),
        counts_(counts),
        plan_(blend_plan(draws.blend, draws.target)),
        add_plan_(plan_),
        method_(blend_method(draws, plan_, clear)),
        blocks_(rect.size / kBlockSize) {
    add_plan_.written[3] = false;
    std::fill_n(out.light_count, size_t(rect.size) * size_t(rect.size), 0u);
  }

  void draw(const TiedFragments* tied) {
    for (int i = 0; i < rect_.size * rect_.size; i += int(hn::Lanes(DF()))) begin(i);
    if (surface_.covered_pixels == 0 && tied == nullptr) return;
    tied_ = tied != nullptr && !tied->tied.empty() ? tied->tied.data() : nullptr;
    touching_lights(in_, rect_, in_.first_base ? 1 : 0, work_.touching);
    if (method_.saturates_alpha && method_.adds) saturate_alpha();
    if (in_.culling && method_.adds) drop_out_of_reach();
    counts_.tile_pairs += uint64_t(surface_.covered_pixels) * work_.touching.size();
    for (size_t first = 0; first < work_.touching.size(); first += kChunkLights) {
      const size_t end = std::min(work_.touching.size(), first + kChunkLights);
      work_.chunk.assign(work_.touching.begin() + std::ptrdiff_t(first), work_.touching.begin() + std::ptrdiff_t(end));
      list_draws();
      for (int by = 0; by < blocks_; by += kRegionBlocks)
        for (int bx = 0; bx < blocks_; bx += kRegionBlocks) draw_region(bx, by);
    }
    if (tied_ != nullptr) draw_tied(*tied);
    const auto pixels = size_t(rect_.size) * size_t(rect_.size);
    for (size_t i = 0; i < pixels; ++i) counts_.lit_pairs += out_.light_count[i];
  }

 private:
  void store(const VF stored[4], int i) {
    for (int c = 0; c < 4; ++c) hn::Store(stored[c], DF(), out_.plane[c] + i);
  }

  // What a vector of pixels holds before any light, or after the first.
  void begin(int i) {
    const DF d;
    const DI di;
    const PixelVector px = terms_.load(surface_, i);
    VF stored[4];
    for (int c = 0; c < 4; ++c) stored[c] = encoded_alone(plan_, hn::Set(d, clear_[c]), c);
    if (in_.base && !hn::AllFalse(d, px.covered)) {
      VF sum[4];
      for (int c = 0; c < 3; ++c) sum[c] = terms_.start(surface_, i, px, c);
      if (in_.first_base && in_.table.size() > 0) {
        LightTerm term;
        term_of(px, 0, term);
        for (int c = 0; c < 3; ++c) sum[c] = hn::Add(sum[c], hn::IfThenElseZero(term.adds, term.color[c]));
        count_lights(hn::IfThenElseZero(hn::RebindMask(di, term.lit), hn::Set(di, 1)), i);
      }
      for (int c = 0; c < 3; ++c) sum[c] = terms_.finished(px, sum[c], c);
      sum[3] = terms_.alpha(surface_, i);
      for (int c = 0; c < 4; ++c) stored[c] = hn::IfThenElse(px.covered, encoded_alone(plan_, sum[c], c), stored[c]);
    }
    store(stored, i);
  }

  // Out of line: it is needed in several places, and is long.
  HWY_NOINLINE void term_of(const PixelVector& px, uint32_t light, LightTerm& term) const { term = terms_(px, light); }

  void count_lights(hn::Vec<DI> lights, int i) {
    const DI di;
    int32_t* count = reinterpret_cast<int32_t*>(out_.light_count) + i;
    hn::Store(hn::Add(hn::Load(di, count), lights), di, count);
  }

  // Coverage of one light over a region, by its outline.
  RegionCover cover(uint32_t light, int bx, int by, RegionMasks& masks) const {
    if (in_.outlines.kind[light] == OutlineKind::everywhere) return RegionCover::all;
    const int width = std::min(kRegionBlocks, blocks_ - bx) * kBlockSize;
    const int height = std::min(kRegionBlocks, blocks_ - by) * kBlockSize;
    return polygon_cover(in_.outlines, light, rect_.x + bx * kBlockSize, rect_.y + by * kBlockSize, width, height,
                         masks);
  }

  bool touches_region(uint32_t light, int bx, int by) const {
    const LightOutlines& o = in_.outlines;
    const int x = rect_.x + bx * kBlockSize, y = rect_.y + by * kBlockSize;
    return o.x0[light] < x + kRegionSize && o.x1[light] > x && o.y0[light] < y + kRegionSize && o.y1[light] > y;
  }

  int mesh_counts(uint32_t light) {
    work_.counts.resize(kMaxTilePixels);
    const LightMesh& mesh = in_.meshes[drawn_extent(in_.lights[light], in_.volumes)];
    return count_light_mesh(mesh, in_.lights[light], in_.outlines, in_.view, rect_, work_.counts.data());
  }

  // Alpha 1 where any light is drawn, in reach or not: no culled list will do.
  void saturate_alpha() {
    const float full = plan_.largest(3);
    uint16_t covered[kMaxTilePixels / kBlockPixels], open[kMaxTilePixels / kBlockPixels];
    covered_bits(surface_, blocks_ * blocks_, covered);
    std::copy_n(covered, blocks_ * blocks_, open);
    for (int by = 0; by < blocks_; by += kRegionBlocks)
      for (int bx = 0; bx < blocks_; bx += kRegionBlocks) close_region(bx, by, open);
    for (const uint32_t light : work_.touching) {
      if (in_.outlines.kind[light] != OutlineKind::mesh) continue;
      if (std::all_of(open, open + blocks_ * blocks_, [](uint16_t bits) { return bits == 0; })) break;
      mesh_counts(light);
      for (int i = 0; i < rect_.size * rect_.size; ++i)
        if (work_.counts[size_t(i)] != 0) open[i / kBlockPixels] &= uint16_t(~(1u << (i % kBlockPixels)));
    }
    for (int i = 0; i < rect_.size * rect_.size; ++i)
      if (((covered[i / kBlockPixels] & ~open[i / kBlockPixels]) >> (i % kBlockPixels) & 1) != 0)
        out_.plane[3][i] = full;
  }

  void close_region(int bx, int by, uint16_t* open) {
    int block[kRegionBlocks * kRegionBlocks];
    const int count = region_blocks(blocks_, bx, by, block);
    for (const uint32_t light : work_.touching) {
      if (in_.outlines.kind[light] == OutlineKind::mesh || !touches_region(light, bx, by)) continue;
      RegionMasks masks;
      const RegionCover covers = cover(light, bx, by, masks);
      if (covers == RegionCover::none) continue;
      unsigned left = 0;
      for (int i = 0; i < count; ++i) {
        const int at = (block[i] / blocks_ - by) * kRegionBlocks + block[i] % blocks_ - bx;
        open[block[i]] &= covers == RegionCover::all ? uint16_t(0) : uint16_t(~masks.block[at]);
        left |= open[block[i]];
      }
      if (left == 0) return;
    }
  }

  void drop_out_of_reach() {
    int all[kMaxTilePixels / kBlockPixels];
    for (int i = 0; i < blocks_ * blocks_; ++i) all[i] = i;
    work_.region.clear();
    reaching_lights(
        in_.table, surface_box(surface_, all, blocks_ * blocks_), work_.touching.size(),
        [&](size_t k) { return work_.touching[k]; }, work_.region);
    work_.touching.swap(work_.region);
  }

  // The draws of a chunk: a light once for each time its geometry covers a pixel.
  void list_draws() {
    work_.entry_light.clear();
    work_.entry_masks.clear();
    work_.tile_masks.clear();
    const auto add = [&](uint32_t light, int32_t masks) {
      work_.entry_light.push_back(light);
      work_.entry_masks.push_back(masks);
    };
    for (const uint32_t light : work_.chunk) {
      const OutlineKind kind = in_.outlines.kind[light];
      if (kind == OutlineKind::everywhere) add(light, kEverywhere);
      if (kind == OutlineKind::polygon)
        for (int i = 0; i < in_.outlines.layers[light]; ++i) add(light, kFromOutline);
      if (kind != OutlineKind::mesh) continue;
      const int most = mesh_counts(light);
      for (int layer = 1; layer <= most; ++layer) {
        add(light, int32_t(work_.tile_masks.size()));
        for (int b = 0; b < blocks_ * blocks_; ++b) {
          unsigned mask = 0;
          for (int i = 0; i < kBlockPixels; ++i)
            mask |= unsigned(work_.counts[size_t(b * kBlockPixels + i)] >= layer) << i;
          work_.tile_masks.push_back(uint16_t(mask));
        }
      }
    }
  }

  // Masks of an entry over a region; false where it covers nothing.
  bool region_masks_of(size_t entry, int bx, int by, RegionMasks& masks) const {
    const int32_t from = work_.entry_masks[entry];
    RegionCover covers = RegionCover::all;
    if (from == kFromOutline) {
      if (!touches_region(work_.entry_light[entry], bx, by)) return false;
      covers = cover(work_.entry_light[entry], bx, by, masks);
    } else if (from >= 0) {
      unsigned any = 0;
      for (int y = 0; y < std::min(kRegionBlocks, blocks_ - by); ++y)
        for (int x = 0; x < std::min(kRegionBlocks, blocks_ - bx); ++x)
          any |= masks.block[y * kRegionBlocks + x] = work_.tile_masks[size_t(from + (by + y) * blocks_ + bx + x)];
      covers = any == 0 ? RegionCover::none : RegionCover::some;
    }
    if (covers == RegionCover::all) std::fill(std::begin(masks.block), std::end(masks.block), uint16_t(0xFFFF));
    return covers != RegionCover::none;
  }

  void draw_region(int bx, int by) {
    int block[kRegionBlocks * kRegionBlocks];
    const int count = region_blocks(blocks_, bx, by, block);
    const Box box = surface_box(surface_, block, count);
    if (box.pixels == 0) return;
    work_.region.clear();
    work_.region_masks.clear();
    for (size_t e = 0; e < work_.entry_light.size(); ++e) {
      const uint32_t light = work_.entry_light[e];
      if (in_.culling && method_.adds && out_of_reach(in_.table, box, light)) continue;
      RegionMasks masks;
      if (!region_masks_of(e, bx, by, masks)) continue;
      work_.region.push_back(light);
      work_.region_masks.push_back(masks);
    }
    if (work_.region.empty()) return;
    for (int i = 0; i < count; ++i) {
      const int at = (block[i] / blocks_ - by) * kRegionBlocks + block[i] % blocks_ - bx;
      for (int k = 0; k < kBlockPixels; k += int(hn::Lanes(DF()))) {
        const CoverageOfVector cover{work_.region_masks.data(), at, k};
        PixelVector px = terms_.load(surface_, block[i] * kBlockPixels + k);
        leave_out_tied(px, block[i] * kBlockPixels + k);
        if (hn::AllFalse(DF(), px.covered)) continue;
        if (!method_.adds)
          draw_every(px, cover, block[i] * kBlockPixels + k);
        else if (method_.codes)
          add_all<true>(px, cover, block[i] * kBlockPixels + k);
        else
          add_all<false>(px, cover, block[i] * kBlockPixels + k);
      }
    }
  }

  void leave_out_tied(PixelVector& px, int i) const {
    if (tied_ == nullptr) return;
    const DI di;
    const auto tied = hn::Load(di, tied_ + i);
    px.covered = hn::And(px.covered, hn::RebindMask(DF(), hn::Eq(tied, hn::Zero(di))));
  }

  template <bool kCodes>
  void add_all(const PixelVector& px, const CoverageOfVector& cover, int i) {
    AddedLight<kCodes> sum{add_plan_, cover, {}, hn::Zero(DI()), 0};
    for (int c = 0; c < 4; ++c) sum.stored[c] = hn::Load(DF(), out_.plane[c] + i);
    add_lights(terms_, px, std::span<const uint32_t>(work_.region), sum);
    store(sum.stored, i);
    count_lights(sum.lights, i);
    counts_.evaluated_pairs += sum.evaluated * hn::Lanes(DF());
  }

  // One draw in full, for blending that a draw of nothing changes too.
  void blend_draw(const PixelVector& px, uint32_t light, MF drawn, VF alpha, VF stored[4], hn::Vec<DI>& lights) {
    const DF d;
    const DI di;
    LightTerm term;
    term_of(px, light, term);
    VF source[4], next[4] = {stored[0], stored[1], stored[2], stored[3]};
    for (int c = 0; c < 3; ++c) source[c] = terms_.finished(px, hn::IfThenElseZero(term.adds, term.color[c]), c);
    source[3] = alpha;
    blend_out_of_line(plan_, source, next);
    for (int c = 0; c < 4; ++c) stored[c] = hn::IfThenElse(drawn, next[c], stored[c]);
    const MF lit = hn::And(term.lit, drawn);
    lights = hn::Add(lights, hn::IfThenElseZero(hn::RebindMask(di, lit), hn::Set(di, 1)));
    counts_.evaluated_pairs += hn::AllFalse(d, hn::And(term.adds, drawn)) ? 0 : hn::Lanes(d);
  }

  // Pixels of a vector that the light's extent does not discard.
  MF inside_extent(const PixelVector& px, uint32_t light) const {
    const DF d;
    const float extent2 = in_.table.extent2[light];
    if (std::isinf(extent2)) return px.covered;
    VF to_light[3];
    for (int c = 0; c < 3; ++c) to_light[c] = hn::Sub(hn::Set(d, in_.table.position[c][light]), px.p[c]);
    return hn::And(px.covered, hn::Lt(dot3(to_light, to_light), hn::Set(d, extent2)));
  }

  void draw_every(const PixelVector& px, const CoverageOfVector& cover, int i) {
    const DF d;
    VF stored[4];
    for (int c = 0; c < 4; ++c) stored[c] = hn::Load(d, out_.plane[c] + i);
    auto lights = hn::Zero(DI());
    const VF alpha = terms_.alpha(surface_, i);
    for (size_t k = 0; k < work_.region.size(); ++k) {
      const MF drawn = hn::And(inside_extent(px, work_.region[k]), cover.at(k));
      if (!hn::AllFalse(d, drawn)) blend_draw(px, work_.region[k], drawn, alpha, stored, lights);
    }
    store(stored, i);
    count_lights(lights, i);
  }

  // Pixels that several fragments share: every light but the first draws all of them, in order of submission.
  void draw_tied(const TiedFragments& tied) {
    const DF d;
    const DI di;
    for (int i = 0; i < rect_.size * rect_.size; i += int(hn::Lanes(d))) {
      if (hn::AllTrue(di, hn::Eq(hn::Load(di, tied_ + i), hn::Zero(di)))) continue;
      VF stored[4];
      for (int c = 0; c < 4; ++c) stored[c] = hn::Load(d, out_.plane[c] + i);
      auto lights = hn::Zero(di);
      for (uint32_t light = 1; light < in_.table.size(); ++light)
        for (size_t layer = 0; layer < tied.used; ++layer) {
          const PixelVector px = terms_.load(*tied.layers[layer], i);
          const MF drawn = inside_extent(px, light);
          if (!hn::AllFalse(d, drawn))
            blend_draw(px, light, drawn, terms_.alpha(*tied.layers[layer], i), stored, lights);
        }
      store(stored, i);
      count_lights(lights, i);
    }
  }

  const LightDraws& in_;
  const LightTerms<Shape> terms_;
  const SurfaceTile& surface_;
  const TileRect& rect_;
  const float* clear_;
  BlendWork& work_;
  ColorTile& out_;
  LightCounts& counts_;
  const BlendPlan plan_;
  BlendPlan add_plan_;  // without alpha
  const BlendMethod method_;
  const int blocks_;
  const int32_t* tied_ = nullptr;
};

/// What blend_tile() is given.
struct BlendTileWork {
  const LightDraws& draws;
  const SurfaceTile& surface;
  const TiedFragments* tied;
  const TileRect& rect;
  const float* clear;
  BlendWork& work;
  ColorTile& out;
  LightCounts& counts;

  template <class Shape>
  void operator()(const Shape& shape) const {
    TileBlender<Shape>(draws, shape, surface, rect, clear, work, out, counts).draw(tied);
  }
};

void blend_tile_simd(const LightDraws& draws, const SurfaceTile& surface, const TiedFragments* tied,
                     const TileRect& rect, const float clear[4], BlendWork& work, ColorTile& out, LightCounts& counts) {
  const BlendTileWork kernel{draws, surface, tied, rect, clear, work, out, counts};
  kernel(AnyShape{shape_of(draws.model, false)});
}

uint64_t count_lit_geometry_simd(const LightDraws& draws, const SurfaceTile& surface, const TileRect& rect,
                                 BlendWork& work) {
  const int blocks = rect.size / kBlockSize;
  uint16_t covered[kMaxTilePixels / kBlockPixels];
  covered_bits(surface, blocks * blocks, covered);
  touching_lights(draws, rect, 0, work.touching);
  work.counts.resize(kMaxTilePixels);
  uint64_t total = 0;
  for (const uint32_t light : work.touching) {
    const OutlineKind kind = draws.outlines.kind[light];
    if (kind == OutlineKind::everywhere) total += uint64_t(surface.covered_pixels);
    if (kind == OutlineKind::mesh) {
      const LightMesh& mesh = draws.meshes[drawn_extent(draws.lights[light], draws.volumes)];
      count_light_mesh(mesh, draws.lights[light], draws.outlines, draws.view, rect, work.counts.data());
      for (int i = 0; i < rect.size * rect.size; ++i) total += uint64_t(work.counts[size_t(i)] & surface.covered[i]);
    }
    if (kind != OutlineKind::polygon) continue;
    for (int by = 0; by < blocks; by += kRegionBlocks)
      for (int bx = 0; bx < blocks; bx += kRegionBlocks) {
        const int wide = std::min(kRegionBlocks, blocks - bx), tall = std::min(kRegionBlocks, blocks - by);
        RegionMasks masks;
        const RegionCover cover = polygon_cover(draws.outlines, light, rect.x + bx * kBlockSize,
                                                rect.y + by * kBlockSize, wide * kBlockSize, tall * kBlockSize, masks);
        if (cover == RegionCover::none) continue;
        for (int y = 0; y < tall; ++y)
          for (int x = 0; x < wide; ++x) {
            const unsigned mask = cover == RegionCover::all ? 0xFFFFu : masks.block[y * kRegionBlocks + x];
            total += uint64_t(std::popcount(mask & covered[(by + y) * blocks + bx + x])) * draws.outlines.layers[light];
          }
      }
  }
  return total;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trueshade {
HWY_EXPORT(blend_tile_simd);
HWY_EXPORT(count_lit_geometry_simd);

void blend_tile(const LightDraws& draws, const SurfaceTile& surface, const TiedFragments* tied, const TileRect& rect,
                const float clear[4], BlendWork& work, ColorTile& out, LightCounts& counts) {
  HWY_DYNAMIC_DISPATCH(blend_tile_simd)(draws, surface, tied, rect, clear, work, out, counts);
}

uint64_t count_lit_geometry(const LightDraws& draws, const SurfaceTile& surface, const TileRect& rect,
                            BlendWork& work) {
  return HWY_DYNAMIC_DISPATCH(count_lit_geometry_simd)(draws, surface, rect, work);
}
}  // namespace trueshade
#endif  // HWY_ONCE
