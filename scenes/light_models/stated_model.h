#pragma once
#include <cstdint>
#include <string>

#include "scenes/pipeline/light_model.h"
#include "scenes/pipeline/light_program.h"

namespace trueshade {

/// The same formula in other operations: the ones of our own arithmetic, which need fewer roots, or N.L and N.H of unit
/// vectors and the whole power, as renderers write them. What a legal driver may compute of the second holds what it may
/// compute of the first.
enum class Spelling : uint8_t { own, as_renderers_write };

/// A light model as a light program: scenes/light_models/presets/terms.glsl with the lines of its terms alone, behind
/// its numbers. `name` stands for the program's file. Surfaces are as the model's own planes have them: under
/// metallic_roughness, specular and shininess are those that metal and roughness were made into.
LightProgram program_of(const LightModel& model, const std::string& name = "light_model",
                        Spelling spelling = Spelling::own);

}  // namespace trueshade
