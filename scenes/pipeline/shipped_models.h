#pragma once
#include <span>
#include <string>
#include <string_view>

#include "scenes/pipeline/light_program.h"

namespace trueshade {

/// A light program that ships: scenes/light_models/NAME.glsl.
struct ShippedModel {
  std::string_view name;
  std::string_view about;  ///< what it is and its source, the first line of its text
  std::string_view text;   ///< GLSL
};

/// All of them, by name.
std::span<const ShippedModel> shipped_models();

/// Whether what names a light program means a model that ships, and not a file: it has neither a dot nor a slash.
bool names_shipped_model(std::string_view name);

/// Error(usage) with the names of all where there is none of this one.
const ShippedModel& shipped_model(std::string_view name);

/// The model as a pipeline has it, without parameters. Error(usage) as above.
LightProgram shipped_program(std::string_view name);

/// Gives a model that ships, which a pipeline's JSON names, its text; other programs stay. Error(usage) as above,
/// Error(bad_input) where the JSON has the SHA-256 of another text.
void give_text(LightProgram& program);

}  // namespace trueshade
