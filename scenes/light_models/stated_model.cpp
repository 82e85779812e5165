#include "scenes/light_models/stated_model.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <string_view>
#include <vector>

#include "core/sha256.h"
#include "scenes/light_models/terms.h"
#include "scenes/pipeline/pipeline_words.h"

namespace trueshade {
namespace {

using Terms = std::set<std::string, std::less<>>;

/// A literal that reads back as the same float.
std::string literal(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", double(value));
  std::string out = text;
  return out.find_first_of(".e") == std::string::npos ? out + ".0" : out;
}

std::string literal(const glm::vec3& v) {
  return "vec3(" + literal(v.x) + ", " + literal(v.y) + ", " + literal(v.z) + ")";
}

/// A function of x^p, by squaring.
std::string whole_power_text(int p) {
  std::string text = "float whole_power(float x) {\n  float s = x;\n";
  int bit = 1;
  while (2 * bit <= p) bit *= 2;
  for (bit /= 2; bit > 0; bit /= 2) text += std::string("  s = s * s") + ((p & bit) != 0 ? " * x;\n" : ";\n");
  return text + "  return s;\n}\n";
}

bool is_even(float shininess) { return shininess <= 8192.0f && std::fmod(shininess, 2.0f) == 0.0f; }
bool is_squared(const LightModel& m) { return m.specular == Specular::blinn_phong && is_even(m.shininess); }
/// What the cosine, or its square, is raised to.
float power_of(const LightModel& m, bool squared) { return squared ? m.shininess / 2 : m.shininess; }

/// The names behind `#ifdef` that hold for a model.
Terms terms_of(const LightModel& m, Spelling spelling) {
  using namespace pipeline_words;
  const bool shines = m.specular != Specular::none, own = reads_specular_plane(m);
  const bool tinted = shines && m.specular_source == SpecularSource::albedo;
  const bool lights_behind =
      m.order == TermOrder::with_ambient || m.diffuse == Diffuse::unclamped || (shines && !m.specular_masked);
  Terms terms{"falloff_" + std::string(kFalloffs[size_t(m.falloff)]), "order_" + std::string(kOrders[size_t(m.order)]),
              "diffuse_" + std::string(kDiffuses[size_t(m.diffuse)]), "cone_" + std::string(kCones[size_t(m.cone)])};
  const auto add = [&terms](bool holds, const char* name) {
    if (holds) terms.insert(name);
  };
  add(m.renormalize, "renormalize");
  add(m.damping != 1.0f, "damped");
  add(m.cone != Cone::none, "coned");
  add(m.cone == Cone::smooth_cutoff || m.cone == Cone::smooth_penumbra, "cone_smooth");
  add(m.viewer == Viewer::local, "viewer_local");
  add(shines, "shines");
  add(m.specular == Specular::phong, "specular_phong");
  add(m.specular == Specular::phong && m.diffuse == Diffuse::clamped, "diffuse_at_most_1");
  add(own, "own_gloss");
  add(shines && !own && !tinted, "own_color");
  add(tinted, "shines_by_albedo");
  const bool usual = spelling == Spelling::as_renderers_write, driven = spelling >= Spelling::for_drivers;
  const bool squared = !own && !usual && is_squared(m);
  const float power = power_of(m, squared);
  add(usual, "as_renderers_write");
  add(driven, "for_drivers");
  add(!driven, "defines_reaches");
  add(shines && squared, "squared");
  add(shines && !usual && !squared && (!own || driven), "not_squared");
  add(shines && own && !usual && !driven, "by_own_power");
  add(shines && m.specular_masked && (lights_behind || driven), "masked_behind");
  add(!lights_behind && !driven, "dark_behind");
  const bool whole = power >= 1 && power <= (spelling == Spelling::in_products ? 64 : 1) && power == std::floor(power);
  add(shines && !own && driven && whole, "products");
  add((shines && !terms.contains("products")) || m.cone == Cone::exponent, "powers");
  add(m.emission, "emission");
  add(m.global_ambient != glm::vec3(0.0f), "global_ambient_given");
  add(m.emission || m.global_ambient != glm::vec3(0.0f), "starts");
  add(m.order == TermOrder::albedo_last || m.clamp_result, "finishes");
  add(m.alpha_from_albedo, "alpha_from_albedo");
  add(m.clamp_result, "clamp_result");
  return terms;
}

/// The model's numbers, as far as its terms read them.
std::string constants_of(const LightModel& m, const Terms& terms) {
  std::string text;
  const auto add = [&](const char* type, const char* name, const std::string& value) {
    text += "const " + std::string(type) + " " + name + " = " + value + ";\n";
  };
  if (terms.contains("shines") && !terms.contains("own_gloss"))
    add("float", "power", literal(power_of(m, terms.contains("squared"))));
  if (terms.contains("own_color")) add("vec3", "specular_color", literal(m.specular_color));
  if (terms.contains("damped")) add("float", "damping", literal(m.damping));
  if (terms.contains("global_ambient_given")) add("vec3", "global_ambient", literal(m.global_ambient));
  if (terms.contains("products")) text += whole_power_text(int(power_of(m, terms.contains("squared"))));
  return text.empty() ? text : text + "\n";
}

/// The lines of a text whose conditions hold, of `#ifdef NAME`, `#else` and `#endif`, which are left out themselves.
std::string chosen_lines(std::string_view text, const Terms& terms) {
  std::string out;
  std::vector<bool> holds;
  while (!text.empty()) {
    const size_t end = text.find('\n') + 1;
    const std::string_view line = text.substr(0, end), word = line.substr(0, line.find_first_of(" \n"));
    text.remove_prefix(end);
    if (word == "#ifdef")
      holds.push_back(terms.contains(line.substr(7, line.size() - 8)));
    else if (word == "#else")
      holds.back() = !holds.back();
    else if (word == "#endif")
      holds.pop_back();
    else if (std::find(holds.begin(), holds.end(), false) == holds.end())
      out += line;
  }
  return out;
}

/// Behind the comment at the head, which is about the choice of terms.
std::string_view below_the_head(std::string_view text) { return text.substr(text.find("\n\n") + 2); }

}  // namespace

LightProgram program_of(const LightModel& model, const std::string& name, Spelling spelling) {
  const Terms terms = terms_of(model, spelling);
  const std::string text = constants_of(model, terms) + chosen_lines(below_the_head(kLightTerms), terms);
  return {name, text, sha256_of(text), {}};
}

}  // namespace trueshade
