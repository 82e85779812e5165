#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include "shading/sum/light_tile-inl.h"
#include "shading/sum/program_pairs-inl.h"
#include "shading/sum/program_tile.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Gives the program the surfaces of the tile; the sums start.
inline void start_sums(const ProgramTile& in) {
  float* const start[3] = {in.out.plane[0], in.out.plane[1], in.out.plane[2]};
  give_surfaces(*in.lights.program, in.surface, in.tile, start, *in.work.program);
  const size_t count = size_t(in.tile) * size_t(in.tile);
  std::fill_n(in.out.light_count, count, 0u);
  if (in.shortcuts.light_alone)
    for (float* const plane : start) std::fill_n(plane, count, 0.0f);
}

/// Those of some covered pixels whose material is unlit.
inline MF unlit_lanes(const ProgramFrame& program, const SurfaceTile& s, MF covered, int first) {
  const DI di;
  if (HWY_LIKELY(!program.has_unlit())) return hn::Lt(hn::Zero(DF()), hn::Zero(DF()));
  alignas(64) int32_t unlit[hn::MaxLanes(DI())];
  for (int k = 0; k < int(hn::Lanes(di)); ++k)
    unlit[k] = s.covered[first + k] != 0 && program.is_unlit(s.material[first + k] - 1) ? -1 : 0;
  return hn::And(covered, hn::RebindMask(DF(), hn::Lt(hn::Load(di, unlit), hn::Zero(di))));
}

/// What is stored of a vector of pixels: the finished sums, the albedo of what is unlit, or `clear`.
inline void store_finished(const ProgramTile& in, const float* const finished[4], bool takes_albedo, int i) {
  const DF d;
  const SurfaceTile& s = in.surface;
  const bool alone = in.shortcuts.light_alone;
  const MF covered = covered_lanes(s, i), unlit = unlit_lanes(*in.lights.program, s, covered, i);
  float* const count = reinterpret_cast<float*>(in.out.light_count) + i;
  hn::Store(hn::IfThenElseZero(hn::AndNot(unlit, covered), hn::Load(d, count)), d, count);
  for (int c = 0; c < 4; ++c) {
    VF value = alone && c == 3 ? hn::Set(d, 1.0f) : hn::Load(d, finished[c] + i);
    if (c == 3 && takes_albedo) value = hn::Load(d, s.plane[kAlbedo + 3] + i);
    if (HWY_UNLIKELY(!hn::AllFalse(d, unlit)))
      value = hn::IfThenElse(unlit, alone ? hn::Zero(d) : hn::Load(d, s.plane[kAlbedo + c] + i), value);
    value = hn::IfThenElse(covered, value, hn::Set(d, in.clear[c]));
    hn::Store(hn::IfThenElse(hn::Eq(value, value), value, one_nan()), d, in.out.plane[c] + i);
  }
}

inline void finish_sums(const ProgramTile& in) {
  const ProgramFrame& program = *in.lights.program;
  ProgramWork& work = *in.work.program;
  const float* const sum[3] = {in.out.plane[0], in.out.plane[1], in.out.plane[2]};
  float* const finished[4] = {work.finished[0], work.finished[1], work.finished[2], work.finished[3]};
  const float* stored[4] = {finished[0], finished[1], finished[2], finished[3]};
  if (in.shortcuts.light_alone)
    std::copy_n(sum, 3, stored);
  else
    run_finish(program.executable(), program.constants(), work.surfaces, sum, finished, work.registers);
  const bool albedo_alpha = takes_albedo(program, in.model);
  for (int i = 0; i < in.tile * in.tile; i += int(hn::Lanes(DF()))) store_finished(in, stored, albedo_alpha, i);
}

/// Adds pairs to the sums of a tile, a batch at a time.
class SumOfPairs {
 public:
  explicit SumOfPairs(const ProgramTile& in) : in_(in) {}
  ~SumOfPairs() { run(); }

  /// Adds the pairs of a block of pixels and the lights whose extents have some of them: those nearer than the root of
  /// cut2, or all where the light has no place.
  void add_block(int first, std::span<const ListedLight> lights) {
    const DF d;
    const SurfaceTile& s = in_.surface;
    MF covered[kBlockVectors];
    VF position[kBlockVectors][3];
    for (size_t v = 0; v < kBlockVectors; ++v) {
      covered[v] = covered_lanes(s, first + int(v * hn::Lanes(d)));
      for (int c = 0; c < 3; ++c) position[v][c] = hn::Load(d, s.plane[kPosition + c] + first + v * hn::Lanes(d));
    }
    for (const ListedLight& light : lights) {
      unsigned pixels = 0;
      for (size_t v = 0; v < kBlockVectors; ++v) {
        MF near = covered[v];
        if (HWY_LIKELY(light.has_position)) near = hn::And(near, within(light, position[v]));
        pixels |= unsigned(mask_bits(near)) << v * hn::Lanes(d);
      }
      batch_.pair[batch_.count] = {uint32_t(first), number_of(in_.lights, light), pixels};
      batch_.count += pixels != 0 ? 1 : 0;
      if (batch_.count == kBatchBlocks) run();
    }
  }

 private:
  static constexpr size_t kBlockVectors = size_t(kBlockPixels) / hn::MaxLanes(DF());

  static HWY_INLINE MF within(const ListedLight& light, const VF position[3]) {
    const DF d;
    VF to_light[3];
    for (int c = 0; c < 3; ++c) to_light[c] = hn::Sub(hn::Set(d, light.position[c]), position[c]);
    return hn::Lt(dot3(to_light, to_light), hn::Set(d, light.cut2));
  }

  void run() {
    if (batch_.count == 0) return;
    const ProgramFrame& program = *in_.lights.program;
    const programs::PairResults results = batch_.run(program, *in_.work.program, in_.counts);
    add_pairs(batch_, results, program.executable().program.defines_reaches, in_.out);
    batch_.count = 0;
  }

  const ProgramTile& in_;
  PairBatch batch_;
};

void program_tile_simd(const ProgramTile& in) {
  const LightClusters none;
  const TileWork work{in.surface, in.tile,      in.lights, none,   in.model,
                      in.clear,   in.shortcuts, in.work,   in.out, in.counts};
  const ListedTile tile(work, any_shape(in.model).shape);
  if (tile.regions.count == 0) return clear_tile(work);
  start_sums(in);
  list_tile_lights(work, tile.regions, tile.cull);
  {
    SumOfPairs sum(in);
    for (int k = 0; k < tile.regions.count; ++k) {
      const Region& region = tile.regions.region[k];
      list_region_lights(work, tile, region);
      for (int b = 0; b < int(kRegionBlockCount); ++b) {
        if (region.covered[b] == 0) continue;
        sum.add_block(region.block(b, work.blocks()) * kBlockPixels, in.work.region.light);
      }
    }
  }
  finish_sums(in);
  in.counts.lit_pairs += sum_of(in.out.light_count, in.tile * in.tile);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace trueshade {
TRUESHADE_KERNEL(program_tile, HWY_NAMESPACE::program_tile_simd);
}  // namespace trueshade
