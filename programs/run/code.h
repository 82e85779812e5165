#pragma once
#include <cstddef>
#include <cstdint>

#include "programs/values/op.h"

namespace trueshade::programs {

/// Lanes go through a program in blocks, so many of them in a batch. A block is a whole number of vectors of any
/// target.
inline constexpr size_t kBlockLanes = 16, kBatchBlocks = 32, kBatchLanes = kBlockLanes * kBatchBlocks;

/// Where an operand lies. A register and a plane have a value a lane; a constant is one, and a light's value holds for
/// the lanes of a block.
enum class Place : uint8_t { lanes, plane, constant, light };

struct Source {
  Place place = Place::lanes;
  uint32_t slot = 0;
};

/// What becomes of the product of the first two sources and the third: two operations, each rounded, whose first result
/// is not stored. The third source has a register, and the first one or a plane.
enum class Product : uint8_t { none, plus, minus, from };

/// One operation on all lanes of a batch. Op::input copies its first source, Op::constant does not occur. Booleans are
/// words of ones or of zeros.
struct Instruction {
  Op op;
  uint32_t to;  ///< a register
  Source from[3];
  Product product = Product::none;
};

/// Instructions and what they work on. Registers may be the target and a source of one instruction.
struct CodeView {
  const Instruction* code;
  size_t count;
  float* registers;            ///< kBatchLanes each, 64-byte aligned
  const float* const* planes;  ///< by slot, 64-byte aligned
  const float* constants;      ///< by slot
  const float* const* lights;  ///< by slot
  const uint32_t* plane_lane;  ///< for each block, the lane of its planes that it starts at, a multiple of kBlockLanes
  const uint32_t* light;       ///< for each block, its light
  size_t blocks;               ///< at most kBatchBlocks
  // Of machine code alone, which may also run a block behind the last: its entries above name lanes that there are.
  const float* light_rows = nullptr;  ///< the same values, one light's side by side
  float* frame = nullptr;             ///< Executable::frame_blocks(), 64-byte aligned
  float* const* results = nullptr;    ///< for each of Stage::kept that the code makes, where its lanes go
  const uint32_t* wanted = nullptr;   ///< for each block, its lanes, bit by bit, whose results are asked for
};

/// Runs the instructions one after the other. Exact: the same bits on every SIMD target, but for those of NaNs.
void run_code(const CodeView& view);

/// What one operation makes of constants: the bits that run_code() makes. Booleans are 0 or 1.
uint32_t applied(Op op, Type type, uint32_t a, uint32_t b = 0, uint32_t c = 0);

/// The word that stands for a value in a register.
uint32_t register_word(Type type, uint32_t bits);

}  // namespace trueshade::programs
