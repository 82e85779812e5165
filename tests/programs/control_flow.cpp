#include <array>
#include <cmath>
#include <spirv-tools/optimizer.hpp>

#include "programs/front/light_program.h"
#include "tests/catch.hpp"
#include "tests/programs/run_program.h"

namespace trueshade::programs {
namespace {

using Floats = std::array<float, 3>;

/// GLSL of light() and what goes before it, and the same in C++. Both see the floats x, y, z of the surface's position.
struct Flow {
  const char* name;
  const char* before;
  const char* body;
  Floats (*wanted)(float x, float y, float z);
};

constexpr const char* kStart = "float x = s.position.x, y = s.position.y, z = s.position.z;\n";

const Flow kFlows[] = {
    {"if and else", "",
     "vec3 r = vec3(1); if (x > y) { r.x = x; if (z > 0.0) r.y = z; else r.z = z; } else r = vec3(y); return r;",
     [](float x, float y, float z) -> Floats {
       Floats r{1, 1, 1};
       if (x > y) {
         r[0] = x;
         (z > 0 ? r[1] : r[2]) = z;
       } else {
         r = {y, y, y};
       }
       return r;
     }},
    {"early returns",
     "float f(float a, float b) { if (a > 1.0) return b; a = a + 1.0; if (b > a) { if (a > 0.5) return a * 3.0; b = "
     "7.0; } return a + b; }",
     "return vec3(f(x, y), f(y, z), f(f(z, x), y));",
     [](float x, float y, float z) -> Floats {
       const auto f = [](float a, float b) {
         if (a > 1) return b;
         a = a + 1;
         if (b > a) {
           if (a > 0.5f) return a * 3;
           b = 7;
         }
         return a + b;
       };
       return {f(x, y), f(y, z), f(f(z, x), y)};
     }},
    {"loops that break and continue", "",
     "float sum = 0.0; int trips = 0; for (int i = 0; i < 10; ++i) { trips = trips + 1; if (float(i) > x + 3.0) break; "
     "if (float(i) < y) continue; sum += float(i) * z; } return vec3(sum, float(trips), z);",
     [](float x, float y, float z) -> Floats {
       float sum = 0;
       int trips = 0;
       for (int i = 0; i < 10; ++i) {
         trips = trips + 1;
         if (float(i) > x + 3) break;
         if (float(i) < y) continue;
         sum += float(i) * z;
       }
       return {sum, float(trips), z};
     }},
    {"loops in loops", "",
     "float sum = 0.0; for (int i = 0; i < 4; ++i) { for (int k = i; k < 6; ++k) { if (float(k) > x + 2.0) break; sum "
     "= sum * 0.5 + float(i * k); } if (sum > y * 4.0) break; } return vec3(sum);",
     [](float x, float y, float) -> Floats {
       float sum = 0;
       for (int i = 0; i < 4; ++i) {
         for (int k = i; k < 6; ++k) {
           if (float(k) > x + 2) break;
           sum = sum * 0.5f + float(i * k);
         }
         if (sum > y * 4) break;
       }
       return {sum, sum, sum};
     }},
    {"a loop that returns",
     "float f(float a) { for (int i = 0; i < 5; ++i) { a = a * 1.5; if (a > 6.0) return float(i); } return -a; }",
     "return vec3(f(x), f(y), f(z));",
     [](float x, float y, float z) -> Floats {
       const auto f = [](float a) {
         for (int i = 0; i < 5; ++i) {
           a = a * 1.5f;
           if (a > 6) return float(i);
         }
         return -a;
       };
       return {f(x), f(y), f(z)};
     }},
    {"while and do", "",
     "int n = 0; float a = abs(x); while (n < 20 && a > 0.5) { a *= 0.5; ++n; } int m = 0; do { a += 1.0; ++m; } while "
     "(a < abs(y) && m < 8); return vec3(a, float(n), float(m));",
     [](float x, float y, float) -> Floats {
       int n = 0, m = 0;
       float a = std::abs(x);
       while (n < 20 && a > 0.5f) a *= 0.5f, ++n;
       do a += 1, ++m;
       while (a < std::abs(y) && m < 8);
       return {a, float(n), float(m)};
     }},
    {"switch",
     "float f(int k, float a) { float r = 0.0; switch (k) { case 0: r = a; break; case 1: r = 2.0; case 2: r += a * "
     "3.0; break; case 5: return a - 1.0; default: r = -a; } return r + 1.0; }",
     "return vec3(f(int(x), y), f(int(y), z), f(int(z) + 3, x));",
     [](float x, float y, float z) -> Floats {
       const auto f = [](int k, float a) {
         float r = 0;
         switch (k) {
           case 0:
             r = a;
             break;
           case 1:
             r = 2;
             [[fallthrough]];
           case 2:
             r += a * 3;
             break;
           case 5:
             return a - 1;
           default:
             r = -a;
         }
         return r + 1;
       };
       return {f(int(x), y), f(int(y), z), f(int(z) + 3, x)};
     }},
    {"parameters in, out and inout",
     "void f(in float a, out float b, inout float c) { a = a + 1.0; b = a * 2.0; if (c > 1.0) c = b; }",
     "float b = 9.0, c = y; if (z > 0.0) f(x, b, c); float d; f(b, d, x); return vec3(b + d, c, x);",
     [](float x, float y, float z) -> Floats {
       const auto f = [](float a, float& b, float& c) {
         a = a + 1;
         b = a * 2;
         if (c > 1) c = b;
       };
       float b = 9, c = y, d = 0;
       if (z > 0) f(x, b, c);
       f(b, d, x);
       return {b + d, c, x};
     }},
    {"indices that are no constants", "const float table[5] = float[](1.0, 2.0, 4.0, 8.0, 16.0);",
     "float a[3]; a[0] = x; a[1] = y; a[2] = z; int i = int(abs(x)) % 3; a[i] = 5.0; vec3 w = vec3(x, y, z); w[(i + 1) "
     "% 3] += 2.0; mat2 m = mat2(x, y, z, 1.0); return vec3(a[0] + a[1] + a[2] + table[i + 1], w[i] + w[2], m[i & "
     "1][1]);",
     [](float x, float y, float z) -> Floats {
       const float table[5] = {1, 2, 4, 8, 16}, m[2][2] = {{x, y}, {z, 1}};
       float a[3] = {x, y, z}, v[3] = {x, y, z};
       const int i = int(std::abs(x)) % 3;
       a[i] = 5;
       v[(i + 1) % 3] += 2;
       return {a[0] + a[1] + a[2] + table[i + 1], v[i] + v[2], m[i & 1][1]};
     }},
    {"an index beyond the end is the last", "",
     "float a[3] = float[](x, y, z); return vec3(a[int(x) + 7], a[-1 - int(abs(x))], 0.0);",
     [](float x, float, float z) -> Floats {
       return {int(x) + 7 > 2 ? z : 0, z, 0};
     }},
    {"structures and globals",
     "struct Pair { float a; vec2 b; }; float count = 2.0; Pair swap(Pair p) { count += 1.0; return Pair(p.b.x, "
     "vec2(p.a, p.b.y * count)); }",
     "Pair p = Pair(x, vec2(y, z)), q = swap(p); Pair list[2]; list[0] = q; list[1] = swap(q); if (x > 0.0) list[0].b "
     "= list[1].b; return vec3(list[0].a + count, list[0].b);",
     [](float x, float y, float z) -> Floats {
       float count = 2;
       struct Pair {
         float a, b, c;
       };
       const auto swap = [&](Pair p) {
         count += 1;
         return Pair{p.b, p.a, p.c * count};
       };
       const Pair q = swap({x, y, z}), r = swap(q);
       return {q.a + count, x > 0 ? r.b : q.b, x > 0 ? r.c : q.c};
     }},
    {"logic that stops early", "bool loud(inout float n, float a) { n += 1.0; return a > 0.0; }",
     "float n = 0.0; bool a = loud(n, x) && loud(n, y) || loud(n, z); float c = a ? (x > y ? x : y) : z; return "
     "vec3(n, c, float(a));",
     [](float x, float y, float z) -> Floats {
       float n = 0;
       const auto loud = [&](float v) { return n += 1, v > 0; };
       const bool a = (loud(x) && loud(y)) || loud(z);
       return {n, a ? (x > y ? x : y) : z, float(a)};
     }},
    {"a branch not taken divides by zero", "",
     "float r = 3.0; if (x != 0.0) r = z / x; else if (y > 0.0) { r = sqrt(y) / z; } return vec3(r, x == 0.0 ? 1.0 : "
     "1.0 / x, 0.0);",
     [](float x, float y, float z) -> Floats {
       return {x != 0 ? z / x : y > 0 ? std::sqrt(y) / z : 3.0f, x == 0 ? 1.0f : 1 / x, 0};
     }},
    {"swizzles and compounds", "",
     "vec4 w = vec4(x, y, z, 1.0); w.zx += w.xy * 2.0; w.wyz = w.xxw - w.yzz; ivec2 i = ivec2(w.xy) / ivec2(2, -3); "
     "uvec2 u = uvec2(ivec2(7, 9) + i) >> 1u; return vec3(w.x + w.y, w.z * w.w, float(u.x ^ u.y) + float(i.x << 2));",
     [](float x, float y, float z) -> Floats {
       float v[4] = {x, y, z, 1};
       const float a = v[0] * 2, b = v[1] * 2;
       v[2] += a, v[0] += b;
       const float p = v[0] - v[1], q = v[0] - v[2], r = v[3] - v[2];
       v[3] = p, v[1] = q, v[2] = r;
       const int i[2] = {int(v[0]) / 2, int(v[1]) / -3};
       const uint32_t u[2] = {uint32_t(7 + i[0]) >> 1, uint32_t(9 + i[1]) >> 1};
       return {v[0] + v[1], v[2] * v[3], float(u[0] ^ u[1]) + float(int(uint32_t(i[0]) << 2))};
     }},
};

constexpr float kValues[] = {-3.25f, -1.0f, 0.0f, 0.75f, 1.0f, 2.5f, 5.0f};

}  // namespace

namespace {

/// The module with functions inlined and variables as values, as other compilers write it; no arithmetic is changed.
std::vector<uint32_t> without_variables(const std::vector<uint32_t>& words) {
  spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_1);
  optimizer.RegisterPass(spvtools::CreateMergeReturnPass())
      .RegisterPass(spvtools::CreateInlineExhaustivePass())
      .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
      .RegisterPass(spvtools::CreatePrivateToLocalPass())
      .RegisterPass(spvtools::CreateScalarReplacementPass())
      .RegisterPass(spvtools::CreateSSARewritePass())
      .RegisterPass(spvtools::CreateAggressiveDCEPass());
  std::vector<uint32_t> out;
  REQUIRE(optimizer.Run(words.data(), words.size(), &out));
  return out;
}

void check_flow(const Flow& c, const Program& program) {
  for (const float x : kValues)
    for (const float y : kValues)
      for (const float z : kValues) {
        const std::vector<float> made =
            light_of(program, {{"surface.position.x", x}, {"surface.position.y", y}, {"surface.position.z", z}});
        const Floats wanted = c.wanted(x, y, z);
        INFO(c.name << " at " << x << " " << y << " " << z);
        for (size_t k = 0; k < 3; ++k)
          REQUIRE((made[k] == wanted[k] || (std::isnan(made[k]) && std::isnan(wanted[k]))));
      }
}

}  // namespace

TEST_CASE("Branches, loops and functions do what they do in C++") {
  for (const Flow& c : kFlows) check_flow(c, program_of_light(std::string(kStart) + c.body, c.before));
}

TEST_CASE("SPIR-V whose variables are values and whose functions are inlined does the same") {
  for (const Flow& c : kFlows) {
    const std::string text = text_of_light(std::string(kStart) + c.body, c.before);
    const std::vector<uint32_t> words = without_variables(compiled_light("a.glsl", text).words);
    INFO(c.name);
    check_flow(c, program_from_spirv("a.spv", words));
  }
}

TEST_CASE("Loops of constant length leave no operation on integers behind") {
  const Program program = program_of_light(
      "float sum = 0.0; for (int i = 0; i < 100; ++i) { if (i % 3 == 0) continue; if (i > 50) break; sum += s.metallic "
      "* float(i); } return vec3(sum);");
  for (const ProgramNode& node : program.nodes)
    CHECK((node.op <= Op::f_mul || node.type == Type::u32 || node.op == Op::f_ne || node.op == Op::select ||
           node.op == Op::b_or));
  CHECK(light_of(program, {{"surface.metallic", 2.0f}})[0] == 2.0f * 867.0f);
}

TEST_CASE("A loop ends by its bound whatever numbers stand behind it") {
  // A switch has its numbers among the ids in the module: here all ids are among them.
  std::string body =
      "int n = 0;\nfor (int i = 4; i >= 0; --i) {\n"
      "  if (s.uv.x * float(4 - i) > 1.0 ^^ s.uv.y > 2.0) break;\n"
      "  n++;\n}\nfloat r = 3.0;\nswitch (n) {\n";
  for (int number = 1; number < 300; ++number) body += "case " + std::to_string(number) + ":\n";
  const Program program = program_of_light(body + "  r = 4.0;\n}\nreturn vec3(n, r, 0);");
  CHECK(light_of(program, {{"surface.uv.x", 0.3f}}) == std::vector<float>{4, 4, 0});
  CHECK(light_of(program, {{"surface.uv.x", 0.0f}, {"surface.uv.y", 1.0f}}) == std::vector<float>{5, 4, 0});
  CHECK(light_of(program, {{"surface.uv.y", 3.0f}}) == std::vector<float>{0, 3, 0});
}

TEST_CASE("A loop ends by its bound where lanes have returned before it, and where its condition is made of others") {
  const Program branched = program_of_light(
      "if (s.uv.x > 1.0) return vec3(7); int n = 0; if (s.uv.y > 0.5) { bool b = s.normal.x > 0.0; int i = 0; while (i "
      "< 1 && b) { i++; n++; } } return vec3(n);");
  CHECK(light_of(branched, {{"surface.uv.y", 1.0f}, {"surface.normal.x", 1.0f}})[0] == 1);
  CHECK(light_of(branched, {{"surface.uv.y", 1.0f}})[0] == 0);
  CHECK(light_of(branched, {{"surface.uv.x", 2.0f}, {"surface.uv.y", 1.0f}, {"surface.normal.x", 1.0f}})[0] == 7);
  const Program indexed = program_of_light(
      "int n = 0; while (n < 2 && (bool(v.view[s.pixel_x][1]) && bool(v.view[1][3]))) { n++; v.view[2][1] = 1.0; } "
      "return vec3(n);");
  CHECK(light_of(indexed, {{"view.view[0].y", 1.0f}, {"view.view[1].w", 1.0f}})[0] == 2);
  CHECK(light_of(indexed, {{"view.view[0].y", 1.0f}})[0] == 0);
}

}  // namespace trueshade::programs
