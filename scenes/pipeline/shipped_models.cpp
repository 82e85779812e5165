#include "scenes/pipeline/shipped_models.h"

#include <array>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/likeliest_name.h"
#include "core/sha256.h"
#include "scenes/pipeline/shipped_texts.h"
#include "scenes/pipeline/presets.h"

namespace trueshade {
namespace {

std::string_view first_line(std::string_view text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  return line.substr(line.find_first_not_of("/ "));
}

constexpr size_t kCount = std::size(kLightModelTexts);

}  // namespace

std::span<const ShippedModel> shipped_models() {
  static const std::array<ShippedModel, kCount> models = [] {
    std::array<ShippedModel, kCount> made;
    for (size_t i = 0; i < kCount; ++i) {
      const auto& [name, text] = kLightModelTexts[i];
      made[i] = {name, first_line(text), text};
    }
    return made;
  }();
  return models;
}

bool names_shipped_model(std::string_view name) { return name.find_first_of("./") == std::string_view::npos; }

const ShippedModel& shipped_model(std::string_view name) {
  std::vector<std::string_view> names;
  std::string all;
  for (const ShippedModel& model : shipped_models()) {
    if (model.name == name) return model;
    names.push_back(model.name);
    all += ' ' + std::string(model.name);
  }
  if (preset_pipeline(name))
    throw Error(ErrorKind::usage, "'" + std::string(name) + "'", "is a preset, and no light model that ships",
                "--preset " + std::string(name));
  throw Error(ErrorKind::usage, "'" + std::string(name) + "'", "is no light model that ships",
              did_you_mean(name, names) + "one of:" + all + "; or a file, whose name has a dot or a slash");
}

LightProgram shipped_program(std::string_view name) {
  const ShippedModel& model = shipped_model(name);
  return {std::string(model.name), std::string(model.text), sha256_of(std::string(model.text)), {}};
}

void give_text(LightProgram& program) {
  if (!program.used() || !program.text.empty() || !names_shipped_model(program.file)) return;
  LightProgram model = shipped_program(program.file);
  if (!program.sha256.empty() && program.sha256 != model.sha256)
    throw Error(ErrorKind::bad_input, program.file, "is not the light program that the pipeline names",
                "the file whose SHA-256 is " + program.sha256);
  model.parameters = std::move(program.parameters);
  program = std::move(model);
}

}  // namespace trueshade
