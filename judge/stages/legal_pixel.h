#pragma once
#include <array>

#include "judge/bounds/profile.h"
#include "judge/legal/pixel_class.h"
#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// What one channel of the target may hold; unorm in codes.
struct LegalChannel {
  double low = 0, high = 0;
  bool is_bounded = true;  ///< false: neither end of the format is illegal
};

/// What one pixel of the target may hold, and what it does.
struct LegalPixel {
  PixelClass pixel_class = PixelClass::exact;
  int channels = 0;
  std::array<LegalChannel, 4> channel{};  ///< each where the other channels are the nominal ones
};

/// Judges the target of one pixel by the capture's own planes there, as judge_lighting() judges all, and finds what
/// each channel may hold: for this it judges the pixel up to two more times a channel. (x, y) counts from the top left.
///   nominal: the target of the reference, legal at the pixel and of the capture's size and format
/// Throws as judge_lighting().
LegalPixel legal_pixel(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                       const Image& nominal, int x, int y);

}  // namespace trueshade::oracle
