#include "scenes/files/reference_json.h"

#include <unordered_map>

#include "core/error.h"
#include "scenes/both_faces.h"
#include "scenes/files/content/scene_files.h"

namespace trueshade {
namespace {

constexpr std::string_view kChangeKeys[] = {"light", "on", "color", "intensity", "position"};
constexpr json::ObjectKeys kChange = {"light_change", kChangeKeys};
constexpr std::string_view kBuiltin = "builtin:";
/// Changes of one light. Each change goes through all steps of the light's color over time.
constexpr uint32_t kMostChanges = 1000;

LightChange change_from_json(const json::Node& node) {
  node.check_keys(kChange);
  LightChange change;
  change.light = uint32_t(node.member("light").integer(0, UINT32_MAX));
  if (const auto on = node.find("on")) change.on = on->boolean();
  if (const auto color = node.find("color")) change.color = color->vec3(0.0, json::kLargest);
  if (const auto intensity = node.find("intensity")) change.intensity = intensity->number(0.0, json::kLargest);
  if (const auto position = node.find("position")) change.position = position->vec3(-json::kLargest, json::kLargest);
  return change;
}

/// A file's path from here.
std::string referred_path(const json::Node& node, const std::string& path, const SceneLimits& limits) {
  const std::string& text = node.string();
  if (text.starts_with(kBuiltin)) return text;
  const std::string where = path + ": " + node.pointer();
  const std::string other = path_from_uri(text, where, limits.named_paths);
  SceneFolder(path, limits.named_paths).check(other, limits.file_bytes, where);
  return path_below(path.substr(0, path.rfind('/') + 1), other);  // npos + 1 is 0
}

}  // namespace

std::vector<json::ObjectKeys> reference_json_keys() { return {kChange}; }

bool lights_both_faces(const json::Node& root) {
  const auto faces = root.find("faces");
  return faces && kFaceChoices[faces->choice(kFaceChoices)] == "both";
}

std::optional<SceneReference> reference_from_json(const json::Node& root, const std::string& path,
                                                  const SceneLimits& limits) {
  const auto scene = root.find("scene");
  if (!scene) {
    for (const char* key : {"light_changes", "time"})
      if (const auto alone = root.find(key)) alone->fail("it stands without \"scene\"", "name the scene that it is of");
    return std::nullopt;
  }
  for (const char* key : {"textures", "materials", "objects"})
    if (const auto own = root.find(key))
      own->fail("it stands beside \"scene\", which has its own", "leave one of them out");
  SceneReference reference;
  reference.scene = referred_path(*scene, path, limits);
  if (const auto time = root.find("time")) reference.time = time->number(-kLatestTime, kLatestTime);
  reference.both_faces = lights_both_faces(root);
  if (const auto lights = root.find("lights")) reference.lights = json::text_of(lights->value());
  const auto changes = root.find("light_changes");
  if (!changes) return reference;
  const size_t count = changes->array(0, SIZE_MAX).size();
  if (count > limits.lights)
    changes->fail("there are " + std::to_string(count) + " changes", within_limit(limits.lights, "", "--max-lights"),
                  ErrorKind::limit);
  std::unordered_map<uint32_t, uint32_t> changes_of;
  for (size_t i = 0; i < count; ++i) {
    reference.changes.push_back(change_from_json(changes->element(i)));
    if (++changes_of[reference.changes.back().light] > kMostChanges)
      changes->element(i).fail("its light is changed more than " + std::to_string(kMostChanges) + " times",
                               "put changes of a light together");
  }
  return reference;
}

Scene scene_of_reference(const SceneReference& reference, const json::Node& root, const SceneLoader& load,
                         const std::function<void(Scene&)>& read_lights) {
  if (!load)
    root.member("scene").fail("another scene refers to this one, which refers to one more", "refer to the last one");
  Scene scene = load(reference.scene);
  if (!reference.lights.empty()) {
    scene.lights.clear(), scene.lights_of_ours = false;
    scene.timeline.lights.clear(), scene.timeline.orbits.clear(), scene.timeline.node_lights.clear();
    read_lights(scene);
  }
  for (size_t i = 0; i < reference.changes.size(); ++i)
    if (reference.changes[i].light >= scene.lights.size())
      root.member("light_changes")
          .element(i)
          .member("light")
          .fail("there is no such light", "the scene has " + std::to_string(scene.lights.size()) + ", from 0");
  change_lights(scene, reference.changes);
  if (reference.time) {
    set_time(scene, *reference.time);
    const double fps = scene.timeline.fps;
    scene.timeline = Timeline();
    scene.timeline.fps = fps, scene.timeline.stands_at = scene.time;
  }
  return scene;
}

std::optional<SceneReference> reference_of_text(std::string_view text, const std::string& path,
                                                const SceneLimits& limits) {
  try {
    const json::Value value = json::parse(text, path);
    return reference_from_json(json::Node(value, path), path, limits);
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace trueshade
