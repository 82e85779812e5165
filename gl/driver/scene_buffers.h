#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "gl/driver/map_textures.h"
#include "gl/driver/objects.h"
#include "gl/lists/scene_records.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// Which surfaces a pass draws.
enum class Surfaces : uint8_t { all, opaque, transparent };

/// A scene on the GPU: each mesh once, lights as texels. Instances' matrices are uploaded for each camera and size.
class SceneBuffers {
 public:
  /// Uploads the meshes. Borrows the scene, which must outlive it unchanged. The context must be current.
  ///   rotation: triangles start with their vertex 0, 1 or 2; the same picture where a driver keeps GL's promises
  explicit SceneBuffers(const Scene& scene, int rotation = 0);

  const Scene& scene() const { return *scene_; }
  bool has_vertex_colors() const;
  uint32_t light_types() const;  ///< of the scene, a bit each: 1 << LightType

  /// Uploads the matrices of every instance (docs/arithmetic.md sections 1 and 2).
  void upload_instances(const Pipeline& pipeline);
  /// Draws every triangle of these surfaces, in submission order, by the program in use. Culling is that of the current
  /// GL state; where the scene has double-sided or mirrored instances, each is culled as upload_instances()'s pipeline
  /// says for it. Where maps() are used, the program must be of GlslOptions::maps. Uses texture units 11 (frames of
  /// normal maps) and 13 to 19.
  void draw_instances(Surfaces which = Surfaces::all) const;
  /// Draws one transparent instance in the same way.
  void draw_transparent(uint32_t instance) const;
  /// Draws the same by one draw call an instance, for programs of GlslOptions::instance_uniforms. The program must be
  /// in use.
  void draw_each_instance(GLuint program, Surfaces which = Surfaces::all) const;
  const MapTextures& maps() const { return maps_; }
  bool has_large_meshes() const;  ///< so large that a draw an instance costs less than matrices read by every vertex
  GLuint light_texels(const Pipeline& pipeline);  ///< light_records()
  /// The buffer texture with the materials' records, which material_text() reads.
  GLuint material_texels(const Pipeline& pipeline);

 private:
  struct MeshBuffers {
    GlVertexArray array;
    GlBuffer vertices, indices;
    GlTexelBuffer tangents;         ///< where there are normal maps
    GlTexelBuffer vertex_tangents;  ///< where meshes have any beside
    GlTexelBuffer more_uv;          ///< where maps read texture coordinates beside the first set
    GLsizei index_count = 0;
  };
  MeshBuffers upload(const Mesh& mesh, int rotation) const;
  void draw_run(const InstanceRun& run, GLuint program) const;
  void set_faces_of(const InstanceRun& run) const;

  const Scene* scene_;
  MapTextures maps_;
  bool double_sided_;  ///< some material is
  std::vector<MeshBuffers> meshes_;
  std::vector<InstanceRun> runs_;
  GlBuffer instances_;
  std::vector<InstanceRecord> records_;  ///< what instances_ holds
  bool has_own_faces_ = false;           ///< some run is not drawn with the pipeline's culling and front face
  GeometryState faces_;                  ///< of the pipeline that the records were made for
  GlTexelBuffer lights_, materials_;
  std::optional<Pipeline> lights_of_, materials_of_;  ///< whose records lights_ and materials_ hold
};

}  // namespace trueshade::oracle
