#pragma once

namespace trueshade {

/// Which edges own the samples that lie on them, of a triangle with positive area whose edge goes by (dx, dy), its
/// inside to the left: those that go down, and of the level ones those to the right; for `upper_left` to the left
/// (GL 4.6 core, 14.6.1; docs/arithmetic.md section 4). Of the two triangles at a shared edge one owns it.
/// edge_rule-inl.h is the same for vectors.
template <class T>
constexpr bool owns_edge(T dx, T dy, bool upper_left) {
  return dy < T(0) || (dy == T(0) && (upper_left ? dx < T(0) : dx > T(0)));
}

}  // namespace trueshade
