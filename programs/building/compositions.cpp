#include "programs/building/compositions.h"

namespace trueshade::programs {

NodeId Compositions::sign(NodeId x) {
  const NodeId zero = b_.number(0.0f);
  const NodeId below = b_.select(b_.make(Op::f_lt, x, zero), b_.number(-1.0f), zero);
  return b_.select(b_.make(Op::f_lt, zero, x), b_.number(1.0f), below);
}

NodeId Compositions::int_sign(NodeId x) {
  const NodeId zero = b_.integer(0);
  const NodeId below = b_.select(b_.make(Op::i_lt, x, zero), b_.integer(-1), zero);
  return b_.select(b_.make(Op::i_lt, zero, x), b_.integer(1), below);
}

NodeId Compositions::int_abs(NodeId x) {
  const NodeId zero = b_.integer(0);
  return b_.select(b_.make(Op::i_lt, x, zero), b_.make(Op::i_sub, zero, x), x);
}

NodeId Compositions::chosen_int(NodeId a, NodeId b, bool is_signed, bool least) {
  const Op less = is_signed ? Op::i_lt : Op::u_lt;
  return b_.select(least ? b_.make(less, a, b) : b_.make(less, b, a), a, b);
}

NodeId Compositions::clamp(NodeId x, NodeId low, NodeId high) {
  return b_.make(Op::f_min, b_.make(Op::f_max, x, low), high);
}

NodeId Compositions::fract(NodeId x) { return sub(x, b_.make(Op::f_floor, x)); }

NodeId Compositions::mod(NodeId x, NodeId y) { return sub(x, mul(y, b_.make(Op::f_floor, div(x, y)))); }

NodeId Compositions::rem(NodeId x, NodeId y) { return sub(x, mul(y, b_.make(Op::f_trunc, div(x, y)))); }

/// The remainder with the divisor's sign.
NodeId Compositions::int_mod(NodeId x, NodeId y) {
  const NodeId zero = b_.integer(0), rest = b_.make(Op::i_rem, x, y);
  const NodeId is_zero = b_.make(Op::i_eq, rest, zero);
  const NodeId differs = b_.make(Op::b_xor, b_.make(Op::i_lt, rest, zero), b_.make(Op::i_lt, y, zero));
  return b_.select(b_.both(b_.negation(is_zero), differs), b_.make(Op::i_add, rest, y), rest);
}

NodeId Compositions::mix(NodeId x, NodeId y, NodeId a) { return add(mul(x, sub(b_.number(1.0f), a)), mul(y, a)); }

NodeId Compositions::step(NodeId edge, NodeId x) {
  return b_.select(b_.make(Op::f_lt, x, edge), b_.number(0.0f), b_.number(1.0f));
}

NodeId Compositions::smoothstep(NodeId low, NodeId high, NodeId x) {
  const NodeId t = clamp(div(sub(x, low), sub(high, low)), b_.number(0.0f), b_.number(1.0f));
  return mul(mul(t, t), sub(b_.number(3.0f), mul(b_.number(2.0f), t)));
}

NodeId Compositions::inverse_root(NodeId x) { return b_.make(Op::f_inverse_sqrt, x); }

NodeId Compositions::dot(std::span<const NodeId> x, std::span<const NodeId> y) {
  NodeId sum = mul(x[0], y[0]);
  for (size_t i = 1; i < x.size(); ++i) sum = add(sum, mul(x[i], y[i]));
  return sum;
}

NodeId Compositions::length(std::span<const NodeId> x) { return b_.make(Op::f_sqrt, dot(x, x)); }

Scalars Compositions::scaled(std::span<const NodeId> x, NodeId factor) {
  Scalars out;
  for (const NodeId one : x) out.push_back(mul(one, factor));
  return out;
}

Scalars Compositions::difference(std::span<const NodeId> a, std::span<const NodeId> b) {
  Scalars out;
  for (size_t i = 0; i < a.size(); ++i) out.push_back(sub(a[i], b[i]));
  return out;
}

Scalars Compositions::normalize(std::span<const NodeId> x) {
  const NodeId length2 = dot(x, x), zero = b_.number(0.0f);
  return scaled(x, b_.select(b_.make(Op::f_lt, zero, length2), inverse_root(length2), zero));
}

Scalars Compositions::cross(std::span<const NodeId> a, std::span<const NodeId> b) {
  Scalars out;
  for (size_t i = 0; i < 3; ++i) {
    const size_t j = (i + 1) % 3, k = (i + 2) % 3;
    // The second component is stated as a.z*b.x - a.x*b.z, which is this order too.
    out.push_back(sub(mul(a[j], b[k]), mul(a[k], b[j])));
  }
  return out;
}

Scalars Compositions::reflect(std::span<const NodeId> i, std::span<const NodeId> n) {
  return difference(i, scaled(n, mul(b_.number(2.0f), dot(n, i))));
}

Scalars Compositions::face_forward(std::span<const NodeId> n, std::span<const NodeId> i,
                                   std::span<const NodeId> reference) {
  const NodeId toward = b_.make(Op::f_lt, dot(reference, i), b_.number(0.0f));
  Scalars out;
  for (const NodeId one : n) out.push_back(b_.select(toward, one, b_.make(Op::f_neg, one)));
  return out;
}

Scalars Compositions::refract(std::span<const NodeId> i, std::span<const NodeId> n, NodeId eta) {
  const NodeId d = dot(n, i), one = b_.number(1.0f), zero = b_.number(0.0f);
  const NodeId k = sub(one, mul(mul(eta, eta), sub(one, mul(d, d))));
  const NodeId along = add(mul(eta, d), b_.make(Op::f_sqrt, k)), total = b_.make(Op::f_lt, k, zero);
  Scalars out;
  for (size_t c = 0; c < i.size(); ++c) out.push_back(b_.select(total, zero, sub(mul(eta, i[c]), mul(along, n[c]))));
  return out;
}

}  // namespace trueshade::programs
