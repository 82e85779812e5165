#include "programs/building/compositions.h"

namespace trueshade::programs {

Scalars Compositions::matrix_vector(std::span<const NodeId> m, std::span<const NodeId> v, size_t rows) {
  Scalars out;
  for (size_t row = 0; row < rows; ++row) {
    NodeId sum = mul(m[row], v[0]);
    for (size_t column = 1; column < v.size(); ++column) sum = add(sum, mul(m[column * rows + row], v[column]));
    out.push_back(sum);
  }
  return out;
}

Scalars Compositions::vector_matrix(std::span<const NodeId> v, std::span<const NodeId> m) {
  Scalars out;
  for (size_t first = 0; first < m.size(); first += v.size()) out.push_back(dot(v, m.subspan(first, v.size())));
  return out;
}

Scalars Compositions::matrix_product(std::span<const NodeId> a, std::span<const NodeId> b, size_t rows) {
  const size_t shared = a.size() / rows;  // columns of a, rows of b
  Scalars out;
  for (size_t first = 0; first < b.size(); first += shared) {
    const Scalars column = matrix_vector(a, b.subspan(first, shared), rows);
    out.insert(out.end(), column.begin(), column.end());
  }
  return out;
}

Scalars Compositions::outer_product(std::span<const NodeId> column, std::span<const NodeId> row) {
  Scalars out;
  for (const NodeId r : row)
    for (const NodeId c : column) out.push_back(mul(c, r));
  return out;
}

Scalars Compositions::transpose(std::span<const NodeId> m, size_t rows) {
  const size_t columns = m.size() / rows;
  Scalars out;
  for (size_t row = 0; row < rows; ++row)
    for (size_t column = 0; column < columns; ++column) out.push_back(m[column * rows + row]);
  return out;
}

/// What is left of a matrix without a column and a row.
Scalars Compositions::minor_of(std::span<const NodeId> m, size_t size, size_t column, size_t row) const {
  Scalars out;
  for (size_t c = 0; c < size; ++c)
    for (size_t r = 0; r < size; ++r)
      if (c != column && r != row) out.push_back(m[c * size + r]);
  return out;
}

NodeId Compositions::determinant(std::span<const NodeId> m, size_t size) {
  if (size == 1) return m[0];
  if (size == 2) return sub(mul(m[0], m[3]), mul(m[2], m[1]));
  if (size == 3) return dot(m.first(3), cross(m.subspan(3, 3), m.subspan(6, 3)));
  NodeId sum = kNoNode;
  for (size_t row = 0; row < 4; ++row) {
    const NodeId term = mul(m[row], determinant(minor_of(m, 4, 0, row), 3));
    sum = row == 0 ? term : row % 2 == 1 ? sub(sum, term) : add(sum, term);
  }
  return sum;
}

Scalars Compositions::inverse(std::span<const NodeId> m, size_t size) {
  const NodeId factor = div(b_.number(1.0f), determinant(m, size));
  Scalars out;
  for (size_t column = 0; column < size; ++column)
    for (size_t row = 0; row < size; ++row) {  // the cofactor of the element across the diagonal
      const NodeId rest = determinant(minor_of(m, size, row, column), size - 1);
      const NodeId cofactor = (row + column) % 2 == 1 ? b_.make(Op::f_neg, rest) : rest;
      out.push_back(mul(cofactor, factor));
    }
  return out;
}

}  // namespace trueshade::programs
