#include "view/light_model.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "programs/run/executable.h"
#include "scenes/pipeline/program_inputs.h"
#include "shading/program/program_frame.h"

namespace trueshade::viewer {
namespace {

std::vector<ModelParameter> parameters_of(const programs::Program& program, const std::string& text) {
  const std::vector<DeclaredParameter> declared = declared_parameters(text);
  std::vector<ModelParameter> parameters;
  for (const programs::ProgramInput& input : program.inputs) {
    if (!input.name.starts_with(kParameterBlock)) continue;
    const std::string whole = without_component(input.name);
    const std::string name = whole.substr(kParameterBlock.size());
    const size_t component = whole == input.name ? 0 : std::string_view("xyzw").find(input.name.back());
    auto known = std::find_if(parameters.begin(), parameters.end(), [&](const auto& one) { return one.name == name; });
    if (known == parameters.end()) {
      const ParameterRange* const range = range_of(declared, name);
      parameters.push_back({name, 1, input.type == programs::Type::f32, range ? std::optional(*range) : std::nullopt});
      known = parameters.end() - 1;
    }
    known->components = std::max(known->components, component + 1);
  }
  const auto place = [&](const ModelParameter& one) {
    return std::find_if(declared.begin(), declared.end(), [&](const auto& other) { return other.name == one.name; });
  };
  std::stable_sort(parameters.begin(), parameters.end(),
                   [&](const auto& a, const auto& b) { return place(a) < place(b); });
  return parameters;
}

float first_value(const ModelParameter& parameter) {
  if (!parameter.range) return 1.0f;
  const auto [least, most] = *parameter.range;
  const double value = std::isinf(most) ? std::max(least, 1.0) : least + (most - least) / 2.0;
  return float(parameter.is_float ? value : std::ceil(value));
}

/// A value that the program had, as the parameter is now.
std::vector<float> value_for(const ModelParameter& parameter, const std::vector<ProgramParameter>& had) {
  std::vector<float> value(parameter.components, first_value(parameter));
  for (const ProgramParameter& one : had) {
    if (one.name != parameter.name) continue;
    for (size_t c = 0; c < std::min(value.size(), one.value.size()); ++c)
      if (!parameter.range || parameter.range->holds(one.value[c])) value[c] = one.value[c];
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
  require_fields(model.program.file, program_reads(model.program.file, model.inputs).captured);
  check_values(model.program, model.inputs);
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
