#include "tests/judge/violations.h"

#include "tests/judge/mutants/mutants.h"
#include "tests/judge/captured.h"

namespace trueshade::testing {

using namespace trueshade::oracle;

uint64_t violations(const Scene& scene, const Pipeline& drawn, const Profile& profile, const Capture& capture,
                    const Capture* legal) {
  const Pipeline pipeline = with_surface_planes(drawn);
  const bool known = legal != nullptr && same_surfaces(*legal, capture);
  const uint64_t found = known ? 0 : judge_gbuffer(scene, pipeline, profile, capture).count(PixelClass::violation);
  return found > 0 ? found : judge_lighting(scene, pipeline, profile, capture).count(PixelClass::violation);
}

}  // namespace trueshade::testing
