#pragma once
#include <array>

#include "judge/bounds/profile.h"
#include "judge/legal/pixel_class.h"
#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// The range of values that one channel of the target may hold; unorm in codes.
struct LegalChannel {
  double low = 0, high = 0;
  bool is_bounded = true;  ///< false: both ends of the format's range are legal, and low and high are not set
};

/// What one pixel of the target may hold, and the class of what it does hold.
struct LegalPixel {
  PixelClass pixel_class = PixelClass::exact;
  int channels = 0;
  std::array<LegalChannel, 4> channel{};  ///< each where the other channels are the nominal ones
};

/// Judges the target at one pixel by the capture's own planes there, as judge_lighting() judges all pixels, and finds
/// what each channel may hold, which takes up to two further judgements a channel. (x, y) counts from the top left.
///   nominal: the reference's target, legal at the pixel, of the capture's size and format
/// Throws as judge_lighting().
LegalPixel legal_pixel(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                       const Image& nominal, int x, int y);

}  // namespace trueshade::oracle
