#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "core/error.h"
#include "judge/diagnosis/picture_search.h"
#include "judge/diagnosis/plane_search.h"

namespace trueshade::oracle {

namespace {

Error no_fault(const std::string& name) {
  return {ErrorKind::usage, "--suppose", "'" + name + "' is no fault that is known",
          "`trueshade list` names them; a parameter follows `=`"};
}

/// Faults of both kinds by their names; those of no table are an error.
struct Supposed {
  std::vector<NamedFault> picture;
  std::vector<NamedPlaneFault> planes;
};

template <class Fault>
const Fault* fault_named(std::string_view name, std::initializer_list<std::span<const Fault>> tables) {
  for (const auto table : tables)
    for (const Fault& f : table)
      if (f.name == name) return &f;
  return nullptr;
}

/// A number, or a word that the fault has for one.
template <class Fault>
double parameter_of(const Fault& fault, const std::string& text, const std::string& name) {
  for (const double start : fault.starts)
    if (fault.says != nullptr && parameter_word(fault, start) == text) return start;
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(number)) throw no_fault(name);
  return number;
}

Supposed supposed_of(std::span<const std::string> names) {
  Supposed out;
  for (const std::string& name : names) {
    const size_t equals = name.find('=');
    const bool given = equals != std::string::npos;
    const std::string_view bare = std::string_view(name).substr(0, equals);
    const std::string text = given ? name.substr(equals + 1) : "";
    const auto* picture = fault_named<PictureFault>(bare, {picture_value_faults(), light_faults()});
    const auto* plane = fault_named<PlaneFault>(bare, {plane_faults(), redraw_faults()});
    if (picture != nullptr && given == (picture->search != Search::none))
      out.picture.push_back({picture, given ? parameter_of(*picture, text, name) : 0});
    else if (plane != nullptr && given == (plane->search != PlaneFault::Search::none))
      out.planes.push_back({plane, given ? parameter_of(*plane, text, name) : 0});
    else
      throw no_fault(name);
  }
  return out;
}

std::string listed_name(std::string_view name, bool has_parameter) {
  return std::string(name) + (has_parameter ? "=N" : "");
}

std::string listed_text(std::string_view text) {
  std::string listed(text);
  if (const size_t at = listed.find("%s"); at != std::string::npos) listed.replace(at, 2, "N");
  return listed;
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

std::string quoted_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string json_number(double v) {
  if (!std::isfinite(v)) return "null";
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", v);
  return text;
}

}  // namespace

std::vector<Finding> diagnose(const Scene& scene, const Pipeline& asked, const Profile& profile, const Capture& capture,
                              std::span<const StageVerdict> stages, std::span<const std::string> supposed,
                              size_t most) {
  Pipeline pipeline = asked;
  pipeline.gbuffer = surface_planes(asked);
  const Supposed only = supposed_of(supposed);
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
  if (lit != nullptr && (supposed.empty() || !only.picture.empty())) {
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
      faults.push_back({listed_name(f.name, f.search != Search::none), "picture", listed_text(f.text)});
  for (const auto table : {plane_faults(), redraw_faults()})
    for (const PlaneFault& f : table)
      faults.push_back({listed_name(f.name, f.search != PlaneFault::Search::none),
                        std::string(kPlaneNames[size_t(f.plane)]), listed_text(f.text)});
  return faults;
}

std::string findings_json(std::span<const Finding> findings) {
  std::string json = "[";
  for (const Finding& f : findings) {
    if (json.size() > 1) json += ",";
    json += "{\"name\":" + quoted_text(f.name) + ",\"plane\":" + quoted_text(f.plane) +
            ",\"text\":" + quoted_text(f.text) + ",\"changed\":" + std::to_string(f.changed) +
            ",\"explained\":" + json_number(f.explained) + ",\"contradicted\":" + json_number(f.contradicted) +
            ",\"together\":" + (f.together ? "true" : "false") + ",\"proof\":{\"x\":" + std::to_string(f.proof.x) +
            ",\"y\":" + std::to_string(f.proof.y) + ",\"plane\":" + quoted_text(f.proof.plane) +
            ",\"given\":" + json_number(f.proof.given) + ",\"right\":" + json_number(f.proof.right) +
            ",\"predicted\":" + json_number(f.proof.predicted) + "},\"command\":" + quoted_text(f.command) + "}";
  }
  return json + "]";
}

}  // namespace trueshade::oracle
