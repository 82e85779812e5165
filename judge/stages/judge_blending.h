#pragma once
// Strategies that draw light by light: each draw's output blended into the target, as docs/gl_rules.md sections 4 and 9
// bound it.
#include "judge/stages/judge.h"

namespace trueshade::oracle {

/// What judge_lighting() does for strategies that blend, where the final image is all there is: the set of values a
/// pixel may hold, carried through all lights as an interval. Two of them, where some light may or may not draw: of the
/// nominal draws, and of all. No light is told apart, and what could cancel is not followed, so this is the weaker
/// judge of the two; its rounding choices are not counted for the tests of the whole image.
StageVerdict judge_blended(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                           const JudgedRows& rows = {});

}  // namespace trueshade::oracle
