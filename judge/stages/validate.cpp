#include "judge/stages/validate.h"

#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "core/json_number.h"
#include "judge/stages/transparent_layers.h"
#include "scenes/pipeline/transparency.h"

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

std::string aggregate_json(const AggregateTest& t) {
  if (!t.tested) return "{\"name\":" + quoted(t.name) + ",\"tested\":false}";
  return "{\"name\":" + quoted(t.name) + ",\"observed\":" + number(t.observed) + ",\"expected\":" + number(t.expected) +
         ",\"sigma\":" + number(t.sigma) + ",\"pass\":" + (t.passes() ? "true" : "false") + "}";
}

template <class List, class Json>
std::string array(const List& list, const Json& json) {
  std::string out = "[";
  for (const auto& item : list) out += (out.size() > 1 ? "," : "") + json(item);
  return out + "]";
}

std::string stage_json(const StageVerdict& s, const std::vector<AggregateTest>& tests) {
  std::string counts = "{";
  for (size_t c = 0; c < kPixelClasses; ++c)
    counts += (c > 0 ? "," : "") + quoted(text(PixelClass(c))) + ":" + number(s.counts[c]);
  return "{\"stage\":" + quoted(s.stage) + ",\"width\":" + std::to_string(s.width) +
         ",\"height\":" + std::to_string(s.height) + ",\"counts\":" + counts + "},\"covered\":" + number(s.covered) +
         ",\"ambiguous\":" + number(s.ambiguous) + ",\"predicted_other\":" + number(s.predicted_other) +
         ",\"stored_values\":" + number(s.stored_values) + ",\"worst_error\":" + number(s.worst_error) +
         ",\"aggregates\":" + array(tests, aggregate_json) + ",\"worst\":" + array(s.worst, worst_json) + "}";
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

void judge_target(const Scene& scene, const Pipeline& pipeline, const Capture& capture, const ValidateOptions& options,
                  std::vector<StageVerdict>& stages) {
  if (!blends_lights(pipeline.strategy) || !options.steps)
    return stages.push_back(judge_lighting(scene, pipeline, options.profile, capture));
  bool same = true;
  const LightSteps watched = [&](const StepSink& sink) {
    const int last = int(scene.lights.size()) - 1;
    options.steps([&](int light, const Image& target) {
      if (light == last) same = target.texels == capture.color.texels;
      sink(light, target);
    });
  };
  stages.push_back(judge_blending(scene, pipeline, options.profile, capture, watched));
  if (!same) stages.push_back(judge_lighting(scene, pipeline, options.profile, capture));
}

/// The target before transparent surfaces, and then each of them; both together where drawing them again gave another.
void judge_layers(const Scene& scene, const Pipeline& pipeline, const Capture& capture, const ValidateOptions& options,
                  std::vector<StageVerdict>& stages) {
  Capture lit = capture;
  bool same = true;
  const LightSteps watched = [&](const StepSink& sink) {
    options.objects([&](int instance, const Image& target) {
      if (instance < 0) lit.color = target;
      same = target.texels == capture.color.texels;
      sink(instance, target);
    });
  };
  StageVerdict layers = judge_transparency(scene, pipeline, options.profile, capture, watched);
  judge_target(without_transparent(scene), pipeline, lit, options, stages);
  stages.push_back(std::move(layers));
  if (!same) stages.push_back(judge_lighting(scene, pipeline, options.profile, capture));
}

}  // namespace

uint64_t Verdict::violations() const {
  uint64_t count = 0;
  for (const StageVerdict& s : stages) count += s.count(PixelClass::violation);
  return count;
}

bool Verdict::suspicious() const {
  for (const auto& tests : aggregates)
    for (const AggregateTest& t : tests)
      if (!t.passes()) return true;
  return false;
}

Verdict validate_capture(const Scene& scene, const Pipeline& asked, const Capture& capture,
                         const ValidateOptions& options) {
  Pipeline pipeline = asked;
  pipeline.gbuffer = surface_planes(asked);  // forward strategies are judged from float planes of the same surfaces
  Verdict v;
  v.scene = scene.spec, v.driver = capture.driver, v.profile = options.profile.name;
  const auto has = [&](std::string_view name) { return capture.plane(name) != nullptr; };
  const bool geometry = has("depth") || has("position") || has("normal") || has("albedo") || has("uv") ||
                        has("id.object") || has("id.material");
  if (geometry) v.stages.push_back(judge_gbuffer(scene, pipeline, options.profile, capture));
  const bool layers =
      draws_transparent(scene, pipeline) && pipeline.transparency.mode == TransparencyMode::after_lights;
  if (capture.color.width > 0) {
    if (layers && options.objects)
      judge_layers(scene, pipeline, capture, options, v.stages);
    else
      judge_target(scene, pipeline, capture, options, v.stages);
  }
  if (v.stages.empty())
    throw Error(ErrorKind::bad_input, capture.name, "has no planes", "capture the target or a G-buffer plane");
  for (const StageVerdict& s : v.stages) v.aggregates.push_back(aggregate_tests(s));
  if (options.infer && geometry) v.inferred = infer_profile(scene, pipeline, capture);
  return v;
}

std::string verdict_json(const Verdict& v) {
  std::string stages = "[";
  for (size_t i = 0; i < v.stages.size(); ++i) stages += (i > 0 ? "," : "") + stage_json(v.stages[i], v.aggregates[i]);
  return "{\"scene\":" + quoted(v.scene) + ",\"driver\":" + quoted(v.driver) + ",\"profile\":" + quoted(v.profile) +
         ",\"pass\":" + (v.violations() == 0 ? "true" : "false") +
         ",\"suspicious\":" + (v.suspicious() ? "true" : "false") + ",\"stages\":" + stages +
         "],\"inferred\":" + (v.inferred ? inference_json(*v.inferred) : "null") + "}";
}

}  // namespace trueshade::oracle
