#pragma once
// Whether a picture is rejected, at no more cost than that takes.
#include <cstdint>

#include "judge/stages/judge.h"

namespace trueshade::testing {

/// How many pixels of the first stage that has any, the surfaces or the target's last state, are violations: a picture
/// is rejected by one.
///   legal: null, or a picture of the same scene and pipeline that passes under the profile; surfaces that are its own,
///   byte by
///          byte, are not judged again
uint64_t violations(const Scene& scene, const Pipeline& pipeline, const oracle::Profile& profile,
                    const oracle::Capture& capture, const oracle::Capture* legal);

}  // namespace trueshade::testing
