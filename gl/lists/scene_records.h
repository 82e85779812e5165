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

/// What a draw needs to know of an instance.
struct InstanceRecord {
  static constexpr int kFloats = 4 * 4 + 3 * 4 + 3 * 3 + 4;  ///< clip rows, world rows, normal rows, base colour
  std::array<float, kFloats> values;
  std::array<uint32_t, 2> ids;
};
/// Matrices of docs/arithmetic.md sections 1 and 2, for every instance.
std::vector<InstanceRecord> instance_records(const Scene& scene, const Pipeline& pipeline);

/// A run of instances, consecutive in the scene, of one mesh, all transparent, double-sided or mirrored or none, and,
/// where materials have maps, of one material: one instanced draw.
struct InstanceRun {
  uint32_t mesh = 0, material = 0;
  uint32_t first = 0, count = 0;
  bool transparent = false, double_sided = false, mirrored = false;
};
InstanceRun run_of(const Scene& scene, uint32_t instance);  ///< that instance alone
std::vector<InstanceRun> instance_runs(const Scene& scene, bool by_material);

/// How faces of a run are culled where the geometry state culls `state`'s: of double-sided materials no back face, and
/// front faces of mirrored instances wind the other way.
std::pair<CullFace, FrontFace> faces_of(const InstanceRun& run, const GeometryState& state);

/// Vertex attributes side by side: position, normal, then, where asked for, colour (1 where the mesh has none) and uv
/// (0 where it has none).
std::vector<float> interleaved(const Mesh& mesh, bool color, bool uv);

/// The same triangles, none of which shares a vertex: triangle i has vertices 3 i to 3 i + 2.
Mesh unshared(const Mesh& mesh);

/// The frames of all triangles of unshared(): of the first set, or of each of kMaxUvSets in turn.
std::vector<float> tangent_texels(const Mesh& mesh, bool all_sets);

/// Of each vertex of unshared() its tangent, and as w the sign of the sum of its triangle's; zeros where
/// the mesh has none.
std::vector<float> vertex_tangent_texels(const Mesh& mesh);

/// u and v of the sets behind the first, kMaxUvSets - 1 texels a vertex.
std::vector<float> more_uv_texels(const Mesh& mesh);

/// Material records as material_text() reads them.
std::vector<float> material_records(const Scene& scene, const Pipeline& pipeline);

bool has_double_sided(const Scene& scene);  ///< an instance of such a material
bool has_transparent(const Scene& scene);
/// Some map reads texture coordinates beside the first set.
bool reads_more_uv(const Scene& scene);
/// There are normal maps and meshes with tangents.
bool reads_tangents(const Scene& scene);

/// The options of shaders that draw the scene, with all planes.
GlslOptions scene_options(const Scene& scene);

}  // namespace trueshade::oracle
