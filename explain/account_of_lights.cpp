#include <algorithm>
#include <optional>

#include "explain/account_parts.h"

namespace trueshade {
namespace {

constexpr size_t kMostLightsListed = 64;

/// The name of the quantity that lists the lights of this fate, which add nothing.
const char* list_name(LightFate fate) {
  switch (fate) {
    case LightFate::out_of_reach:
      return "out_of_reach";
    case LightFate::faces_away:
      return "behind";
    case LightFate::outside_cone:
      return "outside_cone";
    case LightFate::behind_light:
      return "behind_light";
    case LightFate::gives_nothing:
      return "gives_nothing";
    default:
      return "not_drawn";
  }
}

/// The light that adds most; none where no light adds something.
std::optional<size_t> strongest(const LightTotal& total) {
  std::optional<size_t> out;
  for (size_t i = 0; i < total.lights.size(); ++i)
    if (total.lights[i].fate == LightFate::adds && (!out || strength(total.lights[i]) > strength(total.lights[*out])))
      out = i;
  return out;
}

/// The lights that get a part of their own, by ascending index: all, or those that add something, of which the 64 that
/// add most.
std::vector<size_t> listed(const LightTotal& total, Detail detail) {
  std::vector<size_t> out;
  for (size_t i = 0; i < total.lights.size(); ++i)
    if (detail == Detail::all || total.lights[i].fate == LightFate::adds) out.push_back(i);
  if (detail == Detail::all || out.size() <= kMostLightsListed) return out;
  std::stable_sort(out.begin(), out.end(),
                   [&](size_t a, size_t b) { return strength(total.lights[a]) > strength(total.lights[b]); });
  out.resize(kMostLightsListed);
  std::sort(out.begin(), out.end());
  return out;
}

/// Adds how many lights add something, and for each other fate the indices of the lights that have it, if there are
/// any.
void add_lists(const LightTotal& total, Account& to) {
  std::vector<int64_t> by_fate[kLightFates];
  for (size_t i = 0; i < total.lights.size(); ++i) by_fate[size_t(total.lights[i].fate)].push_back(int64_t(i));
  to.add("adding", int64_t(by_fate[size_t(LightFate::adds)].size()), "lights that add something");
  for (const LightFate fate : {LightFate::out_of_reach, LightFate::faces_away, LightFate::outside_cone,
                               LightFate::behind_light, LightFate::not_drawn, LightFate::gives_nothing}) {
    const std::vector<int64_t>& lights = by_fate[size_t(fate)];
    if (lights.empty()) continue;
    to.add(list_name(fate), lights, "indices of lights that add nothing: " + std::string(text(fate)));
    to.quantities.back().shown = index_ranges(lights);
  }
}

}  // namespace

Account lights_account(const ExplainedFrame& frame, const LightTotal& total, LightsReach reach, const std::string& of,
                       Detail detail) {
  const bool is_stated = !frame.pipeline.light_program.used();
  Account out("lights",
              "Lights on " + of + (is_stated ? " (docs/arithmetic.md, section 8)" : " (docs/light_programs.md)"));
  if (total.program->is_unlit()) {
    out.add("unlit", total.surface.albedo, "its albedo R, G, B, A is shown, and the program is not asked");
    return out;
  }
  add_program(frame, total, detail, out);
  add_lists(total, out);
  const std::vector<size_t> shown = listed(total, detail);
  if (detail == Detail::usual && shown.size() == kMostLightsListed)
    out.add("shown", int64_t(shown.size()), "lights that add most; --all prints all");
  for (const size_t i : shown) {
    const LightAtPixel& at = total.lights[i];
    const LightType type = total.table->row[i].type;
    Account& part = out.part(
        "light", "light " + std::to_string(i) + ", " + std::string(name_of(type)) + ": " + std::string(text(at.fate)));
    part.add("light", int64_t(i), "index").add("fate", std::string(text(at.fate)), "");
    const bool tells_lines = detail == Detail::all || i == strongest(total);
    add_program_light(frame, total, i, tells_lines ? ProgramLines::told : ProgramLines::left_out, detail, part);
  }
  if (reach == LightsReach::one_by_one) return out;
  Account& sum = out.part("sum", "The sum, lights added in the order of their indices");
  add_program_sum(frame, total, detail, sum);
  sum.add("sum", total.sum, "R, G, B, A as the target receives them");
  return out;
}

}  // namespace trueshade
