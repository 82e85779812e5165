#pragma once
// A driver's profile, measured: for each field of a profile the tightest value that no frame of the driver's speaks
// against.
#include <string>
#include <vector>

#include "judge/bounds/profile.h"
#include "judge/probe/probe_frames.h"
#include "oracle/capture.h"

namespace trueshade::oracle {

/// A frame as the probed driver drew it, with the plan that it was drawn by. Borrows the plan.
struct ProbeFrame {
  const ProbePlan* plan = nullptr;
  Capture capture;
  LightSteps steps;  ///< of strategies that blend
};

/// What the frames tell of one field of the profile, or of fields that go together.
struct ProbedField {
  enum class State : uint8_t {
    told,     ///< the value holds in every frame, and a tighter one, or the other ones, do not
    open,     ///< unknown: values that exclude each other hold, or a value holds that no driver has
    refuted,  ///< no value holds: the driver does something that the judge has no word for
  };
  std::string field, value;  ///< as the profile's file spells them; the word `unknown` where it is not told
  State state = State::open;
  int tried = 0;        ///< how many values were tried
  std::string against;  ///< the frame that speaks against the next tighter value; empty where there is none
};

/// What the frames of a driver tell of its profile.
struct ProbeResult {
  Profile profile;
  std::vector<ProbedField> fields;
  std::vector<std::string> set_aside;  ///< frames that no OpenGL may have drawn: nothing is learnt of these
};

/// Finds the tightest profile that no frame contradicts, and gives it this name. Each value of each field is held
/// against frames until one contradicts it; takes some seconds of one core.
ProbeResult probe_profile(const std::vector<ProbeFrame>& frames, const std::string& name);

/// What a profile makes of a frame that was not used to find it.
struct ProbeCheck {
  std::string frame;
  uint64_t pixels = 0, exact = 0, violations = 0;  ///< of all stages
};

/// Judges a frame's G-buffer, and its blending or lighting, by a profile. Counts all pixels, the exact and the illegal
/// ones; a pixel counts once in each of the two stages.
ProbeCheck check_profile(const ProbeFrame& frame, const Profile& profile);

}  // namespace trueshade::oracle
