#pragma once
// What shaders of gl/emit read of a scene, as numbers in the order in which a GPU is handed them.
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "gl/emit/glsl.h"
#include "gl/emit/light_record.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// What the shaders of a draw read of one instance.
struct InstanceRecord {
  static constexpr int kFloats = 4 * 4 + 3 * 4 + 3 * 3 + 4;  ///< clip rows, world rows, normal rows, base colour
  std::array<float, kFloats> values;
  std::array<uint32_t, 2> ids;
};
/// The matrices and identifiers of every instance (docs/arithmetic.md sections 1 and 2).
std::vector<InstanceRecord> instance_records(const Scene& scene, const Pipeline& pipeline);

/// Instances that one instanced draw call can draw: consecutive in the scene, of one mesh, alike in being transparent,
/// double-sided and mirrored and, where materials have maps, of one material.
struct InstanceRun {
  uint32_t mesh = 0, material = 0;
  uint32_t first = 0, count = 0;
  bool transparent = false, double_sided = false, mirrored = false;
};
InstanceRun run_of(const Scene& scene, uint32_t instance);  ///< that instance alone
std::vector<InstanceRun> instance_runs(const Scene& scene, bool by_material);

/// How the faces of a run are culled where the pipeline has this state. No back face of a double-sided material is
/// culled; the front faces of mirrored instances wind the other way.
std::pair<CullFace, FrontFace> faces_of(const InstanceRun& run, const GeometryState& state);

/// A mesh's vertex attributes, vertex by vertex: position, normal, then, where asked for, colour (1 where the mesh has
/// none) and uv (0 where it has none).
std::vector<float> interleaved(const Mesh& mesh, bool color, bool uv);

/// A copy of the mesh in which no triangles share a vertex: triangle i has vertices 3 i to 3 i + 2.
Mesh unshared(const Mesh& mesh);

/// The normal-map frames of all triangles of an unshared() mesh: of the first uv set, or of each of kMaxUvSets in turn.
std::vector<float> tangent_texels(const Mesh& mesh, bool all_sets);

/// For each vertex of an unshared() mesh its tangent, with the sign of the sum of its triangle's w as w; zeros where
/// the mesh has no tangents.
std::vector<float> vertex_tangent_texels(const Mesh& mesh);

/// u and v of the uv sets after the first, for each vertex kMaxUvSets - 1 texels.
std::vector<float> more_uv_texels(const Mesh& mesh);

/// The materials' records, as material_text() reads them.
std::vector<float> material_records(const Scene& scene, const Pipeline& pipeline);

bool has_double_sided(const Scene& scene);  ///< an instance of such a material
bool has_transparent(const Scene& scene);
/// Whether some map reads texture coordinates of another set than the first.
bool reads_more_uv(const Scene& scene);
/// Whether there are both normal maps and meshes with tangents.
bool reads_tangents(const Scene& scene);

/// The options for shaders that draw the scene with all planes.
GlslOptions scene_options(const Scene& scene);

}  // namespace trueshade::oracle
