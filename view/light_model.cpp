#include "view/light_model.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "programs/run/executable.h"
#include "scenes/pipeline/program_inputs.h"
#include "shading/program/program_frame.h"

namespace trueshade::viewer {
namespace {

/// Those of the block that the program reads, in the order of the block.
std::vector<ModelParameter> parameters_of(const programs::Program& program, const std::string& text) {
  const std::vector<DeclaredParameter> ranges = declared_parameters(text);
  std::vector<ModelParameter> parameters;
  for (const std::string& declaration : program.parameters) {
    const ParameterType type = parameter_type(declaration);
    const std::string whole = std::string(kParameterBlock) + type.name;
    const auto is_part = [&](const programs::ProgramInput& input) {
      return type.components == 1 ? input.name == whole : without_component(input.name) == whole;
    };
    if (std::none_of(program.inputs.begin(), program.inputs.end(), is_part)) continue;
    const ParameterRange* const range = range_of(ranges, type.name.substr(0, type.name.find('[')));
    parameters.push_back(
        {type.name, type.components, type.is_float, type.is_signed, range ? std::optional(*range) : std::nullopt});
  }
  return parameters;
}

/// Whether the value is one of the parameter's type, within its range.
bool takes(const ModelParameter& parameter, float value) {
  const float least = parameter.is_signed ? -kLargestWholeParameter : 0.0f;
  const bool has_type =
      parameter.is_float || (value == std::floor(value) && value >= least && value <= kLargestWholeParameter);
  return has_type && (!parameter.range || parameter.range->holds(value));
}

float first_value(const ModelParameter& parameter) {
  if (!parameter.range) return 1.0f;
  const auto [least, most, usual] = *parameter.range;
  if (usual) return *usual;
  const double value = std::isinf(most) ? std::max(least, 1.0) : least + (most - least) / 2.0;
  return float(parameter.is_float ? value : std::ceil(value));
}

/// A value that the program had, as the parameter is now.
std::vector<float> value_for(const ModelParameter& parameter, const std::vector<ProgramParameter>& had) {
  std::vector<float> value(parameter.components, first_value(parameter));
  for (const ProgramParameter& one : had) {
    if (one.name != parameter.name) continue;
    for (size_t c = 0; c < std::min(value.size(), one.value.size()); ++c)
      if (takes(parameter, one.value[c])) value[c] = one.value[c];
  }
  return value;
}

}  // namespace

ReadyModel ready_model(LightProgram program) {
  const std::shared_ptr<const programs::Executable> executable = executable_of(program);
  ReadyModel model;
  model.program = std::move(program);
  model.parameters = parameters_of(executable->program, model.program.text);
  std::vector<ProgramParameter> values;
  for (const ModelParameter& parameter : model.parameters)
    values.push_back({parameter.name, value_for(parameter, model.program.parameters)});
  model.program.parameters = std::move(values);
  for (const programs::ProgramInput& input : executable->program.inputs) {
    model.inputs.push_back(input.name);
    model.reads_time = model.reads_time || input.name == "view.time" || input.name == "view.frame";
  }
  model.declared = executable->program.parameters;
  require_fields(model.program.file, program_reads(model.program.file, model.inputs).captured);
  check_values(model.program, model.inputs, model.declared);
  return model;
}

BrokenModel broken_model(const std::string& file, const std::string& text, const std::string& reason) {
  BrokenModel broken{reason, {}};
  if (!reason.starts_with(file + ':')) return broken;
  const int line = std::atoi(reason.c_str() + file.size() + 1);  // 0 where no number stands there
  size_t first = 0;
  for (int i = 1; i < line && first < text.size(); ++i) first = std::min(text.find('\n', first), text.size()) + 1;
  if (line <= 0 || first >= text.size()) return broken;
  const std::string whole = text.substr(first, text.find('\n', first) - first);
  const size_t begin = whole.find_first_not_of(" \t"), end = whole.find_last_not_of(" \t\r");
  if (begin != std::string::npos) broken.line = whole.substr(begin, end + 1 - begin);
  return broken;
}

}  // namespace trueshade::viewer
