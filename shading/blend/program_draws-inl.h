// Lights of a light program drawn over a tile, each blended before the next: docs/light_programs.md. Included once per
// SIMD target.
#if defined(TRUESHADE_SHADING_BLEND_PROGRAM_DRAWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_BLEND_PROGRAM_DRAWS_INL_H_
#undef TRUESHADE_SHADING_BLEND_PROGRAM_DRAWS_INL_H_
#else
#define TRUESHADE_SHADING_BLEND_PROGRAM_DRAWS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstring>

#include "shading/blend/blend_draw-inl.h"
#include "shading/blend/blend_tile-inl.h"
#include "shading/sum/program_pairs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Alpha of a draw whose program says nothing of it.
inline constexpr programs::LaneBlock kOpaque{{1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}};

/// The draws of a tile whose table has a program. A draw writes finish(s, v, sum), where the sum is `start` in the first
/// draw, with light 0 where the strategy draws it there, and what `light` gives in a light's. A light's draw leaves out
/// what its extent does not have, and surfaces that are unlit.
class ProgramDraws {
 public:
  explicit ProgramDraws(const TileBlend& t)
      : t_(t),
        program_(*t.in.table.program),
        work_(program_work(program_, t.rect.size, t.work.program)),
        reaches_(program_.executable().program.defines_reaches),
        finishes_(program_.executable().program.defines_finish),
        takes_albedo_(takes_albedo(program_, t.in.model)),
        adds_values_(t.plan.sums_values && !t.plan.written[3]) {}

  /// What pixels hold before the draws that are blended.
  void begin();
  /// The draws in t.work.lights, region by region.
  void draw_regions();
  /// All lights from `first_light` on, at pixels that several fragments share.
  void draw_tied(const TiedFragments& tied, uint32_t first_light);

 private:
  /// Pixels of a block that lights are drawn on: they have a surface, which is not unlit.
  unsigned lit_pixels(const SurfaceTile& surface, int first) const {
    unsigned pixels = 0;
    for (int i = 0; i < kBlockPixels; ++i)
      if (surface.covered[first + i] != 0 && !program_.is_unlit(surface.material[first + i] - 1)) pixels |= 1u << i;
    return pixels;
  }
  unsigned tied_pixels(int first) const {
    unsigned pixels = 0;
    for (int i = 0; t_.tied != nullptr && i < kBlockPixels; ++i) pixels |= unsigned(t_.tied[first + i] & 1) << i;
    return pixels;
  }

  void add_first_light();
  void draw_light(const Region& r, const ListedLight& light);
  void add(int first, const ListedLight& light, unsigned pixels);
  void run();
  void blend(const float* const source[4], unsigned pixels, size_t at) const;
  void count(const programs::PairResults& results, size_t lane, unsigned pixels, size_t at) const;
  const float* alpha(const SurfaceTile& surface, size_t at) const {
    return takes_albedo_ ? surface.plane[kAlbedo + 3] + at : kOpaque.lane;
  }

  struct TiedLayer;
  void draw_tied_block(const TiedFragments& tied, uint32_t first_light, int first, unsigned pixels);
  void light_layer(uint32_t first_light, uint32_t lights, int first, TiedLayer& layer);

  const TileBlend& t_;
  const ProgramFrame& program_;
  ProgramWork& work_;
  const bool reaches_, finishes_, takes_albedo_, adds_values_;
  unsigned lit_[kMaxTilePixels / kBlockPixels];
  PairBatch batch_;
  bool batched_[kMaxTilePixels / kBlockPixels] = {};  ///< blocks of the batch
};

inline void ProgramDraws::add_first_light() {
  const ListedLight light = TileLights::listed(t_.in.table, 0);
  const int blocks = t_.pixels() / kBlockPixels;
  for (int b = 0; b < blocks; ++b) {
    const unsigned pixels = pixels_in_extent(t_.surface, b * kBlockPixels, light, lit_[b]);
    if (pixels != 0) batch_.add(b * kBlockPixels, number_of(t_.in.table, light), pixels);
    if (batch_.count != kBatchBlocks && b + 1 != blocks) continue;
    if (batch_.count != 0) add_pairs(batch_, batch_.run(program_, work_, t_.counts), reaches_, t_.out);
    batch_.count = 0;
  }
}

inline void ProgramDraws::begin() {
  const DF d;
  float* const start[3] = {t_.out.plane[0], t_.out.plane[1], t_.out.plane[2]};
  give_surfaces(program_, t_.surface, t_.rect.size, t_.in.base ? start : nullptr, work_);
  const int blocks = t_.pixels() / kBlockPixels;
  for (int b = 0; b < blocks; ++b) lit_[b] = lit_pixels(t_.surface, b * kBlockPixels);
  if (t_.in.first_base && t_.in.table.size() > 0) add_first_light();
  if (t_.in.base) finish_surfaces(program_, t_.surface, t_.rect.size, t_.in.model, start, work_);
  for (int b = 0; b < blocks; ++b) lit_[b] &= ~tied_pixels(b * kBlockPixels);
  for (int i = 0; i < t_.pixels(); i += int(hn::Lanes(d))) {
    const MF drawn = t_.in.base ? covered_lanes(t_.surface, i) : lanes_of(0);
    for (int c = 0; c < 4; ++c) {
      const VF clear = encoded_alone(t_.plan, hn::Set(d, t_.clear[c]), c);
      const VF stored = encoded_alone(t_.plan, hn::Load(d, work_.finished[c] + i), c);
      hn::Store(hn::IfThenElse(drawn, stored, clear), d, t_.out.plane[c] + i);
    }
  }
}

/// Blends fragments of a block into the pixels from `at` on.
inline void ProgramDraws::blend(const float* const source[4], unsigned pixels, size_t at) const {
  const DF d;
  for (size_t i = 0; i < size_t(kBlockPixels); i += hn::Lanes(d)) {
    const MF drawn = lanes_of(pixels >> i);
    VF from[4], stored[4], next[4];
    for (int c = 0; c < 4; ++c) {
      from[c] = hn::Load(d, source[c] + i);
      next[c] = stored[c] = hn::Load(d, t_.out.plane[c] + at + i);
    }
    if (adds_values_)
      sum_values(t_.plan, from, next);
    else
      blend_out_of_line(t_.plan, from, next);
    for (int c = 0; c < 4; ++c)
      hn::Store(hn::IfThenElse(drawn, next[c], stored[c]), d, t_.out.plane[c] + at + i);
  }
}

inline void ProgramDraws::add(int first, const ListedLight& light, unsigned pixels) {
  bool& batched = batched_[first / kBlockPixels];
  if (batch_.count == kBatchBlocks || (finishes_ && batched)) run();
  batch_.add(first, number_of(t_.in.table, light), pixels);
  batched = true;
}

/// Draws the batch. A program's own `finish` takes each light's sum by itself, at pixels of which the batch has one light.
inline void ProgramDraws::run() {
  if (batch_.count == 0) return;
  const programs::PairResults results = batch_.run(program_, work_, t_.counts);
  for (size_t k = 0; k < batch_.count; ++k) count(results, k * kBlockPixels, batch_.pair[k].wanted, batch_.pair[k].first_pixel);
  std::array<const float*, 4> made{results.light[0], results.light[1], results.light[2], nullptr};
  if (finishes_) {
    for (size_t k = 0; k < batch_.count; ++k)
      for (int c = 0; c < 3; ++c)
        std::copy_n(results.light[c] + k * kBlockPixels, kBlockPixels, work_.sum[c] + batch_.pair[k].first_pixel);
    const float* const sum[3] = {work_.sum[0], work_.sum[1], work_.sum[2]};
    made = run_finish(program_.executable(), program_.constants(), work_.surfaces, sum, {batch_.pair, batch_.count},
                      work_.registers);
  }
  for (size_t k = 0; k < batch_.count; ++k) {
    const size_t at = batch_.pair[k].first_pixel, lane = k * kBlockPixels;
    const float* const source[4] = {made[0] + lane, made[1] + lane, made[2] + lane,
                                    finishes_ ? made[3] + lane : alpha(t_.surface, at)};
    blend(source, batch_.pair[k].wanted, at);
    batched_[at / kBlockPixels] = false;
  }
  batch_.count = 0;
}

inline void ProgramDraws::draw_regions() {
  for (int n = 0; n < t_.regions.count; ++n) {
    const Region& r = t_.regions.region[n];
    region_lights(t_.work.lights, r, t_.blocks(), t_.cull, t_.work.region);
    t_.counts.tested += t_.work.lights.light.size();
    for (const ListedLight& light : t_.work.region.light) draw_light(r, light);
  }
  run();
}

inline void ProgramDraws::draw_light(const Region& r, const ListedLight& light) {
  for (int k = 0; k < int(kRegionBlockCount); ++k) {
    if (r.covered[k] == 0) continue;
    const int block = r.block(k, t_.blocks());
    const unsigned pixels = lit_[block] & cover_of_block(t_.work.lights, light, block, t_.blocks());
    if (pixels == 0) continue;
    const int first = block * kBlockPixels;
    if (const unsigned near = pixels_in_extent(t_.surface, first, light, pixels); near != 0) add(first, light, near);
  }
}

/// A block of a layer of fragments that share pixels, and what some lights draw there.
struct ProgramDraws::TiedLayer {
  TiedLayer(const SurfaceTile& of, const programs::Stage& stage, unsigned drawn)
      : surface(of), pixels(drawn), values(stage, kBlockPixels), source(4 * kBatchBlocks) {}

  const SurfaceTile& surface;
  unsigned pixels;
  programs::LaneValues values;
  std::vector<programs::LaneBlock> source;  ///< four a light
  unsigned drawn[kBatchBlocks];             ///< pixels of each light
};

inline void ProgramDraws::draw_tied(const TiedFragments& tied, uint32_t first_light) {
  for (int first = 0; first < t_.pixels(); first += kBlockPixels)
    if (const unsigned pixels = tied_pixels(first); pixels != 0) draw_tied_block(tied, first_light, first, pixels);
}

inline void ProgramDraws::draw_tied_block(const TiedFragments& tied, uint32_t first_light, int first, unsigned pixels) {
  const programs::Stage& stage = program_.executable().at(programs::Rate::surface);
  const uint32_t* const places[2] = {work_.pixel[0], work_.pixel[1]};
  std::vector<TiedLayer> layers;
  for (size_t k = 0; k < tied.used; ++k) {
    const SurfaceTile& surface = *tied.layers[k];
    const unsigned drawn = pixels & lit_pixels(surface, first);
    if (drawn == 0) continue;
    TiedLayer& layer = layers.emplace_back(surface, stage, drawn);
    for (size_t i = 0; i < stage.inputs.size(); ++i)
      layer.values.set_input(i, static_cast<const float*>(program_.plane_of(i, surface, places)) + first);
    run_surfaces(program_.executable(), program_.constants(), layer.values, nullptr, work_.registers);
  }
  const auto lights = uint32_t(t_.in.table.size());
  for (uint32_t light = first_light; light < lights; light += kBatchBlocks) {
    const uint32_t count = std::min(lights - light, uint32_t(kBatchBlocks));
    for (TiedLayer& layer : layers) light_layer(light, count, first, layer);
    for (uint32_t k = 0; k < count; ++k)
      for (const TiedLayer& layer : layers) {
        const programs::LaneBlock* const of = &layer.source[4 * k];
        const float* const source[4] = {of[0].lane, of[1].lane, of[2].lane, of[3].lane};
        blend(source, layer.drawn[k], size_t(first));
      }
  }
}

/// What lights draw of a layer.
inline void ProgramDraws::light_layer(uint32_t first_light, uint32_t lights, int first, TiedLayer& layer) {
  PairBatch batch;
  for (uint32_t k = 0; k < lights; ++k) {
    const ListedLight light = TileLights::listed(t_.in.table, first_light + k);
    layer.drawn[k] = pixels_in_extent(layer.surface, first, light, layer.pixels);
    batch.add(0, number_of(t_.in.table, light), layer.drawn[k]);
  }
  t_.counts.evaluated_pairs += lights * kBlockPixels;
  const programs::PairResults results = run_pairs(program_.executable(), program_.constants(), program_.lights(),
                                                  layer.values, {batch.pair, lights}, work_.registers);
  for (uint32_t k = 0; k < lights; ++k) {
    programs::LaneBlock* const to = &layer.source[4 * k];
    count(results, k * kBlockPixels, layer.drawn[k], size_t(first));
    for (int c = 0; c < 3; ++c) std::copy_n(results.light[c] + k * kBlockPixels, kBlockPixels, to[c].lane);
    std::copy_n(alpha(layer.surface, size_t(first)), kBlockPixels, to[3].lane);
  }
  for (uint32_t k = 0; finishes_ && k < lights; ++k) {
    programs::LaneBlock* const to = &layer.source[4 * k];
    const programs::LaneBlock light[3] = {to[0], to[1], to[2]};
    const float* const sum[3] = {light[0].lane, light[1].lane, light[2].lane};
    float* const finished[4] = {to[0].lane, to[1].lane, to[2].lane, to[3].lane};
    run_finish(program_.executable(), program_.constants(), layer.values, sum, finished, work_.registers);
  }
}

/// Counts the lights of a pair at the pixels from `at` on.
inline void ProgramDraws::count(const programs::PairResults& results, size_t lane, unsigned pixels, size_t at) const {
  for (size_t i = 0; i < size_t(kBlockPixels); i += hn::Lanes(DF()))
    PairVector(results, lane + i, pixels >> i, reaches_).count(t_.out, at + i);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
