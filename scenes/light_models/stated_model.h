#pragma once
#include <string>

#include "scenes/pipeline/light_model.h"
#include "scenes/pipeline/light_program.h"

namespace trueshade {

/// A light model as a light program: scenes/light_models/presets/terms.glsl with the lines of its terms alone, behind
/// its numbers. `name` stands for the program's file. Surfaces are as the model's own planes have them: under
/// metallic_roughness, specular and shininess are those that metal and roughness were made into.
LightProgram program_of(const LightModel& model, const std::string& name = "light_model");

}  // namespace trueshade
