#pragma once
#include <xbyak/xbyak.h>

#include "core/simd/dispatch.h"
#include "programs/values/op.h"

namespace trueshade::programs {

/// How an operation is encoded.
enum class Encoding : uint8_t {
  one,       ///< VectorAssembler::one()
  two,       ///< two()
  fused,     ///< f_fma
  choice,    ///< select
  compare,   ///< a comparison, of which AVX-512 makes a mask
  masks,     ///< of booleans, which AVX-512 has as masks
  function,  ///< a call of lane_function()
};
Encoding encoding_of(Op op);
/// Whether the operands can be swapped; of two NaNs the result is one or the other.
bool commutes(Op op);

/// Instructions of operations on whole vectors: 16 lanes of AVX-512 or 8 of AVX2. Nothing is contracted, and
/// minima and maxima give the second operand where one is NaN or both are 0, as lane_operations-inl.h has it. Booleans
/// are words of ones or zeros, or masks.
class VectorAssembler : public Xbyak::CodeGenerator {
 public:
  VectorAssembler(SimdTarget target, uint8_t* code, size_t size)
      : CodeGenerator(size, code), wide_(target == SimdTarget::avx512) {}

  bool wide() const { return wide_; }
  int lanes() const { return wide_ ? 16 : 8; }
  int registers() const { return wide_ ? 32 : 16; }
  Xbyak::Xmm vector(int k) const { return wide_ ? Xbyak::Xmm(Xbyak::Zmm(k)) : Xbyak::Xmm(Xbyak::Ymm(k)); }
  /// A register that no value is held in: of 0, 1, 2.
  Xbyak::Xmm scratch(int k) const { return vector(registers() - 1 - k); }

  // Results may be written to a register that holds an operand. Scratch registers 1 and 2 are used.
  void one(Op op, const Xbyak::Xmm& to, const Xbyak::Xmm& a);
  void two(Op op, const Xbyak::Xmm& to, const Xbyak::Xmm& a, const Xbyak::Operand& b);
  // Of AVX-512: booleans as masks.
  void compare(Op op, const Xbyak::Opmask& to, const Xbyak::Xmm& a, const Xbyak::Operand& b);
  void masks(Op op, const Xbyak::Opmask& to, const Xbyak::Opmask& a, const Xbyak::Opmask& b);
  /// x^power, 0 <= power <= 8192, in double and rounded once. All scratch registers are used; x is none of them.
  void whole_power(const Xbyak::Xmm& to, const Xbyak::Xmm& x, int power);
  /// The constants that the instructions read; behind all code.
  void literals();

 private:
  Xbyak::Address literal(Xbyak::Label& label) { return wide_ ? ptr_b[rip + label] : ptr[rip + label]; }
  void bits(Op op, const Xbyak::Xmm& to, const Xbyak::Xmm& a, const Xbyak::Operand& b);
  void shift(Op op, const Xbyak::Xmm& to, const Xbyak::Xmm& a, const Xbyak::Operand& b);
  void round(int mode, const Xbyak::Xmm& to, const Xbyak::Xmm& a);
  void half_power(const Xbyak::Xmm& to, const Xbyak::Operand& x, int power);

  const bool wide_;
  Xbyak::Label sign_, size_, one_, ones_, shift_;
};

}  // namespace trueshade::programs
