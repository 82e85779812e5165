#include "cli/batch/job_commands.h"

#include <algorithm>
#include <filesystem>
#include <unordered_map>

#include "cli/option_values.h"
#include "cli/options.h"
#include "core/error.h"

namespace trueshade::batch {
namespace {

constexpr std::string_view kJobCommands[] = {"render",  "validate", "compare", "shade",
                                             "explain", "info",     "export",  "glsl"};

/// `WHERE: REASON (REMEDY)` without its remedy, and the remedy.
std::pair<std::string, std::string> reason_and_remedy(const std::string& text) {
  int depth = 0;
  for (size_t at = text.size(); at-- > 0;) {
    depth += text[at] == ')' ? 1 : text[at] == '(' ? -1 : 0;
    if (depth == 0 && at > 0) return {text.substr(0, at - 1), text.substr(at + 1, text.size() - at - 2)};
  }
  return {text, "correct it"};
}

Command command_of(const Job& job, const std::string& where) {
  if (std::find(std::begin(kJobCommands), std::end(kJobCommands), job.run.front()) == std::end(kJobCommands))
    throw Error(ErrorKind::bad_input, where + "/0", "'" + job.run.front() + "' is no command that a job may be",
                did_you_mean(job.run.front(), kJobCommands) + "one of: " + joined(kJobCommands));
  std::vector<const char*> words{"trueshade"};
  for (const std::string& word : job.run) words.push_back(word.c_str());
  try {
    return command_from_arguments(int(words.size()), words.data());
  } catch (const Error& error) {
    const auto [reason, remedy] = reason_and_remedy(error.what());
    throw Error(ErrorKind::bad_input, where, reason, remedy);
  }
}

/// Files that a command is told to write. Names of frames and of cube faces are made of these.
std::vector<std::string> written_files(const Command& command) {
  std::vector<std::string> files;
  const auto add = [&files](const std::optional<std::string>& file) {
    if (file) files.push_back(*file);
  };
  std::visit(
      [&](const auto& options) {
        if constexpr (requires { options.outputs; })
          files.insert(files.end(), options.outputs.begin(), options.outputs.end());
        if constexpr (requires { options.saved; })
          files.insert(files.end(), options.saved.begin(), options.saved.end());
        if constexpr (requires { options.output; }) files.push_back(options.output);
        if constexpr (requires { options.report; }) add(options.report);
        if constexpr (requires { options.junit; }) add(options.junit);
      },
      command);
  std::erase_if(files,
                [](const std::string& file) { return file.empty() || file == "-" || file.starts_with("/dev/"); });
  return files;
}

}  // namespace

void check_commands(const JobList& list) {
  std::unordered_map<std::string, const Job*> writers;
  for (const Job& job : list.jobs) {
    const std::string where = list.file + ": " + job.pointer + "/run";
    for (const std::string& file : written_files(command_of(job, where))) {
      const auto [found, is_new] = writers.emplace(std::filesystem::path(file).lexically_normal().string(), &job);
      if (!is_new && found->second != &job)
        throw Error(ErrorKind::bad_input, where,
                    "the job '" + job.name + "' writes " + file + ", as the job '" + found->second->name + "' does",
                    "another name for one of them");
    }
  }
}

}  // namespace trueshade::batch
