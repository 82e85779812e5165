#include "judge/bounds/interval_integers.h"

#include <bit>
#include <cstdint>

namespace trueshade::oracle {

namespace {

using programs::Op;
using programs::ProgramNode;
using programs::Type;

/// Any integer of a type.
Interval any_integer(Type type) {
  if (type == Type::u32) return {0, 0, 0xFFFFFFFFp0, false};
  return {0, -0x1p31, 0x1p31 - 1, false};
}

uint32_t bits_of(const Interval& x, Type type) {
  if (type == Type::f32) return std::bit_cast<uint32_t>(float(x.low));
  return uint32_t(int64_t(x.low));
}

Interval of_bits(uint32_t bits, Type type) {
  if (type == Type::f32) return Interval::of(double(std::bit_cast<float>(bits)));
  return Interval::of(type == Type::i32 ? double(int32_t(bits)) : double(bits));
}

float of_half(uint32_t half) {
  const uint32_t exponent = half >> 10 & 31, mantissa = half & 1023;
  const double size = exponent == 31  ? (mantissa != 0 ? NAN : HUGE_VAL)
                      : exponent == 0 ? std::ldexp(double(mantissa), -24)
                                      : std::ldexp(double(1024 + mantissa), int(exponent) - 25);
  return float((half & 0x8000) != 0 ? -size : size);
}

/// An operation on the bits of known operands; for those operations that of_integers() does not leave open.
uint32_t integer(Op op, uint32_t x, uint32_t y) {
  const auto i = int32_t(x), j = int32_t(y);
  switch (op) {
    case Op::i_add:
      return x + y;
    case Op::i_sub:
      return x - y;
    case Op::i_mul:
      return x * y;
    case Op::i_mul_high:
      return uint32_t(uint64_t(int64_t(i) * int64_t(j)) >> 32);
    case Op::u_mul_high:
      return uint32_t(uint64_t(x) * y >> 32);
    case Op::i_div:
      return j == 0 ? 0 : uint32_t(int64_t(i) / j);
    case Op::i_rem:
      return j == 0 ? 0 : uint32_t(int64_t(i) % j);
    case Op::u_div:
      return y == 0 ? 0 : x / y;
    case Op::u_rem:
      return y == 0 ? 0 : x % y;
    case Op::i_and:
      return x & y;
    case Op::i_or:
      return x | y;
    case Op::i_xor:
      return x ^ y;
    case Op::i_not:
      return ~x;
    case Op::i_shl:
      return x << (y & 31);
    case Op::i_shr:
      return uint32_t(i >> (y & 31));
    case Op::u_shr:
      return x >> (y & 31);
    case Op::bit_count:
      return uint32_t(std::popcount(x));
    case Op::lowest_bit:
      return x == 0 ? ~0u : uint32_t(std::countr_zero(x));
    case Op::highest_bit:
      return x == 0 ? ~0u : uint32_t(31 - std::countl_zero(x));
    case Op::bit_reverse: {
      uint32_t out = 0;
      for (int k = 0; k < 32; ++k) out |= (x >> k & 1) << (31 - k);
      return out;
    }
    default:
      return x;  // the bits of a float, and a float of bits
  }
}

}  // namespace

Interval as_unsigned(const Interval& x) {
  if (x.known()) return Interval::of(double(uint32_t(int64_t(x.low))));
  return x.low < 0 || x.maybe_nan ? any_integer(Type::u32) : x;
}
Interval as_signed(const Interval& x) {
  if (x.known()) return Interval::of(double(int32_t(uint32_t(int64_t(x.low)))));
  return x.high > 0x1p31 - 1 || x.maybe_nan ? any_integer(Type::i32) : x;
}

Interval of_integers(const ProgramNode& node, const Interval& x, const Interval& y) {
  const programs::OpInfo& op = info(node.op);
  if (!x.known() || (op.operands > 1 && !y.known()))
    return node.type == Type::f32 ? Interval::anything() : any_integer(node.type);
  if (node.op == Op::f_bits && !(x.size() >= kSmallestFloat)) return any_integer(node.type);  // 0 has either sign
  if (node.op == Op::f_from_half) return Interval::of(double(of_half(bits_of(x, Type::u32))));
  if (node.op == Op::f_to_half || node.op == Op::f_significand || node.op == Op::f_exponent) {
    int exponent = 0;
    const double part = std::frexp(x.value, &exponent);
    if (node.op == Op::f_exponent) return Interval::of(exponent);
    if (node.op == Op::f_significand) return Interval::of(part);
    return any_integer(node.type);  // drivers round halves either way
  }
  return of_bits(integer(node.op, bits_of(x, op.operand[0]), bits_of(y, op.operand[1])), node.type);
}

Interval converted(const ProgramNode& node, const Interval& x) {
  const bool is_signed = node.op == Op::f_to_i;
  const double least = is_signed ? -0x1p31 : 0, most = is_signed ? 0x1p31 - 1 : 0xFFFFFFFFp0;
  if (x.maybe_nan || x.low < least || x.high > most) return any_integer(node.type);  // GLSL leaves these undefined
  return monotone(x, [](double v) { return std::trunc(v); });
}

}  // namespace trueshade::oracle
