// The light models as GLSL: docs/arithmetic.md section 8, term by term. Shared by every design.
#include <limits>

#include "gl/emit/glsl.h"

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

/// `float x`: the cosine to be powered, or its square, and the exponent that then belongs to it.
std::string cosine_text(const LightModel& m, float& exponent) {
  if (m.specular == Specular::phong)
    return "  vec3 R = (2.0 * min(max(nl, 0.0), 1.0)) * N - L;\n  float x = clamp(dot(R, V), 0.0, 1.0);\n";
  std::string text = "  vec3 H = L + V;\n  float h2 = dot(H, H);\n  float t = max(dot(N, H), 0.0);\n";
  const bool even = !reads_specular_plane(m) && is_even_integer(m.shininess);  // needs no square root
  text += even ? "  float x = h2 > 0.0 ? t * t / h2 : 0.0;\n" : "  float x = h2 > 0.0 ? t / sqrt(h2) : 0.0;\n";
  if (even) exponent = m.shininess / 2;
  return m.renormalize ? text + "  x = min(x, 1.0);\n" : text;
}

/// `float s`: the cosine of the half angle, or to the reflected ray, to the shininess.
std::string specular_text(const LightModel& m, bool products) {
  if (m.specular == Specular::none) return {};
  float exponent = m.shininess;
  const std::string text = cosine_text(m, exponent);
  const bool whole = exponent >= 1.0f && exponent <= 64.0f && exponent == float(int(exponent));
  if (products && whole && !reads_specular_plane(m))
    return text + products_text(int(exponent)) + (m.specular_masked ? "  s = nl > 0.0 ? s : 0.0;\n" : "");
  const std::string specular =
      reads_specular_plane(m) ? "(gloss.a == 0.0 ? 1.0 : pow(x, gloss.a))" : power("x", exponent);
  return text + "  float s = " + (m.specular_masked ? "nl > 0.0 ? " + specular + " : 0.0" : specular) + ";\n";
}

std::string falloff_text(Falloff falloff) {
  switch (falloff) {
    case Falloff::linear_range:
      return "  float f = max(1.0 - d / color.w, 0.0);  // color.w: the range\n";
    case Falloff::quadratic:
      return "  float f = 1.0 / ((1.0 + k.y * d) + (k.z * d) * d);\n";
    case Falloff::none:
      return "  float f = 1.0;\n";
    case Falloff::linear:
      return "  float f = 1.0 - d / color.w;  // color.w: the range\n";
    case Falloff::attenuation:
      return "  float f = min(1.0 / ((k.x + k.y * d) + (k.z * d) * d), 1e18);\n";
    case Falloff::inverse_square:
      return "  float u = d2 / (color.w * color.w);  // color.w: the range\n"
             "  float f = d < color.w ? max(1.0 - u * u, 0.0) * min(r * r, 1e18) : 0.0;\n";
  }
  return {};
}

/// Multiplies `f` by the cone of a spot light. cone: what light_records() says.
std::string cone_text(Cone cone) {
  std::string factor;
  switch (cone) {
    case Cone::none:
      return {};
    case Cone::smooth_cutoff:
    case Cone::smooth_penumbra:
      factor = "(cone.x < cone.y ? smoothstep(cone.x, cone.y, a) : a > cone.x ? 1.0 : 0.0)";
      break;
    case Cone::exponent:
      factor = "(a >= cone.x ? (cone.y == 0.0 ? 1.0 : pow(max(a, 0.0), cone.y)) : 0.0)";
      break;
    case Cone::squared_penumbra:
      factor = "b * b";
      break;
  }
  return std::string("  if (place.w == 3.0) {\n    float a = dot(L, -axis);\n") +
         (cone == Cone::squared_penumbra ? "    float b = clamp(a * cone.x + cone.y, 0.0, 1.0);\n" : "") +
         "    f = f * " + factor + ";\n  }\n";
}

/// `vec3 added`: what the light adds where its distance is a number.
std::string sum_text(const LightModel& m) {
  const bool none = m.specular == Specular::none, albedo = m.specular_source == SpecularSource::albedo;
  const std::string ks = albedo ? "albedo" : reads_specular_plane(m) ? "gloss.rgb" : "specular_color";
  const std::string reflected = none ? "albedo * c" : albedo ? "albedo * (c + s)" : "(albedo * c + " + ks + " * s)";
  const std::string added = "  vec3 added = ";
  switch (m.order) {
    case TermOrder::factored:
      return added + reflected + " * (color.rgb * f);\n";
    case TermOrder::separate:
      return added + "albedo * c * color.rgb * f" + (none ? std::string() : " + color.rgb * s * " + ks + " * f") +
             ";\n";
    case TermOrder::albedo_last:
      return added + (none ? "(c * f)" : "((c + s) * f)") + " * color.rgb;\n";
    case TermOrder::with_ambient:
      return added + "(albedo * ambient + " + reflected + " * color.rgb) * f;\n";
  }
  return {};
}

std::string parameters_text(const LightModel& m) {
  const LightLayout layout(m);
  return std::string(reads_specular_plane(m) ? ", vec4 gloss" : "") + (m.emission ? ", float arriving" : "") +
         ", vec4 place, vec4 color" + (layout.attenuation ? ", vec3 k" : "") +
         (layout.cone ? ", vec3 axis, vec3 cone" : "") + (layout.ambient ? ", vec3 ambient" : "");
}

std::string vector_text(const glm::vec3& v) {
  return "vec3(" + glsl_float(v.r) + ", " + glsl_float(v.g) + ", " + glsl_float(v.b) + ")";
}

}  // namespace

LightLayout::LightLayout(const LightModel& model)
    : attenuation(model.falloff == Falloff::quadratic || model.falloff == Falloff::attenuation),
      cone(model.cone != Cone::none),
      ambient(model.order == TermOrder::with_ambient) {}

std::string surface_text(const LightModel& model) {
  return std::string(model.renormalize ? "  vec3 N = unit(stored_normal);\n" : "  vec3 N = stored_normal;\n") +
         (model.viewer == Viewer::local ? "  vec3 V = unit(eye - P);\n" : "  vec3 V = view_axis;\n");
}

std::string sum_start_text(const LightModel& model) {
  const bool ambient = model.global_ambient != glm::vec3(0.0f);
  std::string start = model.emission ? "emission.rgb" : ambient ? "" : "vec3(0.0)";
  if (!ambient) return start;
  if (model.emission) start += " + ";
  return start + (model.order == TermOrder::albedo_last ? "" : "albedo.rgb * ") + vector_text(model.global_ambient) +
         (model.emission ? " * emission.a" : "");
}

std::string target_text(const LightModel& model, const std::string& sum) {
  const std::string rgb = model.order == TermOrder::albedo_last ? "(" + sum + ") * albedo.rgb" : sum;
  const std::string rgba = "vec4(" + rgb + (model.alpha_from_albedo ? ", albedo.a)" : ", 1.0)");
  return "  target = " + (model.clamp_result ? "clamp(" + rgba + ", 0.0, 1.0)" : rgba) + ";\n";
}

std::string light_function_text(const LightModel& m, const GlslOptions& options) {
  std::string text = "const vec3 specular_color = " + vector_text(m.specular_color) + ";\n" + R"(
// Unit length, and 0 for 0.
vec3 unit(vec3 v) {
  float l2 = dot(v, v);
  return v * (l2 > 0.0 ? inversesqrt(l2) : 0.0);
}

// What one light adds to a pixel. place: position (directional: -direction) and type; color: colour and range.
)";
  text += "vec3 lit(vec3 P, vec3 N, vec3 V, vec3 albedo" + parameters_text(m) + ") {\n";
  if (options.ambient)
    text += std::string("  if (place.w == 0.0) return ") +
            (m.order == TermOrder::albedo_last ? "color.rgb" : "albedo * color.rgb") +
            (m.emission ? " * arriving;\n" : ";\n");
  text += "  vec3 D = place.xyz - P;\n";
  if (options.directional) text += "  if (place.w == 1.0) D = place.xyz;\n";
  text += "  float d2 = dot(D, D);\n  float r = d2 > 0.0 ? inversesqrt(d2) : 0.0;\n";
  text += "  float d = d2 * r;\n" + falloff_text(m.falloff);
  if (options.directional) text += "  if (place.w == 1.0) { r = 1.0; f = 1.0; }\n";
  text += "  float nl = dot(N, D) * r;\n";
  text += "  vec3 L = D * r;\n" + cone_text(m.cone);
  text += m.diffuse == Diffuse::unclamped ? "  float c = nl;\n"
          : m.specular == Specular::phong ? "  float c = clamp(nl, 0.0, 1.0);\n"
                                          : "  float c = max(nl, 0.0);\n";
  return text + specular_text(m, options.products) + sum_text(m) +
         "  return d2 <= " + glsl_float(std::numeric_limits<float>::max()) +
         " ? added : vec3(0.0);  // 0 where the distance is not finite\n}\n";
}

}  // namespace trueshade::oracle
