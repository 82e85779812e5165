#pragma once
#include <optional>
#include <string>
#include <vector>

#include "scenes/pipeline/light_program.h"
#include "scenes/pipeline/parameter_ranges.h"

namespace trueshade::viewer {

/// A number or vector that a light program reads of its block of parameters.
struct ModelParameter {
  std::string name;
  size_t components = 1;
  bool is_float = true;  ///< else whole numbers
  bool is_signed = true;
  std::optional<ParameterRange> range;
};

/// A light program that can be drawn by.
struct ReadyModel {
  LightProgram program;  ///< with a value for each parameter
  std::vector<ModelParameter> parameters;
  std::vector<std::string> inputs;    ///< that it reads, as programs::Program has them
  std::vector<std::string> declared;  ///< as programs::Program::parameters has them
  bool reads_time = false;
};

/// Compiles a program. Values that it has stay where it still reads them; a parameter without one gets the middle of
/// its range, or 1. Error as drawing by it throws.
ReadyModel ready_model(LightProgram program);

/// Why a file is no light model now.
struct BrokenModel {
  std::string reason;  ///< FILE:LINE:COLUMN: reason (remedy)
  std::string line;    ///< the line that this is about, without blanks around it; empty where it is about none
};

/// `file` as the reason of an error has it in front; `text` as it was read.
BrokenModel broken_model(const std::string& file, const std::string& text, const std::string& reason);

}  // namespace trueshade::viewer
