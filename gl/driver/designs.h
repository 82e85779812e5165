#pragma once
#include <memory>

#include "gl/driver/renderer.h"
#include "gl/emit/designs.h"

namespace trueshade::oracle {

/// One design of a renderer, ready to draw: programs linked, textures there, matrices uploaded. A pipeline that draws
/// what lies behind (depth function, culling, viewport) is drawn as it says.
class GlPeer {
 public:
  /// Borrows the renderer, which must outlive this object.
  ///   tile: side in pixels of the tiles of designs that bin lights; 0: what is fastest on llvmpipe, 16 for
  ///         forward_plus and 32 for the tiled ones
  GlPeer(GlRenderer& renderer, const Pipeline& pipeline, GlDesign design, int tile = 0);
  ~GlPeer();

  /// Draws a frame, without its planes. If asked to, reads the target back, after the time of the last pass is taken.
  GlFrame draw(bool read_back);

 private:
  struct Work;  ///< one design's programs, textures and passes
  std::unique_ptr<Work> work_;
};

}  // namespace trueshade::oracle
