#pragma once
#include <optional>
#include <span>
#include <string_view>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// A named row of numbers that a pipeline starts from.
struct Preset {
  std::string_view name;
  std::string_view source;  ///< where the row's numbers come from
  Pipeline pipeline;
};

/// All presets, in the order of `trueshade list`.
std::span<const Preset> presets();

/// The pipeline of a preset's row; nothing if the name is unknown.
std::optional<Pipeline> preset_pipeline(std::string_view name);

/// The pipeline that a scene starts from where no preset is named: that of the first row, or for a photometric scene
/// that of the row for candela and lux, with back faces culled: glTF's materials that are not double-sided show none.
const Pipeline& default_pipeline(const Scene& scene);

}  // namespace trueshade
