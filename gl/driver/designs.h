#pragma once
#include <memory>

#include "gl/driver/renderer.h"
#include "gl/emit/designs.h"

namespace trueshade::oracle {

/// One design, ready: programs linked, textures there, matrices uploaded. draw() does a frame's work and no more.
/// A pipeline that draws what lies behind (depth function, culling, viewport) is taken as it is.
class GlPeer {
 public:
  /// Borrows the renderer, which must outlive it. `tile`: pixels a side of the designs that bin lights; 0: what is
  /// fastest on llvmpipe, 16 of forward_plus and 32 of tiled.
  GlPeer(GlRenderer& renderer, const Pipeline& pipeline, GlDesign design, int tile = 0);
  ~GlPeer();

  /// A frame: the target is read back where asked for, after the last pass's time was taken. No planes.
  GlFrame draw(bool read_back);

 private:
  struct Work;  ///< one design's programs, textures and passes
  std::unique_ptr<Work> work_;
};

}  // namespace trueshade::oracle
