#include "tests/judge/random_light_text.h"

#include <cstdio>
#include <span>

namespace trueshade::testing {

namespace {

constexpr const char* kScalars[] = {"dot(vN, vL)",
                                    "dot(vN, vV)",
                                    "dot(vN, vH)",
                                    "length(vD)",
                                    "length(vD) / l.range",
                                    "s.roughness",
                                    "s.metallic",
                                    "s.albedo.g",
                                    "l.color.r * 0.25",
                                    "s.position.x * 0.1",
                                    "l.position.y * 0.1",
                                    "l.cos_outer",
                                    "float(l.index) * 0.05",
                                    "s.normal.z",
                                    "v.eye.y * 0.1",
                                    "l.attenuation.y",
                                    "l.cone * 0.3",
                                    "float(s.object) * 0.1",
                                    "s.albedo.a",
                                    "v.size.x * 0.01",
                                    "float(s.pixel_x) * 0.02"};
constexpr const char* kVectors[] = {
    "vN", "vL", "vV", "vH", "s.albedo.rgb", "l.direction", "s.normal", "s.position * 0.1", "vD * 0.2", "v.axis"};
// $ a scalar, # a number from 0.1 to 2, @ a vector.
constexpr const char* kOfScalars[] = {"$ + $",
                                      "$ - $",
                                      "$ * $",
                                      "$ * #",
                                      "$ / (1.0 + abs($))",
                                      "max($, $)",
                                      "min($, $)",
                                      "clamp($, -1.0, #)",
                                      "sqrt(abs($) + 0.01)",
                                      "inversesqrt(0.1 + abs($))",
                                      "pow(clamp($, 0.0, 1.0), #)",
                                      "pow(clamp($, 0.001, 1.0), 5.0)",
                                      "exp(-abs($))",
                                      "exp2(-abs($))",
                                      "log(1.0 + abs($))",
                                      "log2(1.5 + abs($))",
                                      "sin($)",
                                      "cos($)",
                                      "smoothstep(0.0, #, $)",
                                      "step(#, $)",
                                      "mix($, $, #)",
                                      "mix($, $, clamp($, 0.0, 1.0))",
                                      "fract($)",
                                      "floor($ * 4.0) * 0.25",
                                      "abs($)",
                                      "-$",
                                      "atan($)",
                                      "atan($, 1.5 + abs($))",
                                      "asin(clamp($, -0.9, 0.9))",
                                      "acos(clamp($, -0.9, 0.9))",
                                      "tanh($)",
                                      "sinh(clamp($, -1.0, 1.0))",
                                      "cosh(clamp($, -1.0, 1.0))",
                                      "asinh($)",
                                      "acosh(1.5 + abs($))",
                                      "atanh(clamp($, -0.5, 0.5))",
                                      "sign($) * 0.5",
                                      "mod($, #)",
                                      "fma($, $, $)",
                                      "$ > # ? $ : $",
                                      "$ < $ ? $ * # : $",
                                      "dot(@, @) * 0.3",
                                      "length(@)",
                                      "distance(@, @)",
                                      "1.0 - $",
                                      "$ * $ * $",
                                      "helper($, @)",
                                      "tan(clamp($, -1.0, 1.0))",
                                      "trunc($ * 3.0) * 0.3",
                                      "float((s.pixel_x * 374761393u + l.index * 2654435761u) >> 8u) * 5.9604645e-8",
                                      "isnan($) ? 0.5 : $",
                                      "s.albedo.r + mix($, $, s.metallic)",
                                      "ceil($ * 2.0) * 0.5",
                                      "radians($ * 40.0)",
                                      "degrees($) * 0.01",
                                      "ldexp($, 1) * 0.25",
                                      "step(0.0, $) * $"};
constexpr const char* kOfVectors[] = {"@ + @",
                                      "@ - @",
                                      "@ * @",
                                      "@ * $",
                                      "normalize(@ + vec3(0.01, 0.02, 3.0))",
                                      "cross(@, @)",
                                      "reflect(@, vN)",
                                      "mix(@, @, clamp($, 0.0, 1.0))",
                                      "max(@, vec3(0.0))",
                                      "clamp(@, vec3(0.0), vec3(1.0))",
                                      "pow(clamp(@, 0.001, 1.0), vec3(#))",
                                      "exp(-abs(@))",
                                      "@ / (vec3(1.0) + abs(@))",
                                      "faceforward(@, vV, vN)",
                                      "vec3($, $, $)",
                                      "@.zxy",
                                      "sqrt(abs(@) + 0.01)",
                                      "mat3(vN, vL, vV) * @ * 0.3",
                                      "@ * mat3(1.0, 0.2, 0.0, 0.1, 1.0, 0.0, 0.3, 0.0, 1.0) * 0.5",
                                      "mix(@, @, vec3(0.25))",
                                      "refract(@, vN, 0.7) * 0.5",
                                      "smoothstep(vec3(-1.0), vec3(1.0), @)",
                                      "sin(@)",
                                      "fract(@)"};

class LightText {
 public:
  explicit LightText(Pcg32& random) : random_(random) {}

  std::string whole() {
    std::string out =
        "float helper(float a, vec3 b) {\n  if (a > 0.25) return a * b.x;\n  return dot(b, vec3(0.2)) - a;\n}\n";
    out +=
        "vec3 light(Surface s, Light l, View v) {\n"
        "  vec3 vD = l.position - s.position, vN = normalize(s.normal + vec3(0.0, 0.0, 1e-3));\n"
        "  if (l.type == light_type_directional) vD = -4.0 * l.direction;\n"
        "  vec3 vL = normalize(vD + vec3(0.0, 1e-3, 0.0)), vV = normalize(v.eye - s.position);\n"
        "  vec3 vH = normalize(vL + vV + vec3(1e-3, 0.0, 0.0));\n";
    for (int i = 0, count = 4 + int(random_.below(10)); i < count; ++i) out += statement();
    out += "  vec3 sum = clamp(" + vector() + " * " + scalar() + " + " + vector() + ", vec3(-1.0), vec3(3.0));\n";
    out += "  return sum * l.color * clamp(1.0 - length(vD) / l.range, 0.0, 1.0);\n}\n";
    if (random_.below(3) == 0) out += "vec3 start(Surface s, View v) { return s.albedo.rgb * 0.05; }\n";
    const uint32_t finish = random_.below(6);
    if (finish == 1) out += "vec4 finish(Surface s, View v, vec3 sum) { return vec4(sum, s.albedo.a * 0.5); }\n";
    if (finish == 2) out += "vec4 finish(Surface s, View v, vec3 sum) { return vec4(sum, s.albedo.a); }\n";
    if (finish == 0)
      out +=
          "vec4 finish(Surface s, View v, vec3 sum) { return vec4(sum / (1.0 + 0.1 * max(sum, vec3(0.0))), "
          "s.albedo.a); }\n";
    if (random_.below(3) == 0)
      out += "bool reaches(Surface s, Light l, View v) { return dot(s.normal, l.position - s.position) > 0.0; }\n";
    return out;
  }

 private:
  template <size_t N>
  const char* any(const char* const (&list)[N]) {
    return list[random_.below(uint32_t(N))];
  }
  std::string number() {
    char text[16];
    std::snprintf(text, sizeof text, "%.3f", random_.between(0.1, 2));
    return text;
  }
  std::string scalar() {
    return scalars_ > 0 && random_.below(3) != 0 ? "f" + std::to_string(random_.below(uint32_t(scalars_)))
                                                 : "(" + std::string(any(kScalars)) + ")";
  }
  std::string vector() {
    return vectors_ > 0 && random_.below(3) != 0 ? "w" + std::to_string(random_.below(uint32_t(vectors_)))
                                                 : "(" + std::string(any(kVectors)) + ")";
  }
  std::string filled(const char* pattern) {
    std::string out;
    for (const char* c = pattern; *c != 0; ++c)
      out += *c == '$' ? scalar() : *c == '@' ? vector() : *c == '#' ? number() : std::string(1, *c);
    return out;
  }

  std::string statement() {
    switch (random_.below(9)) {
      case 0: {  // a loop with a constant end
        const std::string name = "f" + std::to_string(scalars_), body = filled(any(kOfScalars));
        const std::string text = "  float " + name + " = 0.0;\n  for (int i = 0; i < " +
                                 std::to_string(2 + random_.below(4)) + "; ++i) " + name + " = " + name +
                                 " * 0.5 + clamp(" + body + ", -2.0, 2.0) * float(i + 1) * 0.2;\n";
        ++scalars_;
        return text;
      }
      case 1: {  // a branch
        const std::string name = "f" + std::to_string(scalars_), begin = filled(any(kOfScalars));
        const std::string text = "  float " + name + " = clamp(" + begin + ", -4.0, 4.0);\n  if (" + scalar() + " > " +
                                 number() + ") " + name + " = clamp(" + filled(any(kOfScalars)) +
                                 ", -4.0, 4.0); else " + name + " *= " + number() + ";\n";
        ++scalars_;
        return text;
      }
      case 2: {  // an array
        const std::string name = "f" + std::to_string(scalars_), list = "a" + name;
        const std::string text = "  float " + list + "[3] = float[3](" + scalar() + ", " + scalar() + ", " + scalar() +
                                 ");\n  float " + name + " = clamp(" + list + "[int(l.index % 3u)] + " + list +
                                 "[1], -4.0, 4.0);\n";
        ++scalars_;
        return text;
      }
      case 3:
      case 4:
      case 5: {
        const std::string text = "  vec3 w" + std::to_string(vectors_) + " = clamp(" + filled(any(kOfVectors)) +
                                 ", vec3(-4.0), vec3(4.0));\n";
        ++vectors_;
        return text;
      }
      default: {
        const std::string text =
            "  float f" + std::to_string(scalars_) + " = clamp(" + filled(any(kOfScalars)) + ", -4.0, 4.0);\n";
        ++scalars_;
        return text;
      }
    }
  }

  Pcg32& random_;
  int scalars_ = 0, vectors_ = 0;
};

}  // namespace

std::string random_light_text(Pcg32& random) { return LightText(random).whole(); }

}  // namespace trueshade::testing
