#pragma once
#include <string>

#include "view/frame_maker.h"
#include "view/scene_source.h"

namespace trueshade::viewer {

/// Writes the picture with all that `trueshade render -o` writes into it. `path`: .png or .exr; empty for a name made
/// of `name` and the hash in the current folder. What to tell comes back, with the whole hash. Error(io), Error(usage).
std::string write_picture(const std::string& path, const std::string& name, const EditedScene& scene,
                          const DrawnPicture& picture);

/// Writes saved_scene(). `path`: .json; empty for a name made of the scene's and the picture's hash, beside the scene's
/// file or in the current folder.
std::string write_scene(const std::string& path, const SceneFacts& facts, const DrawnPicture& picture);

}  // namespace trueshade::viewer
