#include "explain/account_parts.h"

namespace trueshade {
namespace {

std::string_view type_name(LightType type) {
  constexpr std::string_view kNames[] = {"ambient", "directional", "point", "spot"};
  return kNames[size_t(type)];
}

/// Indices as a reader writes them: "0-3, 7, 9-12".
std::string ranges(const std::vector<size_t>& indices) {
  std::string out;
  for (size_t i = 0; i < indices.size();) {
    size_t end = i + 1;
    while (end < indices.size() && indices[end] == indices[end - 1] + 1) ++end;
    if (!out.empty()) out += ", ";
    out += std::to_string(indices[i]);
    if (end - i > 1) out += '-' + std::to_string(indices[end - 1]);
    i = end;
  }
  return out;
}

void add_light(const ExplainedFrame& frame, const LightRow& row, const LightAtPixel& at, Account& to) {
  const LightModel& model = frame.pipeline.light_model;
  const bool placed = row.type == LightType::point || row.type == LightType::spot;
  to.add("color", row.color, "colour times intensity times damping");
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
    to.add("L", at.L, "unit").add("nl", at.nl, "N . L");
    if (placed) to.add("f", at.f, "falloff");
    if (row.kind == LightKind::coned)
      to.add("cosine", at.cosine, "of the angle to the cone's axis").add("g", at.g, "cone");
    if (at.fate == LightFate::adds) {
      to.add("c", at.c, "diffuse");
      if (model.specular != Specular::none)
        to.add("x", at.x, "what is raised to the shininess").add("s", at.s, "specular");
    }
  }
  if (at.fate == LightFate::adds) to.add("term", at.term, "what the light adds: R, G, B");
}

}  // namespace

Account lights_account(const ExplainedFrame& frame, const LightTotal& total, const std::string& key,
                       LightDetail detail) {
  Account out(key, "Lights (docs/arithmetic.md, sections 8 and 9)");
  const LitPixel& pixel = total.pixel;
  out.add("N", pixel.normal,
          frame.pipeline.light_model.renormalize ? "the normal, made unit" : "the normal as it is read");
  out.add("V", pixel.viewer, "to the viewer");
  out.add("albedo", pixel.albedo, "R, G, B, A");
  if (frame.pipeline.light_model.specular != Specular::none)
    out.add("ks", pixel.specular, "specular colour").add("shininess", pixel.shininess, "");
  out.add("start", pixel.start, "what the sum starts from: emission and ambient light of the scene");
  std::vector<size_t> by_fate[kLightFates];
  for (size_t i = 0; i < total.lights.size(); ++i) by_fate[size_t(total.lights[i].fate)].push_back(i);
  out.add("adding", int64_t(by_fate[0].size()), "lights that add something");
  constexpr const char* kNames[kLightFates] = {"", "out_of_reach", "behind", "outside_cone", "not_drawn"};
  for (size_t fate = 1; fate < kLightFates; ++fate)
    if (!by_fate[fate].empty())
      out.add(kNames[fate], ranges(by_fate[fate]),
              "indices of lights that add nothing: " + std::string(text(LightFate(fate))));
  for (size_t i = 0; i < total.lights.size(); ++i) {
    const LightAtPixel& at = total.lights[i];
    if (at.fate != LightFate::adds && detail == LightDetail::adding) continue;
    const LightRow& row = frame.lights.row[i];
    Account& part = out.part("light", "light " + std::to_string(i) + ", " + std::string(type_name(row.type)) + ": " +
                                          std::string(text(at.fate)));
    part.add("light", int64_t(i), "index").add("fate", std::string(text(at.fate)), "");
    add_light(frame, row, at, part);
  }
  const bool blended = blends_lights(frame.pipeline.strategy) && key == "lights";
  if (!blended)
    out.part("sum", "The sum, lights added in the order of their indices")
        .add("sum", total.sum, "R, G, B, A as the target receives them");
  return out;
}

}  // namespace trueshade
