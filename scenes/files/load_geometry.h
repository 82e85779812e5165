#pragma once
#include <string>
#include <string_view>

#include "scenes/files/content/scene_files.h"
#include "scenes/files/load_ply.h"

namespace trueshade {

/// Whether the ending of a name is that of a geometry format: .ply or .ply.gz.
bool is_geometry_name(std::string_view name);

/// Mesh of a geometry file's content. `name` chooses the format and stands in errors; `limits` hold for what is
/// packed. Error(limit) where the mesh is over the memory cap.
Mesh mesh_from_file(const Bytes& content, const std::string& name, const SceneLimits& limits,
                    MissingNormals missing_normals, Faults& faults);

}  // namespace trueshade
