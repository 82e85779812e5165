#include "scenes/files/load_geometry.h"

namespace trueshade {

bool is_geometry_name(std::string_view name) { return name.ends_with(".ply") || name.ends_with(".ply.gz"); }

Mesh mesh_from_file(const Bytes& content, const std::string& name, const SceneLimits& limits,
                    MissingNormals missing_normals) {
  const bool packed = name.ends_with(".gz");
  Mesh mesh = mesh_from_ply(packed ? gunzipped(content, limits, name) : content, name, missing_normals);
  mesh.name = name;
  return mesh;
}

}  // namespace trueshade
