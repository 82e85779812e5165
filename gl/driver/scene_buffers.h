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

/// A scene on the GPU: each mesh once, lights as texels. Instance matrices follow when a camera and a size are known.
class SceneBuffers {
 public:
  /// `rotation`: triangles start with their vertex 0, 1 or 2; the same picture where a driver keeps GL's promises.
  /// Borrows the scene, which must outlive it unchanged. The context must be current.
  explicit SceneBuffers(const Scene& scene, int rotation = 0);

  const Scene& scene() const { return *scene_; }
  bool has_vertex_colors() const;
  uint32_t light_types() const;  ///< of the scene, a bit each: 1 << LightType

  /// Matrices of docs/arithmetic.md sections 1 and 2, for every instance.
  void upload_instances(const Pipeline& pipeline);
  /// Every triangle of those surfaces, in submission order, by the program in use, culled as the state in force
  /// says; where there are double-sided or mirrored ones, as that of upload_instances()'s pipeline says for them; one
  /// of GlslOptions::maps where maps() are used; texture units 11 (frames of normal maps) and 13 to 19.
  void draw_instances(Surfaces which = Surfaces::all) const;
  /// One transparent instance of them.
  void draw_transparent(uint32_t instance) const;
  /// The same with a draw an instance, for programs of GlslOptions::instance_uniforms. The program must be in use.
  void draw_each_instance(GLuint program, Surfaces which = Surfaces::all) const;
  const MapTextures& maps() const { return maps_; }
  bool has_large_meshes() const;  ///< so large that a draw an instance costs less than matrices read by every vertex
  GLuint light_texels(const Pipeline& pipeline);  ///< light_records()
  /// Material records as material_text() reads them.
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
