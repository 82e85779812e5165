#pragma once
#include <string>
#include <string_view>

#include "scenes/files/load_ply.h"
#include "scenes/files/scene_files.h"

namespace trueshade {

/// Whether the ending of a name is that of a geometry format: .ply or .ply.gz.
bool is_geometry_name(std::string_view name);

/// Mesh of a geometry file's content. `name` chooses the format and stands in errors; `limit` bytes once unpacked.
Mesh mesh_from_file(const Bytes& content, const std::string& name, uint64_t limit, MissingNormals missing_normals);

}  // namespace trueshade
