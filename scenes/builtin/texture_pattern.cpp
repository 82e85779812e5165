#include "scenes/builtin/texture_pattern.h"

#include <algorithm>

namespace trueshade {
namespace {

/// 16 bits of a lattice point: three rounds of multiply and shift (the finaliser of Murmur3, A. Appleby).
uint32_t hashed(uint32_t x, uint32_t y, uint64_t seed) {
  uint64_t h = seed + 0x9E3779B97F4A7C15u * (uint64_t(x) << 32 | y);
  h = (h ^ (h >> 33)) * 0xFF51AFD7ED558CCDu;
  h = (h ^ (h >> 33)) * 0xC4CEB9FE1A85EC53u;
  return uint32_t((h ^ (h >> 33)) & 0xffffu);
}

/// Where a texel's middle lies among `cells` over `side` texels, in 1/65536 cell.
int64_t place(int texel, int side, int cells) { return ((2 * int64_t(texel) + 1) * cells << 16) / (2 * int64_t(side)); }

int64_t smooth(int64_t t) { return (t * t >> 16) * (3 * 65536 - 2 * t) >> 16; }  // 3 t^2 - 2 t^3 in 1/65536
int64_t mixed(int64_t a, int64_t b, int64_t t) { return a + ((b - a) * t >> 16); }

/// Value noise in [0, 65535], repeating after `columns` x `rows` cells.
int64_t lattice_noise(int64_t x, int64_t y, uint32_t columns, uint32_t rows, uint64_t seed) {
  const uint32_t cx = uint32_t(x >> 16), cy = uint32_t(y >> 16);
  const int64_t tx = smooth(x & 0xffff), ty = smooth(y & 0xffff);
  const auto corner = [&](uint32_t dx, uint32_t dy) {
    return int64_t(hashed((cx + dx) % columns, (cy + dy) % rows, seed));
  };
  return mixed(mixed(corner(0, 0), corner(1, 0), tx), mixed(corner(0, 1), corner(1, 1), tx), ty);
}

/// Share of the second colour at a texel, in 1/65536.
int64_t share(const TexturePattern& p, int x, int y) {
  const int64_t u = place(x, p.width, p.columns), v = place(y, p.height, p.rows);
  switch (p.pattern) {
    case Pattern::checker:
      return ((u >> 16) + (v >> 16)) % 2 == 0 ? 0 : 65536;
    case Pattern::brick: {
      const int64_t row = v >> 16, shifted = u + (row % 2) * 32768;
      const int64_t across = shifted & 0xffff, up = v & 0xffff;
      if (across < 65536 / 16 || up < 65536 / 8) return 65536;
      const auto column = uint32_t((shifted >> 16) % p.columns);
      return int64_t(hashed(column, uint32_t(row), p.seed)) >> 2;  // up to a quarter
    }
    case Pattern::noise: {
      int64_t sum = 0;
      for (int octave = 0; octave < 4; ++octave)
        sum += lattice_noise(u << octave, v << octave, uint32_t(p.columns) << octave, uint32_t(p.rows) << octave,
                             p.seed + uint64_t(octave)) >>
               (octave + 1);
      return sum * 65536 / 61440;  // 1/2 + 1/4 + 1/8 + 1/16 = 15/16
    }
  }
  return 0;
}

}  // namespace

Texture texture_of(const TexturePattern& p) {
  Texture texture{std::string(kPatternNames[size_t(p.pattern)]), p.format, {}};
  TextureLevel level{p.width, p.height, {}};
  level.bytes.reserve(size_t(p.width) * size_t(p.height) * size_t(bytes_per_texel(p.format)));
  for (int y = 0; y < p.height; ++y) {
    for (int x = 0; x < p.width; ++x) {
      const float part = float(std::min<int64_t>(share(p, x, y), 65536)) * 0x1p-16f;
      std::array<float, 4> value;
      for (int c = 0; c < 4; ++c) value[size_t(c)] = p.colors[0][c] * (1.0f - part) + p.colors[1][c] * part;
      append_texel(p.format, value, level.bytes);
    }
  }
  texture.levels.push_back(std::move(level));
  return texture;
}

}  // namespace trueshade
