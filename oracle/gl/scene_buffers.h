#pragma once
#include <cstdint>
#include <vector>

#include "oracle/gl/objects.h"
#include "scenes/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// A run of instances, consecutive in the scene, of one mesh: one instanced draw.
struct InstanceRun {
  uint32_t mesh = 0;
  uint32_t first = 0, count = 0;
};

/// A scene on the GPU: each mesh once, lights as texels. Instance matrices follow when a camera and a size are known.
class SceneBuffers {
 public:
  /// `rotation`: triangles start with their vertex 0, 1 or 2; the same picture where a driver keeps GL's promises.
  /// Borrows the scene, which must outlive it unchanged. The context must be current.
  explicit SceneBuffers(const Scene& scene, int rotation = 0);

  const Scene& scene() const { return *scene_; }
  bool has_type(LightType type) const;

  /// Matrices of docs/arithmetic.md sections 1 and 2, for every instance.
  void upload_instances(const Pipeline& pipeline);
  void draw_instances() const;  ///< every triangle, in submission order
  /// Light records in the layout of texels_per_light(); made again when the layout changes.
  GLuint light_texels(const LightModel& model);

 private:
  struct MeshBuffers {
    GlVertexArray array;
    GlBuffer vertices, indices;
    GLsizei index_count = 0;
  };
  MeshBuffers upload(const Mesh& mesh, int rotation) const;

  const Scene* scene_;
  std::vector<MeshBuffers> meshes_;
  std::vector<InstanceRun> runs_;
  GlBuffer instances_;
  GlTexelBuffer lights_;
  int light_layout_ = 0;  ///< texels a light of lights_; 0: none yet
};

/// The light records as the shaders read them, RGBA a texel.
std::vector<float> light_records(const Scene& scene, const LightModel& model);

}  // namespace trueshade::oracle
