#pragma once
// Frames of random_frame() drawn by a renderer that is right, and judged: none may be convicted.
#include <functional>
#include <string>

#include "judge/bounds/profile.h"
#include "oracle/capture.h"
#include "tests/judge/random_frame.h"

namespace trueshade::testing {

/// A frame, and the target after each light and each transparent object, where the renderer was asked to show them.
struct DrawnFrame {
  oracle::Capture capture;
  int subpixel_bits = 8;
  bool shows_steps = false;
  std::vector<std::pair<int, Image>> lights, objects;
};

/// Throws Error(no_gl_driver or limit) where it cannot draw what the pipeline asks for.
using FrameDrawer = std::function<DrawnFrame(const RandomFrame&)>;

struct RandomFrames {
  std::string drawer;       ///< of the line that says what was judged
  oracle::Profile profile;  ///< what frames are held to, but for the subpixel bits, which the driver states
  FrameTheme theme = FrameTheme::any;
  uint64_t first = 1;  ///< seed
  int count = 0;
  double most_refused = 1.0 / 3;  ///< share of the frames that may be left out, or not drawn
  /// Why a frame is left out, where the driver is known to be wrong there; empty of others.
  std::function<std::string(const RandomFrame&, const DrawnFrame&)> left_out{};
};

/// Checks that none of the frames has a violation or is convicted, as a capture from files and, where its steps are
/// shown, draw by draw. Each alarm is told by its seed.
void check_random_frames(const RandomFrames& asked, const FrameDrawer& drawer);

// A file of a profile, LEGAL_PROFILE of the environment, is what all frames are held to instead.

/// How many frames the long tests judge: LEGAL_FRAMES of the environment, else `usual`.
int long_count(int usual);
/// Seed of the long tests' first frame: LEGAL_FIRST of the environment, else `usual`.
uint64_t long_first(uint64_t usual);

}  // namespace trueshade::testing
