// Branches, loops, calls and memory of light programs in the oracle's interpreter, with values worked out by hand.
#include <bit>

#include "oracle/spirv_interpreter.h"
#include "tests/catch.hpp"
#include "tests/programs/oracle/compiled_light.h"
#include "tests/programs/oracle/program_inputs.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

/// Zeros but for s.object = n and s.shininess = x.
oracle::SpirvScalars inputs_of(uint32_t n, float x) {
  oracle::SpirvScalars inputs;
  for (const ProgramInput& input : interface_inputs()) inputs[input.name].assign(size_t(input.scalars), 0);
  inputs["TsSurface.ts_surface.object"] = {n};
  inputs["TsSurface.ts_surface.shininess"] = {std::bit_cast<uint32_t>(x)};
  return inputs;
}

/// What a body of `float f(Surface s, int n, float x)` returns; `before` stands in front of it.
float returned(const std::string& body, uint32_t n, float x, const std::string& before = "") {
  const std::string text =
      before + "\nfloat f(Surface s, int n, float x) {" + body +
      "}\nvec3 light(Surface s, Light l, View v) { return vec3(f(s, int(s.object), s.shininess)); }\n";
  const oracle::SpirvModule module = oracle::spirv_module(compiled_shader(whole_shader(text, false, false, false)));
  return std::bit_cast<float>(run_spirv(module, inputs_of(n, x)).at("TsResult.light")[1]);
}

}  // namespace

TEST_CASE("loops end where their conditions, breaks and returns say") {
  CHECK(returned("float sum = 0.0; for (int i = 0; i < n; ++i) sum += float(i); return sum;", 5, 0) == 10);
  CHECK(returned("float sum = 0.0; for (int i = 0; i < n; ++i) sum += float(i); return sum;", 0, 0) == 0);
  CHECK(returned("int k = 0; while (x > 1.0) { x *= 0.5; ++k; } return float(k);", 0, 9) == 4);
  CHECK(returned("int k = 0; do { ++k; } while (k < n); return float(k);", 0, 0) == 1);
  CHECK(returned("int k = 0; for (int i = 0; i < 10; ++i) { if (i == n) continue; if (i > 6) break; k += i; } return "
                 "float(k);",
                 3, 0) == 18);
  CHECK(returned("for (int i = 0; i < 10; ++i) for (int j = 0; j < 10; ++j) if (i * j == n) return float(10 * i + j); "
                 "return -1.0;",
                 42, 0) == 67);
  CHECK(returned("for (int i = 0; i < 10; ++i) for (int j = 0; j < 10; ++j) if (i * j == n) return float(10 * i + j); "
                 "return -1.0;",
                 11, 0) == -1);
  // A loop that never ends by itself: an inner break leaves the inner loop alone.
  CHECK(returned("int k = 0; for (;;) { for (;;) { if (++k % 3 == 0) break; } if (k > n) break; } return float(k);", 10,
                 0) == 12);
}

TEST_CASE("a switch falls through, takes its default, and leaves loops alone") {
  const std::string body =
      "float r = 0.0; switch (n) { case 1: r += 1.0; case 2: r += 2.0; break; default: r = 50.0; case 7: r += 7.0; } "
      "return r;";
  CHECK(returned(body, 1, 0) == 3);
  CHECK(returned(body, 2, 0) == 2);
  CHECK(returned(body, 7, 0) == 7);
  CHECK(returned(body, 5, 0) == 57);
  CHECK(returned("float r = 0.0; for (int i = 0; i < 4; ++i) { switch (i) { case 1: continue; case 2: r += 10.0; "
                 "break; } r += 1.0; } return r;",
                 0, 0) == 13);
}

TEST_CASE("values of branches that are not taken have no effect") {
  CHECK(returned("return n > 0 ? 1.0 / x : 2.0;", 0, 0) == 2);
  CHECK(returned("if (n > 0 && 8 / n > 3) return 1.0; return 2.0;", 0, 0) == 2);
  CHECK(returned("if (n == 0 || touch()) return float(touched); return -1.0;", 0, 0,
                 "int touched = 0; bool touch() { touched += 5; return true; }") == 0);
  CHECK(returned("if (n == 1 || touch()) return float(touched); return -1.0;", 0, 0,
                 "int touched = 0; bool touch() { touched += 5; return true; }") == 5);
}

TEST_CASE("parameters of functions go in and out by copy") {
  const std::string swap = "void change(inout float a, inout float b) { float c = a; a = b; b = c + 1.0; }";
  CHECK(returned("float y = 2.0; change(x, y); return 10.0 * x + y;", 0, 3, swap) == 24);
  // Both parameters are one variable: the second is copied back last.
  CHECK(returned("change(x, x); return x;", 0, 3, swap) == 4);
  CHECK(returned("vec3 a = vec3(1.0, 2.0, 3.0); change(a.y, a.z); return 100.0 * a.x + 10.0 * a.y + a.z;", 0, 0,
                 swap) == 133);
  CHECK(returned("float g[3] = float[](1.0, 2.0, 3.0); return read(g, n) + g[1];", 1, 0,
                 "float read(float a[3], int i) { a[1] = 9.0; return a[i]; }") == 11);
  CHECK(returned("s.shininess = 7.0; return s.shininess + other(s);", 0, 1,
                 "float other(Surface s) { s.shininess *= 2.0; return s.shininess; }") == 21);
}

TEST_CASE("variables are 0 before they are written, and anew at each call") {
  CHECK(returned("float a; vec3 b; float c[4]; return a + b.y + c[n];", 3, 0) == 0);
  CHECK(returned("count(); count(); return count();", 0, 0, "float count() { float a; a += 1.0; return a; }") == 1);
  CHECK(returned("count(); count(); return count();", 0, 0,
                 "float total; float count() { total += 1.0; return total; }") == 3);
  // Declared in a loop it is one variable of the function, which keeps what it had.
  CHECK(returned("float r = 0.0; for (int i = 0; i < 3; ++i) { float a; a += 1.0; r = a; } return r;", 0, 0) == 3);
}

TEST_CASE("aggregates are read and written by parts, at indices that are known late") {
  CHECK(returned("float a[4] = float[](1.0, 2.0, 3.0, 4.0); a[n] = x; a[n + 9] = 8.0; return 1000.0 * a[0] + 100.0 * "
                 "a[1] + 10.0 * a[2] + a[3];",
                 1, 5) == 1538);
  CHECK(returned("mat3x2 m = mat3x2(0.0); m[n][n - 1] = x; vec2 c = m[n]; c[n] = 9.0; return 10.0 * m[1].x + c.y;", 1,
                 5) == 59);
  CHECK(
      returned("vec4 a = vec4(1.0, 2.0, 3.0, 4.0); a.wx = a.xy; return 1000.0 * a.x + 100.0 * a.y + 10.0 * a.z + a.w;",
               0, 0) == 2231);
  const std::string types = "struct Inner { float a[2]; vec2 b; }; struct Outer { Inner in0, in1; mat2 m; };";
  CHECK(returned("Outer o[2]; o[n].in1.b.y = x; o[n].in1.a[n] = 2.0; Outer p = o[1]; return 10.0 * p.in1.b.y + "
                 "p.in1.a[1] + o[0].in1.b.y;",
                 1, 5, types) == 52);
  CHECK(returned("Inner a = Inner(float[](1.0, x), vec2(2.0)), b = a; bool same = a == b; b.a[1] += 1.0; return "
                 "float(same) + 10.0 * float(a == b);",
                 0, 5, types) == 1);
  CHECK(returned("const float k[3] = float[](4.0, 5.0, 6.0); return k[n] + k[n - 5];", 2, 0) == 12);
}

TEST_CASE("an entry point stores what its functions return, or the defaults") {
  const std::string light = "vec3 light(Surface s, Light l, View v) { return vec3(s.shininess); }\n";
  const auto run = [](const std::string& text, bool reaches, bool start, bool finish, float x) {
    oracle::SpirvScalars inputs = inputs_of(3, x);
    inputs["TsSum.ts_sum"] = {std::bit_cast<uint32_t>(0.25f), std::bit_cast<uint32_t>(0.5f),
                              std::bit_cast<uint32_t>(0.75f)};
    return run_spirv(oracle::spirv_module(compiled_shader(whole_shader(text, reaches, start, finish))), inputs);
  };
  const uint32_t one = std::bit_cast<uint32_t>(1.0f), half = std::bit_cast<uint32_t>(0.5f);
  oracle::SpirvScalars found = run(light, false, false, false, 0);
  CHECK(found.at("TsResult.reaches") == std::vector<uint32_t>{0});
  CHECK(found.at("TsResult.start") == std::vector<uint32_t>{0, 0, 0});
  CHECK(found.at("TsResult.finish") ==
        std::vector<uint32_t>{std::bit_cast<uint32_t>(0.25f), half, std::bit_cast<uint32_t>(0.75f), one});
  CHECK(run(light, false, false, false, 1).at("TsResult.reaches") == std::vector<uint32_t>{1});
  found = run(light +
                  "bool reaches(Surface s, Light l, View v) { return s.object == 3u; } vec3 start(Surface s, View v) { "
                  "return vec3(1.0); }\n"
                  "vec4 finish(Surface s, View v, vec3 sum) { return sum.yyyy; }",
              true, true, true, 0);
  CHECK(found.at("TsResult.reaches") == std::vector<uint32_t>{1});
  CHECK(found.at("TsResult.start") == std::vector<uint32_t>{one, one, one});
  CHECK(found.at("TsResult.finish") == std::vector<uint32_t>{half, half, half, half});
}
