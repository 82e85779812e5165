// The session's light model: which one, its parameters, and the file that is compiled anew when it is saved.
#include <algorithm>
#include <utility>

#include "cli/preparation.h"
#include "core/error.h"
#include "scenes/pipeline/presets.h"
#include "scenes/pipeline/program_inputs.h"
#include "view/session.h"

namespace trueshade::viewer {

void Session::use(ReadyModel model) {
  for (Pipeline* pipeline : {&state_.pipeline, &base_pipeline_}) pipeline->light_program = model.program;
  parameters_ = std::move(model.parameters);
  model_inputs_ = std::move(model.inputs), model_declared_ = std::move(model.declared),
  model_reads_time_ = model.reads_time;
  plays_ = plays_ && has_time();
  ++model_revision_;
}

void Session::use_program(const LightProgram& program) {
  if (program != state_.pipeline.light_program) use(program.used() ? ready_model(program) : ReadyModel());
}

/// The model of that name; without, what the preset draws by.
void Session::set_model(const std::string& name) {
  const std::optional<Pipeline> preset = preset_pipeline(state_.pipeline.preset);
  const LightProgram program = !name.empty() ? light_program_of(name) : preset ? preset->light_program : LightProgram();
  ReadyModel model = program.used() ? ready_model(program) : ReadyModel();
  LightVolumes& volumes = state_.pipeline.light_volumes;
  if (preset) volumes.point = preset->light_volumes.point, volumes.spot = preset->light_volumes.spot;
  if (!name.empty()) end_at_range(volumes);
  use(std::move(model));
  broken_model_.reset();
  changed();
}

void Session::set_parameter(const std::string& name, const std::vector<float>& value) {
  LightProgram program = state_.pipeline.light_program;
  const auto known = std::find_if(program.parameters.begin(), program.parameters.end(),
                                  [&](const ProgramParameter& one) { return one.name == name; });
  if (known == program.parameters.end() || known->value.size() != value.size())
    throw Error(ErrorKind::bad_input, "light-parameter",
                "the light model reads no '" + name + "' of " + std::to_string(value.size()) + " numbers",
                "the panel `model` names its parameters");
  known->value = value;
  check_values(program, model_inputs_, model_declared_);
  for (Pipeline* pipeline : {&state_.pipeline, &base_pipeline_}) pipeline->light_program = program;
  changed();
}

void Session::reload_model() {
  model_watch_.watch({model_file_});  // what changes from here on calls for another time
  if (state_.pipeline.light_program.file != model_file_) return;
  maker_.work_on([this, shown = state_.pipeline.light_program] {
    LightProgram read{shown.file, {}, {}, {}};
    try {
      read = light_program_of(shown.file);
      read.parameters = shown.parameters;
      auto model = std::make_shared<ReadyModel>(ready_model(read));
      maker_.post([this, model] { take_model(std::move(*model)); });
    } catch (const Error& error) {
      maker_.post([this, broken = trueshade::viewer::broken_model(read.file, read.text, error.what())] {
        if (state_.pipeline.light_program.file != model_file_) return;  // another one is shown by now
        problems_.push_back(broken.reason);
        broken_model_ = broken;
        ++model_revision_;
      });
    }
  });
}

/// The file as it is now. What the panel has set since it was read stays.
void Session::take_model(ReadyModel model) {
  const LightProgram& shown = state_.pipeline.light_program;
  if (shown.file != model.program.file) return;
  const bool is_same = shown.text == model.program.text;
  model.program.parameters = shown.parameters;
  use(ready_model(std::move(model.program)));
  broken_model_.reset();
  if (is_same) return;
  card_.reset();
  changed();
  tell("compiled " + shown.file + " anew");
}

}  // namespace trueshade::viewer
