#pragma once
#include <string>
#include <string_view>

#include "scenes/camera_changes.h"

namespace trueshade {

// What a picture's file says of how its scene was seen.
inline constexpr const char* kCameraKey = "trueshade:camera";        ///< camera_json(); absent: through the scene's own
inline constexpr const char* kAnimationKey = "trueshade:animation";  ///< SceneParts::animation

/// `{"name":"Side","orbit":[30,20],"distance_percent":150,"eye":[0,1,2],"look_at":[0,0,0],"fov_deg":40}`, each key
/// where it is said, and "distance" where it is in scene units; empty where nothing is. Does not say the animation.
std::string camera_json(const SceneParts& parts, const CameraChanges& changes);

/// Reads that text. Error(bad_input) behind `where`.
void read_camera_json(std::string_view text, const std::string& where, SceneParts& parts, CameraChanges& changes);

/// The options that say the same, each with a space before it, for a shell.
std::string camera_words(const SceneParts& parts, const CameraChanges& changes);

}  // namespace trueshade
