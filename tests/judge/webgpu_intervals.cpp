// What the profile `webgpu` lets a single operation compute, against the acceptance intervals of the WebGPU CTS
// (gpuweb/cts, src/unittests/floating_point.spec.ts: inputs and bounds) and against WGSL's "Floating Point Accuracy"
// written down again in long double.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "judge/bounds/interval.h"
#include "judge/bounds/profile.h"
#include "programs/values/op.h"
#include "scenes/builtin/pcg32.h"
#include "tests/catch.hpp"

using namespace trueshade;
using namespace trueshade::oracle;
using programs::Op;

namespace {

constexpr double kAny = HUGE_VAL;
constexpr double kMost = 0x1.fffffep127, kLeast = 0x1p-126, kSubMost = 0x1.fffffcp-127, kSubLeast = 0x1p-149;
/// Ours stays on its side of zero, and is zero where all of it is; the suite goes beyond by ulps of 2^-126.
constexpr double kBeyondZero = 4097 * kLeast;

double f(uint32_t bits) { return double(std::bit_cast<float>(bits)); }
double d(uint64_t bits) { return std::bit_cast<double>(bits); }
const double kPi = f(0x40490fdb), kPi34 = f(0x4016cbe4), kPi3 = f(0x3f860a92), kPi4 = f(0x3f490fdb),
             kPi6 = f(0x3f060a92), kE = f(0x402df854);

/// The suite's ulp of a float: the nearer neighbour's distance, what is below 2^-126 flushed.
double ulp(double x) {
  const auto y = float(std::fabs(x));
  if (y < float(kLeast)) return kLeast;
  return double(y) - double(std::nextafterf(y, 0.0f));
}
double plus(double x, double n) { return x + n * ulp(x); }

/// A number that may be no float: either of its neighbours.
Interval given(double x) {
  const auto y = float(x);
  Interval out = Interval::of(double(y));
  if (double(y) > x) out.low = double(std::nextafterf(y, -HUGE_VALF));
  if (double(y) < x) out.high = double(std::nextafterf(y, HUGE_VALF));
  return out;
}

const IntervalArithmetic& webgpu() {
  static const IntervalArithmetic of(profile_named("webgpu")->arithmetic);
  return of;
}
Interval made(Op op, const Interval& x, const Interval& y = {}, const Interval& z = {}) {
  programs::ProgramNode node;
  node.op = op, node.type = programs::info(op).result;
  return webgpu()(node, x, y, z);
}
const Interval kOne = Interval::of(1), kZero = Interval::of(0);
Interval clamped(const Interval& x, const Interval& low, const Interval& high) {
  return made(Op::f_min, made(Op::f_max, x, low), high);
}

/// WGSL's functions as docs/light_programs.md composes them.
const std::map<std::string, Interval (*)(const Interval&, const Interval&, const Interval&)> kFunctions{
    {"fract",
     [](const Interval& x, const Interval&, const Interval&) { return made(Op::f_sub, x, made(Op::f_floor, x)); }},
    {"length",
     [](const Interval& x, const Interval&, const Interval&) { return made(Op::f_sqrt, made(Op::f_mul, x, x)); }},
    {"saturate", [](const Interval& x, const Interval&, const Interval&) { return clamped(x, kZero, kOne); }},
    {"sign",
     [](const Interval& x, const Interval&, const Interval&) {
       const Interval below = made(Op::select, made(Op::f_lt, x, kZero), Interval::of(-1), kZero);
       return made(Op::select, made(Op::f_lt, kZero, x), kOne, below);
     }},
    {"%",
     [](const Interval& x, const Interval& y, const Interval&) {
       return made(Op::f_sub, x, made(Op::f_mul, y, made(Op::f_trunc, made(Op::f_div, x, y))));
     }},
    {"step", [](const Interval& x, const Interval& y,
                const Interval&) { return made(Op::select, made(Op::f_lt, y, x), kZero, kOne); }},
    {"clamp", [](const Interval& x, const Interval& y, const Interval& z) { return clamped(x, y, z); }},
    {"mix",
     [](const Interval& x, const Interval& y, const Interval& z) {
       return made(Op::f_add, made(Op::f_mul, x, made(Op::f_sub, kOne, z)), made(Op::f_mul, y, z));
     }},
    {"smoothstep",
     [](const Interval& x, const Interval& y, const Interval& z) {
       const Interval t = clamped(made(Op::f_div, made(Op::f_sub, z, x), made(Op::f_sub, y, x)), kZero, kOne);
       return made(Op::f_mul, made(Op::f_mul, t, t),
                   made(Op::f_sub, Interval::of(3), made(Op::f_mul, Interval::of(2), t)));
     }},
};

Op op_named(const std::string& name) {
  for (int i = 0; i < programs::kOpCount; ++i)
    if (programs::info(Op(i)).name == name) return Op(i);
  FAIL("no operation " << name);
  return Op::constant;
}

Interval made(const std::string& name, const Interval& x, const Interval& y, const Interval& z) {
  const auto found = kFunctions.find(name);
  return found != kFunctions.end() ? found->second(x, y, z) : made(op_named(name), x, y, z);
}

struct Bounds {
  double low, high;
};
const Bounds kAnything{-kAny, kAny};
Bounds only(double x) { return {x, x}; }
Bounds off(double low, double high, double ulps) { return {low - ulps * ulp(low), high + ulps * ulp(high)}; }

struct Row {
  const char* name;
  std::vector<double> input;
  Bounds expected;
};

/// Numbers alone: which inputs the suite tries, and between which bounds it accepts their results.
std::vector<Row> rows() {
  const Bounds any = kAnything;
  const double tenth = f(0x3dcccccd), less = plus(tenth, -1), hundredth = f(0x3c23d70a), root3 = f(0x3fddb3d7);
  std::vector<Row> all;
  const auto add = [&](const char* name, std::vector<Row> of) {
    for (Row& row : of) row.name = name, all.push_back(row);
  };
  const auto r1 = [](double x, Bounds b) { return Row{"", {x}, b}; };
  const auto r2 = [](double x, double y, Bounds b) { return Row{"", {x, y}, b}; };
  const auto r3 = [](double x, double y, double z, Bounds b) { return Row{"", {x, y, z}, b}; };
  for (const char* name : {"acos", "asin", "acosh", "asinh", "atanh", "cos", "sin", "tan", "cosh", "sinh", "tanh"})
    for (const double x : {-kAny, kAny, kMost, -kMost}) add(name, {r1(x, any)});
  add("acos",
      {r1(-1, any), r1(-0.5, {f(0x4005fa91), f(0x40061a94)}), r1(0, any), r1(1, any),
       r1(0.5, {f(0x3f85fa8f), f(0x3f861a94)}), r1(1 - 0x1p-24, {d(0x3f2ffdff60000000), d(0x3f3b106fc9334fb9)})});
  add("acosh", {r1(-1, any), r1(0, any), r1(1, any), r1(1.1, {d(0x3fdc636820000000), d(0x3fdc636f80000000)}),
                r1(1.1, {d(0x3fdc636880000000), d(0x3fdc636f20000000)}),
                r1(10, {d(0x4007f21e40000000), d(0x4007f21f60000000)})});
  add("asin", {r1(-1, any), r1(0, any), r1(1, any), r1(-kLeast, {-6.77e-5, 6.77e-5}), r1(kLeast, {-6.77e-5, 6.77e-5}),
               r1(-0.5, {d(0xbfe0c352c0000000), d(0xbfe0bf51c0000000)}),
               r1(0.5, {d(0x3fe0bf51c0000000), d(0x3fe0c352c0000000)})});
  add("asinh",
      {r1(-1, {d(0xbfec343a80000000), d(0xbfec343280000000)}), r1(0, {d(0xbeaa000020000000), d(0x3eb1ffffd0000000)}),
       r1(1, {d(0x3fec343540000000), d(0x3fec343780000000)})});
  add("atan", {r1(-kAny, any), r1(kAny, any), r1(0, off(0, 0, 4096)), r1(-root3, off(-kPi3, plus(-kPi3, 1), 4096)),
               r1(-1, off(-kPi4, plus(-kPi4, 1), 4096)), r1(f(0xbf13cd3a), off(-kPi6, plus(-kPi6, 1), 4096)),
               r1(f(0x3f13cd3a), off(plus(kPi6, -1), kPi6, 4096)), r1(1, off(plus(kPi4, -1), kPi4, 4096)),
               r1(root3, off(plus(kPi3, -1), kPi3, 4096))});
  add("atanh",
      {r1(-1, any), r1(1, any), r1(-0.1, {d(0xbfb9af9a60000000), d(0xbfb9af8cc0000000)}),
       r1(0, {d(0xbe96000020000000), d(0x3e98000000000000)}), r1(0.1, {d(0x3fb9af8b80000000), d(0x3fb9af9b00000000)})});
  for (const auto& [x, floor, ceil, trunc, round] :
       std::vector<std::array<double, 5>>{{0, 0, 0, 0, 0},
                                          {0.1, 0, 1, 0, 0},
                                          {0.9, 0, 1, 0, 1},
                                          {1, 1, 1, 1, 1},
                                          {1.1, 1, 2, 1, 1},
                                          {1.9, 1, 2, 1, 2},
                                          {-0.1, -1, 0, 0, 0},
                                          {-0.9, -1, 0, 0, -1},
                                          {-1, -1, -1, -1, -1},
                                          {-1.1, -2, -1, -1, -1},
                                          {-1.9, -2, -1, -1, -2},
                                          {kMost, kMost, kMost, kMost, kMost},
                                          {-kMost, -kMost, -kMost, -kMost, -kMost},
                                          {kLeast, 0, 1, 0, 0},
                                          {-kLeast, -1, 0, 0, 0},
                                          {0x1p30, 0x1p30, 0x1p30, 0x1p30, 0x1p30},
                                          {-0x1p30, -0x1p30, -0x1p30, -0x1p30, -0x1p30}}) {
    add("floor", {r1(x, only(floor))}), add("ceil", {r1(x, only(ceil))});
    add("trunc", {r1(x, only(trunc))}), add("round_even", {r1(x, only(round))});
  }
  for (const double x : {kAny, -kAny}) {
    for (const char* name : {"floor", "ceil", "trunc", "round_even", "neg", "sqrt", "length", "fract", "saturate"})
      add(name, {r1(x, any)});
    for (const char* name : {"add", "sub", "mul", "max", "min", "div"})
      for (const double y : {0.0, 1.0, -1.0, kAny, -kAny}) add(name, {r2(x, y, any), r2(y, x, any)});
  }
  for (const double x : {kSubMost, kSubLeast}) {
    add("floor", {r1(x, only(0)), r1(-x, {-1, 0})}), add("ceil", {r1(x, {0, 1}), r1(-x, only(0))});
    add("trunc", {r1(x, only(0)), r1(-x, only(0))}), add("round_even", {r1(x, only(0)), r1(-x, only(0))});
    add("neg", {r1(x, {-x, 0}), r1(-x, {0, x})}), add("sign", {r1(x, {0, 1}), r1(-x, {-1, 0})});
    add("saturate", {r1(x, {0, x}), r1(-x, {-x, 0})}), add("length", {r1(x, any), r1(-x, any)});
    for (const char* name : {"add", "max", "min"})
      add(name, {r2(x, 0, {0, x}), r2(0, x, {0, x}), r2(-x, 0, {-x, 0}), r2(0, -x, {-x, 0})});
    add("sub", {r2(x, 0, {0, x}), r2(0, x, {-x, 0}), r2(-x, 0, {-x, 0}), r2(0, -x, {0, x})});
    add("step", {r2(0, x, only(1)), r2(0, -x, {0, 1}), r2(1, x, only(0)), r2(1, -x, only(0)), r2(-1, x, only(1)),
                 r2(-1, -x, only(1)), r2(x, 0, {0, 1}), r2(-x, 0, only(1)), r2(x, 1, only(1)), r2(-x, 1, only(1)),
                 r2(x, -1, only(0)), r2(-x, -1, only(0))});
  }
  add("step", {r2(-kSubMost, kSubMost, only(1)), r2(kSubMost, -kSubMost, {0, 1}), r2(0, 0, only(1)), r2(1, 1, only(1)),
               r2(0, 1, only(1)), r2(1, 0, only(0)), r2(-1, -1, only(1)), r2(0, -1, only(0)), r2(0.1, 0.1, {0, 1}),
               r2(0, 0.1, only(1)), r2(0.1, 0, only(0)), r2(-0.1, -0.1, {0, 1}), r2(-1, -0.1, only(1))});
  add("max", {r2(1, kSubMost, only(1)), r2(-kSubMost, kSubMost, {-kSubMost, kSubMost})});
  add("min", {r2(-1, kSubMost, only(-1)), r2(-kSubMost, kSubMost, {-kSubMost, kSubMost})});
  add("cos", {r1(-kPi, {-1 - 0x1p-11, plus(-1, 1) + 0x1p-11}), r1(-kPi3, {plus(0.5, -1) - 0x1p-11, 0.5 + 0x1p-11}),
              r1(0, {1 - 0x1p-11, 1 + 0x1p-11}), r1(kPi3, {plus(0.5, -1) - 0x1p-11, 0.5 + 0x1p-11}),
              r1(kPi, {-1 - 0x1p-11, plus(-1, 1) + 0x1p-11})});
  add("sin", {r1(-kPi / 2, {-1 - 0x1p-11, plus(-1, 1) + 0x1p-11}), r1(0, {-0x1p-11, 0x1p-11}),
              r1(kPi / 2, {plus(1, -1) - 0x1p-11, 1 + 0x1p-11})});
  add("tan",
      {r1(-kPi, {d(0xbf4002bc90000000), d(0x3f400144f0000000)}), r1(-kPi / 2, any), r1(kPi / 2, any),
       r1(0, {d(0xbf400200b0000000), d(0x3f400200b0000000)}), r1(kPi, {d(0xbf400144f0000000), d(0x3f4002bc90000000)})});
  for (const double x : {1.0, -1.0}) add("cosh", {r1(x, {f(0x3fc583a4), f(0x3fc583b1)})});
  add("cosh", {r1(0, {f(0x3f7ffffd), f(0x3f800002)})});
  add("sinh", {r1(-1, {f(0xbf966d05), f(0xbf966cf8)}), r1(0, {f(0xb4600000), f(0x34600000)}),
               r1(1, {f(0x3f966cf8), f(0x3f966d05)})});
  add("tanh",
      {r1(-1, {d(0xbfe85efd10000000), d(0xbfe85ef890000000)}), r1(0, {d(0xbe8c0000b0000000), d(0x3e8c0000b0000000)}),
       r1(1, {d(0x3fe85ef890000000), d(0x3fe85efd10000000)})});
  add("exp", {r1(-kAny, any), r1(0, off(1, 1, 3)), r1(1, off(kE, plus(kE, 1), 5)), r1(89, any)});
  add("exp2", {r1(-kAny, any), r1(0, off(1, 1, 3)), r1(1, off(2, 2, 5)), r1(128, any)});
  add("fract",
      {r1(0, only(0)), r1(0.1, {less, tenth}), r1(0.9, {f(0x3f666666), plus(f(0x3f666666), 1)}), r1(1, only(0)),
       r1(1.1, {d(0x3fb9999800000000), d(0x3fb9999a00000000)}), r1(-0.1, {f(0x3f666666), plus(f(0x3f666666), 1)}),
       r1(-0.9, {d(0x3fb9999900000000), d(0x3fb9999a00000000)}), r1(-1, only(0)),
       r1(-1.1, {d(0x3fecccccc0000000), d(0x3feccccd00000000)}), r1(kMost, only(0)), r1(kLeast, only(kLeast)),
       r1(-kMost, only(0)), r1(-kLeast, {1 - 0x1p-24, 1})});
  add("inversesqrt", {r1(-1, any), r1(0, any), r1(kAny, any), r1(0.04, off(plus(5, -1), plus(5, 1), 2)),
                      r1(1, off(1, 1, 2)), r1(100, off(less, tenth, 2)), r1(kMost, off(0x1p-64, plus(0x1p-64, 2), 2))});
  add("length",
      {r1(0, any), r1(0.1, {d(0x3fb9999890000000), d(0x3fb9999a70000000)}),
       r1(1, {d(0x3fefffff70000000), d(0x3ff0000090000000)}), r1(10, {d(0x4023ffff70000000), d(0x40240000b0000000)}),
       r1(kLeast, any), r1(kMost, any), r1(-kMost, any)});
  add("sqrt",
      {r1(-1, any), r1(0, any), r1(0.01, {d(0x3fb99998b0000000), d(0x3fb9999a70000000)}),
       r1(1, {d(0x3fefffff70000000), d(0x3ff0000090000000)}), r1(4, {d(0x3fffffff70000000), d(0x4000000090000000)}),
       r1(100, {d(0x4023ffff70000000), d(0x40240000b0000000)})});
  add("log", {r1(-1, any), r1(0, any), r1(1, {-0x1p-21, 0x1p-21}), r1(kE, off(plus(1, -1), 1, 3)),
              r1(kMost, off(plus(f(0x42b17218), -1), f(0x42b17218), 3))});
  add("log2", {r1(-1, any), r1(0, any), r1(1, {-0x1p-21, 0x1p-21}), r1(2, {1 - 0x1p-21, 1 + 0x1p-21}),
               r1(kMost, off(plus(128, -1), 128, 3))});
  add("neg",
      {r1(0, only(0)), r1(0.1, {-tenth, -less}), r1(1, only(-1)), r1(kMost, only(-kMost)), r1(kLeast, only(-kLeast))});
  add("saturate", {r1(0, only(0)), r1(1, only(1)), r1(-10, only(0)), r1(0.1, {less, tenth}), r1(11.1, only(1)),
                   r1(kMost, only(1))});
  add("sign", {r1(-kMost, only(-1)), r1(-0.1, only(-1)), r1(-kLeast, only(-1)), r1(0, only(0)), r1(kLeast, only(1)),
               r1(10, only(1))});
  add("add", {r2(0, 0, only(0)), r2(1, -1, only(0)), r2(-1, -1, only(-2)), r2(0.1, 0, {less, tenth}),
              r2(0, -0.1, {-tenth, -less}), r2(0.1, 0.1, {plus(f(0x3e4ccccd), -1), f(0x3e4ccccd)}),
              r2(0.1, -0.1, {less - tenth, tenth - less})});
  add("sub", {r2(0, 0, only(0)), r2(1, -1, only(2)), r2(0.1, 0, {less, tenth}),
              r2(0.1, 0.1, {less - tenth, tenth - less}), r2(0.1, -0.1, {plus(f(0x3e4ccccd), -1), f(0x3e4ccccd)})});
  add("mul", {r2(0, -1, only(0)), r2(-2, -2, only(4)), r2(0.1, 0, only(0)),
              r2(0.1, 0.1, {plus(hundredth, -2), plus(hundredth, 1)}),
              r2(-0.1, 0.1, {plus(-hundredth, 1) - 2 * ulp(hundredth), plus(-hundredth, 2)}), r2(kMost, kMost, any),
              r2(kMost, -kMost, any)});
  add("atan2",
      {r2(1, root3, {plus(kPi6, -4097), plus(kPi6, 4096)}), r2(1, 1, {plus(kPi4, -4097), plus(kPi4, 4096)}),
       r2(root3, 1, {d(0x3ff0bf5220000000), d(0x3ff0c35240000000)}), r2(1, -1, {plus(kPi34, -4096), plus(kPi34, 4097)}),
       r2(-1, -1, {plus(-kPi34, -4097), plus(-kPi34, 4096)}), r2(-1, 1, {plus(-kPi4, -4096), plus(-kPi4, 4097)}),
       r2(kAny, 1, any), r2(-kAny, -1, any), r2(-kLeast, -1, {plus(-kPi, -4096), plus(-kPi, 4096)}),
       r2(kLeast, -1, {plus(kPi, -4096), plus(kPi, 4096)}), r2(kSubMost, 1, any), r2(-kSubMost, 1, any),
       r2(1, kMost, any), r2(1, -kMost, any)});
  for (const double x : {0.0, kSubMost, -kSubMost, kLeast, -kLeast, kMost, -kMost, kAny, -kAny, 1.0})
    add("atan2", {r2(0, x, any)});
  for (const double x : {1.0, -1.0})
    for (const double y : {1.0, -1.0}) {
      const double ten = x * y * 10;
      add("div",
          {r2(0, y, off(0, 0, 2.5)), r2(x, y, off(x * y, x * y, 2.5)), r2(4 * x, 2 * y, off(2 * x * y, 2 * x * y, 2.5)),
           r2(0, 0.1 * y, off(0, 0, 2.5)), r2(x, 0.1 * y, off(plus(ten, -1), plus(ten, 1), 2.5))});
    }
  for (const char* name : {"div", "%"})
    for (const double y : {kMost, -kMost, 0.0, kSubMost}) add(name, {r2(1, y, any)});
  add("ldexp",
      {r2(0, 1, only(0)), r2(1, 1, only(2)), r2(-1, -1, only(-0.5)), r2(1.0000000001, 1, {2, plus(2, 2)}),
       r2(1.9999998807907104, 127, only(kMost)), r2(1, -126, only(kLeast)), r2(0.9999998807907104, -126, {0, kSubMost}),
       r2(1.1920928955078125e-07, -126, {0, kSubLeast}), r2(-0.9999998807907104, -126, {-kSubMost, 0}), r2(1, 128, any),
       r2(-1, 128, any), r2(100, 126, any), r2(kMost, 2147483647, any)});
  add("max", {r2(1, 0, only(1)), r2(0, -1, only(0)), r2(-1, -1, only(-1)), r2(0.1, 0, {less, tenth}),
              r2(-0.1, 0, only(0)), r2(-0.1, -0.1, {-tenth, -less})});
  add("min", {r2(1, 0, only(0)), r2(0, -1, only(-1)), r2(-0.1, 0, {-tenth, -less}), r2(0.1, 0, only(0)),
              r2(0.1, 0.1, {less, tenth})});
  const Bounds to_0{1 - 3 * 0x1p-24, d(0x3ff0000030000000)};
  add("pow", {r2(-1, 0, any), r2(0, 0, any), r2(1, 0, to_0), r2(2, 0, to_0), r2(kMost, 0, to_0), r2(0, 1, any),
              r2(1, 1, {d(0x3feffffedffffe00), d(0x3ff00000c0000200)}),
              r2(1, 100, {d(0x3fefffba3fff3800), d(0x3ff000232000c800)}), r2(1, kMost, any),
              r2(2, 1, {d(0x3ffffffea0000200), d(0x4000000100000200)}),
              r2(2, 2, {d(0x400ffffda0000400), d(0x40100001a0000400)}),
              r2(10, 10, {d(0x4202a04f51f77000), d(0x4202a070ee08e000)}),
              r2(10, 1, {d(0x4023fffe0b658b00), d(0x40240002149a7c00)}), r2(kMost, 1, any)});
  add("%", {r2(0, 1, only(0)), r2(1, 1, {0, 1}), r2(-1, 1, {-1, 0}), r2(4, -2, {0, 2}), r2(-4, 2, {-2, 0}),
            r2(2, 4, only(2)), r2(-2, -4, only(-2)), r2(0, 0.1, only(0)), r2(1, 0.1, {f(0xb4000000), f(0x3dccccd8)}),
            r2(-1, -0.1, {f(0xbdccccd8), f(0x34000000)})});
  add("clamp", {r3(0, 0, 1, only(0)), r3(1, 0, 0, only(0)), r3(1, 1, 0, only(0)), r3(1, 10, 100, only(10)),
                r3(100, 1, 10, only(10)), r3(-10, 1, -100, only(-100)), r3(kSubMost, 0, 0, {0, kSubMost}),
                r3(0, 0, kSubMost, {0, kSubMost}), r3(kSubMost, kSubLeast, -kSubLeast, {-kSubLeast, kSubMost}),
                r3(kMost, kMost, kSubLeast, {0, kSubLeast}), r3(0, 1, kAny, any), r3(0, kAny, kAny, any),
                r3(-kAny, kAny, -kAny, any)});
  add("fma",
      {r3(1, 0, 0, only(0)), r3(1, 1, 1, only(2)), r3(10, 1, -100, only(-90)), r3(-10, -10, -10, only(90)),
       r3(kSubMost, 0, 0, only(0)), r3(0, 0, kSubMost, {0, kSubMost}), r3(kSubMost, kSubMost, 0, {0, kSubLeast}),
       r3(kSubMost, kSubMost, kSubMost, {0, kLeast}), r3(kSubMost, kSubLeast, -kSubLeast, {-kSubLeast, kSubLeast}),
       r3(kSubMost, -kSubMost, -kSubLeast, {f(0x80000002), 0}), r3(0, 1, kAny, any), r3(0, kAny, kAny, any),
       r3(kMost, kMost, kSubLeast, any)});
  const auto mix = [&](double x, double y, double z, Bounds b) { add("mix", {r3(x, y, z, b)}); };
  mix(0, 1, -1, only(-1)), mix(0, 1, 0, only(0)), mix(0, 1, 0.1, {d(0x3fb9999980000000), d(0x3fb99999a0000000)}),
      mix(0, 1, 2, only(2));
  mix(1, 0, 0.1, {d(0x3fecccccc0000000), d(0x3fecccccd0000000 + 0x10000000)}),
      mix(1, 0, 0.9, {d(0x3fb9999900000000), d(0x3fb9999a00000000)});
  mix(0, 10, 0.1, {d(0x3fefffffe0000000), d(0x3ff0000020000000)}),
      mix(0, 10, 0.9, {d(0x4021ffffe0000000), d(0x4022000020000000)}), mix(1, 0, 2, only(-1));
  mix(0, kAny, 0.5, any), mix(kAny, 0, 0.5, any), mix(0, 1, kAny, any);
  return all;
}

/// How many times the suite's width ours has at most, by operation, as measured; what has no row is as wide as the
/// suite's. Ulps are parts of 2^-23 here, up to two of the suite's. The 1e-5 of tanh came into WGSL after these rows.
const std::map<std::string, double> kWider{
    {"acos", 1.05},  {"acosh", 1.74}, {"asin", 1.05},   {"asinh", 1.8},       {"atan", 1.58}, {"atan2", 1.58},
    {"atanh", 1.34}, {"cos", 1.001},  {"sin", 1.001},   {"tan", 1.001},       {"cosh", 2.29}, {"sinh", 2.29},
    {"tanh", 48},    {"div", 2.81},   {"exp", 2.67},    {"exp2", 2.67},       {"pow", 2.67},  {"log", 2.29},
    {"log2", 2.29},  {"sqrt", 1.96},  {"length", 1.96}, {"inversesqrt", 3.01}};
/// The same of the rules below, which measure from the real result and take floats alone.
const std::map<std::string, double> kWiderThanRule{
    {"div", 3.5},  {"sqrt", 3},    {"inversesqrt", 4.001}, {"length", 3.1}, {"exp", 3.3},   {"exp2", 3.3},
    {"log", 3.2},  {"log2", 3.2},  {"pow", 4.001},         {"tan", 1.001},  {"sin", 1.001}, {"cos", 1.001},
    {"atan", 2},   {"atan2", 2},   {"asin", 1.9},          {"acos", 1.9},   {"sinh", 3.3},  {"cosh", 3.3},
    {"tanh", 1.6}, {"asinh", 3.3}, {"acosh", 3.4},         {"atanh", 2.9},  {"%", 13},      {"smoothstep", 3.3}};

double factor_of(const std::map<std::string, double>& factors, const std::string& name) {
  const auto found = factors.find(name);
  return found == factors.end() ? 1 : found->second;
}

// WGSL's accuracy again, of ranges of floats.
using Real = long double;

/// Results that are accepted: floats from low to high; open: any value.
struct AcceptedRange {
  Real low, high;
  bool open = false;
};

Real down(Real x) {
  const auto y = float(x);
  return Real(y) > x ? std::nextafterf(y, -HUGE_VALF) : y;
}
Real up(Real x) { return -down(-x); }
Real spec_ulp(Real x) {
  const Real a = down(x), b = up(x);
  if (a != b) return b - a;
  const auto y = float(x);
  return std::min(x - Real(std::nextafterf(y, -HUGE_VALF)), Real(std::nextafterf(y, HUGE_VALF)) - x);
}
AcceptedRange settled(AcceptedRange r) {
  if (!(r.low >= -Real(kMost) && r.high <= Real(kMost))) r.open = true;
  if (r.low > 0 && r.low < Real(kLeast)) r.low = 0;
  if (r.high < 0 && r.high > -Real(kLeast)) r.high = 0;
  return r;
}
AcceptedRange exactly(Real x) { return {x, x}; }
AcceptedRange rounded(Real low, Real high, bool open) { return settled({down(low), up(high), open}); }
AcceptedRange about(Real low, Real high, Real low_off, Real high_off, bool open) {
  if (!(std::fabs(low) < 1e39L && std::fabs(high) < 1e39L)) return {0, 0, true};
  return settled({up(low - low_off), down(high + high_off), open});
}
AcceptedRange within_ulps(Real low, Real high, Real low_ulps, Real high_ulps, bool open) {
  if (!(std::fabs(low) < 1e39L && std::fabs(high) < 1e39L)) return {0, 0, true};
  return about(low, high, low_ulps * spec_ulp(low), high_ulps * spec_ulp(high), open);
}
template <class F>
std::pair<Real, Real> corners(const AcceptedRange& x, const AcceptedRange& y, F f) {
  const Real all[] = {f(x.low, y.low), f(x.low, y.high), f(x.high, y.low), f(x.high, y.high)};
  return {*std::min_element(all, all + 4), *std::max_element(all, all + 4)};
}
AcceptedRange negated(const AcceptedRange& x) { return {-x.high, -x.low, x.open}; }
AcceptedRange plus(const AcceptedRange& x, const AcceptedRange& y) {
  return rounded(x.low + y.low, x.high + y.high, x.open || y.open);
}
AcceptedRange minus(const AcceptedRange& x, const AcceptedRange& y) { return plus(x, negated(y)); }
AcceptedRange times(const AcceptedRange& x, const AcceptedRange& y) {
  const auto [low, high] = corners(x, y, [](Real a, Real b) { return a * b; });
  return rounded(low, high, x.open || y.open);
}
bool divides(const AcceptedRange& y) {
  const Real least = std::min(std::fabs(y.low), std::fabs(y.high)),
             most = std::max(std::fabs(y.low), std::fabs(y.high));
  return (y.low > 0) == (y.high > 0) && least >= Real(kLeast) && most <= 0x1p126L;
}
AcceptedRange over(const AcceptedRange& x, const AcceptedRange& y) {
  if (x.open || y.open || !divides(y)) return {0, 0, true};
  const auto [low, high] = corners(x, y, [](Real a, Real b) { return a / b; });
  return within_ulps(low, high, 2.5L, 2.5L, false);
}
AcceptedRange inverse_root(const AcceptedRange& x) {
  if (x.open || !(x.low >= Real(kLeast))) return {0, 0, true};
  return within_ulps(1 / std::sqrt(x.high), 1 / std::sqrt(x.low), 2, 2, false);
}
AcceptedRange root(const AcceptedRange& x) { return over(exactly(1), inverse_root(x)); }
AcceptedRange power_of(Real (*f)(Real), const AcceptedRange& x) {
  return within_ulps(f(x.low), f(x.high), 3 + 2 * std::fabs(x.low), 3 + 2 * std::fabs(x.high), x.open);
}
AcceptedRange exp_of(const AcceptedRange& x) {
  return power_of([](Real v) { return std::exp(v); }, x);
}
AcceptedRange exp2_of(const AcceptedRange& x) {
  return power_of([](Real v) { return std::exp2(v); }, x);
}
AcceptedRange logarithm(Real (*f)(Real), const AcceptedRange& x) {
  if (x.open || !(x.low >= Real(kLeast))) return {0, 0, true};
  const auto off = [&](Real v) { return v >= 0.5L && v <= 2 ? 0x1p-21L : 3 * spec_ulp(f(v)); };
  return about(f(x.low), f(x.high), off(x.low), off(x.high), false);
}
AcceptedRange log_of(const AcceptedRange& x) {
  return logarithm([](Real v) { return std::log(v); }, x);
}
AcceptedRange log2_of(const AcceptedRange& x) {
  return logarithm([](Real v) { return std::log2(v); }, x);
}
AcceptedRange wave(Real (*f)(Real), const AcceptedRange& x) {  // of a point
  if (x.open || std::fabs(x.low) > std::numbers::pi_v<Real>) return {0, 0, true};
  return about(f(x.low), f(x.low), 0x1p-11L, 0x1p-11L, false);
}
AcceptedRange sin_of(const AcceptedRange& x) {
  return wave([](Real v) { return std::sin(v); }, x);
}
AcceptedRange cos_of(const AcceptedRange& x) {
  return wave([](Real v) { return std::cos(v); }, x);
}
AcceptedRange angle(const AcceptedRange& y, const AcceptedRange& x) {
  const bool is_normal = std::min(std::fabs(y.low), std::fabs(y.high)) >= Real(kLeast) && (y.low > 0) == (y.high > 0);
  if (x.open || y.open || !is_normal || !divides(x)) return {0, 0, true};
  const auto [low, high] = corners(y, x, [](Real a, Real b) { return std::atan2(a, b); });
  return within_ulps(low, high, 4096, 4096, false);
}
AcceptedRange either(const AcceptedRange& x, const AcceptedRange& y) {
  return {std::min(x.low, y.low), std::max(x.high, y.high), x.open || y.open};
}
AcceptedRange truncated(const AcceptedRange& x) { return {std::trunc(x.low), std::trunc(x.high), x.open}; }
AcceptedRange floored(const AcceptedRange& x) { return {std::floor(x.low), std::floor(x.high), x.open}; }
AcceptedRange sinh_of(const AcceptedRange& x) { return times(minus(exp_of(x), exp_of(negated(x))), exactly(0.5L)); }
AcceptedRange cosh_of(const AcceptedRange& x) { return times(plus(exp_of(x), exp_of(negated(x))), exactly(0.5L)); }
AcceptedRange other_leg(const AcceptedRange& x) { return root(minus(exactly(1), times(x, x))); }
AcceptedRange smooth(const AcceptedRange& low, const AcceptedRange& high, const AcceptedRange& x) {
  AcceptedRange t = over(minus(x, low), minus(high, low));
  t.low = std::clamp<Real>(t.low, 0, 1), t.high = std::clamp<Real>(t.high, 0, 1);
  return times(times(t, t), minus(exactly(3), times(exactly(2), t)));
}

using Operands = std::array<AcceptedRange, 3>;
struct Rule {
  const char* name;
  double least, most;  ///< of the operands; of negative ones too, where least is negative
  AcceptedRange (*of)(const Operands& v);
  int operands = 1;
};
const Rule kRules[] = {
    {"add", -1e6, 1e6, [](const Operands& v) { return plus(v[0], v[1]); }, 2},
    {"sub", -1e6, 1e6, [](const Operands& v) { return minus(v[0], v[1]); }, 2},
    {"mul", -1e6, 1e6, [](const Operands& v) { return times(v[0], v[1]); }, 2},
    {"div", -1e6, 1e6, [](const Operands& v) { return over(v[0], v[1]); }, 2},
    {"sqrt", 1e-30, 1e30, [](const Operands& v) { return root(v[0]); }},
    {"inversesqrt", 1e-30, 1e30, [](const Operands& v) { return inverse_root(v[0]); }},
    {"length", -1e6, 1e6, [](const Operands& v) { return root(times(v[0], v[0])); }},
    {"exp", -80, 80, [](const Operands& v) { return exp_of(v[0]); }},
    {"exp2", -120, 120, [](const Operands& v) { return exp2_of(v[0]); }},
    {"log", 1e-30, 1e30, [](const Operands& v) { return log_of(v[0]); }},
    {"log2", 1e-30, 1e30, [](const Operands& v) { return log2_of(v[0]); }},
    {"pow", 1e-6, 1e6, [](const Operands& v) { return exp2_of(times(v[1], log2_of(v[0]))); }, 2},
    {"sin", -4, 4, [](const Operands& v) { return sin_of(v[0]); }},
    {"cos", -4, 4, [](const Operands& v) { return cos_of(v[0]); }},
    {"tan", -4, 4, [](const Operands& v) { return over(sin_of(v[0]), cos_of(v[0])); }},
    {"atan", -1e6, 1e6,
     [](const Operands& v) { return within_ulps(std::atan(v[0].low), std::atan(v[0].high), 4096, 4096, v[0].open); }},
    {"atan2", -1e6, 1e6, [](const Operands& v) { return angle(v[0], v[1]); }, 2},
    {"asin", -1, 1,
     [](const Operands& v) {
       return either(angle(v[0], other_leg(v[0])),
                     about(std::asin(v[0].low), std::asin(v[0].high), 6.81e-5L, 6.81e-5L, false));
     }},
    {"acos", -1, 1,
     [](const Operands& v) {
       return either(angle(other_leg(v[0]), v[0]),
                     about(std::acos(v[0].high), std::acos(v[0].low), 6.77e-5L, 6.77e-5L, false));
     }},
    {"sinh", -40, 40, [](const Operands& v) { return sinh_of(v[0]); }},
    {"cosh", -40, 40, [](const Operands& v) { return cosh_of(v[0]); }},
    {"tanh", -40, 40,
     [](const Operands& v) {
       return either(over(sinh_of(v[0]), cosh_of(v[0])),
                     about(std::tanh(v[0].low), std::tanh(v[0].high), 1e-5L, 1e-5L, false));
     }},
    {"asinh", -1e3, 1e3,
     [](const Operands& v) { return log_of(plus(v[0], root(plus(times(v[0], v[0]), exactly(1))))); }},
    {"acosh", 1, 1e6, [](const Operands& v) { return log_of(plus(v[0], root(minus(times(v[0], v[0]), exactly(1))))); }},
    {"atanh", -1, 1,
     [](const Operands& v) {
       return times(log_of(over(plus(exactly(1), v[0]), minus(exactly(1), v[0]))), exactly(0.5L));
     }},
    {"fract", -1e6, 1e6, [](const Operands& v) { return minus(v[0], floored(v[0])); }},
    {"%", -1e3, 1e3, [](const Operands& v) { return minus(v[0], times(v[1], truncated(over(v[0], v[1])))); }, 2},
    {"fma", -1e6, 1e6, [](const Operands& v) { return plus(times(v[0], v[1]), v[2]); }, 3},
    {"mix", -1e3, 1e3, [](const Operands& v) { return plus(times(v[0], minus(exactly(1), v[2])), times(v[1], v[2])); },
     3},
    {"smoothstep", -1e3, 1e3, [](const Operands& v) { return smooth(v[0], v[1], v[2]); }, 3},
};

/// A float, its logarithm spread evenly; one in eight to a few digits.
float somewhere(Pcg32& random, double least, double most) {
  const double size = std::max(std::fabs(least), std::fabs(most)), smallest = least > 0 ? least : size * 0x1p-30;
  double x = smallest * std::pow(size / smallest, random.between(0, 1));
  if (random.below(8) == 0) x = std::round(x * 16) / 16;
  if (least < 0 && random.below(2) == 0) x = -x;
  return float(std::clamp(x, least, most));
}

}  // namespace

TEST_CASE("Each operation of the profile webgpu holds what the WebGPU CTS accepts, and little more") {
  std::map<std::string, std::pair<int, double>> seen;
  for (const Row& row : rows()) {
    std::vector<Interval> in;
    for (const double x : row.input) in.push_back(given(x));
    in.resize(3);
    const Interval ours = made(row.name, in[0], in[1], in[2]);
    const Bounds& suite = row.expected;
    CAPTURE(row.name, row.input, suite.low, suite.high, ours.low, ours.high, ours.maybe_nan);
    auto& [count, ratio] = seen[row.name];
    ++count;
    CHECK(ours.maybe_nan == (suite.high == kAny));
    if (ours.maybe_nan || suite.high == kAny) continue;
    CHECK((ours.low <= suite.low || (ours.low == 0 && suite.low >= -kBeyondZero)));
    CHECK((ours.high >= suite.high || (ours.high == 0 && suite.high <= kBeyondZero)));
    const double width = suite.high - suite.low;
    const double more = std::max(0.0, ours.high - ours.low - 2 * kLeast);
    if (more > width) ratio = std::max(ratio, width > 0 ? more / width : HUGE_VAL);
  }
  for (const auto& [name, is] : seen) {
    std::printf("%-12s %3d rows, %.3f times as wide\n", name.c_str(), is.first, std::max(1.0, is.second));
    CAPTURE(name);
    CHECK(is.second <= factor_of(kWider, name));
  }
}

TEST_CASE("Each operation of the profile webgpu holds what WGSL's accuracy lets a device compute of random floats") {
  const int points = 4000;
  for (const Rule& rule : kRules) {
    Pcg32 random(29);
    int judged = 0, unjudged = 0, open = 0;
    std::vector<double> ratios;
    for (int i = 0; i < points; ++i) {
      Operands x{exactly(0), exactly(0), exactly(0)};
      Interval point[3], some[3];
      for (int k = 0; k < rule.operands; ++k) {
        const float v = k == 1 && std::string(rule.name) == "pow" ? somewhere(random, -8, 8)
                                                                  : somewhere(random, rule.least, rule.most);
        x[size_t(k)] = settled(exactly(Real(v)));
        point[k] = some[k] = Interval::of(double(v));
        some[k].low -= random.between(0, 1e-5) * std::fabs(double(v)),
            some[k].high += random.between(0, 1e-5) * std::fabs(double(v));
      }
      const AcceptedRange legal = rule.of(x);
      for (const bool is_point : {true, false}) {
        const Interval* in = is_point ? point : some;
        const Interval ours = made(rule.name, in[0], in[1], in[2]);
        CAPTURE(rule.name, point[0].value, point[1].value, point[2].value, is_point, double(legal.low),
                double(legal.high), ours.low, ours.high);
        if (legal.open || ours.maybe_nan) {
          if (legal.open && !ours.maybe_nan) FAIL("any value is legal, ours is bounded");
          if (is_point) ++(legal.open ? open : unjudged);
          continue;
        }
        if (!(Real(ours.low) <= legal.low || (ours.low == 0 && legal.low >= -Real(kBeyondZero)))) FAIL("below ours");
        if (!(Real(ours.high) >= legal.high || (ours.high == 0 && legal.high <= Real(kBeyondZero)))) FAIL("above ours");
        if (!is_point) continue;
        ++judged;
        const double width = double(legal.high - legal.low), more = ours.high - ours.low - 0x1p-100;
        ratios.push_back(more <= width ? 1 : width > 0 ? more / width : HUGE_VAL);
      }
    }
    std::sort(ratios.begin(), ratios.end());
    // Of the rest some next to a step of floor() may go either way by ours alone.
    const double ratio = ratios.empty() ? HUGE_VAL : ratios[ratios.size() * 99 / 100];
    std::printf("%-12s %d points judged, %d open, %d for ours alone, 99 %% at most %.3f times as wide\n", rule.name,
                judged, open, unjudged, ratio);
    CAPTURE(rule.name);
    CHECK(judged > points / 2);
    CHECK(unjudged <= points / 50);
    CHECK(ratio <= factor_of(kWiderThanRule, rule.name));
  }
}
