#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/json/json_value.h"
#include "scenes/light_change.h"
#include "scenes/scene.h"

// Scene files that refer to another scene by their key "scene", and say what is otherwise: another camera, say.
namespace trueshade {

/// Loads a scene by what load_scene() takes.
using SceneLoader = std::function<Scene(const std::string& spec)>;

std::vector<json::ObjectKeys> reference_json_keys();

/// The part of a scene file that another one stands for.
struct SceneReference {
  std::string scene;                 ///< as load_scene() takes it; a file by its path from here
  std::vector<LightChange> changes;  ///< in their order
  std::optional<double> time;        ///< the other scene as it stands then, without what moves
  bool both_faces = false;           ///< its materials are lit on both faces
  std::string lights{};              ///< text of lights in place of the other scene's, before the changes; empty: none
};

/// Whether a scene file's root says `both` by its key "faces".
bool lights_both_faces(const json::Node& root);

/// Nothing where the root has no key "scene". `path` is the file's own.
std::optional<SceneReference> reference_from_json(const json::Node& root, const std::string& path,
                                                  const SceneLimits& limits);

/// The scene that is referred to, with the changes and at the time of the reference. Its camera, clear colour, frames a
/// second and pipeline are for the caller to replace.
///   read_lights: appends those under the root's key "lights"
Scene scene_of_reference(const SceneReference& reference, const json::Node& root, const SceneLoader& load,
                         const std::function<void(Scene&)>& read_lights);

/// The reference of a scene file's text; nothing where it has none, or is no scene file. Throws nothing.
std::optional<SceneReference> reference_of_text(std::string_view text, const std::string& path,
                                                const SceneLimits& limits);

}  // namespace trueshade
