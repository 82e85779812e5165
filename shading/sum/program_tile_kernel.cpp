#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include "shading/sum/light_tile-inl.h"
#include "shading/sum/program_tile.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using programs::kBatchBlocks;
static_assert(programs::kBlockLanes == kBlockPixels);

/// Pairs of a block of pixels and a light on their way through the program, and the pixels of each that the light's
/// extent has.
class PairBatch {
 public:
  explicit PairBatch(const ProgramTile& in) : in_(in), program_(*in.lights.program), work_(*in.work.program) {}
  ~PairBatch() { run(); }

  void add(int first_pixel, uint32_t light, unsigned pixels) {
    pair_[count_] = {uint32_t(first_pixel), light}, pixels_[count_] = pixels;
    if (++count_ == kBatchBlocks) run();
  }

 private:
  void run() {
    if (count_ == 0) return;
    const programs::PairResults results = run_pairs(program_.executable(), program_.constants(), program_.lights(),
                                                    work_.surfaces, {pair_, count_}, work_.registers);
    for (size_t k = 0; k < count_; ++k) add_up(k, results);
    in_.counts.evaluated_pairs += count_ * kBlockPixels;
    count_ = 0;
  }

  /// Pixels of which some channel is not 0. Highway's Ne is false with NaN on some targets.
  static MF any_channel(const VF light[3]) {
    const VF zero = hn::Zero(DF());
    return hn::Not(hn::And(hn::And(hn::Eq(light[0], zero), hn::Eq(light[1], zero)), hn::Eq(light[2], zero)));
  }

  static MF is_set(const float* words) {
    const DI di;
    return hn::RebindMask(DF(), hn::Ne(hn::Load(di, reinterpret_cast<const int32_t*>(words)), hn::Zero(di)));
  }

  /// Adds a pair's results to its pixels' sums, which the pairs before it have been added to.
  void add_up(size_t k, const programs::PairResults& results) {
    const DF d;
    const DI di;
    const size_t block = k * kBlockPixels;
    for (size_t i = 0; i < size_t(kBlockPixels); i += hn::Lanes(d)) {
      VF light[3];
      for (int c = 0; c < 3; ++c) light[c] = hn::Load(d, results.light[c] + block + i);
      const MF adds = hn::And(lanes_of(pixels_[k] >> i), any_channel(light));
      const MF counted = reaches_ ? hn::And(lanes_of(pixels_[k] >> i), is_set(results.reaches + block + i)) : adds;
      const size_t at = pair_[k].first_pixel + i;
      for (int c = 0; c < 3; ++c) {
        float* const sum = in_.out.plane[c] + at;
        const VF before = hn::Load(d, sum);
        hn::Store(hn::IfThenElse(adds, hn::Add(before, light[c]), before), d, sum);
      }
      int32_t* const count = reinterpret_cast<int32_t*>(in_.out.light_count + at);
      const auto one = hn::BitCast(di, hn::IfThenElseZero(counted, hn::BitCast(d, hn::Set(di, 1))));
      hn::Store(hn::Add(hn::Load(di, count), one), di, count);
    }
  }

  const ProgramTile& in_;
  const ProgramFrame& program_;
  ProgramWork& work_;
  const bool reaches_ = program_.executable().program.defines_reaches;
  programs::PairBlock pair_[kBatchBlocks];
  unsigned pixels_[kBatchBlocks];
  size_t count_ = 0;
};

/// The pixels of a block that a light's extent has: those nearer than the root of cut2, or all where it has no place.
inline unsigned pixels_in_extent(const SurfaceTile& s, int first, const ListedLight& light) {
  const DF d;
  unsigned pixels = 0;
  for (size_t i = 0; i < size_t(kBlockPixels); i += hn::Lanes(d)) {
    MF near = covered_lanes(s, first + int(i));
    if (light.has_position) {
      VF to_light[3];
      for (int c = 0; c < 3; ++c)
        to_light[c] = hn::Sub(hn::Set(d, light.position[c]), hn::Load(d, s.plane[kPosition + c] + first + i));
      near = hn::And(near, hn::Lt(dot3(to_light, to_light), hn::Set(d, light.cut2)));
    }
    pixels |= unsigned(mask_bits(near)) << i;
  }
  return pixels;
}

/// Gives the program the surfaces of the tile; the sums start.
inline void start_sums(const ProgramTile& in) {
  const ProgramFrame& program = *in.lights.program;
  ProgramWork& work = *in.work.program;
  for (int y = 0; y < in.tile; ++y)
    for (int x = 0; x < in.tile; ++x) {
      const int i = tile_index(in.tile, x, y);
      work.pixel[0][i] = uint32_t(in.surface.x + x), work.pixel[1][i] = uint32_t(in.surface.y + y);
    }
  const uint32_t* const pixels[2] = {work.pixel[0], work.pixel[1]};
  const size_t inputs = program.executable().at(programs::Rate::surface).inputs.size();
  for (size_t i = 0; i < inputs; ++i) work.surfaces.set_input(i, program.plane_of(i, in.surface, pixels));
  float* const start[3] = {in.out.plane[0], in.out.plane[1], in.out.plane[2]};
  run_surfaces(program.executable(), program.constants(), work.surfaces, start, work.registers);
  const size_t count = size_t(in.tile) * size_t(in.tile);
  std::fill_n(in.out.light_count, count, 0u);
  if (in.shortcuts.light_alone)
    for (float* const plane : start) std::fill_n(plane, count, 0.0f);
}

/// What is stored of a pixel: the finished sum, the albedo of what is unlit, or `clear`.
inline void finish_sums(const ProgramTile& in) {
  const ProgramFrame& program = *in.lights.program;
  ProgramWork& work = *in.work.program;
  const float* const sum[3] = {in.out.plane[0], in.out.plane[1], in.out.plane[2]};
  float* const finished[4] = {work.finished[0], work.finished[1], work.finished[2], work.finished[3]};
  if (!in.shortcuts.light_alone)
    run_finish(program.executable(), program.constants(), work.surfaces, sum, finished, work.registers);
  const SurfaceTile& s = in.surface;
  const bool takes_albedo = !program.executable().program.defines_finish && in.model.alpha_from_albedo;
  for (int i = 0; i < in.tile * in.tile; ++i) {
    const bool covered = s.covered[i] != 0, unlit = covered && program.is_unlit(s.material[i] - 1);
    if (!covered || unlit) in.out.light_count[i] = 0;
    for (int c = 0; c < 4; ++c) {
      float value = in.shortcuts.light_alone ? (c < 3 ? sum[c][i] : 1.0f) : finished[c][i];
      if (c == 3 && takes_albedo) value = s.plane[kAlbedo + 3][i];
      if (unlit) value = in.shortcuts.light_alone ? 0.0f : s.plane[kAlbedo + c][i];
      if (!covered) value = in.clear[c];
      in.out.plane[c][i] = value == value ? value : std::numeric_limits<float>::quiet_NaN();
    }
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
    PairBatch batch(in);
    for (int k = 0; k < tile.regions.count; ++k) {
      const Region& region = tile.regions.region[k];
      list_region_lights(work, tile, region);
      for (int b = 0; b < int(kRegionBlockCount); ++b) {
        if (region.covered[b] == 0) continue;
        const int first = region.block(b, work.blocks()) * kBlockPixels;
        for (const ListedLight& light : in.work.region.light)
          if (const unsigned pixels = pixels_in_extent(in.surface, first, light); pixels != 0)
            batch.add(first, in.lights.first_light + uint32_t(light.light - in.lights.row.data()), pixels);
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
