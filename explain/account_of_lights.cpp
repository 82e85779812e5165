#include <algorithm>
#include <cmath>
#include <optional>

#include "explain/account_parts.h"
#include "shading/light/power.h"

namespace trueshade {
namespace {

constexpr size_t kMostListed = 64;

std::string_view type_name(LightType type) {
  switch (type) {
    case LightType::ambient:
      return "ambient";
    case LightType::directional:
      return "directional";
    case LightType::point:
      return "point";
    case LightType::spot:
      return "spot";
  }
  return {};  // unreachable: every enumerator returns above
}

/// Names of what a light that adds nothing is listed under.
const char* list_name(LightFate fate) {
  switch (fate) {
    case LightFate::out_of_reach:
      return "out_of_reach";
    case LightFate::faces_away:
      return "behind";
    case LightFate::outside_cone:
      return "outside_cone";
    case LightFate::gives_nothing:
      return "gives_nothing";
    default:
      return "not_drawn";
  }
}

/// What the shininess makes of the cosine: the exponent, and what it is of.
void add_power(const LightModel& model, const LitPixel& pixel, const LightAtPixel& at, Account& to) {
  const bool blinn = model.specular == Specular::blinn_phong;
  const Exponent exponent = exponent_of(pixel.shininess, blinn ? PowerBase::square_if_even : PowerBase::cosine);
  to.add("x", at.x,
         exponent.squared ? "the squared cosine of N and the half vector"
         : blinn          ? "the cosine of N and the half vector"
                          : "the cosine of the reflected and the viewer's direction");
  to.add("p", exponent.value, "its exponent");
  to.add("s", at.s, "specular: x to the power p");
}

/// The numbers of a light as far as they were computed: a light that is out of reach has no direction.
void add_light(const LightModel& model, const LightRow& row, const LitPixel& pixel, const LightAtPixel& at,
               Account& to) {
  const bool placed = row.type == LightType::point || row.type == LightType::spot;
  to.add("color", row.color, "colour times intensity times damping");
  if (placed && std::isfinite(row.range)) to.add("range", row.range, "scene units");
  if (row.type != LightType::ambient) {
    to.add("D", at.D, placed ? "from the surface to the light, scene units" : "to the light, of unit length");
    if (placed) to.add("d2", at.d2, "squared distance").add("d", at.d, "distance, scene units");
    to.add("a", at.a, "N . D");
  }
  if (at.fate == LightFate::out_of_reach) {
    to.add("end", row.cut2, "squared distance from which this light adds nothing");
    return;
  }
  if (row.type != LightType::ambient) {
    if (placed) to.add("r", at.r, "1 / d");
    to.add("L", at.L, "unit").add("nl", at.nl, "N . L");
    if (placed) to.add("f", at.f, "falloff");
  }
  if (at.fate == LightFate::faces_away) return;
  if (row.kind == LightKind::coned && model.cone != Cone::none)
    to.add("cosine", at.cosine, "of the angle to the cone's axis").add("g", at.g, "cone");
  if (at.fate == LightFate::outside_cone) return;
  if (row.type != LightType::ambient) {
    to.add("c", at.c, "diffuse");
    if (model.specular != Specular::none) add_power(model, pixel, at, to);
  }
  to.add("term", at.term, at.fate == LightFate::adds ? "what the light adds: R, G, B" : "what it would add: R, G, B");
}

/// What the lights of a model read.
void add_surface(const LightModel& model, const LitPixel& pixel, Account& to) {
  to.add("N", pixel.normal, model.renormalize ? "the normal, made unit" : "the normal as it is read");
  to.add("V", pixel.viewer, "to the viewer");
  to.add("albedo", pixel.albedo, "R, G, B, A");
  if (model.specular != Specular::none)
    to.add("ks", pixel.specular, "specular colour").add("shininess", pixel.shininess, "");
  to.add("start", pixel.start, "what the sum starts from: emission and ambient light of the scene");
}

/// The light that adds most; none where no light adds something.
std::optional<size_t> strongest(const LightTotal& total) {
  std::optional<size_t> out;
  for (size_t i = 0; i < total.lights.size(); ++i)
    if (total.lights[i].fate == LightFate::adds && (!out || strength(total.lights[i]) > strength(total.lights[*out])))
      out = i;
  return out;
}

/// The lights that are parts: all, or those that add most, in the order of their indices.
std::vector<size_t> listed(const LightTotal& total, Detail detail) {
  std::vector<size_t> out;
  for (size_t i = 0; i < total.lights.size(); ++i)
    if (detail == Detail::all || total.lights[i].fate == LightFate::adds) out.push_back(i);
  if (detail == Detail::all || out.size() <= kMostListed) return out;
  std::stable_sort(out.begin(), out.end(),
                   [&](size_t a, size_t b) { return strength(total.lights[a]) > strength(total.lights[b]); });
  out.resize(kMostListed);
  std::sort(out.begin(), out.end());
  return out;
}

void add_lists(const LightTotal& total, Account& to) {
  std::vector<int64_t> by_fate[kLightFates];
  for (size_t i = 0; i < total.lights.size(); ++i) by_fate[size_t(total.lights[i].fate)].push_back(int64_t(i));
  to.add("adding", int64_t(by_fate[size_t(LightFate::adds)].size()), "lights that add something");
  for (const LightFate fate : {LightFate::out_of_reach, LightFate::faces_away, LightFate::outside_cone,
                               LightFate::not_drawn, LightFate::gives_nothing}) {
    const std::vector<int64_t>& lights = by_fate[size_t(fate)];
    if (lights.empty()) continue;
    to.add(list_name(fate), lights, "indices of lights that add nothing: " + std::string(text(fate)));
    to.quantities.back().shown = index_ranges(lights);
  }
}

}  // namespace

Account lights_account(const ExplainedFrame& frame, const LightTotal& total, LightsReach reach, const std::string& of,
                       Detail detail) {
  const LightModel& model = frame.pipeline.light_model;
  const bool by_program = total.program != nullptr;
  Account out("lights", "Lights on " + of +
                            (by_program ? " (docs/light_programs.md)" : " (docs/arithmetic.md, sections 8 and 9)"));
  if (by_program && total.program->is_unlit()) {
    out.add("unlit", total.pixel.albedo, "its albedo R, G, B, A is shown, and the program is not asked");
    return out;
  }
  if (by_program)
    add_program(frame, total, detail, out);
  else
    add_surface(model, total.pixel, out);
  add_lists(total, out);
  const std::vector<size_t> shown = listed(total, detail);
  if (detail == Detail::usual && shown.size() == kMostListed)
    out.add("shown", int64_t(shown.size()), "lights that add most; --all prints all");
  for (const size_t i : shown) {
    const LightRow& row = total.table->row[i];
    const LightAtPixel& at = total.lights[i];
    Account& part = out.part("light", "light " + std::to_string(i) + ", " + std::string(type_name(row.type)) + ": " +
                                          std::string(text(at.fate)));
    part.add("light", int64_t(i), "index").add("fate", std::string(text(at.fate)), "");
    if (by_program)
      add_program_light(frame, total, i,
                        detail == Detail::all || i == strongest(total) ? ProgramLines::told : ProgramLines::left_out,
                        detail, part);
    else
      add_light(model, row, total.pixel, at, part);
  }
  if (reach == LightsReach::one_by_one) return out;
  Account& sum = out.part("sum", "The sum, lights added in the order of their indices");
  if (by_program) add_program_sum(frame, total, detail, sum);
  sum.add("sum", total.sum, "R, G, B, A as the target receives them");
  return out;
}

}  // namespace trueshade
