#include <array>
#include <cmath>
#include <functional>

#include "tests/catch.hpp"
#include "tests/programs/random_words.h"
#include "tests/programs/run_program.h"

namespace trueshade::programs {
namespace {

using V3 = std::array<float, 3>;

float dot(V3 a, V3 b) { return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]; }
V3 times(V3 a, float x) { return {a[0] * x, a[1] * x, a[2] * x}; }
V3 minus(V3 a, V3 b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
V3 cross(V3 a, V3 b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }
float least(float a, float b) { return a < b ? a : b; }
float most(float a, float b) { return a > b ? a : b; }
V3 each(V3 a, V3 b, float (*f)(float, float)) { return {f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2])}; }

/// The columns of a 3x3 matrix.
using M3 = std::array<V3, 3>;
M3 matrix(V3 a, V3 b) { return {a, b, {a[1], b[2], a[0]}}; }
float det2(float a, float b, float c, float d) { return a * d - c * b; }  // columns (a, b), (c, d)

V3 inverse_times(const M3& m, V3 v) {
  const float factor = 1.0f / dot(m[0], cross(m[1], m[2]));
  M3 inverse;
  for (size_t column = 0; column < 3; ++column)
    for (size_t row = 0; row < 3; ++row) {
      const size_t c0 = row == 0 ? 1 : 0, c1 = row == 2 ? 1 : 2, r0 = column == 0 ? 1 : 0, r1 = column == 2 ? 1 : 2;
      const float rest = det2(m[c0][r0], m[c0][r1], m[c1][r0], m[c1][r1]);
      inverse[column][row] = ((row + column) % 2 == 1 ? -rest : rest) * factor;
    }
  V3 out;
  for (size_t r = 0; r < 3; ++r) out[r] = (inverse[0][r] * v[0] + inverse[1][r] * v[1]) + inverse[2][r] * v[2];
  return out;
}

struct Composition {
  const char* glsl;
  std::function<V3(V3 a, V3 b, float c)> wanted;
};

const std::vector<Composition> kCompositions = {
    {"vec3(dot(a, b), length(a), distance(a, b))",
     [](V3 a, V3 b, float) -> V3 {
       const V3 d = minus(a, b);
       return {dot(a, b), std::sqrt(dot(a, a)), std::sqrt(dot(d, d))};
     }},
    {"normalize(a)", [](V3 a, V3, float) { return times(a, dot(a, a) > 0 ? 1.0f / std::sqrt(dot(a, a)) : 0.0f); }},
    {"normalize(a - a)",
     [](V3, V3, float) -> V3 {
       return {0, 0, 0};
     }},
    {"cross(a, b)", [](V3 a, V3 b, float) { return cross(a, b); }},
    {"reflect(a, b)", [](V3 a, V3 b, float) { return minus(a, times(b, 2.0f * dot(b, a))); }},
    {"refract(a, b, c)",
     [](V3 a, V3 b, float c) -> V3 {
       const float d = dot(b, a), k = 1.0f - (c * c) * (1.0f - d * d);
       return k < 0 ? V3{0, 0, 0} : minus(times(a, c), times(b, c * d + std::sqrt(k)));
     }},
    {"faceforward(a, b, a)", [](V3 a, V3 b, float) { return dot(a, b) < 0 ? a : times(a, -1.0f); }},
    {"mix(a, b, c)",
     [](V3 a, V3 b, float c) -> V3 {
       V3 out;
       for (size_t k = 0; k < 3; ++k) out[k] = a[k] * (1.0f - c) + b[k] * c;
       return out;
     }},
    {"mix(a, b, greaterThan(a, b))", [](V3 a, V3 b, float) { return each(a, b, least); }},
    {"smoothstep(b, b + 1.0, a)",
     [](V3 a, V3 b, float) {
       return each(a, b, [](float x, float low) {
         const float high = low + 1.0f, t = least(most((x - low) / (high - low), 0.0f), 1.0f);
         return (t * t) * (3.0f - 2.0f * t);
       });
     }},
    {"mod(a, b)",
     [](V3 a, V3 b, float) { return each(a, b, [](float x, float y) { return x - y * std::floor(x / y); }); }},
    {"fract(a) + sign(b) * step(a, b)",
     [](V3 a, V3 b, float) {
       return each(a, b, [](float x, float y) {
         return (x - std::floor(x)) + (y > 0 ? 1.0f : y < 0 ? -1.0f : 0.0f) * (y < x ? 0.0f : 1.0f);
       });
     }},
    {"clamp(a, b, vec3(c))",
     [](V3 a, V3 b, float c) -> V3 {
       V3 out;
       for (size_t k = 0; k < 3; ++k) out[k] = least(most(a[k], b[k]), c);
       return out;
     }},
    {"inversesqrt(abs(a)) + radians(b)",
     [](V3 a, V3 b, float) {
       return each(a, b, [](float x, float y) { return 1.0f / std::sqrt(std::abs(x)) + y * 0.01745329251994329577f; });
     }},
    {"fma(a, b, vec3(c))",
     [](V3 a, V3 b, float c) -> V3 {
       return {std::fma(a[0], b[0], c), std::fma(a[1], b[1], c), std::fma(a[2], b[2], c)};
     }},
    {"mat3(a, b, vec3(a.y, b.z, a.x)) * b",
     [](V3 a, V3 b, float) -> V3 {
       const M3 m = matrix(a, b);
       V3 out;
       for (size_t r = 0; r < 3; ++r) out[r] = (m[0][r] * b[0] + m[1][r] * b[1]) + m[2][r] * b[2];
       return out;
     }},
    {"a * mat3(a, b, vec3(a.y, b.z, a.x))",
     [](V3 a, V3 b, float) -> V3 {
       const M3 m = matrix(a, b);
       return {dot(a, m[0]), dot(a, m[1]), dot(a, m[2])};
     }},
    {"(mat3(a, b, vec3(a.y, b.z, a.x)) * outerProduct(a, b) * c)[1]",
     [](V3 a, V3 b, float c) -> V3 {
       const M3 m = matrix(a, b);
       const V3 v = times(a, b[1]);
       V3 out;
       for (size_t r = 0; r < 3; ++r) out[r] = ((m[0][r] * v[0] + m[1][r] * v[1]) + m[2][r] * v[2]) * c;
       return out;
     }},
    {"inverse(mat3(a, b, vec3(a.y, b.z, a.x))) * b", [](V3 a, V3 b, float) { return inverse_times(matrix(a, b), b); }},
    {"vec3(determinant(mat2(a.xy, b.yz)), determinant(mat3(a, b, vec3(a.y, b.z, a.x))), transpose(mat3(a, b, a))[2].y)",
     [](V3 a, V3 b, float) -> V3 {
       const M3 m = matrix(a, b);
       return {det2(a[0], a[1], b[1], b[2]), dot(m[0], cross(m[1], m[2])), b[2]};
     }},
    {"vec3(determinant(mat4(a, c, b, c, a.zxy, c, b.yxz, 1.0)))",
     [](V3 a, V3 b, float c) -> V3 {
       const float m[4][4] = {
           {a[0], a[1], a[2], c}, {b[0], b[1], b[2], c}, {a[2], a[0], a[1], c}, {b[1], b[0], b[2], 1}};
       float sum = 0;
       for (size_t row = 0; row < 4; ++row) {
         M3 rest;
         for (size_t column = 0; column < 3; ++column)
           for (size_t r = 0; r < 3; ++r) rest[column][r] = m[column + 1][r + (r >= row)];
         const float term = m[0][row] * dot(rest[0], cross(rest[1], rest[2]));
         sum = row == 0 ? term : row % 2 == 1 ? sum - term : sum + term;
       }
       return {sum, sum, sum};
     }},
    {"vec3(frexp(a.x, ai), float(ai), modf(b.x, c) + c)",
     [](V3 a, V3 b, float) -> V3 {
       int exponent = 0;
       const float part = std::frexp(a[0], &exponent), whole = std::trunc(b[0]);
       return {part, float(exponent), (b[0] - whole) + whole};
     }},
    {"vec3(uintBitsToFloat(packUnorm4x8(vec4(a, c))), unpackSnorm2x16(packSnorm2x16(b.xy)))",
     [](V3 a, V3 b, float c) -> V3 {
       uint32_t packed = 0;
       const float in[4] = {a[0], a[1], a[2], c};
       for (int k = 0; k < 4; ++k) packed |= uint32_t(std::nearbyint(least(most(in[k], 0.0f), 1.0f) * 255.0f)) << 8 * k;
       V3 out{float_of(packed), 0, 0};
       for (size_t k = 0; k < 2; ++k)
         out[k + 1] = least(most(std::nearbyint(least(most(b[k], -1.0f), 1.0f) * 32767.0f) / 32767.0f, -1.0f), 1.0f);
       return out;
     }},
    {"vec3(unpackHalf2x16(packHalf2x16(vec2(1.0009765625, c * 0.0))), float(bitfieldExtract(-9, 1, 5)))",
     [](V3, V3, float c) -> V3 {
       return {1.0009765625f, c * 0.0f, float((-9 >> 1) << 27 >> 27)};
     }},
    {"vec3(float(findMSB(int(a.x * 100.0))), float(bitCount(uint(abs(b.x) * 999.0))), float(bitfieldInsert(7u, 5u, 4, "
     "3)))",
     [](V3 a, V3 b, float) -> V3 {
       const int x = int(a[0] * 100.0f);
       int highest = -1;
       for (int k = 0; k < 32; ++k)
         if ((((x < 0 ? ~x : x) >> k) & 1) != 0) highest = k;
       return {float(highest), float(__builtin_popcount(uint32_t(std::abs(b[0]) * 999.0f))), 87.0f};
     }},
};

V3 random_vector(RandomWords& random) {
  V3 out;
  for (float& x : out) x = float(random() >> 8) * 0x1p-22f - 2.0f;
  return out;
}

bool same_but_for_zeros(float a, float b) {
  return bits_of(a) == bits_of(b) || (std::isnan(a) && std::isnan(b)) || (a == 0 && b == 0);
}

}  // namespace

TEST_CASE("Functions of vectors and matrices are composed as stated") {
  RandomWords random(5);
  for (const Composition& c : kCompositions) {
    const std::string glsl = c.glsl;
    const Program program =
        program_of_light("vec3 a = s.position, b = s.normal; float c = s.metallic; int ai; return " + glsl + ";");
    for (int round = 0; round < 200; ++round) {
      const V3 a = random_vector(random), b = random_vector(random);
      const float factor = random_vector(random)[0];
      const std::vector<float> made = light_of(program, {{"surface.position.x", a[0]},
                                                         {"surface.position.y", a[1]},
                                                         {"surface.position.z", a[2]},
                                                         {"surface.normal.x", b[0]},
                                                         {"surface.normal.y", b[1]},
                                                         {"surface.normal.z", b[2]},
                                                         {"surface.metallic", factor}});
      const V3 wanted = c.wanted(a, b, factor);
      INFO(glsl << " of " << a[0] << " " << a[1] << " " << a[2] << ", " << b[0] << " " << b[1] << " " << b[2] << ", "
                << factor);
      for (size_t k = 0; k < 3; ++k) {
        INFO(made[k] << " for " << wanted[k]);
        REQUIRE(same_but_for_zeros(made[k], wanted[k]));
      }
    }
  }
}

}  // namespace trueshade::programs
