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

/// What is stored of a pixel: the finished sum, or the sum alone, or `clear`.
inline void finish_sums(const ProgramTile& in) {
  const ProgramFrame& program = *in.lights.program;
  ProgramWork& work = *in.work.program;
  const bool alone = in.shortcuts.light_alone;
  const float* const sum[3] = {in.out.plane[0], in.out.plane[1], in.out.plane[2]};
  if (!alone) finish_surfaces(program, in.surface, in.tile, in.model, sum, work);
  const SurfaceTile& s = in.surface;
  for (int i = 0; i < in.tile * in.tile; ++i) {
    const bool covered = s.covered[i] != 0, unlit = covered && program.is_unlit(s.material[i] - 1);
    if (!covered || unlit) in.out.light_count[i] = 0;
    for (int c = 0; c < 4; ++c) {
      float value = alone ? (unlit ? 0.0f : c < 3 ? sum[c][i] : 1.0f) : work.finished[c][i];
      if (!covered) value = in.clear[c];
      in.out.plane[c][i] = value == value ? value : std::numeric_limits<float>::quiet_NaN();
    }
  }
}

/// Adds pairs to the sums of a tile, a batch at a time.
class SumOfPairs {
 public:
  explicit SumOfPairs(const ProgramTile& in) : in_(in) {}
  ~SumOfPairs() { run(); }

  void add(int first_pixel, const ListedLight& light, unsigned pixels) {
    batch_.add(first_pixel, number_of(in_.lights, light), pixels);
    if (batch_.count == kBatchBlocks) run();
  }

 private:
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

/// Brings the lights in in.work.region to the pixels of a region.
inline void add_region_lights(const ProgramTile& in, const TileWork& work, const Region& r, SumOfPairs& sum) {
  for (int b = 0; b < int(kRegionBlockCount); ++b) {
    if (r.covered[b] == 0) continue;
    const int first = r.block(b, work.blocks()) * kBlockPixels;
    for (const ListedLight& light : in.work.region.light)
      if (const unsigned pixels = pixels_in_extent(in.surface, first, light, r.covered[b]); pixels != 0)
        sum.add(first, light, pixels);
  }
}

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
      list_region_lights(work, tile, tile.regions.region[k]);
      add_region_lights(in, work, tile.regions.region[k], sum);
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
