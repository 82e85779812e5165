#pragma once
#include <span>
#include <string>

#include "scenes/add_normals.h"
#include "scenes/files/obj/obj_pictures.h"
#include "scenes/scene.h"

namespace trueshade {

/// Whether the ending of a name is OBJ's: .obj or .obj.gz.
bool is_obj_name(std::string_view name);

/// What an OBJ file draws, without camera and lights: an instance for each object and material; docs/obj.md. Materials
/// are those that are drawn, in the order of their first use. `path` is the file's; libraries and pictures come from
/// `read`. Not validated. Error(bad_input) with the line; Error(limit); Error(io) for files that cannot be read.
Scene scene_from_obj(std::span<const uint8_t> file, const std::string& path, const SceneLimits& limits,
                     const ImageDecoder& decode, MissingNormals missing_normals, const obj::FileReader& read);

/// The same, reading what the file names from the folder of `path`. A name that ends in .gz is unpacked.
Scene scene_from_obj(std::span<const uint8_t> file, const std::string& path, const SceneLimits& limits,
                     const ImageDecoder& decode, MissingNormals missing_normals);

}  // namespace trueshade
