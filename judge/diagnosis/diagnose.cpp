#include <algorithm>

#include "core/json_number.h"
#include "core/json_string.h"
#include "judge/diagnosis/supposed_faults.h"
#include "judge/stages/aggregate.h"

namespace trueshade::oracle {

namespace {

std::string listed_name(std::string_view name, const ParameterForm& form) {
  return std::string(name) + (form.any() ? "=" + listed_parameter(form) : "");
}

std::string listed_text(std::string_view text, const ParameterForm& form) {
  constexpr const char* kVectors[] = {"", "X", "(X, Y)", "(X, Y, Z)"};
  std::string listed(text);
  for (const auto& [mark, word] : {std::pair("%s", "N"), std::pair("%p", "P"), std::pair("%v", kVectors[form.vector])})
    if (const size_t at = listed.find(mark); at != std::string::npos) listed.replace(at, 2, word);
  return listed;
}

/// Whether there is something to explain. A picture that is as its own G-buffer makes it has no fault, though a few of
/// its pixels are not as predicted in doubles.
bool is_suspicious(const StageVerdict& stage) {
  constexpr double kLeastChance = 1e-6 / double(kAggregateTests);
  return !stage.passes() || !least_likely(aggregate_tests(stage)).passes(kLeastChance);
}

/// The likeliest of both, and then the others. What is wrong in a plane may be why the picture is: planes come first.
std::vector<Finding> merged(std::vector<Finding> planes, std::vector<Finding> picture, size_t most) {
  const auto first = [](const std::vector<Finding>& list) {
    size_t count = std::min<size_t>(1, list.size());
    while (count < list.size() && list[count].together) ++count;
    return count;
  };
  const size_t of_planes = first(planes), of_picture = first(picture);
  std::vector<Finding> findings;
  const auto add = [&](std::vector<Finding>& list, size_t from, size_t to) {
    for (size_t i = from; i < to && findings.size() < most; ++i) findings.push_back(std::move(list[i]));
  };
  add(planes, 0, of_planes), add(picture, 0, of_picture);
  add(planes, of_planes, planes.size()), add(picture, of_picture, picture.size());
  return findings;
}

}  // namespace

std::vector<Finding> diagnose(const Scene& scene, const Pipeline& asked, const Profile& profile, const Capture& capture,
                              std::span<const StageVerdict> stages, std::span<const std::string> supposed,
                              size_t most) {
  Pipeline pipeline = asked;
  pipeline.gbuffer = surface_planes(asked);
  const SupposedFaults only = supposed_faults(supposed, scene);
  const auto stage_of = [&](std::initializer_list<std::string_view> names) -> const StageVerdict* {
    for (const StageVerdict& s : stages)
      if (std::find(names.begin(), names.end(), s.stage) != names.end()) return &s;
    return nullptr;
  };
  const StageVerdict *surfaces = stage_of({"gbuffer"}), *lit = stage_of({"lighting", "blending"});
  PlaneFindings planes;
  if (surfaces != nullptr && (supposed.empty() || !only.planes.empty()) &&
      (!supposed.empty() || surfaces->count(PixelClass::violation) > 0))
    planes = plane_findings(scene, pipeline, profile, capture, *surfaces, only.planes);
  std::vector<Finding> findings;
  if (lit != nullptr && (supposed.empty() ? is_suspicious(*lit) : !only.picture.empty())) {
    PictureCase picture(scene, pipeline, profile, capture, *lit);
    if (planes.expected != nullptr) {  // the picture may have been lit before a plane was written wrongly
      PictureCase healed = picture;
      healed.heal(planes.expected, planes.wrong);
      if (changed_pixels(healed) < changed_pixels(picture)) picture.heal(planes.expected, planes.wrong);
    }
    findings = picture_findings(picture, only.picture);
  }
  return merged(std::move(planes.findings), std::move(findings), most);
}

std::vector<KnownFault> known_faults() {
  std::vector<KnownFault> faults;
  for (const auto table : {picture_value_faults(), light_faults()})
    for (const PictureFault& f : table)
      faults.push_back({listed_name(f.name, f.form()), "picture", listed_text(f.text, f.form())});
  for (const auto table : {plane_faults(), redraw_faults(), object_faults(), camera_faults(), material_faults()})
    for (const PlaneFault& f : table)
      faults.push_back({listed_name(f.name, f.form()), std::string(kPlaneNames[size_t(f.plane)]),
                        listed_text(f.text, f.form())});
  return faults;
}

std::string findings_json(std::span<const Finding> findings) {
  std::string json = "[";
  for (const Finding& f : findings) {
    if (json.size() > 1) json += ",";
    json += "{\"name\":" + json_string(f.name) + ",\"plane\":" + json_string(f.plane) +
            ",\"text\":" + json_string(f.text) + ",\"changed\":" + std::to_string(f.changed) +
            ",\"explained\":" + json_in_nine_digits(f.explained) +
            ",\"contradicted\":" + json_in_nine_digits(f.contradicted) +
            ",\"together\":" + (f.together ? "true" : "false") + ",\"alone\":" + json_in_nine_digits(f.alone) +
            ",\"proof\":{\"x\":" + std::to_string(f.proof.x) + ",\"y\":" + std::to_string(f.proof.y) +
            ",\"plane\":" + json_string(f.proof.plane) + ",\"given\":" + json_in_nine_digits(f.proof.given) +
            ",\"right\":" + json_in_nine_digits(f.proof.right) +
            ",\"predicted\":" + json_in_nine_digits(f.proof.predicted) +
            ",\"by_both\":" + (f.proof.by_both ? "true" : "false") +
            ",\"anything\":" + (f.proof.anything ? "true" : "false") + "},\"command\":" + json_string(f.command) + "}";
  }
  return json + "]";
}

}  // namespace trueshade::oracle
