#include "core/json_number.h"
#include "core/json_string.h"
#include "judge/stages/validate.h"

namespace trueshade::oracle {

namespace {

std::string number(double v) { return json_in_nine_digits(v); }
std::string number(uint64_t v) { return std::to_string(v); }

std::string worst_json(const WorstPixel& w) {
  return "{\"x\":" + std::to_string(w.x) + ",\"y\":" + std::to_string(w.y) +
         ",\"class\":" + json_string(text(w.pixel_class)) + ",\"plane\":" + json_string(w.plane) +
         ",\"low\":" + number(w.low) + ",\"high\":" + number(w.high) + ",\"nominal\":" + number(w.nominal) +
         ",\"given\":" + number(w.given) + ",\"note\":" + json_string(w.note) + "}";
}

std::string window_json(const LocalWindow& w) {
  return "{\"side\":" + std::to_string(w.side) + ",\"x\":" + std::to_string(w.x) + ",\"y\":" + std::to_string(w.y) +
         ",\"width\":" + std::to_string(w.width) + ",\"height\":" + std::to_string(w.height) +
         ",\"pixels\":" + number(w.seen) + ",\"violations\":" + number(w.found) + ",\"other\":" + number(w.others) +
         ",\"mean_excess\":" + number(w.mean()) + ",\"largest_excess\":" + number(w.largest) + "}";
}

std::string aggregate_json(const AggregateTest& t, double least_chance) {
  return "{\"name\":" + json_string(t.name) + ",\"observed\":" + number(t.observed) + ",\"low\":" + number(t.low) +
         ",\"high\":" + number(t.high) + ",\"chance\":" + number(t.chance) + ",\"where\":" + json_string(t.where) +
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
    counts += (c > 0 ? "," : "") + json_string(text(PixelClass(c))) + ":" + number(s.counts[c]);
  return "{\"stage\":" + json_string(s.stage) + ",\"width\":" + std::to_string(s.width) +
         ",\"height\":" + std::to_string(s.height) + ",\"counts\":" + counts + "},\"left_out\":" + number(s.left_out) +
         ",\"covered\":" + number(s.covered) + ",\"ambiguous\":" + number(s.ambiguous) +
         ",\"predicted_other\":" + number(s.predicted_other) + ",\"stored_values\":" + number(s.stored_values) +
         ",\"worst_error\":" + number(s.worst_error) + ",\"power\":" + number(s.power) +
         ",\"rounding\":" + json_string(text(evidence.rule)) +
         ",\"aggregates\":" + array(evidence.tests, test_json) +
         ",\"windows\":" + array(worst_windows(s), window_json) + ",\"worst\":" + array(s.worst, worst_json) + "}";
}

std::string material_json(const MaterialEvidence& m) {
  return "{\"stage\":" + json_string(m.stage) + ",\"material\":" + std::to_string(m.material) +
         ",\"plane\":" + json_string(m.plane) + ",\"map\":" + json_string(m.map) +
         ",\"cause\":" + json_string(m.cause) + ",\"value\":" + number(m.value) + ",\"error\":" + number(m.error) +
         ",\"least\":" + number(m.least) + ",\"pass\":" + (m.against ? "false" : "true") + "}";
}

std::string inference_json(const Inference& i) {
  const auto tried = [](const Hypothesis& h) {
    return "{\"knob\":" + json_string(h.knob) + ",\"value\":" + json_string(h.value) +
           ",\"violations\":" + number(h.violations()) + ",\"gbuffer\":" + number(h.surfaces) +
           ",\"lighting\":" + (h.lights ? number(*h.lights) : "null") + "}";
  };
  return "{\"summary\":" + json_string(text(i)) + ",\"known_as\":" + json_string(i.known_as) +
         ",\"nearest\":" + json_string(i.nearest) +
         ",\"subpixel_bits\":" + (i.subpixel_bits ? std::to_string(*i.subpixel_bits) : "null") +
         ",\"snap\":" + (i.snap ? json_string(text(*i.snap)) : "null") +
         ",\"plane_origin\":" + (i.plane_origin ? json_string(text(*i.plane_origin)) : "null") +
         ",\"half\":" + (i.half ? json_string(text(*i.half)) : "null") +
         ",\"unorm_reach\":" + (i.unorm_reach ? number(*i.unorm_reach) : "null") +
         ",\"sampled_rows\":" + std::to_string(i.sampled_rows) + ",\"tried\":" + array(i.tried, tried) + "}";
}

}  // namespace

std::string verdict_json(const Verdict& v) {
  std::string stages = "[";
  for (size_t i = 0; i < v.stages.size(); ++i)
    stages += (i > 0 ? "," : "") + stage_json(v.stages[i], v.evidence[i], v.least_chance(v.stages.size()));
  return "{\"scene\":" + json_string(v.scene) + ",\"driver\":" + json_string(v.driver) +
         ",\"profile\":" + json_string(v.profile) +
         ",\"pass\":" + (v.violations() == 0 && !v.convicted() ? "true" : "false") +
         ",\"convicted\":" + (v.convicted() ? "true" : "false") +
         ",\"suspicious\":" + (v.suspicious() ? "true" : "false") + ",\"significance\":" + number(v.significance) +
         ",\"evidence\":" + json_string(v.evidence_line()) + ",\"stages\":" + stages +
         "],\"materials\":" + array(v.materials, material_json) +
         ",\"inferred\":" + (v.inferred ? inference_json(*v.inferred) : "null") + "}";
}

}  // namespace trueshade::oracle
