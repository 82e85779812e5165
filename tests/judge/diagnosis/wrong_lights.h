#pragma once
// A light pass in plain floats that can be wrong in ways which no scene and no pipeline expresses: written from
// docs/arithmetic.md section 8, for planting faults alone.
#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::testing {

enum class LightSlip {
  none,
  distance_once,        ///< 1 / d for 1 / d^2, k2 d for k2 d^2
  distance_squared,     ///< 1 - d^2 / range^2, k1 d^2
  half_without_viewer,  ///< H = L - V
  half_without_light,   ///< H = V - L
  reflection,           ///< R.V for N.H
  quake_root,           ///< 1 / sqrt by a shifted integer and one step of Newton's
  short_root,           ///< 1 / sqrt cut to 12 bits
  half_sums,            ///< a sum in half precision
  truncated_stores,     ///< codes cut off
  dithered,             ///< a Bayer matrix of 4 by 4 before the store
  normals_of_8_bits,    ///< read from a texture of 8 bits
  normals_in_view,      ///< rotated by the camera
  normals_raw,          ///< not normalised where they should be, or the other way round
  highlight_mask,       ///< kept where N.L <= 0, or the other way round
  premultiplied,        ///< colour times alpha before the store
  shifted_tiles,        ///< lists of 16x16 tiles are those of the tiles to their right
  stale_tile,           ///< one tile of 16x16 pixels is lit by none of the later lights
  most_at_pixel,        ///< a list that holds so many
  full_lists,           ///< lists of 16x16 tiles that hold so many
  two_sided,            ///< |N.L|
};

/// The picture that a light pass with the slip makes of the capture's planes. Point lights, lamps and lights without a
/// cone, of Blinn-Phong models; the strategies deferred-loop and deferred-volumes without meshes.
///   amount: what the slip needs of a number
Image slipped_picture(const Scene& scene, const Pipeline& pipeline, const oracle::Capture& capture, LightSlip slip,
                      int amount = 0);

}  // namespace trueshade::testing
