#pragma once
#include <cstdint>
#include <span>
#include <string_view>

namespace trueshade::programs {

/// The type of a scalar. A boolean is 0 or 1 in a Program; integers are 32 bits, and i32 and u32 only say how to print.
enum class Type : uint8_t { f32, i32, u32, boolean };

/// Every operation on scalars that an executor must know. What each makes, bit for bit, is said in docs/arithmetic.md;
/// all else that GLSL has is composed of these (programs/building).
enum class Op : uint8_t {
  constant,  ///< ProgramNode::bits
  input,     ///< Program::inputs[ProgramNode::bits]
  // One rounding.
  f_add,
  f_sub,
  f_mul,
  f_div,
  f_sqrt,
  f_inverse_sqrt,  ///< 1 / sqrt, each rounded: one operation, whose accuracy GLSL states
  f_fma,
  f_floor,
  f_ceil,
  f_trunc,
  f_round,  ///< to nearest even
  i_to_f,
  u_to_f,
  // None.
  f_neg,
  f_abs,
  f_min,  ///< a < b ? a : b
  f_max,  ///< a > b ? a : b
  f_eq,
  f_ne,  ///< true with NaN
  f_lt,
  f_le,
  f_to_i,       ///< truncated, saturated, NaN gives 0
  f_to_u,       ///< the same
  f_bits,       ///< the bits of a float as an integer, 7FC00000 for every NaN
  f_from_bits,  ///< and back
  f_significand,
  f_exponent,
  f_to_half,    ///< 16 bits: nearest even, overflow to infinity, NaN is 7E00
  f_from_half,  ///< of the lower 16 bits
  select,       ///< a ? b : c, of any type
  // Booleans.
  b_and,
  b_or,
  b_xor,
  b_not,
  // Integers; sums and products wrap.
  i_add,
  i_sub,
  i_mul,
  i_mul_high,
  u_mul_high,
  i_div,  ///< truncates; x / 0 = 0, INT_MIN / -1 = INT_MIN
  u_div,
  i_rem,  ///< the dividend's sign; x % 0 = 0
  u_rem,
  i_and,
  i_or,
  i_xor,
  i_not,
  i_shl,  ///< by amount & 31, as the two below
  i_shr,  ///< arithmetic
  u_shr,  ///< logical
  i_eq,
  i_lt,
  u_lt,
  bit_count,
  bit_reverse,
  lowest_bit,   ///< its number, -1 for none
  highest_bit,  ///< the same, of an unsigned number
  // A formula in f64, rounded once.
  ldexp,
  exp,
  exp2,
  log,
  log2,
  pow,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  atan2,  ///< of y, x
  sinh,
  cosh,
  tanh,
  asinh,
  acosh,
  atanh,
};
inline constexpr int kOpCount = int(Op::atanh) + 1;

/// How an operation is written down and what it takes.
struct OpInfo {
  std::string_view name;
  Type result;  ///< that of `constant`, `input` and `select` is the node's own
  int operands;
  Type operand[3];  ///< an integer where the signedness does not matter is i32
};
const OpInfo& info(Op op);

}  // namespace trueshade::programs
