#include <algorithm>
#include <sstream>

#include "judge/diagnosis/finding.h"
#include "judge/stages/validate.h"
#include "scenes/pipeline/presets.h"
#include "tests/judge/diagnosis/unseen_frames.h"

namespace trueshade::testing {
namespace {

Subject subject(std::string_view name, const char* scene, const char* preset) {
  Subject s{name, load_scene(scene), *preset_pipeline(preset)};
  set_time(s.scene, 1.0);
  s.pipeline.width = 128, s.pipeline.height = 96;
  s.pipeline.target = Format::rgba8;
  return s;
}

/// Cornell's box with its last two objects, those that stand in it, made of coloured glass.
Subject box_of_glass() {
  Subject s = subject("box", "builtin:cornell", "many-lights");
  for (size_t i = s.scene.instances.size() - 2; i < s.scene.instances.size(); ++i) {
    Material glass = s.scene.materials[s.scene.instances[i].material];
    glass.base_color = i % 2 == 0 ? glm::vec4(0.9f, 0.5f, 0.3f, 0.4f) : glm::vec4(0.3f, 0.6f, 0.9f, 0.6f);
    glass.transparent = true;
    s.scene.instances[i].material = uint32_t(s.scene.materials.size());
    s.scene.materials.push_back(glass);
  }
  return s;
}

bool differs(const oracle::Capture& a, const oracle::Capture& b, int x, int y) {
  const auto at = [&](const Image& i, const Image& j) {
    return !std::equal(i.texel(x, y), i.texel(x, y) + info(i.format).bytes_per_texel(), j.texel(x, y));
  };
  bool any = at(a.color, b.color);
  for (size_t p = 0; p < a.planes.size(); ++p) any = any || at(a.planes[p].image, b.planes[p].image);
  return any;
}

int changed_pixels(const oracle::Capture& a, const oracle::Capture& b) {
  int changed = 0;
  for (int y = 0; y < a.color.height; ++y)
    for (int x = 0; x < a.color.width; ++x) changed += differs(a, b, x, y) ? 1 : 0;
  return changed;
}

bool is_accepted(std::string_view accepted, const std::string& name) {
  std::istringstream words{std::string(accepted)};
  const std::string kind = name.substr(0, name.find('='));
  for (std::string word; words >> word;)
    if (word == kind) return true;
  return false;
}

}  // namespace

Subject subject_named(std::string_view name) {
  if (name == "cornell") return subject(name, "builtin:cornell", "gl-fixed");
  if (name == "lecture") return subject(name, "builtin:lecture,lights=6", "lecture");
  if (name == "atrium") return subject(name, "builtin:atrium,glass=1,lights=24", "punctual");
  if (name == "box") return box_of_glass();
  Subject city = subject(name, "builtin:city,lights=60,objects=150", "many-lights");
  city.pipeline.light_model.damping = 0.15f;  // so few lights reach far, and would saturate it
  return city;
}

std::vector<UnseenFault> unseen_faults() {
  std::vector<UnseenFault> all = unseen_faults_of_lights();
  for (const auto& more : {unseen_faults_of_scenes(), unseen_faults_of_planes(), unseen_faults_of_pictures()})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

Trial tried(const UnseenFault& fault, const Subject& s) {
  Trial trial;
  const oracle::Capture capture = fault.draw(s);
  trial.changed = changed_pixels(capture, right_of(s));
  oracle::Profile profile;
  profile.subpixel_bits = 8;
  oracle::ValidateOptions options;
  options.profile = profile, options.infer = false;
  const oracle::Verdict verdict = oracle::validate_capture(s.scene, s.pipeline, capture, options);
  trial.convicted = verdict.violations() > 0 || verdict.convicted();
  if (!trial.convicted) return trial;
  const auto findings = oracle::diagnose(s.scene, s.pipeline, profile, capture, verdict.stages);
  const bool named = !findings.empty() && !findings[0].partial;
  trial.accepted = is_accepted(fault.accepted, named ? findings[0].name : "-");
  if (named) trial.first = findings[0].name, trial.explained = findings[0].explained;
  for (size_t i = 1; named && i < findings.size() && findings[i].tied; ++i)
    trial.first += " or " + findings[i].name,
        trial.accepted = trial.accepted || is_accepted(fault.accepted, findings[i].name);
  return trial;
}

}  // namespace trueshade::testing
