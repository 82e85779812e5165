#pragma once
#include <string>
#include <utility>
#include <vector>

namespace trueshade {

/// A chain of macros, each of which is made of the one before it: `first` is the line of number 0, `others` that of the
/// others, in which N is a macro's number and M that of the one before.
inline std::string macro_chain(const std::string& first, const std::string& others, int count) {
  std::string text = first;
  for (int n = 1; n < count; ++n)
    for (const char c : others)
      text += c == 'N' ? std::to_string(n) : c == 'M' ? std::to_string(n - 1) : std::string(1, c);
  return text;
}

inline std::string repeated(const std::string& text, int times) {
  std::string out;
  for (int i = 0; i < times; ++i) out += text;
  return out;
}

inline std::string light_that_returns(const std::string& value, const std::string& before = {}) {
  return "vec3 light(Surface s, Light l, View v) { " + before + " return vec3(" + value + "); }\n";
}

/// Short texts of light programs whose macros grow beyond any memory, or any patience, once they are expanded.
inline std::vector<std::pair<const char*, std::string>> macro_bombs() {
  const std::string sums = macro_chain("#define a0 1.0+1.0\n", "#define aN aM+aM\n", 40);
  return {
      {"sums of sums", sums + light_that_returns("a39")},
      {"of no tokens at all", macro_chain("#define a0\n", "#define aN aM aM\n", 40) + light_that_returns("1", "a39")},
      {"with parameters",
       macro_chain("#define a0(x) x+x\n", "#define aN(x) aM(x)+aM(x)\n", 40) + light_that_returns("a39(1.0)")},
      {"nested arguments", "#define d(x) x+x\n" + light_that_returns(repeated("d(", 40) + "1.0" + repeated(")", 40))},
      {"nested arguments that are left out", "#define d(x) e(x)\n#define e(x) x,x\n#define g(...) 1.0\n" +
                                                 light_that_returns(repeated("d(", 45) + "1.0" + repeated(")", 45))},
      {"two arguments", "#define d(x,y) d2(x,y)+d2(y,x)\n#define d2(x,y) x+y+x+y\n" +
                            light_that_returns(repeated("d(1.0,", 30) + "1.0" + repeated(")", 30))},
      {"a macro that is handed over", "#define twice(f,x) f(x) f(x)\n#define s(x) x + x +\n" +
                                          macro_chain("#define a0(x) twice(s,x)\n", "#define aN(x) twice(aM,x)\n", 40) +
                                          light_that_returns("a39(1.0) 0.0")},
      {"in a condition",
       macro_chain("#define a0 1+1\n", "#define aN aM+aM\n", 40) + "#if a39\n#endif\n" + light_that_returns("1")},
      {"lines that go on", macro_chain("#define a0 1.0 + \\\n 1.0\n", "#define /* ( */ aN aM \\\n+ aM // a\n", 40) +
                               light_that_returns("a39")},
      {"in a circle", "#define a b b\n#define b c c\n#define c a a\n" + light_that_returns("1", "a")},
      {"behind a definition that does not count",
       "#if 0\n#define a39 1\n#else\n" + sums + "#endif\n" + light_that_returns("a39")},
  };
}

}  // namespace trueshade
