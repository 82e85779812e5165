// Normal maps and blends with every liberty GLSL and OpenGL give.
#include <algorithm>
#include <cmath>

#include "tests/intervals/loose_renderer.h"

namespace trueshade::testing {

void loose_bend(LooseFloat& f, const float along_u[3], const float along_v[3], const std::array<float, 4>& texel,
                float scale, float normal[3]) {
  const float n2 = f.dot(normal, normal);
  float t[3], c[3];
  const float q = f.div(f.dot(normal, along_u), n2);
  for (int k = 0; k < 3; ++k) t[k] = f.mad(-normal[k], q, along_u[k]);
  const float t2 = f.dot(t, t);
  if (!(n2 > 0 && t2 > 0)) return;
  const float r = f.inverse_sqrt(t2);
  for (float& x : t) x = f.mul(x, r);
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    c[k] = f.mad(normal[i], t[j], -f.mul(normal[j], t[i]));
  }
  const float length = f.inverse_sqrt(n2), turn = f.dot(c, along_v) < 0 ? -length : length;
  const float x = f.mul(f.mad(2, texel[0], -1), scale), y = f.mul(f.mad(2, texel[1], -1), scale);
  const float z = f.mad(2, texel[2], -1);
  for (int k = 0; k < 3; ++k) normal[k] = f.mad(normal[k], z, f.mad(f.mul(c[k], turn), y, f.mul(t[k], x)));
}

namespace {

double decoded(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }

/// Numbers from 0 to 1, or codes; each product rounded as its arithmetic may.
struct LooseNumbers {
  LooseFloat& f;
  double one;  ///< 0: floats, else the code of 1
  double times(double a, double b) const {
    if (one == 0) return double(f.mul(float(a), float(b)));
    const double exact = a * b / one;
    return (f.random().next() & 1) != 0 ? std::floor(exact) : std::ceil(exact);
  }
  double plus(double a, double b) const { return one == 0 ? double(f.add(float(a), float(b))) : std::min(a + b, one); }
  double rest(double a) const { return one == 0 ? double(f.sub(1, float(a))) : one - a; }
};

double factor_of(const LooseNumbers& n, BlendFactor factor, const std::array<double, 4>& s,
                 const std::array<double, 4>& d, size_t k) {
  switch (factor) {
    case BlendFactor::src_alpha:
      return s[3];
    case BlendFactor::one_minus_src_alpha:
      return n.rest(s[3]);
    default:
      return d[k];  // dst_color
  }
}

}  // namespace

std::array<double, 4> loose_blend(LooseFloat& f, const BlendState& state, Format format, const Liberties& liberties,
                                  const float source[4], const std::array<double, 4>& stored) {
  const FormatInfo layout = info(format);
  const bool fixed = layout.number_class == NumberClass::unorm, in_codes = fixed && !layout.srgb && liberties.blends_codes;
  const LooseNumbers numbers{f, in_codes ? double(layout.largest_code(0)) : 0};
  std::array<double, 4> s{}, d{}, out{};
  for (size_t k = 0; k < 4; ++k) {
    const double largest = fixed ? double(layout.largest_code(int(k))) : 1;
    s[k] = fixed ? std::clamp(double(source[k]), 0.0, 1.0) : double(source[k]);
    d[k] = stored[k];
    if (in_codes) {
      s[k] = (f.random().next() & 1) != 0 ? std::floor(s[k] * largest) : std::ceil(s[k] * largest);
      continue;
    }
    if (fixed) d[k] = layout.srgb_channel(int(k)) ? decoded(d[k] / largest) : double(f.div(float(d[k]), float(largest)));
  }
  for (size_t k = 0; k < 4; ++k) {
    const BlendTerm& term = k == 3 ? state.alpha : state.rgb;
    const auto part = [&](BlendFactor by, double x) {
      return by == BlendFactor::one ? x : numbers.times(x, factor_of(numbers, by, s, d, k));
    };
    const bool no_dst = term.dst == BlendFactor::zero;
    out[k] = no_dst ? part(term.src, s[k]) : numbers.plus(part(term.src, s[k]), part(term.dst, d[k]));
  }
  return out;
}

}  // namespace trueshade::testing
