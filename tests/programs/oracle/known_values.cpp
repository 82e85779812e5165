#include "tests/programs/oracle/known_values.h"

#include <bit>
#include <cmath>
#include <limits>

namespace trueshade::testing {

namespace {

constexpr float kInf = std::numeric_limits<float>::infinity(), kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kLeast = 0x1p-149f, kMost = 0x1.fffffep127f, kPi = 3.14159265358979f;
constexpr uint32_t kMinus = 0x80000000u;

KnownValue real(const char* expression, std::vector<float> floats, float expected) {
  return {expression, 'f', std::move(floats), {}, std::bit_cast<uint32_t>(expected)};
}
KnownValue truth(const char* expression, std::vector<float> floats, bool expected) {
  return {expression, 'b', std::move(floats), {}, expected};
}
KnownValue whole(const char* expression, std::vector<uint32_t> integers, int64_t expected) {
  return {expression, 'i', {}, std::move(integers), uint32_t(expected)};
}
KnownValue bits(const char* expression, std::vector<uint32_t> integers, uint32_t expected) {
  return {expression, 'u', {}, std::move(integers), expected};
}
KnownValue of_real(const char* expression, char type, std::vector<float> floats, int64_t expected) {
  return {expression, type, std::move(floats), {}, uint32_t(expected)};
}
KnownValue real_of(const char* expression, std::vector<uint32_t> integers, float expected) {
  return {expression, 'f', {}, std::move(integers), std::bit_cast<uint32_t>(expected)};
}

using Values = std::vector<KnownValue>;

void add(Values& all, std::initializer_list<KnownValue> more) { all.insert(all.end(), more); }

void one_rounding(Values& all) {
  add(all, {
               real("x + y", {1, 0x1p-24f}, 1),
               real("x + y", {1, 0x1.8p-24f}, 0x1.000002p0f),
               real("x + y", {-0.0f, -0.0f}, -0.0f),
               real("x - y", {1, 1}, 0),
               real("x - y", {kInf, kInf}, kNaN),
               real("x + y", {0x1p-149f, 0x1p-149f}, 0x1p-148f),
               real("x * y", {0x1p-100f, 0x1p-49f}, kLeast),
               real("x * y", {0x1p-100f, 0x1p-50f}, 0),
               real("x * y", {0, -1}, -0.0f),
               real("x * y", {kInf, 0}, kNaN),
               real("x / y", {1, 3}, 0x1.555556p-2f),
               real("x / y", {1, -0.0f}, -kInf),
               real("x / y", {0, 0}, kNaN),
               real("x * x - 1.0", {0x1.001p0f}, 0x1p-11f),
               real("fma(x, x, -1.0)", {0x1.001p0f}, 0x1.0008p-11f),
               real("fma(x, y, z)", {kMost, 2, -kInf}, -kInf),
               real("sqrt(x)", {2}, 1.41421356237309505f),
               real("sqrt(x)", {-0.0f}, -0.0f),
               real("sqrt(x)", {-kLeast}, kNaN),
               real("sqrt(x)", {0x1p-148f}, 0x1p-74f),
               real("floor(x)", {-0.5f}, -1),
               real("floor(x)", {-0.0f}, -0.0f),
               real("ceil(x)", {-0.5f}, -0.0f),
               real("ceil(x)", {kLeast}, 1),
               real("trunc(x)", {-1.75f}, -1),
               real("trunc(x)", {-0.5f}, -0.0f),
               real("round(x)", {2.5f}, 2),
               real("round(x)", {-0.5f}, -0.0f),
               real("roundEven(x)", {3.5f}, 4),
               real("round(x)", {0x1.fffffep-2f}, 0),
               real("-x", {0}, -0.0f),
               real("abs(x)", {-0.0f}, 0),
               real("abs(x)", {-kInf}, kInf),
               real("radians(x)", {180}, kPi),
               real("degrees(x)", {1}, 57.295779513082f),
               real("inversesqrt(x)", {4}, 0.5f),
               real("inversesqrt(x)", {0}, kInf),
               real("inversesqrt(x)", {-0.0f}, -kInf),
               real("inversesqrt(x)", {-1}, kNaN),
               // 1 / RN(sqrt 3), which is one unit off the nearest of 1 / sqrt 3 = 0x1.279a745...p-1: RN(sqrt 3) =
               // 0x1.bb67aep0.
               real("inversesqrt(x)", {3}, 1 / 1.7320508075688772f),
           });
}

void conversions(Values& all) {
  add(all, {
               of_real("int(x)", 'i', {-1.75f}, -1),
               of_real("int(x)", 'i', {3e9f}, 0x7FFFFFFF),
               of_real("int(x)", 'i', {-3e9f}, kMinus),
               of_real("int(x)", 'i', {kNaN}, 0),
               of_real("int(x)", 'i', {kInf}, 0x7FFFFFFF),
               of_real("int(x)", 'i', {-kInf}, kMinus),
               of_real("int(x)", 'i', {0x1.fffffep30f}, 0x7FFFFF80),
               of_real("uint(x)", 'u', {-1}, 0),
               of_real("uint(x)", 'u', {-0.5f}, 0),
               of_real("uint(x)", 'u', {5e9f}, 0xFFFFFFFF),
               of_real("uint(x)", 'u', {kNaN}, 0),
               of_real("uint(x)", 'u', {kInf}, 0xFFFFFFFF),
               of_real("uint(x)", 'u', {0x1.fffffep31f}, 0xFFFFFF00),
               of_real("uint(x)", 'u', {3.99f}, 3),
               truth("bool(x)", {kNaN}, true),
               truth("bool(x)", {-0.0f}, false),
               truth("bool(x)", {kLeast}, true),
               real_of("float(i)", {16777217}, 16777216.0f),
               real_of("float(i)", {16777219}, 16777220.0f),
               real_of("float(i)", {kMinus}, -0x1p31f),
               real_of("float(a)", {0xFFFFFFFF}, 0x1p32f),
               real_of("float(a)", {0x80000080}, 0x1p31f),
               real_of("float(a)", {0x80000180}, 0x1.000004p31f),
               real_of("float(bool(a))", {7}, 1),
               whole("int(a)", {0xFFFFFFFE}, -2),
               bits("uint(bool(i))", {5}, 1),
               bits("uint(i)", {0xFFFFFFFF}, 0xFFFFFFFF),
               of_real("floatBitsToInt(x)", 'i', {-1}, 0xBF800000),
               of_real("floatBitsToUint(x)", 'u', {-kNaN}, 0x7FC00000),
               of_real("floatBitsToInt(x * y)", 'i', {kInf, 0}, 0x7FC00000),
               real_of("intBitsToFloat(i)", {0x3F800000}, 1),
               real_of("uintBitsToFloat(a)", {1}, kLeast),
               real_of("uintBitsToFloat(a)", {0x7F800001}, kNaN),
               bits("floatBitsToUint(uintBitsToFloat(a))", {0xFF800001}, 0x7FC00000),
           });
}

void comparisons(Values& all) {
  add(all, {
               truth("x == y", {0, -0.0f}, true),
               truth("x == x", {kNaN}, false),
               truth("x != x", {kNaN}, true),
               truth("x < y", {kNaN, 1}, false),
               truth("x >= y", {kNaN, 1}, false),
               truth("x > y", {1, kNaN}, false),
               truth("x <= y", {1, 1}, true),
               truth("!(x < y)", {kNaN, 1}, true),
               truth("isnan(x)", {kNaN}, true),
               truth("isnan(x)", {kInf}, false),
               truth("isinf(x)", {-kInf}, true),
               truth("isinf(x)", {kNaN}, false),
               truth("any(lessThan(X, Y))", {1, 2, 3, 4, 1, 2, 3, 5}, true),
               truth("all(lessThan(X, Y))", {1, 2, 3, 4, 1, 2, 3, 5}, false),
               truth("X == Y", {1, kNaN, 0, 0, 1, kNaN, 0, 0}, false),
               truth("X != Y", {1, kNaN, 0, 0, 1, kNaN, 0, 0}, true),
               truth("any(notEqual(X, Y))", {0, 0, 0, 0, -0.0f, 0, 0, 0}, false),
               truth("all(equal(X, Y))", {0, 0, 0, 0, -0.0f, 0, 0, 0}, true),
               truth("any(not(greaterThanEqual(X, Y)))", {kNaN}, true),
               truth("(x < y) ^^ (y < x)", {1, 2}, true),
               {"i < j", 'b', {}, {0xFFFFFFFF, 0}, 1},
               {"a < b", 'b', {}, {0xFFFFFFFF, 0}, 0},
               {"i >= j", 'b', {}, {kMinus, 0x7FFFFFFF}, 0},
               {"a > b", 'b', {}, {kMinus, 0x7FFFFFFF}, 1},
               real("sign(x)", {-0.0f}, 0),
               real("sign(x)", {kNaN}, 0),
               real("sign(x)", {-kLeast}, -1),
               real("sign(x)", {kInf}, 1),
               real("min(x, y)", {kNaN, 1}, 1),
               real("min(x, y)", {1, kNaN}, kNaN),
               real("min(x, y)", {0, -0.0f}, -0.0f),
               real("min(x, y)", {-0.0f, 0}, 0),
               real("max(x, y)", {kNaN, 1}, 1),
               real("max(x, y)", {1, kNaN}, kNaN),
               real("max(x, y)", {-0.0f, 0}, 0),
               real("max(x, y)", {0, -0.0f}, -0.0f),
               real("clamp(x, y, z)", {kNaN, 2, 3}, 2),
               real("clamp(x, y, z)", {5, 2, 3}, 3),
               real("clamp(x, y, z)", {5, 7, 3}, 3),
               real("clamp(x, y, z)", {-0.0f, 0, 1}, 0),
               real("step(x, y)", {1, 1}, 1),
               real("step(x, y)", {1, 0.5f}, 0),
               real("step(x, y)", {kNaN, 1}, 1),
               real("mix(x, y, z)", {2, 4, 0.25f}, 2.5f),
               // 1 - 2^-25 rounds to 1, and 2^30 + 2^5 to 2^30.
               real("mix(x, y, z)", {0x1p30f, 0x1p30f, 0x1p-25f}, 0x1p30f),
               real("mix(x, y, z)", {kInf, 1, 1}, kNaN),
               real("mix(x, y, z > 0.0)", {kInf, 1, 1}, 1),
               real("mix(x, y, z > 0.0)", {kInf, 1, 0}, kInf),
               real("fract(x)", {-0.25f}, 0.75f),
               real("fract(x)", {-0x1p-30f}, 1),
               real("fract(x)", {kInf}, kNaN),
               real("fract(x)", {-0.0f}, 0),
               real("mod(x, y)", {-5.5f, 3}, 0.5f),
               real("mod(x, y)", {5.5f, -3}, -0.5f),
               real("mod(x, y)", {1, 0}, kNaN),
               real("mod(x, y)", {1, kInf}, kNaN),
               // RN(1 / RN(0.1)) = 10 exactly, and 1 - RN(0.1) * 10 = 0.
               real("mod(x, y)", {1, 0.1f}, 0),
               real("smoothstep(x, y, z)", {0, 2, 0.5f}, 0.15625f),
               real("smoothstep(x, y, z)", {0, 2, 3}, 1),
               real("smoothstep(x, y, z)", {1, 1, 1}, 0),
               real("smoothstep(x, y, z)", {1, 1, 2}, 1),
               real("smoothstep(x, y, z)", {2, 0, 0.5f}, 0.84375f),
           });
}

void vectors(Values& all) {
  add(all, {
               // (x0 y0 + x1 y1) + x2 y2, and the fourth last.
               real("dot(X.xyz, Y.xyz)", {1e8f, 1, -1e8f, 0, 1, 1, 1, 0}, 0),
               real("dot(X.xzy, Y.xyz)", {1e8f, 1, -1e8f, 0, 1, 1, 1, 0}, 1),
               real("dot(X, Y)", {1e8f, -1e8f, 1, 0.5f, 1, 1, 1, 1}, 1.5f),
               real("dot(X.xy, Y.xy)", {3, 4, 0, 0, 5, 6}, 39),
               real("dot(X, Y)", {1, 0x1p-24f, 0x1p-24f, 0x1p-24f, 1, 1, 1, 1}, 1),
               real("length(X.xy)", {3, 4}, 5),
               real("length(x)", {-3}, 3),
               real("length(x)", {0x1p-80f}, 0),
               real("length(X.xyz)", {0x1p64f, 0, 0}, kInf),
               real("distance(X, Y)", {1, 2, 3, 4, 1, 2, 3, 2}, 2),
               real("distance(x, y)", {1, 4}, 3),
               real("normalize(X.xy).x", {3, 4}, 0x1.333334p-1f),
               real("normalize(X).w", {0, 0, 0, 0}, 0),
               real("normalize(X).x", {-0.0f, 0, 0, 0}, -0.0f),
               real("normalize(x)", {-7}, -0x1p0f),
               real("normalize(X.xyz).y", {0, 0x1p-80f, 0}, 0),
               real("normalize(X).x", {kNaN, 1, 1, 1}, kNaN),
               real("normalize(X).y", {kNaN, 1, 1, 1}, 0),
               real("cross(X.xyz, Y.xyz).x", {1, 2, 3, 0, 4, 5, 7}, -1),
               real("cross(X.xyz, Y.xyz).y", {1, 2, 3, 0, 4, 5, 7}, 5),
               real("cross(X.xyz, Y.xyz).z", {1, 2, 3, 0, 4, 5, 7}, -3),
               real("reflect(X.xy, Y.xy).y", {1, -1, 0, 0, 0, 1}, 1),
               real("reflect(X, Y).x", {1, 2, 3, 4, 1, 1, 0, 0}, -5),
               real("reflect(x, y)", {3, 2}, -21),
               real("faceforward(X.xy, Y.xy, Z.xy).x", {1, 2, 0, 0, 1, 0, 0, 0, -1, 0}, 1),
               real("faceforward(X.xy, Y.xy, Z.xy).x", {1, 2, 0, 0, 1, 0, 0, 0, 1, 0}, -1),
               real("faceforward(X.xy, Y.xy, Z.xy).x", {0, 2, 0, 0, 0, 0, 0, 0, 1, 0}, -0.0f),
               real("faceforward(x, y, z)", {2, kNaN, 1}, -2),
           });
  add(all,
      {
          real("refract(X.xy, Y.xy, z).y", {0, -1, 2, 0, 0, 1}, -1),
          real("refract(X.xy, Y.xy, z).x", {1, 0, 2, 0, 0, 1}, 0),
          real("refract(X.xy, Y.xy, z).x", {1, 0, 0.5f, 0, 0, 1}, 0.5f),
          real("refract(X.xy, Y.xy, z).y", {1, 0, 0.5f, 0, 0, 1}, -0.866025403784f),
          real("refract(x, y, z)", {-1, 1, 0.5f}, -1),
          real("refract(x, y, z)", {kNaN, 1, 0.5f}, kNaN),
          real("(mat2(X) * Y.xy).x", {1, 2, 3, 4, 5, 6}, 23),
          real("(mat2(X) * Y.xy).y", {1, 2, 3, 4, 5, 6}, 34),
          real("(Y.xy * mat2(X)).x", {1, 2, 3, 4, 5, 6}, 17),
          real("(Y.xy * mat2(X)).y", {1, 2, 3, 4, 5, 6}, 39),
          real("(mat2(X) * mat2(Y))[1][0]", {1, 2, 3, 4, 5, 6, 7, 8}, 31),
          real("(mat2(X) * mat2(Y))[0][1]", {1, 2, 3, 4, 5, 6, 7, 8}, 34),
          real("(mat4(X, Y, Z, vec4(1.0)) * vec4(1.0)).x", {1e8f, 0, 0, 0, 1, 0, 0, 0, -1e8f}, 1),
          real("outerProduct(X.xyz, Y.xy)[1][2]", {1, 2, 3, 0, 5, 7}, 21),
          real("transpose(mat2x3(X.xyz, Y.xyz))[2][1]", {1, 2, 3, 0, 5, 7, 11}, 11),
          real("matrixCompMult(mat2(X), mat2(Y))[1][0]", {1, 2, 3, 4, 5, 6, 7, 8}, 21),
          real("(mat2(X) / 3.0)[0][0]", {1}, 0x1.555556p-2f),
          real("(mat2(X) / z)[0][0]", {7, 0, 3, 0}, 7 * 0x1.555556p-2f),
          real("(2.0 - mat2(X))[1][1]", {1, 2, 3, 4}, -2),
          real("(-mat2(X))[1][1]", {1, 2, 3, 0}, -0.0f),
          truth("mat2(X) == mat2(Y)", {1, 2, 3, 4, 1, 2, 3, 4}, true),
          truth("mat2(X) != mat2(Y)", {1, 2, 3, 4, 1, 2, 3, 5}, true),
          real("mat3(mat2(X))[2][2]", {1, 2, 3, 4}, 1),
          real("mat2(x)[0][0]", {9}, 9),
          real("mat2(x)[1][0]", {9}, 0),
          real("determinant(mat2(X))", {1, 2, 3, 4}, -2),
          // Columns (2, 0, 0), (1, 3, 0), (5, 7, 4); and (1, 2, 3, 4), (0, 1, 0, 2), (2, 0, 1, 0), (1, 1, 1, 1), which
          // along its second column is 1 * -1 + 2 * 3.
          real("determinant(mat3(X.xyz, Y.xyz, Z.xyz))", {2, 0, 0, 0, 1, 3, 0, 0, 5, 7, 4}, 24),
          real("determinant(mat4(X, Y, Z, vec4(1.0)))", {1, 2, 3, 4, 0, 1, 0, 2, 2, 0, 1, 0}, 5),
          real("inverse(mat2(X))[0][0]", {1, 2, 3, 4}, -2),
          real("inverse(mat2(X))[0][1]", {1, 2, 3, 4}, 1),
          real("inverse(mat2(X))[1][0]", {1, 2, 3, 4}, 1.5f),
          real("inverse(mat2(X))[1][1]", {1, 2, 3, 4}, -0.5f),
          real("inverse(mat3(X.xyz, Y.xyz, Z.xyz))[1][0]", {2, 0, 0, 0, 1, 3, 0, 0, 5, 7, 4}, -4 * (1 / 24.0f)),
          real("inverse(mat3(X.xyz, Y.xyz, Z.xyz))[0][1]", {2, 0, 0, 0, 1, 3, 0, 0, 5, 7, 4}, -0.0f),
          real("inverse(mat3(X.xyz, Y.xyz, Z.xyz))[2][0]", {2, 0, 0, 0, 1, 3, 0, 0, 5, 7, 4}, -8 * (1 / 24.0f)),
          // Columns (2, 0, 0, 0), (0, 4, 0, 0), (0, 0, 8, 0), (1, 1, 1, 1): the last column of the inverse is
          // (-1/2, -1/4, -1/8, 1).
          real("inverse(mat4(X, Y, Z, vec4(1.0)))[0][0]", {2, 0, 0, 0, 0, 4, 0, 0, 0, 0, 8}, 0.5f),
          real("inverse(mat4(X, Y, Z, vec4(1.0)))[3][2]", {2, 0, 0, 0, 0, 4, 0, 0, 0, 0, 8}, -0.125f),
          real("inverse(mat4(X, Y, Z, vec4(1.0)))[3][0]", {2, 0, 0, 0, 0, 4, 0, 0, 0, 0, 8}, -0.5f),
          real("inverse(mat4(X, Y, Z, vec4(1.0)))[3][3]", {2, 0, 0, 0, 0, 4, 0, 0, 0, 0, 8}, 1),
          real("inverse(mat2(X))[0][0]", {0, 0, 0, 0}, kNaN),
          // A dynamic index is an unsigned number; beyond the last is the last.
          {"X[a]", 'f', {1, 2, 3, 4}, {2}, std::bit_cast<uint32_t>(3.0f)},
          {"X[a]", 'f', {1, 2, 3, 4}, {9}, std::bit_cast<uint32_t>(4.0f)},
          {"X[i]", 'f', {1, 2, 3, 4}, {0xFFFFFFFF}, std::bit_cast<uint32_t>(4.0f)},
          {"s.user[i].y", 'f', {1, 2, 3, 4, 5, 6}, {1}, std::bit_cast<uint32_t>(6.0f)},
          {"mat2(X)[i][j]", 'f', {1, 2, 3, 4}, {7, 0}, std::bit_cast<uint32_t>(3.0f)},
          {"vec3[3](X.xyz, Y.xyz, Z.xyz)[i].x", 'f', {1, 2, 3, 4, 5, 6, 7, 8, 9}, {5}, std::bit_cast<uint32_t>(9.0f)},
      });
}

void integers(Values& all) {
  add(all, {
               whole("i + j", {0x7FFFFFFF, 1}, int32_t(kMinus)),
               whole("i * j", {0x10001, 0x10001}, 0x20001),
               whole("-i", {kMinus}, kMinus),
               whole("abs(i)", {kMinus}, kMinus),
               whole("i / j", {7, uint32_t(-2)}, -3),
               whole("i / j", {7, 0}, 0),
               whole("i / j", {kMinus, 0xFFFFFFFF}, kMinus),
               whole("i % j", {7, 0}, 0),
               whole("i % j", {kMinus, 0xFFFFFFFF}, 0),
               whole("i % j", {7, 3}, 1),
               whole("i % j", {uint32_t(-7), 3}, 2),
               whole("i % j", {7, uint32_t(-3)}, -2),
               bits("a / b", {7, 0}, 0),
               bits("a / b", {0xFFFFFFFF, 2}, 0x7FFFFFFF),
               bits("a % b", {7, 0}, 0),
               bits("a % b", {0xFFFFFFFF, 10}, 5),
               whole("i << j", {1, 33}, 2),
               whole("i >> j", {kMinus, 31}, -1),
               bits("a >> b", {kMinus, 63}, 1),
               whole("i >> j", {uint32_t(-8), 0xFFFFFFFF}, -1),
               bits("a & b | c ^ ~a", {0xF0, 0x3C, 0xFF}, (0xF0u & 0x3Cu) | (0xFFu ^ ~0xF0u)),
               whole("sign(i)", {uint32_t(-9)}, -1),
               whole("sign(i)", {0}, 0),
               whole("min(i, j)", {uint32_t(-1), 1}, -1),
               bits("min(a, b)", {uint32_t(-1), 1}, 1),
               whole("max(i, j)", {uint32_t(-1), 1}, 1),
               bits("max(a, b)", {uint32_t(-1), 1}, uint32_t(-1)),
               whole("clamp(i, j, k)", {5, uint32_t(-3), 2}, 2),
               whole("clamp(i, j, k)", {5, 9, 2}, 2),
               bits("clamp(a, b, c)", {uint32_t(-1), 1, 7}, 7),
               whole("mix(i, j, k > 0)", {5, 9, 1}, 9),
               bits("bitfieldExtract(a, j, k)", {0xABCD1234, 8, 12}, 0xD12),
               whole("bitfieldExtract(i, j, k)", {0xABCD1234, 8, 12}, 0xD12 - 0x1000),
               whole("bitfieldExtract(i, j, k)", {0xABCD1234, 8, 0}, 0),
               bits("bitfieldExtract(a, j, k)", {0xABCD1234, 28, 30}, 0xA),
               bits("bitfieldExtract(a, j, k)", {0xABCD1234, uint32_t(-1), 4}, 0),
               bits("bitfieldExtract(a, j, k)", {0xABCD1234, 0, uint32_t(-1)}, 0xABCD1234),
               bits("bitfieldInsert(a, b, 4, k)", {0xFFFFFFFF, 0x5, 8}, 0xFFFFF05F),
               bits("bitfieldInsert(a, b, 28, k)", {0, 0xFF, 8}, 0xF0000000),
               bits("bitfieldInsert(a, b, 40, k)", {7, 0xFF, 8}, 7),
               bits("bitfieldInsert(a, b, 0, k)", {7, 0xFF, 32}, 0xFF),
               bits("bitfieldInsert(a, b, 3, k)", {7, 0xFF, 0}, 7),
               bits("bitfieldReverse(a)", {0x1}, kMinus),
               whole("bitCount(a)", {0xF0F0}, 8),
               whole("findLSB(a)", {0}, -1),
               whole("findLSB(i)", {0x50}, 4),
               whole("findMSB(a)", {0}, -1),
               whole("findMSB(a)", {kMinus}, 31),
               whole("findMSB(i)", {0}, -1),
               whole("findMSB(i)", {0xFFFFFFFF}, -1),
               whole("findMSB(i)", {kMinus}, 30),
               whole("findMSB(i)", {uint32_t(-3)}, 1),
               bits("sum_of(a, b)", {0xFFFFFFFF, 2}, 1),
               bits("carry_of(a, b)", {0xFFFFFFFF, 2}, 1),
               bits("carry_of(a, b)", {0xFFFFFFFE, 1}, 0),
               bits("difference_of(a, b)", {1, 2}, 0xFFFFFFFF),
               bits("borrow_of(a, b)", {1, 2}, 1),
               bits("borrow_of(a, b)", {2, 2}, 0),
               bits("high_of(a, b)", {0xFFFFFFFF, 0xFFFFFFFF}, 0xFFFFFFFE),
               bits("low_of(a, b)", {0xFFFFFFFF, 0xFFFFFFFF}, 1),
               whole("signed_high_of(i, j)", {0xFFFFFFFF, 5}, -1),
               whole("signed_low_of(i, j)", {0xFFFFFFFF, 5}, -5),
               whole("signed_high_of(i, j)", {kMinus, kMinus}, 0x40000000),
           });
}

void parts(Values& all) {
  add(all, {
               real("fraction_of(x)", {-2.75f}, -0.75f),
               real("whole_of(x)", {-2.75f}, -2),
               real("fraction_of(x)", {kInf}, kNaN),
               real("whole_of(x)", {kInf}, kInf),
               real("fraction_of(x)", {-0.0f}, 0),
               real("whole_of(x)", {-0.0f}, -0.0f),
               real("whole_of(x)", {-0.5f}, -0.0f),
               real("significand_of(x)", {8}, 0.5f),
               of_real("exponent_of(x)", 'i', {8}, 4),
               real("significand_of(x)", {-3}, -0.75f),
               of_real("exponent_of(x)", 'i', {kLeast}, -148),
               real("significand_of(x)", {kLeast}, 0.5f),
               real("significand_of(x)", {-kInf}, -kInf),
               of_real("exponent_of(x)", 'i', {-kInf}, 0),
               real("significand_of(x)", {kNaN}, kNaN),
               of_real("exponent_of(x)", 'i', {kNaN}, 0),
               real("significand_of(x)", {-0.0f}, -0.0f),
               real("ldexp(x, -149)", {1}, kLeast),
               real("ldexp(x, -150)", {1}, 0),
               real("ldexp(x, -150)", {1.5f}, kLeast),
               real("ldexp(x, 128)", {1}, kInf),
               real("ldexp(x, 300)", {kLeast}, kInf),
               real("ldexp(x, 1000)", {0x1p-149f}, kInf),
               real("ldexp(x, -2000000000)", {-kMost}, -0.0f),
               real("ldexp(x, 5)", {-0.0f}, -0.0f),
               real("ldexp(x, 276)", {kLeast}, 0x1p127f),
               of_real("packHalf2x16(X.xy)", 'u', {1, -2}, 0xC0003C00),
               of_real("packHalf2x16(X.xy)", 'u', {65519, 65520}, 0x7C007BFF),
               of_real("packHalf2x16(X.xy)", 'u', {0x1p-24f, 0x1p-25f}, 0x00000001),
               of_real("packHalf2x16(X.xy)", 'u', {0x1.8p-25f, -0.0f}, 0x80000001),
               of_real("packHalf2x16(X.xy)", 'u', {0x1.002p0f, 0x1.006p0f}, 0x3C023C00),
               of_real("packHalf2x16(X.xy)", 'u', {-kInf, 0x1.ffep-15f}, 0x0400FC00),
               of_real("packHalf2x16(X.xy)", 'u', {kNaN, kMost}, 0x7C007E00),
               real_of("unpackHalf2x16(a).x", {0x3C000001}, 0x1p-24f),
               real_of("unpackHalf2x16(a).y", {0xC2000000}, -3),
               real_of("unpackHalf2x16(a).x", {0x7C00}, kInf),
               real_of("unpackHalf2x16(a).x", {0x8000}, -0.0f),
               real_of("unpackHalf2x16(a).x", {0x7E00}, kNaN),
               real_of("unpackHalf2x16(a).x", {0x7BFF}, 65504),
               of_real("packUnorm4x8(X)", 'u', {0, 1, 0.5f, 2}, 0xFF80FF00),
               of_real("packUnorm4x8(X)", 'u', {kNaN, -1, 0x1.010102p-9f, kInf}, 0xFF000000),
               of_real("packSnorm4x8(X)", 'u', {-1, 1, -0.5f, -9}, 0x81C07F81),
               of_real("packSnorm4x8(X)", 'u', {kNaN, 0, 0, 0}, 0x81),
               of_real("packUnorm2x16(X.xy)", 'u', {0.5f, 1}, 0xFFFF8000),
               of_real("packSnorm2x16(X.xy)", 'u', {-1, 0.5f}, 0x40008001),
               real_of("unpackUnorm4x8(a).z", {0x00330000}, 0.2f),
               real_of("unpackSnorm4x8(a).x", {0x80}, -1),
               real_of("unpackSnorm4x8(a).y", {0x4000}, 64 / 127.0f),
               real_of("unpackUnorm2x16(a).y", {0x80000000}, 32768 / 65535.0f),
               real_of("unpackSnorm2x16(a).x", {0x8000}, -1),
               real_of("unpackSnorm2x16(a).y", {0xC0000000}, -16384 / 32767.0f),
           });
}

/// Values of real functions are their decimal digits, which C++ rounds to the nearest float.
void functions(Values& all) {
  add(all, {
               real("exp(x)", {1}, 2.718281828459045f),
               real("exp(x)", {-0.0f}, 1),
               real("exp(x)", {89}, kInf),
               real("exp(x)", {-104}, 0),
               real("exp(x)", {-kInf}, 0),
               real("exp(x)", {kInf}, kInf),
               real("exp(x)", {kNaN}, kNaN),
               real("exp2(x)", {-149}, kLeast),
               real("exp2(x)", {0.5f}, 1.414213562373095f),
               real("exp2(x)", {128}, kInf),
               real("exp2(x)", {-150}, 0),
               real("log(x)", {10}, 2.302585092994046f),
               real("log(x)", {1}, 0),
               real("log(x)", {0}, -kInf),
               real("log(x)", {-0.0f}, -kInf),
               real("log(x)", {-1}, kNaN),
               real("log(x)", {kInf}, kInf),
               real("log2(x)", {kLeast}, -149),
               real("log2(x)", {0x1p100f}, 100),
               real("log2(x)", {3}, 1.584962500721156f),
               real("log2(x)", {kNaN}, kNaN),
               real("log2(x)", {0x1.000002p0f}, 1.719826406118446e-07f),
               real("pow(x, y)", {2, 10}, 1024),
               real("pow(x, y)", {-2, 3}, -8),
               real("pow(x, y)", {-2, 2.5f}, kNaN),
               real("pow(x, y)", {-2, -1}, kNaN),
               real("pow(x, y)", {kNaN, 0}, 1),
               real("pow(x, y)", {kNaN, -0.0f}, 1),
               real("pow(x, y)", {2, kNaN}, kNaN),
               real("pow(x, y)", {0, 0.5f}, 0),
               real("pow(x, y)", {0, -0.5f}, kInf),
               real("pow(x, y)", {-0.0f, 3}, -0.0f),
               real("pow(x, y)", {1, kInf}, kNaN),
               real("pow(x, y)", {2, kInf}, kInf),
               real("pow(x, y)", {0.5f, kInf}, 0),
               real("pow(x, y)", {kInf, -1}, 0),
               real("pow(x, y)", {2, -2}, 0.25f),
               real("pow(x, y)", {2, 0.5f}, 1.414213562373095f),
               real("pow(x, y)", {-1, 8191}, -1),
               real("pow(x, y)", {-1, 8193}, kNaN),
               real("pow(x, y)", {1, 8193}, 1),
               real("pow(x, y)", {-kInf, 3}, -kInf),
               real("sin(x)", {1}, 0.8414709848078965f),
               real("sin(x)", {-0.0f}, -0.0f),
               real("sin(x)", {kLeast}, kLeast),
               real("sin(x)", {kPi}, -8.742277657347586e-8f),
               real("sin(x)", {1e6f}, -0.3499935021712930f),
               real("sin(x)", {1000001}, kNaN),
               real("sin(x)", {-kInf}, kNaN),
               real("cos(x)", {1}, 0.5403023058681398f),
               real("cos(x)", {-0.0f}, 1),
               real("cos(x)", {-2e6f}, kNaN),
               real("cos(x)", {1.5707964f}, -4.371138828673793e-8f),
               real("tan(x)", {1}, 1.557407724654902f),
               real("tan(x)", {-0.0f}, -0.0f),
               real("tan(x)", {1.5707964f}, -22877332.42885645f),
               real("tan(x)", {kNaN}, kNaN),
               real("asin(x)", {1}, 1.570796326794897f),
               real("asin(x)", {-1}, -1.570796326794897f),
               real("asin(x)", {0.5f}, 0.5235987755982989f),
               real("asin(x)", {-0.0f}, -0.0f),
               real("asin(x)", {0x1.000002p0f}, kNaN),
               real("acos(x)", {1}, 0),
               real("acos(x)", {-1}, 3.141592653589793f),
               real("acos(x)", {0}, 1.570796326794897f),
               real("acos(x)", {-0.0f}, 1.570796326794897f),
               real("acos(x)", {0.5f}, 1.047197551196598f),
               real("acos(x)", {-0.5f}, 2.094395102393195f),
               real("acos(x)", {kInf}, kNaN),
               real("atan(x)", {1}, 0.7853981633974483f),
               real("atan(x)", {-kInf}, -1.570796326794897f),
               real("atan(x)", {-0.0f}, -0.0f),
               real("atan(x)", {3}, 1.249045772398254f),
               real("atan(x)", {kNaN}, kNaN),
               real("atan(x, y)", {0, 0}, 0),
               real("atan(x, y)", {-0.0f, 0}, -0.0f),
               real("atan(x, y)", {0, -0.0f}, 3.141592653589793f),
               real("atan(x, y)", {-0.0f, -0.0f}, -3.141592653589793f),
               real("atan(x, y)", {-0.0f, -1}, -3.141592653589793f),
               real("atan(x, y)", {1, 0}, 1.570796326794897f),
               real("atan(x, y)", {-1, -0.0f}, -1.570796326794897f),
               real("atan(x, y)", {kInf, -kInf}, 2.356194490192345f),
               real("atan(x, y)", {-kInf, kInf}, -0.7853981633974483f),
               real("atan(x, y)", {1, -kInf}, 3.141592653589793f),
               real("atan(x, y)", {-1, kInf}, -0.0f),
               real("atan(x, y)", {1, kNaN}, kNaN),
               real("atan(x, y)", {1, -1}, 2.356194490192345f),
               real("atan(x, y)", {kLeast, kMost}, 0),
               real("sinh(x)", {1}, 1.175201193643801f),
               real("sinh(x)", {-0.0f}, -0.0f),
               real("sinh(x)", {-100}, -kInf),
               real("sinh(x)", {0.001f}, 0.001000000214074659f),
               real("cosh(x)", {1}, 1.543080634815244f),
               real("cosh(x)", {-kInf}, kInf),
               real("tanh(x)", {1}, 0.7615941559557649f),
               real("tanh(x)", {-30}, -1),
               real("tanh(x)", {kInf}, 1),
               real("tanh(x)", {-0.0f}, -0.0f),
               real("tanh(x)", {kNaN}, kNaN),
               real("asinh(x)", {1}, 0.881373587019543f),
               real("asinh(x)", {-kInf}, -kInf),
               real("asinh(x)", {-0.0f}, -0.0f),
               real("acosh(x)", {2}, 1.316957896924817f),
               real("acosh(x)", {1}, 0),
               real("acosh(x)", {0.5f}, kNaN),
               real("acosh(x)", {kInf}, kInf),
               real("atanh(x)", {0.5f}, 0.5493061443340548f),
               real("atanh(x)", {-1}, -kInf),
               real("atanh(x)", {-0.0f}, -0.0f),
               real("atanh(x)", {1.5f}, kNaN),
           });
}

}  // namespace

std::span<const KnownValue> known_values() {
  static const Values all = [] {
    Values made;
    one_rounding(made), conversions(made), comparisons(made), vectors(made), integers(made), parts(made),
        functions(made);
    return made;
  }();
  return all;
}

std::string program_of(const KnownValue& value) {
  std::string text = R"(float fraction_of(float x) { float whole; return modf(x, whole); }
float whole_of(float x) { float whole; modf(x, whole); return whole; }
float significand_of(float x) { int e; return frexp(x, e); }
int exponent_of(float x) { int e; frexp(x, e); return e; }
uint sum_of(uint a, uint b) { uint carry; return uaddCarry(a, b, carry); }
uint carry_of(uint a, uint b) { uint carry; uaddCarry(a, b, carry); return carry; }
uint difference_of(uint a, uint b) { uint borrow; return usubBorrow(a, b, borrow); }
uint borrow_of(uint a, uint b) { uint borrow; usubBorrow(a, b, borrow); return borrow; }
uint high_of(uint a, uint b) { uint high, low; umulExtended(a, b, high, low); return high; }
uint low_of(uint a, uint b) { uint high, low; umulExtended(a, b, high, low); return low; }
int signed_high_of(int a, int b) { int high, low; imulExtended(a, b, high, low); return high; }
int signed_low_of(int a, int b) { int high, low; imulExtended(a, b, high, low); return low; }
vec3 light(Surface s, Light l, View v) {
  vec4 X = s.user[0], Y = s.user[1], Z = s.user[2];
  float x = X.x, y = X.y, z = X.z, w = X.w;
  uint a = s.object, b = s.material, c = s.pixel_x, d = s.pixel_y;
  int i = int(a), j = int(b), k = int(c);
)";
  if (value.type == 'f') return text + "  return vec3(" + value.expression + ", 0.0, 0.0);\n}\n";
  return text + "  uint u = uint(" + value.expression +
         ");\n  return vec3(0.0, float(u >> 16), float(u & 0xFFFFu));\n}\n";
}

}  // namespace trueshade::testing
