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
      const auto number = in_.lights.first_light + uint32_t(light.light - in_.lights.row.data());
      pair_[count_] = {uint32_t(first), number, pixels};
      count_ += pixels != 0 ? 1 : 0;
      if (count_ == kBatchBlocks) run();
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
    if (count_ == 0) return;
    const programs::PairResults results = run_pairs(program_.executable(), program_.constants(), program_.lights(),
                                                    work_.surfaces, {pair_, count_}, work_.registers);
    for (size_t first = 0, end = 0; first < count_; first = end) {
      while (end < count_ && pair_[end].first_pixel == pair_[first].first_pixel) ++end;
      for (size_t i = 0; i < size_t(kBlockPixels); i += hn::Lanes(DF())) add_up(first, end, i, results);
    }
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

  /// Adds the results of pairs of one block, in their order, to the sums of a vector of its pixels, those from lane i
  /// on.
  void add_up(size_t first, size_t end, size_t i, const programs::PairResults& results) {
    const DF d;
    const DI di;
    const size_t at = pair_[first].first_pixel + i;
    int32_t* const count = reinterpret_cast<int32_t*>(in_.out.light_count + at);
    VF sum[3];
    for (int c = 0; c < 3; ++c) sum[c] = hn::Load(d, in_.out.plane[c] + at);
    hn::Vec<DI> lights = hn::Load(di, count);
    for (size_t k = first; k < end; ++k) {
      const unsigned pixels = pair_[k].wanted >> i;
      if (hn::MaxLanes(d) < size_t(kBlockPixels) && (pixels & ((1u << hn::MaxLanes(d)) - 1)) == 0) continue;
      const size_t lane = k * kBlockPixels + i;
      VF light[3];
      for (int c = 0; c < 3; ++c) light[c] = hn::Load(d, results.light[c] + lane);
      const MF inside = lanes_of(pixels), adds = hn::And(inside, any_channel(light));
      const MF counted = reaches_ ? hn::And(inside, is_set(results.reaches + lane)) : adds;
      for (int c = 0; c < 3; ++c) sum[c] = hn::IfThenElse(adds, hn::Add(sum[c], light[c]), sum[c]);
      lights = hn::Sub(lights, hn::VecFromMask(di, hn::RebindMask(di, counted)));
    }
    for (int c = 0; c < 3; ++c) hn::Store(sum[c], d, in_.out.plane[c] + at);
    hn::Store(lights, di, count);
  }

  const ProgramTile& in_;
  const ProgramFrame& program_;
  ProgramWork& work_;
  const bool reaches_ = program_.executable().program.defines_reaches;
  programs::PairBlock pair_[kBatchBlocks];
  size_t count_ = 0;
};

/// The numbers of the tile's columns and rows, pixel by pixel.
inline void number_pixels(const ProgramTile& in) {
  for (int y = 0; y < in.tile; ++y)
    for (int x = 0; x < in.tile; ++x) {
      const int i = tile_index(in.tile, x, y);
      in.work.program->pixel[0][i] = uint32_t(in.surface.x + x);
      in.work.program->pixel[1][i] = uint32_t(in.surface.y + y);
    }
}

/// Gives the program the surfaces of the tile; the sums start.
inline void start_sums(const ProgramTile& in) {
  const ProgramFrame& program = *in.lights.program;
  ProgramWork& work = *in.work.program;
  const uint32_t* const pixels[2] = {work.pixel[0], work.pixel[1]};
  const size_t inputs = program.executable().at(programs::Rate::surface).inputs.size();
  bool reads_pixels = false;
  for (size_t i = 0; i < inputs; ++i) {
    const void* const plane = program.plane_of(i, in.surface, pixels);
    reads_pixels = reads_pixels || plane == pixels[0] || plane == pixels[1];
    work.surfaces.set_input(i, plane);
  }
  if (reads_pixels) number_pixels(in);
  float* const start[3] = {in.out.plane[0], in.out.plane[1], in.out.plane[2]};
  run_surfaces(program.executable(), program.constants(), work.surfaces, start, work.registers);
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
  const bool takes_albedo = !program.executable().program.defines_finish && in.model.alpha_from_albedo;
  for (int i = 0; i < in.tile * in.tile; i += int(hn::Lanes(DF()))) store_finished(in, stored, takes_albedo, i);
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
        batch.add_block(region.block(b, work.blocks()) * kBlockPixels, in.work.region.light);
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
