#include "judge/stages/validate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "core/error.h"
#include "judge/bounds/program_bounds.h"
#include "judge/stages/transparent_layers.h"
#include "scenes/pipeline/program_inputs.h"
#include "scenes/pipeline/transparency.h"

namespace trueshade::oracle {

namespace {

/// A stage as it was judged, and how to judge it by another rule of stores.
struct Stage {
  StageVerdict verdict;
  std::function<StageVerdict(const Profile&)> judge;
};

class Validation {
 public:
  Validation(const Scene& scene, const Pipeline& pipeline, const Capture& capture, const ValidateOptions& options)
      : scene_(scene), pipeline_(pipeline), capture_(capture), options_(options) {}

  std::vector<Stage> stages() {
    const auto has = [&](std::string_view name) { return capture_.plane(name) != nullptr; };
    begin("the surfaces");
    if (options_.surfaces && (has("depth") || has("position") || has("normal") || has("albedo") || has("uv") ||
                              has("id.object") || has("id.material")))
      add_surfaces();
    const bool layers =
        draws_transparent(scene_, pipeline_) && pipeline_.transparency.mode == TransparencyMode::after_lights;
    begin("the lights");
    if (capture_.color.width > 0) {
      if (layers && options_.objects)
        judge_layers();
      else
        judge_target(scene_, capture_);
    }
    return std::move(stages_);
  }

  /// What the judgement of the surfaces found, where a profile is to be inferred.
  JudgedBefore before() { return {options_.profile, std::move(surfaces_), nullptr}; }

 private:
  void begin(const char* part) const {
    if (options_.begins) options_.begins(part);
  }

  void add(std::function<StageVerdict(const Profile&)> judge) {
    StageVerdict verdict = judge(options_.profile);
    stages_.push_back({std::move(verdict), std::move(judge)});
  }

  void add_surfaces() {
    StageVerdict verdict =
        judge_gbuffer(scene_, pipeline_, options_.profile, capture_, {}, options_.infer ? &surfaces_ : nullptr);
    stages_.push_back(
        {std::move(verdict), [this](const Profile& p) { return judge_gbuffer(scene_, pipeline_, p, capture_); }});
  }

  void judge_target(const Scene& scene, const Capture& capture) {
    const auto whole = [this, &scene, &capture](const Profile& p) {
      return judge_lighting(scene, pipeline_, p, capture);
    };
    if (!blends_lights(pipeline_.strategy) || !options_.steps) return add(whole);
    bool same = true;
    const LightSteps watched = [&, last = int(scene.lights.size()) - 1](const StepSink& sink) {
      options_.steps([&](int light, const Image& target) {
        if (light == last) same = target.texels == capture.color.texels;
        sink(light, target);
      });
    };
    StageVerdict by_light = judge_blending(scene, pipeline_, options_.profile, capture, watched);
    stages_.push_back({std::move(by_light), [this, &scene, &capture](const Profile& p) {
                         return judge_blending(scene, pipeline_, p, capture, options_.steps);
                       }});
    if (!same) add(whole);
  }

  /// The target before transparent surfaces, and then each of them; both together where drawing them again gave
  /// another.
  void judge_layers() {
    lit_ = capture_;
    opaque_ = without_transparent(scene_);
    bool same = true;
    const LightSteps watched = [&](const StepSink& sink) {
      options_.objects([&](int instance, const Image& target) {
        if (instance < 0) lit_.color = target;
        same = target.texels == capture_.color.texels;
        sink(instance, target);
      });
    };
    StageVerdict layers = judge_transparency(scene_, pipeline_, options_.profile, capture_, watched);
    judge_target(opaque_, lit_);
    stages_.push_back({std::move(layers), [this](const Profile& p) {
                         return judge_transparency(scene_, pipeline_, p, capture_, options_.objects);
                       }});
    if (!same) add([this](const Profile& p) { return judge_lighting(scene_, pipeline_, p, capture_); });
  }

  const Scene& scene_;
  const Pipeline& pipeline_;
  const Capture& capture_;
  const ValidateOptions& options_;
  Capture lit_;   ///< before what is transparent
  Scene opaque_;  ///< without it
  std::vector<Stage> stages_;
  FoundSurfaces surfaces_;
};

}  // namespace

uint64_t Verdict::violations() const {
  uint64_t count = 0;
  for (const StageVerdict& s : stages) count += s.count(PixelClass::violation);
  return count;
}

double Verdict::least_chance(size_t stages_judged) const {
  return significance / double(stages_judged * kAggregateTests);
}

bool Verdict::rounds_unlike_any() const {
  return std::any_of(evidence.begin(), evidence.end(), [](const Evidence& e) { return e.against; });
}

bool Verdict::convicted() const {
  return rounds_unlike_any() ||
         std::any_of(materials.begin(), materials.end(), [](const MaterialEvidence& e) { return e.against; });
}

bool Verdict::suspicious() const {
  return std::any_of(evidence.begin(), evidence.end(), [](const Evidence& e) { return e.against || !e.as_stated; });
}

std::string Verdict::evidence_line() const {
  const AggregateTest* strongest = nullptr;
  std::string stage;
  for (size_t i = 0; i < evidence.size(); ++i) {
    if (!evidence[i].against) continue;
    const AggregateTest& t = evidence[i].least_likely();
    if (strongest == nullptr || t.chance < strongest->chance) strongest = &t, stage = stages[i].stage;
  }
  if (strongest == nullptr) return material_line();
  const auto tests = double(stages.size() * kAggregateTests);  // of which one is the rarest
  char text[256];
  std::snprintf(
      text, sizeof text, "%s, %s%s%s: %.6g, where %.6g to %.6g are expected: one legal image in %s makes that",
      stage.c_str(), strongest->name.c_str(), strongest->where.empty() ? "" : ", ", strongest->where.c_str(),
      strongest->observed, strongest->low, strongest->high, one_in(std::min(1.0, strongest->chance * tests)).c_str());
  return text;
}

std::string Verdict::material_line() const {
  const MaterialEvidence* strongest = nullptr;
  const auto strength = [](const MaterialEvidence& e) { return std::fabs(e.value) / e.least; };
  for (const MaterialEvidence& e : materials)
    if (e.against && (strongest == nullptr || strength(e) > strength(*strongest))) strongest = &e;
  return strongest == nullptr ? std::string()
                              : strongest->stage + ", " + strongest->subject() + ": " + strongest->text();
}

Verdict validate_capture(const Scene& scene, const Pipeline& asked, const Capture& capture,
                         const ValidateOptions& options) {
  check_lights(scene.lights, asked);
  Pipeline pipeline = with_planes_that_program_reads(asked);
  pipeline.gbuffer = surface_planes(pipeline);  // forward strategies are judged from float planes of the same surfaces
  Validation validation(scene, pipeline, capture, options);
  std::vector<Stage> stages = validation.stages();
  if (stages.empty())
    throw Error(ErrorKind::bad_input, capture.name, "has no planes", "capture the target or a G-buffer plane");
  Verdict v;
  v.scene = scene.spec, v.driver = capture.driver, v.profile = options.profile.name;
  v.significance = options.significance;
  const auto begin = [&](const char* part) {
    if (options.begins) options.begins(part);
  };
  begin("the rounding");
  for (Stage& stage : stages) {
    v.evidence.push_back(evidence_of(stage.verdict, stage.judge, options.profile, v.least_chance(stages.size())));
    v.stages.push_back(std::move(stage.verdict));
  }
  v.materials = material_evidence(scene, pipeline, options.profile, capture, v.stages, options.significance);
  begin("what profile explains it");
  if (options.infer && v.stages.front().stage == "gbuffer") {
    JudgedBefore before = validation.before();
    const bool is_lit = v.stages.size() == 2 && v.stages[1].stage == "lighting";
    if (is_lit) before.lighting = &v.stages[1];
    v.inferred = infer_profile(scene, pipeline, capture, v.stages, &before);
  }
  return v;
}

}  // namespace trueshade::oracle
