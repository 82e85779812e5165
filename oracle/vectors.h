#pragma once
#include <array>

namespace trueshade::oracle {

using Real = long double;
using Vector = std::array<Real, 3>;

inline Vector difference(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Real dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

}  // namespace trueshade::oracle
