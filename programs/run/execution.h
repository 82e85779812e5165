#pragma once
#include <array>
#include <span>
#include <vector>

#include "programs/run/executable.h"

// How a light pass runs a program: run_constants() once a frame, run_lights() once for all lights, run_surfaces() once
// for the pixels of a region, run_pairs() for its pairs of pixels and lights, a batch at a time, and run_finish() when
// the sums are known. Every function gives the same bits on every SIMD target, whatever the batches.
namespace trueshade::programs {

/// A vector of lanes of any target.
struct alignas(64) LaneBlock {
  float lane[kBlockLanes];
};

/// Registers for one thread, room for outputs that are computed once a light, a pixel or a frame, and machine code's.
class Registers {
 public:
  explicit Registers(const Executable& executable)
      : count_(executable.registers()),
        blocks_((count_ + kOutputCount) * kBatchBlocks + executable.frame_blocks()),
        results_(executable.program.nodes.size()) {}
  float* data() { return blocks_.data()->lane; }
  float* output(int i) { return data() + (count_ + size_t(i)) * kBatchLanes; }
  float* frame() { return output(kOutputCount); }
  float** results() { return results_.data(); }

 private:
  size_t count_;
  std::vector<LaneBlock> blocks_;
  std::vector<float*> results_;
};

/// Values of one rate, a plane each, of a number of lanes that is a multiple of kBlockLanes. The caller points the
/// first planes at inputs of its own, in the order of Stage::inputs, 64-byte aligned; the others are kept here.
class LaneValues {
 public:
  LaneValues(const Stage& stage, size_t lanes);
  void set_input(size_t input, const void* plane) { plane_[input] = static_cast<const float*>(plane); }
  size_t lanes() const { return lanes_; }
  const float* const* planes() const { return plane_.data(); }
  float* kept(size_t i) { return blocks_.data()[i * (lanes_ / kBlockLanes)].lane; }
  const float* rows() const { return rows_.data(); }
  void make_rows();  ///< copies all values, those of a lane side by side

 private:
  size_t lanes_;
  std::vector<LaneBlock> blocks_;
  std::vector<const float*> plane_;
  std::vector<float> rows_;
};

/// Values of rate `constant`: the caller sets those of Stage::inputs. Integers and booleans are words of bits.
class ConstantValues {
 public:
  explicit ConstantValues(const Executable& executable);
  void set_input(size_t input, uint32_t bits);
  float* data() { return value_.data(); }
  const float* data() const { return value_.data(); }

 private:
  std::vector<float> value_;
};

void run_constants(const Executable& executable, ConstantValues& constants, Registers& registers);

/// A lane is a light.
void run_lights(const Executable& executable, const ConstantValues& constants, LaneValues& lights,
                Registers& registers);

/// A lane is a pixel. start: three planes as long as `surfaces`, for what the sums start from; nullptr: not asked.
void run_surfaces(const Executable& executable, const ConstantValues& constants, LaneValues& surfaces,
                  float* const* start, Registers& registers);

/// A light and kBlockLanes pixels that lie side by side.
struct PairBlock {
  uint32_t first_pixel;  ///< a multiple of kBlockLanes
  uint32_t light;
  uint32_t wanted = 0xFFFF;  ///< lanes whose results are asked for, bit by bit; others may be left out
};

/// What a batch of pairs adds, kBlockLanes lanes for each of its blocks. It lies in the registers, until these are used
/// again.
struct PairResults {
  const float* light[3];
  const float* reaches;  ///< words, 0 where the light does not reach the pixel
};

/// At most kBatchBlocks pairs of blocks.
PairResults run_pairs(const Executable& executable, const ConstantValues& constants, const LaneValues& lights,
                      const LaneValues& surfaces, std::span<const PairBlock> pairs, Registers& registers);

/// From the sums, as long as `surfaces`, makes what is stored: four planes of the same length.
void run_finish(const Executable& executable, const ConstantValues& constants, const LaneValues& surfaces,
                const float* const sum[3], float* const finish[4], Registers& registers);

/// The same of at most kBatchBlocks blocks, all of other pixels; their lights are not read. The four results lie as
/// those of run_pairs().
std::array<const float*, 4> run_finish(const Executable& executable, const ConstantValues& constants,
                                       const LaneValues& surfaces, const float* const sum[3],
                                       std::span<const PairBlock> blocks, Registers& registers);

}  // namespace trueshade::programs
