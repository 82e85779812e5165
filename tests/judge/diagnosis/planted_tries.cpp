#include <chrono>
#include <map>
#include <memory>
#include <mutex>

#include "judge/diagnosis/finding.h"
#include "judge/stages/validate.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "tests/judge/captured.h"
#include "tests/judge/diagnosis/planted.h"

namespace trueshade::testing {

using namespace trueshade::oracle;

namespace {

constexpr const char* kScenes[] = {"city,lights=60,objects=300", "cornell", "circle,lights=24"};

Scene scene_of(const Ground& ground) {
  Scene scene = builtin_scene(ground.scene);
  scene.camera.eye += glm::vec3(0.11f, 0.07f, -0.05f) * float(ground.view);
  return scene;
}

Pipeline pipeline_of(const Ground& ground) {
  Pipeline p = *preset_pipeline(ground.preset);
  p.width = 128, p.height = 96;
  p.strategy = ground.strategy, p.target = ground.target;
  return p;
}

const Image* plane_named(const Capture& capture, std::string_view name) {
  if (name == "picture") return &capture.color;
  return capture.plane(name);
}

/// Pixels of any plane of that kind that are stored otherwise.
uint64_t changed_pixels(const Capture& right, const Capture& wrong, std::string_view plane) {
  std::vector<std::string_view> planes = {plane};
  if (plane == "G-buffer") planes = {"depth", "position", "normal", "albedo", "id.object"};
  uint64_t most = 0;
  for (const std::string_view name : planes) {
    const Image *a = plane_named(right, name), *b = plane_named(wrong, name);
    if (a == nullptr || b == nullptr) continue;
    uint64_t count = 0;
    for (int y = 0; y < a->height; ++y)
      for (int x = 0; x < a->width; ++x) {
        bool differs = a->format != b->format;
        for (int k = 0; k < info(a->format).channels && !differs; ++k) differs = a->code(x, y, k) != b->code(x, y, k);
        count += differs ? 1 : 0;
      }
    most = std::max(most, count);
  }
  return most;
}

bool says(const Finding& finding, const Plant& plant) {
  const std::string_view bare = std::string_view(finding.name).substr(0, finding.name.find('='));
  return std::find(plant.names.begin(), plant.names.end(), bare) != plant.names.end();
}

}  // namespace

std::vector<Ground> grounds(std::string_view preset, int views) {
  std::vector<Ground> all;
  for (int view = 0; view < views; ++view)
    for (const char* scene : kScenes)
      for (const Format target : {Format::rgba8, Format::rgba16f})
        for (const Strategy strategy : {Strategy::deferred_loop, Strategy::deferred_volumes})
          all.push_back({scene, std::string(preset), strategy, target, view});
  return all;
}

PlantedTry planted_try(const Ground& ground, const Plant& plant, int variant, const Plant* other) {
  Scene scene = scene_of(ground);
  Pipeline pipeline = pipeline_of(ground);
  for (const Plant* p : {&plant, other})
    if (p != nullptr && p->base != nullptr) p->base(scene, pipeline);
  const Capture right = captured(scene, pipeline);
  PlantedTry out;
  Scene wrong_scene = scene;
  Pipeline wrong_pipeline = pipeline;
  bool plain = true;
  for (const Plant* p : {&plant, other}) {
    if (p == nullptr || p->input == nullptr) continue;
    if (!p->input(wrong_scene, wrong_pipeline, variant)) return out;
    plain = false;
  }
  Capture wrong = plain ? right : captured(wrong_scene, wrong_pipeline);
  for (const Plant* p : {&plant, other})
    if (p != nullptr && p->output != nullptr) p->output(wrong_scene, wrong_pipeline, wrong, variant);
  out.changed = changed_pixels(right, wrong, plant.plane);
  if (out.changed < 100) return out;
  Profile profile;
  profile.subpixel_bits = 8;
  const Verdict verdict = validate_capture(scene, pipeline, wrong, {profile, false, {}, {}});
  out.convicted = verdict.violations() > 0 || verdict.convicted();
  const auto start = std::chrono::steady_clock::now();
  const std::vector<Finding> findings = diagnose(scene, pipeline, profile, wrong, verdict.stages);
  out.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  for (size_t i = 0; i < findings.size(); ++i) {
    out.found += (i > 0 ? " " : "") + findings[i].name;
    if (says(findings[i], plant))
      out.named = true, out.first = out.first || i == 0, out.blamed = findings[i].plane == plant.plane;
    if (other != nullptr && says(findings[i], *other)) out.second = true;
  }
  return out;
}

}  // namespace trueshade::testing
