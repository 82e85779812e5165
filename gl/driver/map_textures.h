#pragma once
#include <vector>

#include "gl/driver/objects.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// The maps of a scene's materials as OpenGL textures, with the scene's own levels. The context must be current.
class MapTextures {
 public:
  explicit MapTextures(const Scene& scene);

  bool used() const { return !color_.empty(); }  ///< some material has a map or a mask
  bool specular() const { return !specular_.empty(); }
  bool normal() const { return !normal_.empty(); }
  bool metal() const { return !metal_.empty(); }
  bool emission() const { return !emission_.empty(); }
  bool occlusion() const { return !occlusion_.empty(); }
  bool vertex_tangents() const { return vertex_tangents_; }  ///< there are normal maps and meshes with tangents
  bool more_uv() const { return more_uv_; }  ///< some map reads texture coordinates beside the first set

  /// Gives a program of GlslOptions::maps a material's maps and cutoff. Uses texture units 13 to 18.
  void bind(GLuint program, uint32_t material) const;

 private:
  const Scene* scene_;
  GlTexture white_;  ///< of maps that no material has, for programs that read them all the same
  std::vector<GlTexture> color_, specular_, normal_, metal_, emission_,
      occlusion_;  ///< one a material; where it has none, a texel that does nothing
  bool more_uv_ = false, vertex_tangents_ = false;
};

}  // namespace trueshade::oracle
