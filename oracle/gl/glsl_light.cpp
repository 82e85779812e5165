// The light models as GLSL: docs/arithmetic.md section 8, term by term. Shared by every design.
#include "oracle/gl/glsl.h"

namespace trueshade::oracle {

namespace {

/// pow as GLSL has it, except the exponents 0 and 1, for which pow(0, p) is undefined or wasted.
std::string power(const std::string& base, float exponent) {
  if (exponent == 0.0f) return "1.0";
  if (exponent == 1.0f) return base;
  return "pow(" + base + ", " + glsl_float(exponent) + ")";
}

/// Statements that leave x^p in s, by binary powering.
std::string products_text(int p) {
  std::string text = "  float s = x;\n";
  int bit = 1;
  while (2 * bit <= p) bit *= 2;
  for (bit /= 2; bit > 0; bit /= 2) text += std::string("  s = s * s") + ((p & bit) != 0 ? " * x;\n" : ";\n");
  return text;
}

bool is_even_integer(float value) { return value <= 8192.0f && float(int(value)) == value && int(value) % 2 == 0; }

/// `float s`: the cosine of the half angle to the shininess. An even one needs no square root.
std::string specular_text(const LightModel& m, bool products) {
  std::string text = R"(  vec3 H = L + V;
  float h2 = dot(H, H);
  float t = max(dot(N, H), 0.0);
)";
  const bool even = is_even_integer(m.shininess);
  text += even ? "  float x = h2 > 0.0 ? t * t / h2 : 0.0;\n" : "  float x = h2 > 0.0 ? t / sqrt(h2) : 0.0;\n";
  if (m.renormalize) text += "  x = min(x, 1.0);\n";
  const float exponent = even ? m.shininess / 2 : m.shininess;
  if (products && exponent >= 1.0f && exponent <= 64.0f && exponent == float(int(exponent)))
    return text + products_text(int(exponent)) + (m.specular_masked ? "  s = nl > 0.0 ? s : 0.0;\n" : "");
  const std::string specular = power("x", exponent);
  return text + "  float s = " + (m.specular_masked ? "nl > 0.0 ? " + specular + " : 0.0" : specular) + ";\n";
}

std::string falloff_text(Falloff falloff) {
  switch (falloff) {
    case Falloff::linear_range:
      return "  float f = max(1.0 - d / color.w, 0.0);  // color.w: the range\n";
    case Falloff::quadratic:
      return "  float f = 1.0 / ((1.0 + k.y * d) + (k.z * d) * d);\n";
  }
  return {};
}

/// specular_color 0: the term is 0 whatever the angle, and nothing of it is computed.
bool has_specular(const LightModel& m) { return m.specular_color != glm::vec3(0.0f); }

std::string sum_text(const LightModel& m) {
  if (!has_specular(m)) return "  return albedo * c * (color.rgb * f);\n";
  switch (m.order) {
    case TermOrder::factored:
      return "  return (albedo * c + specular_color * s) * (color.rgb * f);\n";
    case TermOrder::separate:
      return "  return albedo * c * color.rgb * f + color.rgb * s * specular_color * f;\n";
  }
  return {};
}

}  // namespace

std::string surface_text(const LightModel& model) {
  return std::string(model.renormalize ? "  vec3 N = unit(stored_normal);\n" : "  vec3 N = stored_normal;\n") +
         (has_specular(model) ? "  vec3 V = unit(eye - P);\n" : "");
}

std::string light_function_text(const LightModel& m, const GlslOptions& options) {
  std::string text;
  if (has_specular(m))
    text = "const vec3 specular_color = vec3(" + glsl_float(m.specular_color.r) + ", " + glsl_float(m.specular_color.g) +
           ", " + glsl_float(m.specular_color.b) + ");\n";
  text += R"(
// Unit length, and 0 for 0.
vec3 unit(vec3 v) {
  float l2 = dot(v, v);
  return v * (l2 > 0.0 ? inversesqrt(l2) : 0.0);
}

// What one light adds to a pixel. place: position (directional: -direction) and type; color: colour and range.
)";
  const bool quadratic = m.falloff == Falloff::quadratic;
  text += std::string(has_specular(m) ? "vec3 lit(vec3 P, vec3 N, vec3 V, vec3 albedo, vec4 place, vec4 color"
                                      : "vec3 lit(vec3 P, vec3 N, vec3 albedo, vec4 place, vec4 color") +
          (quadratic ? ", vec3 k" : "") + ") {\n";
  if (options.ambient) text += "  if (place.w == 0.0) return albedo * color.rgb;\n";
  text += "  vec3 D = place.xyz - P;\n";
  if (options.directional) text += "  if (place.w == 1.0) D = place.xyz;\n";
  text += "  float d2 = dot(D, D);\n  float r = d2 > 0.0 ? inversesqrt(d2) : 0.0;\n";
  text += "  float d = d2 * r;\n" + falloff_text(m.falloff);
  if (options.directional) text += "  if (place.w == 1.0) { r = 1.0; f = 1.0; }\n";
  text += "  float nl = dot(N, D) * r;\n";
  text += "  vec3 L = D * r;\n  float c = max(nl, 0.0);\n";
  if (has_specular(m)) text += specular_text(m, options.products);
  return text + sum_text(m) + "}\n";
}

}  // namespace trueshade::oracle
