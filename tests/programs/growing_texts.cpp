// Texts of light programs that grow in the compiler: by macros, by structures of structures, by depth.
#include <chrono>

#include "core/error.h"
#include "programs/front/light_program.h"
#include "programs/front/macro_growth.h"
#include "tests/catch.hpp"
#include "tests/programs/macro_bombs.h"

namespace trueshade::programs {
namespace {

/// What a text comes to, and the seconds it takes.
struct Outcome {
  std::string said;
  bool is_limit = false;
  double seconds = 0;
};

Outcome outcome(const std::string& text, const ProgramLimits& limits = {}) {
  const auto start = std::chrono::steady_clock::now();
  Outcome out{"made"};
  try {
    program_from_glsl("a.glsl", text, limits);
  } catch (const Error& error) {
    out.said = error.what(), out.is_limit = error.kind() == ErrorKind::limit;
  }
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

/// Structures of two of the structure before, up to 2^count numbers.
std::string doubled_structures(int count) {
  return macro_chain("struct S0 { float a, b; };\n", "struct SN { SM a, b; };\n", count);
}

}  // namespace

TEST_CASE("Tokens are counted with their macros expanded") {
  CHECK(tokens_with_macros("") == 0);
  CHECK(tokens_with_macros("a + b1 /* c d */ - 2.5 // e\n;") == 8);
  CHECK(tokens_with_macros("#define a 1 + 2\na a") == 8);
  CHECK(tokens_with_macros("#define a \\\n 1 + \\\r\n 2\na") == 4);
  CHECK(tokens_with_macros("#define a\n#define b a a a\nb") == 4);
  CHECK(tokens_with_macros("#define f(x) x x x\nf(1) f (1 2)") ==
        1 + 4 + 1 + 8);                                      // arguments are expanded once besides
  CHECK(tokens_with_macros("#define f (x) x x x\nf") == 7);  // a blank: it has no parameters
  CHECK(tokens_with_macros("#define f(x) x x\nf") == 1);
  CHECK(tokens_with_macros("#define sin(x) sin(x) + 0\nsin(1)") == 8);
  CHECK(tokens_with_macros("#ifdef a\n#define a 1\n#else\n#define a 1 + 2 + 3\n#endif\na") == 6);
  CHECK(tokens_with_macros("#define list(x) x(1) x(2)\n#define item(n) n n n n\nlist(item)") < 60);
  CHECK(tokens_with_macros("#define a b\n#define b a\na") == kEndlessGrowth);
  CHECK(tokens_with_macros("#define a b\n#define b a\n") == 0);
  for (const char* const text :
       {"#", "#define", "#define a(", "#define a(x", "/*", "//", "\\", "#define f(x) x\nf(", "f)", "/"})
    CHECK(tokens_with_macros(text) < 9);
}

TEST_CASE("Macros that grow beyond all bounds are refused at once, and heavy use of macros is not") {
  for (const auto& [name, text] : macro_bombs()) {
    INFO(name);
    const Outcome refused = outcome(text);
    INFO(refused.said);
    CHECK(refused.is_limit);
    CHECK_THAT(refused.said, Catch::Contains("macros"));
    CHECK(refused.seconds < 1.0);
  }
  std::string text = macro_chain("#define k0 l.range\n", "#define kN (kM + 1.0)\n", 200) +
                     macro_chain("#define s0(x) (x)\n", "#define sN(x) ((x) * 0.5 + N.0)\n", 200) +
                     "#define both(f, g, x) f(g(x))\n#ifdef GL_ES\n#define unit 2.0\n#else\n#define unit 1.0\n#endif\n"
                     "#define FIELDS(do_to) do_to(albedo) do_to(emission)\n#define ADD(field) + s.field.r\n";
  std::string sum = "k199 * unit FIELDS(ADD)";
  for (int i = 0; i < 200; ++i) {
    const std::string n = std::to_string(i), m = std::to_string((i + 7) % 200);
    sum += " + s" + n + "(s" + m + "(s.metallic)) + both(s" + m + ", s" + n + ", s.roughness)";
  }
  CHECK(tokens_with_macros(text + sum) > 10'000);
  CHECK(outcome(text + light_that_returns(sum)).said == "made");
}

TEST_CASE("Structures that grow are ended in a process of their own, by memory or by time") {
  const std::string constants = doubled_structures(30) + "const S0 c0 = S0(1, 2);\n" +
                                macro_chain("", "const SN cN = SN(cM, cM);\n", 30) +
                                light_that_returns("c29.a" + repeated(".a", 29));
  const std::string compared = doubled_structures(30) + light_that_returns("a == b ? 1.0 : 0.0", "S29 a, b;");
  ProgramLimits limits;
  limits.seconds = 1, limits.memory = uint64_t(64) << 20;
  const Outcome in_memory = outcome(constants, limits);
  CHECK(in_memory.is_limit);
  CHECK_THAT(in_memory.said, Catch::Contains("64 MiB") || Catch::Contains("--max-program-time"));
  const Outcome in_time = outcome(compared, limits);
  CHECK(in_time.is_limit);
  CHECK_THAT(in_time.said, Catch::Contains("64 MiB") || Catch::Contains("more than 1 s"));
  CHECK(in_time.seconds < 5.0);
  CHECK(outcome(doubled_structures(5) + light_that_returns("a == b ? 1.0 : 0.0", "S4 a, b;"), limits).said == "made");
}

TEST_CASE("Very deep texts are compiled or refused, within memory") {
  const std::pair<const char*, std::string> rows[] = {
      {"parentheses", light_that_returns(repeated("(", 90'000) + "1" + repeated(")", 90'000))},
      {"signs", light_that_returns(repeated("- ", 190'000) + "l.range")},
      {"braces", light_that_returns("1", repeated("{", 90'000) + repeated("}", 90'000))},
      {"choices", light_that_returns(repeated("l.range > 1.0 ? 1.0 : ", 20'000) + "0.0")},
      {"commas", light_that_returns("x", "float x = 0.0; x = " + repeated("x,", 90'000) + "x;")},
      {"else", light_that_returns("1", repeated("if (l.range > 1.0) return vec3(1); else ", 10'000))},
      {"loops", light_that_returns("1", repeated("for (;;) ", 30'000) + ";")},
      {"indices",
       light_that_returns("l.user[" + repeated("int(l.user[", 20'000) + "0" + repeated("].x)", 20'000) + "].x")},
      {"too many tokens", light_that_returns("1" + repeated("+1", 100'000))},
  };
  for (const auto& [name, text] : rows) {
    INFO(name);
    const Outcome one = outcome(text);
    INFO(one.said.substr(0, 300));
    CHECK((one.said == "made" || one.said.starts_with("a.glsl")));
    CHECK(one.seconds < 10.0);
  }
}

TEST_CASE("The process that compiles gives back words, and errors as they are") {
  ProgramLimits here;
  here.memory = 0;  // in this process
  for (const std::string& text :
       {light_that_returns("s.normal * gain", "float gain = 2.0;"), light_that_returns("nothing"),
        light_that_returns("1", "\n\n  int x = 1.0 (: ) (;"), std::string("#error (a: b)\n"), std::string("}")}) {
    INFO(text);
    const Outcome apart = outcome(text), together = outcome(text, here);
    CHECK(apart.said == together.said);
    CHECK(apart.is_limit == together.is_limit);
  }
}

TEST_CASE("An error over a limit names its option") {
  using Catch::Contains;
  const std::string loop = light_that_returns("a", "float a = l.range; for (int i = 0; i < 100; ++i) a = a * a + 1.0;");
  CHECK(outcome(loop).said == "made");
  CHECK_THAT(outcome(loop, {.nodes = 100}).said, Contains("--max-program-nodes"));
  CHECK_THAT(outcome(loop, {.trips = 99}).said, Contains("--max-loop-trips"));
  const std::string deep = light_that_returns("n",
                                              "int n = 0; for (int i = 0; i < 1000; ++i) for (int k = 0; k < 1000; "
                                              "++k) for (int m = 0; m < 1000; ++m) n = n ^ m;");
  CHECK_THAT(outcome(deep).said, Contains("to unroll") && Contains("--max-program-nodes"));
  CHECK_THAT(outcome(deep, {.nodes = 10'000'000, .seconds = 1}).said,
             Contains("1 s to unroll") && Contains("--max-program-time"));
}

}  // namespace trueshade::programs
