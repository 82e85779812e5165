// Pairs of a block of pixels and a light on their way through a light program. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_SUM_PROGRAM_PAIRS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_SUM_PROGRAM_PAIRS_INL_H_
#undef TRUESHADE_SHADING_SUM_PROGRAM_PAIRS_INL_H_
#else
#define TRUESHADE_SHADING_SUM_PROGRAM_PAIRS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <span>

#include "shading/light/light_term-inl.h"
#include "shading/light/lists/light_lists-inl.h"
#include "shading/sum/light_pass.h"
#include "shading/sum/program_work.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using programs::kBatchBlocks;
static_assert(programs::kBlockLanes == kBlockPixels);

/// A batch of pairs, and the pixels of each that the light is brought to.
struct PairBatch {
  programs::PairBlock pair[kBatchBlocks];
  size_t count = 0;

  void add(int first_pixel, uint32_t light, unsigned pixels) { pair[count++] = {uint32_t(first_pixel), light, pixels}; }
  programs::PairResults run(const ProgramFrame& program, ProgramWork& work, LightCounts& counts) const {
    counts.evaluated_pairs += count * kBlockPixels;
    return run_pairs(program.executable(), program.constants(), program.lights(), work.surfaces, {pair, count},
                     work.registers);
  }
};

/// A listed light's number in the scene.
inline uint32_t number_of(const LightTable& lights, const ListedLight& listed) {
  return lights.first_light + uint32_t(listed.light - lights.row.data());
}

/// What the program gives for one light at a vector of pixels.
struct PairVector {
  VF light[3];
  MF adds;     ///< some channel is not 0, at a pixel that the light is brought to
  MF counted;  ///< the light is counted there

  PairVector(const programs::PairResults& results, size_t at, unsigned pixels, bool reaches) {
    const DF d;
    const DI di;
    const VF zero = hn::Zero(d);
    for (int c = 0; c < 3; ++c) light[c] = hn::Load(d, results.light[c] + at);
    // Highway's Ne is false with NaN on some targets.
    const MF black = hn::And(hn::And(hn::Eq(light[0], zero), hn::Eq(light[1], zero)), hn::Eq(light[2], zero));
    adds = counted = hn::And(lanes_of(pixels), hn::Not(black));
    if (!reaches) return;
    const auto words = hn::Load(di, reinterpret_cast<const int32_t*>(results.reaches + at));
    counted = hn::And(lanes_of(pixels), hn::RebindMask(d, hn::Ne(words, hn::Zero(di))));
  }

  void count(ColorTile& out, size_t at) const {
    int32_t* const count = reinterpret_cast<int32_t*>(out.light_count + at);
    hn::Store(counted_with(hn::Load(DI(), count)), DI(), count);
  }
  hn::Vec<DI> counted_with(hn::Vec<DI> count) const {
    return hn::Sub(count, hn::VecFromMask(DI(), hn::RebindMask(DI(), counted)));
  }
};

/// Adds the results of pairs of one block, in their order, to the sums of a vector of its pixels, those from lane i on.
inline void add_pairs_of_block(const PairBatch& batch, size_t first, size_t end, size_t i,
                               const programs::PairResults& results, bool reaches, ColorTile& out) {
  const DF d;
  const DI di;
  const size_t at = batch.pair[first].first_pixel + i;
  int32_t* const count = reinterpret_cast<int32_t*>(out.light_count + at);
  VF sum[3];
  for (int c = 0; c < 3; ++c) sum[c] = hn::Load(d, out.plane[c] + at);
  hn::Vec<DI> lights = hn::Load(di, count);
  for (size_t k = first; k < end; ++k) {
    const unsigned pixels = batch.pair[k].wanted >> i;
    if (hn::MaxLanes(d) < size_t(kBlockPixels) && (pixels & ((1u << hn::MaxLanes(d)) - 1)) == 0) continue;
    const PairVector of(results, k * kBlockPixels + i, pixels, reaches);
    for (int c = 0; c < 3; ++c) sum[c] = hn::IfThenElse(of.adds, hn::Add(sum[c], of.light[c]), sum[c]);
    lights = of.counted_with(lights);
  }
  for (int c = 0; c < 3; ++c) hn::Store(sum[c], d, out.plane[c] + at);
  hn::Store(lights, di, count);
}

/// Adds the results of a batch to the sums in `out`, which the pairs before it have been added to.
inline void add_pairs(const PairBatch& batch, const programs::PairResults& results, bool reaches, ColorTile& out) {
  for (size_t first = 0, end = 0; first < batch.count; first = end) {
    while (end < batch.count && batch.pair[end].first_pixel == batch.pair[first].first_pixel) ++end;
    for (size_t i = 0; i < size_t(kBlockPixels); i += hn::Lanes(DF()))
      add_pairs_of_block(batch, first, end, i, results, reaches, out);
  }
}

/// Of some pixels of a block those that a light's extent has: nearer than the root of cut2, or all where it has no
/// place.
inline unsigned pixels_in_extent(const SurfaceTile& s, int first, const ListedLight& light, unsigned pixels) {
  const DF d;
  if (!light.has_position) return pixels;
  unsigned near = 0;
  for (size_t i = 0; i < size_t(kBlockPixels); i += hn::Lanes(d)) {
    VF to_light[3];
    for (int c = 0; c < 3; ++c)
      to_light[c] = hn::Sub(hn::Set(d, light.position[c]), hn::Load(d, s.plane[kPosition + c] + first + i));
    near |= unsigned(mask_bits(hn::Lt(dot3(to_light, to_light), hn::Set(d, light.cut2)))) << i;
  }
  return near & pixels;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
