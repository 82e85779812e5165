#pragma once
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace trueshade::testing {

/// What an expression of GLSL is worth by the contract of light programs, worked out by hand.
/// It may read the floats x, y, z, w, the vectors X (these four), Y and Z, the unsigned integers a, b, c, d, and the
/// integers i, j, k of the bits of a, b, c.
struct KnownValue {
  const char* expression;
  char type;                       ///< of the expression: f, i, u or b
  std::vector<float> floats;       ///< of X, Y, Z in this order; what is left out is 0
  std::vector<uint32_t> integers;  ///< a, b, c, d
  uint32_t expected;               ///< bits; any NaN for a NaN; a boolean is 0 or 1
};

std::span<const KnownValue> known_values();

/// A light program whose light.x is the expression if it is a float, and else its halves in light.y (high) and light.z.
/// `s.user[0]` to `s.user[2]` hold the floats, `s.object`, `s.material`, `s.pixel_x`, `s.pixel_y` the integers.
std::string program_of(const KnownValue& value);

/// What the body of `float f(Surface s, int n, float x)` returns, worked out by hand, for s.object = n and s.shininess
/// = x; all other inputs are 0.
struct KnownBody {
  const char* body;
  uint32_t n;
  float x, expected;
  const char* before = "";  ///< stands in front of the function
  bool bounded = true;      ///< every loop has an end that does not depend on n and x
};

/// Branches, loops, calls and memory.
std::span<const KnownBody> known_bodies();

/// A light program whose light is the body's value.
std::string program_of(const KnownBody& value);

}  // namespace trueshade::testing
