#include "cli/capture/unpacking.h"

#include <algorithm>
#include <cmath>

namespace trueshade {
namespace {

constexpr double kRounding = 0x1p-23;       // u
constexpr double kFloatRounding = 0x1p-24;  // of our own values, at most 2, to float

const double kSqrt2 = std::sqrt(2.0), kSqrt6 = std::sqrt(6.0);

}  // namespace

PackedNumber signed_number(const PackedNumber& c) {
  return {2 * c.value - 1, 2 * c.step, 2 * c.fetch + kRounding};
}

/// packing_error: a store may be a step off, and what is stored, computed by a product and a sum, two roundings.
UnpackedVector unpacked_components(const std::array<PackedNumber, 3>& n) {
  UnpackedVector v;
  for (size_t k = 0; k < 3; ++k) {
    v.value[k] = n[k].value;
    v.reading_error = std::max(v.reading_error, n[k].fetch);
    v.packing_error = std::max(v.packing_error, n[k].step + n[k].fetch + (n[k].step > 0 ? 2 * kRounding : 0));
  }
  v.reading_error += kFloatRounding, v.packing_error += kFloatRounding;
  return v;
}

/// With x and y off by e each, v.z is by 2 e, so |dv| <= sqrt(1 + 1 + 4) e; v.z takes two roundings and a folded
/// component one, so 3 u more. The map is continuous on the square and this holds in each of its triangles, so it
/// holds between any two points. Making v unit length divides by |v| >= 1 / sqrt(3), and takes 3 roundings of the dot
/// product (halved by the root), 2 u of inversesqrt and a product: 4.5 u. Packing divides by |x| + |y| + |z|, folds,
/// and stores a neighbouring code: at most 6 u and a step in x and y.
std::optional<UnpackedVector> unpacked_octahedral(const PackedNumber& x, const PackedNumber& y) {
  const double a = std::fabs(x.value), b = std::fabs(y.value);
  if (!(a <= 1 + x.fetch) || !(b <= 1 + y.fetch)) return std::nullopt;
  std::array<double, 3> v = {x.value, y.value, 1 - a - b};
  if (v[2] < 0) v = {std::copysign(1 - b, x.value), std::copysign(1 - a, y.value), v[2]};
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  UnpackedVector n;
  for (size_t k = 0; k < 3; ++k) n.value[k] = v[k] / length;
  const double e = std::max(x.fetch, y.fetch), step = std::max(x.step, y.step) + 6 * kRounding + e;
  n.reading_error = 1.01 * ((kSqrt6 * e + 3 * kRounding) / length + 4.5 * kRounding) + kFloatRounding;
  const double room = length - kSqrt6 * step;
  n.packing_error = std::min(2.0, kSqrt6 * step / std::max(room, 0.1)) + 16 * kRounding + kFloatRounding;
  return n;
}

namespace {

/// The bound on the error of each component of n (see unpacked_spheremap) where each component of f is off by `e`, with
/// the roundings of the unpacking. |f|^2, `f2`, is off by 2 |f| sqrt(2) e + 2 e^2 and three roundings;
/// s = 1 - |f|^2 / 4 by a quarter of this error and one rounding; its root by min(ds / root, sqrt(ds)) and 4.5 u.
/// |f| <= 2.
double spheremap_error(double f2, double e) {
  const double length = std::sqrt(f2), root = std::sqrt(std::max(0.0, 1 - f2 / 4));
  const double df2 = 2 * length * kSqrt2 * e + 2 * e * e + 3 * kRounding * f2, ds = df2 / 4 + kRounding;
  const double droot = (root > 0 ? std::min(ds / root, std::sqrt(ds)) : std::sqrt(ds)) + 4.5 * kRounding * root;
  return std::max(e * root + (2 + e) * droot + kRounding, df2 / 2 + kRounding);
}

}  // namespace

std::optional<UnpackedVector> unpacked_spheremap(const PackedNumber& x, const PackedNumber& y) {
  const double f[] = {4 * x.value - 2, 4 * y.value - 2}, f2 = f[0] * f[0] + f[1] * f[1];
  const double fetched = 4 * std::max(x.fetch, y.fetch) + 2 * kRounding;
  const double packed = 4 * std::max(x.step, y.step) + 32 * kRounding + fetched;  // n.xy / sqrt(8 n.z + 8) + 1/2
  if (!(f2 <= 4 + 4 * kSqrt2 * packed)) return std::nullopt;
  const double root = std::sqrt(std::max(0.0, 1 - f2 / 4));
  UnpackedVector n;
  n.value = {f[0] * root, f[1] * root, 1 - f2 / 2};
  n.reading_error = spheremap_error(f2, fetched) + kFloatRounding;
  n.packing_error = std::min(2.0, spheremap_error(f2, packed)) + kFloatRounding;
  return n;
}

}  // namespace trueshade
