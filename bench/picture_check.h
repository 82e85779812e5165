#pragma once
#include <cstdint>

#include "core/image.h"
#include "scenes/pipeline/pipeline.h"
#include "shading/frame.h"

namespace trueshade {

/// A peer's picture, and the pipeline by which render_frame() draws it.
struct PeerPicture {
  Image image;
  Pipeline as;
};

/// Two pictures are one where at most one pixel in so many has a channel that is over picture_codes() apart: OpenGL's
/// edges and light terms go either way. A code is 1/255 of the larger value, of 1 where that is less. 100; 40 where
/// surfaces are textured, because a driver takes derivatives from 2x2 pixels, whose triangles end in between.
uint64_t one_pixel_in(const Scene& scene);

/// 2; where textured surfaces are blended light by light, more: a texel that differs by a part of a code
/// (docs/gl_rules.md section 5) takes each light's term to the next code or does not, a random walk of as many steps as
/// there are lights.
double picture_codes(const Scene& scene, Strategy strategy);

uint64_t pixels_apart(const Image& a, const Image& b, double codes);

/// How a peer's picture compares to ours.
struct PictureCheck {
  Strategy strategy;       ///< of ours that draws this picture: where values are rounded, where lights end
  bool same_rounding;      ///< as in the frame that is timed: light by light, or a sum once
  double codes;            ///< that pixels may be apart
  uint64_t off_ours = 0;   ///< pixels apart from what that strategy draws here
  uint64_t off_timed = 0;  ///< pixels apart from the frame that is timed
  uint64_t pixels = 0;
  uint64_t one_in = 100;                                              ///< pixels that may be apart
  bool right() const { return off_ours * one_in <= pixels; }          ///< the peer draws what it says it does
  bool same_shading() const { return off_timed * one_in <= pixels; }  ///< but for where light is rounded
  bool same() const { return same_rounding && same_shading(); }
};
PictureCheck picture_check(const PreparedScene& prepared, const Execution& execution, const Pipeline& pipeline,
                           const Image& timed, const PeerPicture& theirs);

}  // namespace trueshade
