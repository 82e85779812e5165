#pragma once
#include <vector>

#include "scenes/pipeline/presets.h"

namespace trueshade {

/// The presets whose light is the formula that their light model states, and no light program: what is held to that
/// formula runs through these.
inline std::vector<Preset> stated_presets() {
  std::vector<Preset> stated;
  for (const Preset& preset : presets())
    if (!preset.pipeline.light_program.used()) stated.push_back(preset);
  return stated;
}

}  // namespace trueshade
