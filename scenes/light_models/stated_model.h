#pragma once
#include <cstdint>
#include <string>

#include "scenes/pipeline/light_model.h"
#include "scenes/pipeline/light_program.h"

namespace trueshade {

/// The same formula in other operations.
enum class Spelling : uint8_t {
  own,                 ///< those of our own arithmetic, which need fewer roots
  as_renderers_write,  ///< N.L and N.H of unit vectors, and the whole power: what is legal of these holds the others
  for_drivers,         ///< what drivers are given: inverse roots, no branch, 0 where GLSL leaves a result open
  in_products          ///< for_drivers, and a whole power up to 64 by multiplications, as fast renderers write it
};

/// A light model as a light program: scenes/light_models/presets/terms.glsl with the lines of its terms alone, behind
/// its numbers. `name` stands for the program's file. Surfaces are as the model's own planes have them: under
/// metallic_roughness, specular and shininess are those that metal and roughness were made into.
LightProgram program_of(const LightModel& model, const std::string& name = "light_model",
                        Spelling spelling = Spelling::own);

}  // namespace trueshade
