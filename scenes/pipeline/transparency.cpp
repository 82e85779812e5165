#include "scenes/pipeline/transparency.h"

#include <algorithm>

#include "core/fp_env.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

bool draws_transparent(const Scene& scene, const Pipeline& pipeline) {
  const FpScope fp;
  return pipeline.transparency.mode != TransparencyMode::none &&
         std::any_of(scene.instances.begin(), scene.instances.end(),
                     [&](const Instance& i) { return scene.materials[i.material].transparent; });
}

}  // namespace trueshade
