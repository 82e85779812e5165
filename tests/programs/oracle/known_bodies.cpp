#include "tests/programs/oracle/known_values.h"

namespace trueshade::testing {

namespace {

constexpr const char* kSum = "float sum = 0.0; for (int i = 0; i < n; ++i) sum += float(i); return sum;";
constexpr const char* kSearch =
    "for (int i = 0; i < 10; ++i) for (int j = 0; j < 10; ++j) if (i * j == n) return float(10 * i + j); return -1.0;";
constexpr const char* kChoice =
    "float r = 0.0; switch (n) { case 1: r += 1.0; case 2: r += 2.0; break; default: r = 50.0; case 7: r += 7.0; }"
    "return r;";
constexpr const char* kTouch = "int touched = 0; bool touch() { touched += 5; return true; }";
constexpr const char* kChange = "void change(inout float a, inout float b) { float c = a; a = b; b = c + 1.0; }";
constexpr const char* kNested = "struct Inner { float a[2]; vec2 b; }; struct Outer { Inner in0, in1; mat2 m; };";

constexpr KnownBody kBodies[] = {
    // Loops end where their conditions, breaks and returns say.
    {kSum, 5, 0, 10, "", false},
    {kSum, 0, 0, 0, "", false},
    {"int k = 0; while (x > 1.0) { x *= 0.5; ++k; } return float(k);", 0, 9, 4, "", false},
    {"int k = 0; do { ++k; } while (k < n); return float(k);", 0, 0, 1, "", false},
    {"int k = 0; for (int i = 0; i < 10; ++i) { if (i == n) continue; if (i > 6) break; k += i; } return float(k);", 3,
     0, 18},
    {"int k = 0; int i = 0; while (i < 8 && x < 40.0) { ++i; x += float(i); k += 10; } return float(k) + x;", 0, 30,
     80},
    {"int k = 0; do { ++k; if (k == n) continue; x += 1.0; } while (k < 5); return x;", 2, 1, 5},
    {kSearch, 42, 0, 67},
    {kSearch, 11, 0, -1},
    // An inner break leaves the inner loop alone.
    {"int k = 0; for (;;) { for (;;) { if (++k % 3 == 0) break; } if (k > n) break; } return float(k);", 10, 0, 12, "",
     false},
    // A switch falls through, takes its default, and leaves loops alone.
    {kChoice, 1, 0, 3},
    {kChoice, 2, 0, 2},
    {kChoice, 7, 0, 7},
    {kChoice, 5, 0, 57},
    {"float r = 0.0; for (int i = 0; i < 4; ++i) { switch (i) { case 1: continue; case 2: r += 10.0; break; } r += "
     "1.0; }"
     "return r;",
     0, 0, 13},
    {"switch (n) { case 0: return 4.0; case 1: if (x > 0.0) return 5.0; break; default: return 6.0; } return 7.0;", 1,
     0, 7},
    {"switch (n) { case 0: return 4.0; case 1: if (x > 0.0) return 5.0; break; default: return 6.0; } return 7.0;", 1,
     1, 5},
    // Branches that are not taken have no effect.
    {"return n > 0 ? 1.0 / x : 2.0;", 0, 0, 2},
    {"if (n > 0 && 8 / n > 3) return 1.0; return 2.0;", 0, 0, 2},
    {"float r = x; if (n == 0) { r = sqrt(-1.0 - x); } else { r += 1.0; } return r;", 1, 2, 3},
    {"if (n == 0 || touch()) return float(touched); return -1.0;", 0, 0, 0, kTouch},
    {"if (n == 1 || touch()) return float(touched); return -1.0;", 0, 0, 5, kTouch},
    // Parameters go in and out by copy; of one variable that is both, the second is copied back last.
    {"float y = 2.0; change(x, y); return 10.0 * x + y;", 0, 3, 24, kChange},
    {"change(x, x); return x;", 0, 3, 4, kChange},
    {"vec3 a = vec3(1.0, 2.0, 3.0); change(a.y, a.z); return 100.0 * a.x + 10.0 * a.y + a.z;", 0, 0, 133, kChange},
    {"float g[3] = float[](1.0, 2.0, 3.0); return read(g, n) + g[1];", 1, 0, 11,
     "float read(float a[3], int i) { a[1] = 9.0; return a[i]; }"},
    {"s.shininess = 7.0; return s.shininess + other(s);", 0, 1, 21,
     "float other(Surface s) { s.shininess *= 2.0; return s.shininess; }"},
    {"float a = first(x, n); return a;", 3, 5, 5,
     "float first(float x, int n) { for (int i = 0; i < 4; ++i) { if (i == n) return x; } return -1.0; }"},
    {"float a = x; if (n > 0) a = early(a); return a + 1.0;", 1, 5, 3,
     "float early(float x) { if (x > 4.0) return 2.0; x *= 2.0; return x; }"},
    // Variables are 0 before they are written, and anew at each call; one that is declared in a loop is one of the
    // function, and keeps what it had.
    {"float a; vec3 b; float c[4]; return a + b.y + c[n];", 3, 0, 0},
    {"count(); count(); return count();", 0, 0, 1, "float count() { float a; a += 1.0; return a; }"},
    {"count(); count(); return count();", 0, 0, 3, "float total; float count() { total += 1.0; return total; }"},
    {"float r = 0.0; for (int i = 0; i < 3; ++i) { float a; a += 1.0; r = a; } return r;", 0, 0, 3},
    // Parts of aggregates, at indices that are known late.
    {"float a[4] = float[](1.0, 2.0, 3.0, 4.0); a[n] = x; a[n + 9] = 8.0;"
     "return 1000.0 * a[0] + 100.0 * a[1] + 10.0 * a[2] + a[3];",
     1, 5, 1538},
    {"mat3x2 m = mat3x2(0.0); m[n][n - 1] = x; vec2 c = m[n]; c[n] = 9.0; return 10.0 * m[1].x + c.y;", 1, 5, 59},
    {"vec4 a = vec4(1.0, 2.0, 3.0, 4.0); a.wx = a.xy; return 1000.0 * a.x + 100.0 * a.y + 10.0 * a.z + a.w;", 0, 0,
     2231},
    {"Outer o[2]; o[n].in1.b.y = x; o[n].in1.a[n] = 2.0; Outer p = o[1];"
     "return 10.0 * p.in1.b.y + p.in1.a[1] + o[0].in1.b.y;",
     1, 5, 52, kNested},
    {"Inner a = Inner(float[](1.0, x), vec2(2.0)), b = a; bool same = a == b; b.a[1] += 1.0;"
     "return float(same) + 10.0 * float(a == b);",
     0, 5, 1, kNested},
    {"Inner a = Inner(float[](1.0, x), vec2(2.0)); move(a, n); return 10.0 * a.a[0] + a.b.y;", 1, 5, 53,
     "struct Inner { float a[2]; vec2 b; }; void move(inout Inner i, int n) { i.a[0] = i.a[n]; i.b = vec2(3.0); }"},
    {"const float k[3] = float[](4.0, 5.0, 6.0); return k[n] + k[n - 5];", 2, 0, 12},
    {"s.user[n].y = x; s.user[n + 1] = s.user[n] * 2.0; return s.user[2].y + s.user[1].x;", 1, 5, 10},
};

}  // namespace

std::span<const KnownBody> known_bodies() { return kBodies; }

std::string program_of(const KnownBody& value) {
  return std::string(value.before) + "\nfloat f(Surface s, int n, float x) { " + value.body +
         " }\nvec3 light(Surface s, Light l, View v) { return vec3(f(s, int(s.object), s.shininess)); }\n";
}

}  // namespace trueshade::testing
