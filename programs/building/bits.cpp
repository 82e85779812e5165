#include "programs/building/compositions.h"

namespace trueshade::programs {

NodeId Compositions::bits_extracted(NodeId x, NodeId offset, NodeId count, bool is_signed) {
  const NodeId all = b_.word(32);
  offset = chosen_int(offset, all, false, true);
  const NodeId left = b_.make(Op::i_sub, all, offset);
  count = chosen_int(count, left, false, true);
  const NodeId above = b_.make(Op::i_sub, left, count), unused = b_.make(Op::i_sub, all, count);
  const NodeId top = b_.make(Op::i_shl, x, above);
  const NodeId value = b_.make(is_signed ? Op::i_shr : Op::u_shr, top, unused);
  return b_.select(b_.make(Op::i_eq, count, b_.word(0)), b_.word(0), value);
}

NodeId Compositions::bits_inserted(NodeId base, NodeId insert, NodeId offset, NodeId count) {
  const NodeId all = b_.word(32), none = b_.word(0);
  offset = chosen_int(offset, all, false, true);
  count = chosen_int(count, b_.make(Op::i_sub, all, offset), false, true);
  const NodeId low = b_.make(Op::u_shr, b_.word(~0u), b_.make(Op::i_sub, all, count));
  const NodeId mask = b_.make(Op::i_shl, low, offset), moved = b_.make(Op::i_shl, insert, offset);
  const NodeId kept = b_.make(Op::i_and, base, b_.make(Op::i_not, mask));
  const NodeId both = b_.make(Op::i_or, kept, b_.make(Op::i_and, moved, mask));
  return b_.select(b_.make(Op::i_eq, count, none), base, both);
}

NodeId Compositions::int_highest_bit(NodeId x) {
  const NodeId negative = b_.make(Op::i_lt, x, b_.integer(0));
  return b_.make(Op::highest_bit, b_.select(negative, b_.make(Op::i_not, x), x));
}

NodeId Compositions::carry(NodeId a, NodeId b) {
  return b_.select(b_.make(Op::u_lt, b_.make(Op::i_add, a, b), a), b_.word(1), b_.word(0));
}

NodeId Compositions::borrow(NodeId a, NodeId b) { return b_.select(b_.make(Op::u_lt, a, b), b_.word(1), b_.word(0)); }

NodeId Compositions::packed_halves(std::span<const NodeId> x) {
  const NodeId low = b_.make(Op::f_to_half, x[0]), high = b_.make(Op::f_to_half, x[1]);
  return b_.make(Op::i_or, low, b_.make(Op::i_shl, high, b_.word(16)));
}

Scalars Compositions::unpacked_halves(NodeId x) {
  const NodeId low = b_.make(Op::i_and, x, b_.word(0xFFFF)), high = b_.make(Op::u_shr, x, b_.word(16));
  return {b_.make(Op::f_from_half, low), b_.make(Op::f_from_half, high)};
}

namespace {

struct FixedCode {
  uint32_t bits;
  float largest;
};
FixedCode fixed_code(size_t codes, bool is_signed) {
  if (codes == 4) return {8, is_signed ? 127.0f : 255.0f};
  return {16, is_signed ? 32767.0f : 65535.0f};
}

}  // namespace

NodeId Compositions::packed_fixed(std::span<const NodeId> x, bool is_signed) {
  const FixedCode code = fixed_code(x.size(), is_signed);
  const NodeId low = b_.number(is_signed ? -1.0f : 0.0f), mask = b_.word((1u << code.bits) - 1);
  NodeId out = b_.word(0);
  for (size_t i = 0; i < x.size(); ++i) {
    const NodeId held = mul(clamp(x[i], low, b_.number(1.0f)), b_.number(code.largest));
    const NodeId whole = b_.make(is_signed ? Op::f_to_i : Op::f_to_u, b_.make(Op::f_round, held));
    const NodeId part = b_.make(Op::i_and, whole, mask);
    out = b_.make(Op::i_or, out, b_.make(Op::i_shl, part, b_.word(uint32_t(i) * code.bits)));
  }
  return out;
}

Scalars Compositions::unpacked_fixed(NodeId x, size_t codes, bool is_signed) {
  const FixedCode code = fixed_code(codes, is_signed);
  Scalars out;
  for (size_t i = 0; i < codes; ++i) {
    const NodeId part = bits_extracted(x, b_.word(uint32_t(i) * code.bits), b_.word(code.bits), is_signed);
    const NodeId value = div(b_.make(is_signed ? Op::i_to_f : Op::u_to_f, part), b_.number(code.largest));
    out.push_back(is_signed ? clamp(value, b_.number(-1.0f), b_.number(1.0f)) : value);
  }
  return out;
}

}  // namespace trueshade::programs
