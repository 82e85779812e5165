#include "cli/shell_words.h"

#include "cli/camera_json.h"
#include "cli/json_text.h"
#include "cli/looks.h"

namespace trueshade {

std::string for_shell(const std::string& word) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./:=,+";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

namespace {

/// How the scene file was read, as options with a space before each.
std::string reading_words(const Limits& limits) {
  return std::string(limits.leniency == Leniency::asked ? " --lenient" : "") +
         (limits.named_paths == NamedPaths::any ? " --trust-paths" : "");
}

}  // namespace

std::string explain_command(const PipelineOptions& options, const CameraChanges& camera, const Pipeline& pipeline,
                            double time, const std::string& against) {
  std::string command = "trueshade explain " + for_shell(options.scene);
  if (options.preset) command += " --preset " + for_shell(*options.preset);
  if (options.pipeline_file) command += " --pipeline " + for_shell(*options.pipeline_file);
  command += " --size " + std::to_string(pipeline.width) + 'x' + std::to_string(pipeline.height);
  if (options.strategy) command += " --strategy " + std::string(name_of(*options.strategy));
  if (options.target) command += " --target " + std::string(info(*options.target).name);
  if (options.profile) command += " --profile " + std::string(profile_name(*options.profile));
  if (options.looks.samples) command += " --samples " + *options.looks.samples;
  command += looks_text(options.looks);
  if (time != 0) command += " --time " + json_number(time);
  command += camera_words(options.parts, camera) + reading_words(options.limits);
  command += " --pixel {x},{y}";
  if (!against.empty()) command += " --against " + for_shell(against);
  return command;
}

}  // namespace trueshade
