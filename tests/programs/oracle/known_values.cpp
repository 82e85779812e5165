#include "tests/programs/oracle/known_values.h"

#include "tests/programs/oracle/known_value_rows.h"

namespace trueshade::testing {

namespace {

using namespace known;

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
               of_real("int(x)", 'i', {0x1p31f}, 0x7FFFFFFF),
               of_real("int(x)", 'i', {-0x1p31f}, kMinus),
               of_real("uint(x)", 'u', {0x1p32f}, 0xFFFFFFFF),
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

}  // namespace

std::span<const KnownValue> known_values() {
  static const Values all = [] {
    Values made;
    one_rounding(made), conversions(made), comparisons(made), vectors(made), add_integers(made), add_parts(made),
        add_functions(made);
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
