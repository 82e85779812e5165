#pragma once
#include <optional>
#include <span>
#include <string_view>

#include "scenes/pipeline/pipeline.h"

namespace trueshade {

struct Preset {
  std::string_view name;
  std::string_view source;  ///< where the row's numbers come from
  Pipeline pipeline;
};

std::span<const Preset> presets();

/// The pipeline of a preset's row; nothing if the name is unknown.
std::optional<Pipeline> preset_pipeline(std::string_view name);

}  // namespace trueshade
