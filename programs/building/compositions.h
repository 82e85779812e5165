#pragma once
#include <span>
#include <vector>

#include "programs/building/node_builder.h"

namespace trueshade::programs {

/// The scalars of a vector; of a matrix, column by column.
using Scalars = std::vector<NodeId>;

/// What GLSL has beyond the operations of op.h, composed of them in the order that docs/arithmetic.md states.
class Compositions {
 public:
  explicit Compositions(NodeBuilder& builder) : b_(builder) {}

  // Scalars.
  NodeId sign(NodeId x);
  NodeId int_sign(NodeId x);
  NodeId int_abs(NodeId x);
  NodeId chosen_int(NodeId a, NodeId b, bool is_signed, bool least);  ///< the lesser or the greater of integers
  NodeId clamp(NodeId x, NodeId low, NodeId high);
  NodeId fract(NodeId x);
  NodeId mod(NodeId x, NodeId y);
  NodeId rem(NodeId x, NodeId y);
  NodeId int_mod(NodeId x, NodeId y);
  NodeId mix(NodeId x, NodeId y, NodeId a);
  NodeId step(NodeId edge, NodeId x);
  NodeId smoothstep(NodeId low, NodeId high, NodeId x);
  NodeId inverse_root(NodeId x);
  NodeId degrees_of(NodeId x, float factor) { return b_.make(Op::f_mul, x, b_.number(factor)); }

  // Vectors.
  NodeId dot(std::span<const NodeId> x, std::span<const NodeId> y);
  NodeId length(std::span<const NodeId> x);
  Scalars normalize(std::span<const NodeId> x);
  Scalars cross(std::span<const NodeId> a, std::span<const NodeId> b);
  Scalars reflect(std::span<const NodeId> i, std::span<const NodeId> n);
  Scalars refract(std::span<const NodeId> i, std::span<const NodeId> n, NodeId eta);
  Scalars face_forward(std::span<const NodeId> n, std::span<const NodeId> i, std::span<const NodeId> reference);
  Scalars difference(std::span<const NodeId> a, std::span<const NodeId> b);
  Scalars scaled(std::span<const NodeId> x, NodeId factor);

  // Matrices of `rows` rows.
  Scalars matrix_vector(std::span<const NodeId> m, std::span<const NodeId> v, size_t rows);
  Scalars vector_matrix(std::span<const NodeId> v, std::span<const NodeId> m);
  Scalars matrix_product(std::span<const NodeId> a, std::span<const NodeId> b, size_t rows);
  Scalars outer_product(std::span<const NodeId> column, std::span<const NodeId> row);
  Scalars transpose(std::span<const NodeId> m, size_t rows);
  NodeId determinant(std::span<const NodeId> m, size_t size);
  Scalars inverse(std::span<const NodeId> m, size_t size);

  // Bits.
  NodeId bits_extracted(NodeId x, NodeId offset, NodeId count, bool is_signed);
  NodeId bits_inserted(NodeId base, NodeId insert, NodeId offset, NodeId count);
  NodeId int_highest_bit(NodeId x);
  NodeId carry(NodeId a, NodeId b);
  NodeId borrow(NodeId a, NodeId b);
  NodeId packed_halves(std::span<const NodeId> x);
  Scalars unpacked_halves(NodeId x);
  NodeId packed_fixed(std::span<const NodeId> x, bool is_signed);  ///< 2 or 4 codes
  Scalars unpacked_fixed(NodeId x, size_t codes, bool is_signed);

 private:
  NodeId add(NodeId a, NodeId b) { return b_.make(Op::f_add, a, b); }
  NodeId sub(NodeId a, NodeId b) { return b_.make(Op::f_sub, a, b); }
  NodeId mul(NodeId a, NodeId b) { return b_.make(Op::f_mul, a, b); }
  NodeId div(NodeId a, NodeId b) { return b_.make(Op::f_div, a, b); }
  Scalars minor_of(std::span<const NodeId> m, size_t size, size_t column, size_t row) const;

  NodeBuilder& b_;
};

}  // namespace trueshade::programs
