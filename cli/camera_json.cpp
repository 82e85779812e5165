#include "cli/camera_json.h"

#include "cli/json_text.h"
#include "cli/option_values.h"
#include "cli/shell_words.h"
#include "scenes/json/json_value.h"

namespace trueshade {
namespace {

constexpr std::string_view kKeys[] = {"name", "orbit", "distance", "distance_percent", "eye", "look_at", "fov_deg"};
constexpr json::ObjectKeys kCamera = {"camera", kKeys};

std::string list_of(const glm::vec3& place) {
  std::string list;
  for (int k = 0; k < 3; ++k) json::append_number(list += k == 0 ? "" : ", ", place[k]);
  return '[' + list + ']';
}

}  // namespace

std::string camera_json(const SceneParts& parts, const CameraChanges& changes) {
  if (!parts.camera && !changes.any()) return {};
  JsonObject out;
  if (parts.camera) out.put("name", *parts.camera);
  if (const auto& orbit = changes.orbit) {
    out.put_raw("orbit",
                JsonArray().add_raw(json_number(orbit->azimuth_deg)).add_raw(json_number(orbit->elevation_deg)).text());
    out.put(orbit->unit == DistanceUnit::percent ? "distance_percent" : "distance", orbit->distance);
  }
  if (changes.eye) out.put_raw("eye", list_of(*changes.eye));
  if (changes.target) out.put_raw("look_at", list_of(*changes.target));
  if (changes.fov_y_deg) out.put_raw("fov_deg", json_number(*changes.fov_y_deg));
  return out.text();
}

void read_camera_json(std::string_view text, const std::string& where, SceneParts& parts, CameraChanges& changes) {
  const json::Value value = json::parse(text, where);
  const json::Node root(value, where);
  root.check_keys(kCamera);
  if (const auto name = root.find("name")) parts.camera = name->string();
  if (const auto orbit = root.find("orbit")) {
    orbit->array(2, 2);
    // The option's text is read as an option is, so that both are held to the same ranges.
    std::string words = json::text_of(orbit->element(0).value()) + ',' + json::text_of(orbit->element(1).value());
    for (const auto& [key, unit] : {std::pair{"distance", ""}, {"distance_percent", "%"}})
      if (const auto distance = root.find(key)) words += ',' + json::text_of(distance->value()) + unit;
    changes.orbit = orbit_from_text(words);
  }
  constexpr double kFarthest = 1e9;
  if (const auto eye = root.find("eye")) changes.eye = eye->vec3(-kFarthest, kFarthest);
  if (const auto target = root.find("look_at")) changes.target = target->vec3(-kFarthest, kFarthest);
  if (const auto fov = root.find("fov_deg")) changes.fov_y_deg = fov->number(0.001, 179.99);
}

std::string camera_words(const SceneParts& parts, const CameraChanges& changes) {
  std::string words;
  if (parts.camera) words += " --camera " + for_shell(*parts.camera);
  words += option_text(changes);
  if (parts.animation) words += " --animation " + for_shell(*parts.animation);
  return words;
}

}  // namespace trueshade
