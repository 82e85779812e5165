#include <algorithm>
#include <chrono>
#include <optional>

#include "judge/diagnosis/finding.h"
#include "judge/stages/validate.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "tests/judge/captured.h"
#include "tests/judge/diagnosis/legal_witness.h"
#include "tests/judge/diagnosis/planted.h"
#include "tests/judge/diagnosis/plants.h"

namespace trueshade::testing {

using namespace trueshade::oracle;

namespace {

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

std::vector<Ground> grounds(std::string_view preset, int views) { return grounds(Plant{}, preset, views); }

std::vector<Ground> grounds(const Plant& plant, std::string_view preset, int views) {
  std::vector<Ground> all;
  for (int view = 0; view < views; ++view)
    for (const std::string_view scene : plant.scenes)
      for (const Format target : {Format::rgba8, Format::rgba16f})
        for (const Strategy strategy : {Strategy::deferred_loop, Strategy::deferred_volumes})
          all.push_back({std::string(scene), std::string(preset), strategy, target, view});
  return all;
}

namespace {

/// What a renderer with these faults captures; nothing where one of them changes nothing.
std::optional<Capture> planted(const Scene& scene, const Pipeline& pipeline, const Capture& right,
                               std::span<const Plant* const> faults, int variant) {
  Scene wrong_scene = scene;
  Pipeline wrong_pipeline = pipeline;
  bool plain = true;
  for (const Plant* p : faults) {
    if (p->input == nullptr) continue;
    if (!p->input(wrong_scene, wrong_pipeline, variant % p->variants)) return std::nullopt;
    plain = false;
  }
  Capture wrong = plain ? right : captured(wrong_scene, wrong_pipeline);
  for (const bool lights_again : {true, false})
    for (const Plant* p : faults)
      if (p->output != nullptr && p->lights_again == lights_again)
        p->output(wrong_scene, wrong_pipeline, wrong, variant % p->variants);
  return wrong;
}

/// Whether no code is so far off that no conversion within 0.6 makes it.
bool may_be_legal(const Image& right, const Image& wrong) {
  constexpr int64_t kMostCodes = 8;  // of sums of many lights
  if (info(right.format).number_class != NumberClass::unorm) return false;
  for (int y = 0; y < right.height; ++y)
    for (int x = 0; x < right.width; ++x)
      for (int k = 0; k < 3; ++k)
        if (std::abs(int64_t(right.code(x, y, k)) - int64_t(wrong.code(x, y, k))) > kMostCodes) return false;
  return true;
}

}  // namespace

std::vector<PlantedPair> pairs_of_plants(int count) {
  // What is estimated of what is drawn is looked for alone: of pairs both are of pictures or of planes.
  const std::span<const Plant> all = plants().first(plants_of_pictures().size() + plants_of_planes().size());
  std::vector<PlantedPair> pairs;
  for (size_t i = 0; int(pairs.size()) < count; ++i) {
    const Plant &one = all[i % all.size()], &other = all[(i * 17 + 11 + i / all.size() * 5) % all.size()];
    if (&one == &other || (one.lights_again && other.lights_again)) continue;
    std::string_view preset;
    for (const std::string_view p : one.presets)
      if (std::find(other.presets.begin(), other.presets.end(), p) != other.presets.end()) preset = p;
    if (preset.empty()) continue;
    if (one.scenes != other.scenes) continue;
    const std::vector<Ground> on = grounds(one, preset, 1);
    const Ground& ground = on[(i * 5) % on.size()];
    if ((one.loops_only || other.loops_only) && blends_lights(ground.strategy)) continue;
    pairs.push_back({&one, &other, ground});
  }
  return pairs;
}

PlantedTry planted_try(const Ground& ground, const Plant& plant, int variant, const Plant* other) {
  Scene scene = scene_of(ground);
  Pipeline pipeline = pipeline_of(ground);
  std::vector<const Plant*> faults = {&plant};
  if (other != nullptr) faults.push_back(other);
  for (const Plant* p : faults)
    if (p->base != nullptr) p->base(scene, pipeline);
  const Capture right = captured(scene, pipeline);
  PlantedTry out;
  const std::optional<Capture> wrong = planted(scene, pipeline, right, faults, variant);
  if (!wrong) return out;
  out.changed = out.beyond = changed_pixels(right, *wrong, plant.plane);
  if (other != nullptr) {  // what each adds to the other
    const std::optional<Capture> one = planted(scene, pipeline, right, {&faults[0], 1}, variant),
                                 two = planted(scene, pipeline, right, {&faults[1], 1}, variant);
    if (!one || !two) return out;
    out.both_matter = std::min(changed_pixels(*one, *wrong, other->plane), changed_pixels(*two, *wrong, plant.plane));
    if (out.both_matter < 100) return out;
  }
  if (out.changed < 100) return out;
  Profile profile;
  profile.subpixel_bits = 8;
  const Verdict verdict = validate_capture(scene, pipeline, *wrong, {profile, false, {}, {}});
  out.convicted = verdict.violations() > 0 || verdict.convicted();
  if (other == nullptr && plant.plane == "picture" && may_be_legal(right.color, wrong->color))
    out.beyond = std::min(out.changed, pixels_without_witness(scene, pipeline, *wrong));
  const auto start = std::chrono::steady_clock::now();
  const std::vector<Finding> findings = diagnose(scene, pipeline, profile, *wrong, verdict.stages);
  out.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  for (size_t i = 0; i < findings.size(); ++i) {
    out.found += (i > 0 ? " " : "") + findings[i].name;
    if (says(findings[i], plant)) {
      out.named = true, out.first = out.first || ((i == 0 || findings[i].tied) && !findings[i].partial);
      out.blamed = out.blamed || findings[i].plane == plant.plane;
    }
    if (other != nullptr && says(findings[i], *other)) out.second = true;
  }
  return out;
}

}  // namespace trueshade::testing
