#pragma once
#include <string>

#include "view/frame_maker.h"
#include "view/scene_source.h"

namespace trueshade::viewer {

/// The text of a scene file that refers to the scene that is shown, and says what is otherwise: camera, lights, time
/// and the whole pipeline. `trueshade render` of the file draws the picture's very bits. `path`: where the file will
/// be; Error(usage) where the scene's file lies neither in the folder of `path` nor below it, or is `path` itself.
std::string saved_scene(const SceneFacts& facts, const DrawnPicture& picture, const std::string& path);

/// The angle in degrees that is read as this float of radians, to the bit.
double degrees_read_as(float radians);

}  // namespace trueshade::viewer
