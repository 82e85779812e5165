#include "scenes/files/load_geometry.h"

#include "core/file_ending.h"

namespace trueshade {

bool is_geometry_name(std::string_view name) { return has_ending(name, ".ply") || has_ending(name, ".ply.gz"); }

Mesh mesh_from_file(const Bytes& content, const std::string& name, const SceneLimits& limits,
                    MissingNormals missing_normals, Faults& faults) {
  const bool packed = has_ending(name, ".gz");
  Mesh mesh = mesh_from_ply(packed ? gunzipped(content, limits, name) : content, name, missing_normals, faults);
  mesh.name = name;
  return mesh;
}

}  // namespace trueshade
