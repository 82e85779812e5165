#pragma once
// Strategies that draw light by light: each draw's output blended into the target, as docs/gl_rules.md sections 4 and 9
// bound it.
#include "judge/stages/judge.h"

namespace trueshade::oracle {

/// What judge_lighting() does under strategies that blend, where only the final image is captured. It carries the
/// interval of values that a pixel may hold through all lights; where a light may or may not draw, a second one by the
/// nominal draws alone. It does not tell lights apart, nor follows what could cancel, so it is weaker than
/// judge_blending(). Its rounding choices are not counted for the tests of the whole image.
StageVerdict judge_blended(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                           const JudgedRows& rows = {});

}  // namespace trueshade::oracle
