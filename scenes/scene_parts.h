#pragma once
#include <optional>
#include <string>
#include <vector>

namespace trueshade {

/// A camera of a glTF file, in the order of its nodes.
struct SceneCamera {
  std::string name, node;  ///< its own name and its node's; either may be empty
  double fov_y_rad = 0.0;  ///< full vertical angle; 0: it is orthographic

  bool operator==(const SceneCamera&) const = default;
};

/// An animation of a glTF file.
struct SceneAnimation {
  std::string name;      ///< may be empty
  double seconds = 0.0;  ///< its last step, as the file says; 0 where it does not say

  bool operator==(const SceneAnimation&) const = default;
};

/// An extension that a glTF file uses.
struct SceneExtension {
  std::string name;       ///< its first 80 bytes
  bool required = false;  ///< the file says that it cannot be drawn without
  bool is_read = true;    ///< else the file is drawn as if it had none

  bool operator==(const SceneExtension&) const = default;
};

/// Which of a file's cameras and animations a scene is made with: a number from 0, or a name.
struct SceneParts {
  std::optional<std::string> camera;     ///< nothing: the first
  std::optional<std::string> animation;  ///< or kAllAnimations; nothing: the first

  bool operator==(const SceneParts&) const = default;
};

inline constexpr const char* kAllAnimations = "all";

/// The place in the list of the camera that the text names: by its number, else by its name. Error(usage) names the
/// option, and lists what the file of this name has. A scene without a list of cameras has camera 0.
size_t camera_named(const std::string& text, const std::vector<SceneCamera>& cameras, const std::string& file);
/// The same of animations.
size_t animation_named(const std::string& text, const std::vector<SceneAnimation>& animations, const std::string& file);

}  // namespace trueshade
