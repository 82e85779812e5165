#include <cmath>
#include <cstdio>

#include "core/json_number.h"
#include "judge/stages/validate.h"

namespace trueshade::oracle {

namespace {

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    char escape[8];
    if (c == '"' || c == '\\') {
      out += '\\', out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      std::snprintf(escape, sizeof escape, "\\u%04x", unsigned(c));
      out += escape;
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string number(double v) {
  if (!std::isfinite(v)) return std::string(json_of_nonfinite(v));
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", v);
  return text;
}

std::string number(uint64_t v) { return std::to_string(v); }

std::string worst_json(const WorstPixel& w) {
  return "{\"x\":" + std::to_string(w.x) + ",\"y\":" + std::to_string(w.y) +
         ",\"class\":" + quoted(text(w.pixel_class)) + ",\"plane\":" + quoted(w.plane) + ",\"low\":" + number(w.low) +
         ",\"high\":" + number(w.high) + ",\"nominal\":" + number(w.nominal) + ",\"given\":" + number(w.given) +
         ",\"note\":" + quoted(w.note) + "}";
}

std::string aggregate_json(const AggregateTest& t, double least_chance) {
  return "{\"name\":" + quoted(t.name) + ",\"observed\":" + number(t.observed) + ",\"low\":" + number(t.low) +
         ",\"high\":" + number(t.high) + ",\"chance\":" + number(t.chance) + ",\"where\":" + quoted(t.where) +
         ",\"pass\":" + (t.passes(least_chance) ? "true" : "false") + "}";
}

template <class List, class Json>
std::string array(const List& list, const Json& json) {
  std::string out = "[";
  for (const auto& item : list) out += (out.size() > 1 ? "," : "") + json(item);
  return out + "]";
}

std::string stage_json(const StageVerdict& s, const Evidence& evidence, double least_chance) {
  const auto test_json = [=](const AggregateTest& t) { return aggregate_json(t, least_chance); };
  std::string counts = "{";
  for (size_t c = 0; c < kPixelClasses; ++c)
    counts += (c > 0 ? "," : "") + quoted(text(PixelClass(c))) + ":" + number(s.counts[c]);
  return "{\"stage\":" + quoted(s.stage) + ",\"width\":" + std::to_string(s.width) +
         ",\"height\":" + std::to_string(s.height) + ",\"counts\":" + counts + "},\"covered\":" + number(s.covered) +
         ",\"ambiguous\":" + number(s.ambiguous) + ",\"predicted_other\":" + number(s.predicted_other) +
         ",\"stored_values\":" + number(s.stored_values) + ",\"worst_error\":" + number(s.worst_error) +
         ",\"rounding\":" + quoted(text(evidence.rule)) + ",\"aggregates\":" + array(evidence.tests, test_json) +
         ",\"worst\":" + array(s.worst, worst_json) + "}";
}

std::string inference_json(const Inference& i) {
  const auto tried = [](const Hypothesis& h) {
    return "{\"knob\":" + quoted(h.knob) + ",\"value\":" + quoted(h.value) +
           ",\"violations\":" + number(h.violations()) + ",\"gbuffer\":" + number(h.surfaces) +
           ",\"lighting\":" + (h.lights ? number(*h.lights) : "null") + "}";
  };
  return "{\"summary\":" + quoted(text(i)) + ",\"known_as\":" + quoted(i.known_as) +
         ",\"nearest\":" + quoted(i.nearest) +
         ",\"subpixel_bits\":" + (i.subpixel_bits ? std::to_string(*i.subpixel_bits) : "null") +
         ",\"snap\":" + (i.snap ? quoted(text(*i.snap)) : "null") +
         ",\"plane_origin\":" + (i.plane_origin ? quoted(text(*i.plane_origin)) : "null") +
         ",\"half\":" + (i.half ? quoted(text(*i.half)) : "null") +
         ",\"unorm_reach\":" + (i.unorm_reach ? number(*i.unorm_reach) : "null") +
         ",\"tried\":" + array(i.tried, tried) + "}";
}

}  // namespace

std::string verdict_json(const Verdict& v) {
  std::string stages = "[";
  for (size_t i = 0; i < v.stages.size(); ++i)
    stages += (i > 0 ? "," : "") + stage_json(v.stages[i], v.evidence[i], v.least_chance(v.stages.size()));
  return "{\"scene\":" + quoted(v.scene) + ",\"driver\":" + quoted(v.driver) + ",\"profile\":" + quoted(v.profile) +
         ",\"pass\":" + (v.violations() == 0 && !v.convicted() ? "true" : "false") +
         ",\"convicted\":" + (v.convicted() ? "true" : "false") +
         ",\"suspicious\":" + (v.suspicious() ? "true" : "false") + ",\"significance\":" + number(v.significance) +
         ",\"evidence\":" + quoted(v.evidence_line()) + ",\"stages\":" + stages +
         "],\"inferred\":" + (v.inferred ? inference_json(*v.inferred) : "null") + "}";
}

}  // namespace trueshade::oracle
