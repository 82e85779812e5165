#ifdef TRUESHADE_XBYAK
#include "programs/run/fast/vector_assembler.h"

namespace trueshade::programs {

using Xbyak::Operand;
using Xbyak::Opmask;
using Xbyak::Xmm;
using Xbyak::Ymm;
using Xbyak::Zmm;

Encoding encoding_of(Op op) {
  switch (op) {
    case Op::input:
    case Op::f_from_bits:
    case Op::f_sqrt:
    case Op::f_inverse_sqrt:
    case Op::f_floor:
    case Op::f_ceil:
    case Op::f_trunc:
    case Op::f_round:
    case Op::i_to_f:
    case Op::f_neg:
    case Op::f_abs:
    case Op::i_not:
      return Encoding::one;
    case Op::b_and:
    case Op::b_or:
    case Op::b_xor:
    case Op::b_not:
      return Encoding::masks;
    case Op::f_eq:
    case Op::f_ne:
    case Op::f_lt:
    case Op::f_le:
    case Op::i_eq:
    case Op::i_lt:
    case Op::u_lt:
      return Encoding::compare;
    case Op::f_fma:
      return Encoding::fused;
    case Op::select:
      return Encoding::choice;
    case Op::i_shl:
    case Op::i_shr:
    case Op::u_shr:
    case Op::i_mul:
      return Encoding::two;
    default:
      const bool floats = (op >= Op::f_add && op <= Op::f_div) || op == Op::f_min || op == Op::f_max;
      const bool words = op == Op::i_add || op == Op::i_sub || (op >= Op::i_and && op <= Op::i_xor);
      return floats || words ? Encoding::two : Encoding::function;
  }
}

namespace {

/// Of vcmpps: ordered and quiet, but for "not equal", which is true with NaN.
uint8_t float_predicate(Op op) {
  if (op == Op::f_eq) return 0x00;
  if (op == Op::f_ne) return 0x04;
  return op == Op::f_lt ? 0x11 : 0x12;
}

}  // namespace

bool commutes(Op op) {
  switch (op) {
    case Op::f_add:
    case Op::f_mul:
    case Op::f_eq:
    case Op::f_ne:
    case Op::b_and:
    case Op::b_or:
    case Op::b_xor:
    case Op::i_add:
    case Op::i_mul:
    case Op::i_and:
    case Op::i_or:
    case Op::i_xor:
    case Op::i_eq:
      return true;
    default:
      return false;
  }
}

void VectorAssembler::one(Op op, const Xmm& to, const Xmm& a) {
  switch (op) {
    case Op::f_sqrt:
      return vsqrtps(to, a);
    case Op::f_inverse_sqrt:
      vsqrtps(scratch(1), a);
      vbroadcastss(scratch(2), dword[rip + one_]);
      return vdivps(to, scratch(2), scratch(1));
    case Op::f_floor:
      return round(1, to, a);
    case Op::f_ceil:
      return round(2, to, a);
    case Op::f_trunc:
      return round(3, to, a);
    case Op::f_round:
      return round(0, to, a);
    case Op::i_to_f:
      return vcvtdq2ps(to, a);
    case Op::f_neg:
      return bits(Op::i_xor, to, a, literal(sign_));
    case Op::f_abs:
      return bits(Op::i_and, to, a, literal(size_));
    case Op::b_not:
    case Op::i_not:
      return bits(Op::i_xor, to, a, literal(ones_));
    default:  // a copy
      if (to.getIdx() != a.getIdx()) vmovaps(to, a);
  }
}

void VectorAssembler::two(Op op, const Xmm& to, const Xmm& a, const Operand& b) {
  switch (op) {
    case Op::f_add:
      return vaddps(to, a, b);
    case Op::f_sub:
      return vsubps(to, a, b);
    case Op::f_mul:
      return vmulps(to, a, b);
    case Op::f_div:
      return vdivps(to, a, b);
    case Op::f_min:
      return vminps(to, a, b);
    case Op::f_max:
      return vmaxps(to, a, b);
    case Op::f_eq:
    case Op::f_ne:
    case Op::f_lt:
    case Op::f_le:
      return vcmpps(to, a, b, float_predicate(op));
    case Op::i_add:
      return vpaddd(to, a, b);
    case Op::i_sub:
      return vpsubd(to, a, b);
    case Op::i_mul:
      return vpmulld(to, a, b);
    case Op::i_shl:
    case Op::i_shr:
    case Op::u_shr:
      return shift(op, to, a, b);
    case Op::i_eq:
      return vpcmpeqd(to, a, b);
    case Op::i_lt:
      vmovaps(scratch(1), b);
      return vpcmpgtd(to, scratch(1), a);
    case Op::u_lt:
      vpmaxud(scratch(1), a, b);  // a where a >= b
      vpcmpeqd(scratch(1), scratch(1), a);
      return vpxor(to, scratch(1), literal(ones_));
    default:
      return bits(op, to, a, b);
  }
}

void VectorAssembler::bits(Op op, const Xmm& to, const Xmm& a, const Operand& b) {
  switch (op) {
    case Op::b_and:
    case Op::i_and:
      return wide_ ? vpandd(to, a, b) : vpand(to, a, b);
    case Op::b_or:
    case Op::i_or:
      return wide_ ? vpord(to, a, b) : vpor(to, a, b);
    default:
      return wide_ ? vpxord(to, a, b) : vpxor(to, a, b);
  }
}

void VectorAssembler::shift(Op op, const Xmm& to, const Xmm& a, const Operand& b) {
  const Xmm amount = scratch(1);
  vmovaps(amount, b);
  bits(Op::i_and, amount, amount, literal(shift_));
  if (op == Op::i_shl) return vpsllvd(to, a, amount);
  if (op == Op::i_shr) return vpsravd(to, a, amount);
  vpsrlvd(to, a, amount);
}

void VectorAssembler::compare(Op op, const Opmask& to, const Xmm& a, const Operand& b) {
  switch (op) {
    case Op::i_eq:
      return vpcmpd(to, a, b, 0);
    case Op::i_lt:
      return vpcmpd(to, a, b, 1);
    case Op::u_lt:
      return vpcmpud(to, a, b, 1);
    default:
      return vcmpps(to, a, b, float_predicate(op));
  }
}

void VectorAssembler::masks(Op op, const Opmask& to, const Opmask& a, const Opmask& b) {
  switch (op) {
    case Op::b_and:
      return kandw(to, a, b);
    case Op::b_or:
      return korw(to, a, b);
    case Op::b_xor:
      return kxorw(to, a, b);
    default:
      return knotw(to, a);
  }
}

void VectorAssembler::round(int mode, const Xmm& to, const Xmm& a) {
  const auto quiet = uint8_t(mode | 8);
  wide_ ? vrndscaleps(to, a, quiet) : vroundps(to, a, quiet);
}

/// Of half a vector: the powers as floats.
void VectorAssembler::half_power(const Xmm& to, const Operand& x, int power) {
  const Xmm base = scratch(0), result = scratch(1);
  vcvtps2pd(base, x);
  int bit = 1;
  while (2 * bit <= power) bit *= 2;
  Xmm last = base;
  for (bit /= 2; bit > 0; bit /= 2) {
    vmulpd(result, last, last);
    if ((power & bit) != 0) vmulpd(result, result, base);
    last = result;
  }
  vcvtpd2ps(to, last);
}

void VectorAssembler::whole_power(const Xmm& to, const Xmm& x, int power) {
  if (power == 0) return vbroadcastss(to, dword[rip + one_]);
  const int index = scratch(2).getIdx(), low = scratch(1).getIdx();
  if (wide_) {
    half_power(Ymm(index), Ymm(x.getIdx()), power);
    vextractf64x4(Ymm(low), Zmm(x.getIdx()), 1);
    half_power(Ymm(low), Ymm(low), power);
    vinsertf64x4(Zmm(to.getIdx()), Zmm(index), Ymm(low), 1);
  } else {
    half_power(Xmm(index), Xmm(x.getIdx()), power);
    vextractf128(Xmm(low), Ymm(x.getIdx()), 1);
    half_power(Xmm(low), Xmm(low), power);
    vinsertf128(Ymm(to.getIdx()), Ymm(index), Xmm(low), 1);
  }
}

void VectorAssembler::literals() {
  for (const auto& [label, word] : {std::pair<Xbyak::Label*, uint32_t>{&sign_, 0x80000000u},
                                    {&size_, 0x7FFFFFFFu},
                                    {&one_, 0x3F800000u},
                                    {&ones_, ~0u},
                                    {&shift_, 31u}}) {
    align(32);
    L(*label);
    for (int k = 0; k < 8; ++k) dd(word);
  }
}

}  // namespace trueshade::programs
#endif
