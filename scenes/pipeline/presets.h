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

/// Whether this build draws by light programs. One that found no glslang does not.
bool draws_light_programs();

/// The pipeline that a scene starts from where no preset is named: that of the first row, or for a photometric scene
/// that of glTF's own light model, with back faces culled: glTF's materials that are not double-sided show none. That
/// model is a light program; without, the row of numbers for candela and lux stands in. A scene that has lights with an
/// area starts from glTF's row too, by the light model `area`.
const Pipeline& default_pipeline(const Scene& scene, bool by_program = draws_light_programs());

/// Whether a pipeline has the light program of its preset's row, or none where the row has none.
bool draws_by_its_preset(const Pipeline& pipeline);

}  // namespace trueshade
