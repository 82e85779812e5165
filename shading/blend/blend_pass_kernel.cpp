#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "shading/blend/added_light-inl.h"
#include "shading/blend/blend_draw-inl.h"
#include "shading/blend/blend_pass.h"
#include "shading/blend/blend_tile-inl.h"
#include "shading/blend/bounded/bounded_blend-inl.h"  // fast path
#include "shading/blend/fast/added_pairs-inl.h"       // fast path
#include "shading/blend/program_draws-inl.h"
#include "shading/light/fast/compiled_models.h"  // fast path
#include "shading/sum/light_loop-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr size_t kChunkLights = 1024;  // drawn over the whole tile before the next: bounds what lists hold

/// Lights whose geometry may touch the tile, ascending, from `first` on.
inline void touching_lights(const LightVolumeDraws& in, const TileRect& rect, uint32_t first,
                            std::vector<uint32_t>& out) {
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
  uint16_t covered[kMaxTilePixels / kBlockPixels], bare[kMaxTilePixels / kBlockPixels];
  covered_bits(t.surface, blocks, covered);
  std::copy_n(covered, blocks, bare);
  for (size_t first = 0; first < t.work.touching.size(); first += kChunkLights) {
    list_chunk(t, first, std::min(t.work.touching.size(), first + kChunkLights));
    for (int b = 0; b < blocks; ++b)
      for (size_t k = 0; k < t.work.lights.light.size() && bare[b] != 0; ++k)
        bare[b] = uint16_t(bare[b] & ~cover_of_block(t.work.lights, t.work.lights.light[k], b, t.blocks()));
  }
  for (int i = 0; i < t.pixels(); ++i)
    if (((covered[i / kBlockPixels] & ~bare[i / kBlockPixels]) >> (i % kBlockPixels) & 1) != 0)
      t.out.plane[3][i] = t.plan.largest(3);
}

template <bool kCodes, class Shape>
void add_to_vector(const TileBlend& t, const LightTerms<Shape>& terms, std::span<const ListedLight> list, int i) {
  PixelVector px = terms.load(t.surface, i);
  leave_out_tied(t, px, i);
  if (hn::AllFalse(DF(), px.covered)) return;
  StoredPixels pixels(t.out, i);
  AddedLight<kCodes> sum(t.add_plan, pixels);
  add_lights(terms, px, list, VectorInTile(t.work.lights, t.blocks(), i), sum);
  for (int c = 0; c < 3; ++c) pixels.stored[c] = sum.stored[c];
  pixels.lights = sum.lights;
  pixels.store(t.out, i);
  t.counts.evaluated_pairs += sum.evaluated * hn::Lanes(DF());
}

void draw_every_at(const TileBlend& t, std::span<const ListedLight> list, int i) {
  PixelVector px = t.terms.load(t.surface, i);
  leave_out_tied(t, px, i);
  if (hn::AllFalse(DF(), px.covered)) return;
  draw_every(t.terms, t.plan, t.surface, px, list, VectorInTile(t.work.lights, t.blocks(), i), i, t.out, t.counts);
}

// Codes add up in any order: lights of a kind follow each other, so that kernels need not choose light by light.
void gather_kinds(const LightTable& table, std::vector<uint32_t>& lights) {
  const auto point = [&](uint32_t i) { return table.row[i].kind == LightKind::point; };
  const auto coned = [&](uint32_t i) { return table.row[i].kind == LightKind::coned; };
  std::partition(std::partition(lights.begin(), lights.end(), point), lights.end(), coned);
}

/// The draws of a chunk over all regions, by the terms of one shape.
struct DrawRegions {
  const TileBlend& t;

  template <class Shape>
  void operator()(const Shape& shape) const {
    const LightTerms<Shape> terms(t.in.table, t.in.model, shape);
    for (int n = 0; n < t.regions.count; ++n) {
      const Region& r = t.regions.region[n];
      region_lights(t.work.lights, r, t.blocks(), t.cull, t.work.region);
      t.counts.tested += t.work.lights.light.size();
      if (t.work.region.light.empty()) continue;
      if (add_bounded_codes(t, r)) continue;           // fast path
      if (add_region_in_pairs(t, terms, r)) continue;  // fast path
      draw_region(terms, r);
    }
  }

 private:
  template <class Shape>
  void draw_region(const LightTerms<Shape>& terms, const Region& r) const {
    for (int k = 0; k < int(kRegionBlockCount); ++k) {
      if (r.covered[k] == 0) continue;
      const int block = r.block(k, t.blocks());
      for (int i = block * kBlockPixels; i < (block + 1) * kBlockPixels; i += int(hn::Lanes(DF())))
        draw_vector(terms, t.work.region.light, i);
    }
  }

  template <class Shape>
  void draw_vector(const LightTerms<Shape>& terms, std::span<const ListedLight> list, int i) const {
    if (!t.method.adds)
      draw_every_at(t, list, i);
    else if (t.method.codes)
      add_to_vector<true>(t, terms, list, i);
    else
      add_to_vector<false>(t, terms, list, i);
  }
};

/// Lists the lights that may change a pixel of the tile in t.work.touching, ascending, from `first` on.
void list_touching(const TileBlend& t, uint32_t first) {
  const LightVolumeDraws& draws = t.in;
  std::vector<uint32_t>& out = t.work.touching;
  if (draws.culling && t.method.adds) {
    t.counts.tested += reaching_lights(draws.table, draws.clusters, t.regions, t.cull, t.work.bits, out);
    std::erase_if(out, [&](uint32_t light) { return light < first || !touches(draws.outlines, light, t.rect); });
  } else {
    touching_lights(draws, t.rect, first, out);
  }
  t.counts.tile_pairs += uint64_t(t.surface.covered_pixels) * out.size();
  if (t.method.adds && t.method.codes && draws.table.cones) gather_kinds(draws.table, out);
}

/// Draws the lights in t.work.touching, a chunk after the other. by_program: null: the light model draws them.
void draw_touching(const TileBlend& t, ProgramDraws* by_program) {
  const size_t count = t.work.touching.size();
  for (size_t first = 0; first < count; first += kChunkLights) {
    list_chunk(t, first, std::min(count, first + kChunkLights));
    if (by_program != nullptr) {
      by_program->draw_regions();
      continue;
    }
    if (t.in.compiled && with_compiled_shape<CompiledFor::blended>(t.in.model, DrawRegions{t})) continue;  // fast path
    DrawRegions{t}(any_shape(t.in.model));
  }
}

void blend_by_program(const TileBlend& t, const TiedFragments* tied, uint32_t first_light) {
  ProgramDraws draws(t);
  draws.begin();
  list_touching(t, first_light);
  draw_touching(t, &draws);
  if (t.tied != nullptr) draws.draw_tied(*tied, first_light);
}

void blend_by_model(const TileBlend& t, const TiedFragments* tied, uint32_t first_light) {
  if (t.method.saturates_alpha && t.method.adds) {
    touching_lights(t.in, t.rect, first_light, t.work.touching);
    saturate_alpha(t);
  }
  list_touching(t, first_light);
  draw_touching(t, nullptr);
  if (t.tied != nullptr) draw_tied(t.terms, t.plan, *tied, first_light, t.pixels(), t.out, t.counts);
}

void blend_tile_simd(const LightVolumeDraws& draws, const SurfaceTile& surface, const TiedFragments* tied,
                     const TileRect& rect, const float clear[4], BlendWork& work, ColorTile& out, LightCounts& counts) {
  TileBlend t(draws, surface, rect, clear, work, out, counts);
  const bool by_program = draws.table.program != nullptr, nothing = surface.covered_pixels == 0 && tied == nullptr;
  std::fill_n(out.light_count, size_t(t.pixels()), 0u);
  if (!by_program)
    begin_all(t);
  else if (nothing)
    begin_black(t);
  if (nothing) return;
  t.tied = tied != nullptr && !tied->tied.empty() ? tied->tied.data() : nullptr;
  (by_program ? blend_by_program : blend_by_model)(t, tied, draws.first_base ? 1 : 0);
  counts.lit_pairs += sum_of(out.light_count, t.pixels());
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace trueshade {
TRUESHADE_KERNEL(blend_tile, HWY_NAMESPACE::blend_tile_simd);
}  // namespace trueshade
