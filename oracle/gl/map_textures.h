#pragma once
#include <map>
#include <vector>

#include "oracle/gl/objects.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// The colour maps of a scene's materials as OpenGL textures, levels as the scene has them. The context must be
/// current.
class MapTextures {
 public:
  explicit MapTextures(const Scene& scene);

  bool used() const { return !color_.empty(); }  ///< some material has a map or a mask

  /// Hands a material's map and cutoff to a program of GlslOptions::maps.
  void bind(GLuint program, uint32_t material, int unit) const;

 private:
  const Scene* scene_;
  std::vector<GlTexture> color_;  ///< one a material; a white texel where it has none
};

}  // namespace trueshade::oracle
