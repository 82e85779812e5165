// The program `trueshade`: every scene, every command.
#include <variant>

#include "cli/commands.h"
#include "cli/options.h"
#include "cli/stale_pages.h"
#include "core/error.h"
#include "judge/diagnosis/finding.h"

namespace trueshade {

std::vector<std::string> fault_names() {
  std::vector<std::string> names;
  for (const oracle::KnownFault& fault : oracle::known_faults()) names.emplace_back(fault.name);
  return names;
}

namespace {

int carry_out(const Command& command) {
  constexpr int kViolation = 1;
  if (const auto* options = std::get_if<RenderOptions>(&command)) render(*options);
  if (const auto* options = std::get_if<InfoOptions>(&command)) print_info(*options);
  if (const auto* options = std::get_if<ListOptions>(&command)) print_list(*options);
  if (const auto* options = std::get_if<GlslFilesOptions>(&command)) write_glsl(*options);
  if (const auto* options = std::get_if<ExportOptions>(&command)) export_scene(*options);
  if (const auto* options = std::get_if<ShadeOptions>(&command)) shade(*options);
  if (const auto* options = std::get_if<ExplainOptions>(&command)) explain(*options);
  if (const auto* options = std::get_if<ViewOptions>(&command)) view(*options);
  if (const auto* options = std::get_if<BenchOptions>(&command)) bench(*options);
  if (const auto* options = std::get_if<ValidationOptions>(&command)) return judge_opengl(*options) ? 0 : kViolation;
  if (const auto* options = std::get_if<ProbeOptions>(&command)) return probe_driver(*options) ? 0 : kViolation;
  if (const auto* options = std::get_if<CompareOptions>(&command)) return compare_pictures(*options);
  if (const auto* options = std::get_if<BatchOptions>(&command)) return run_batch(*options);
  if (const auto* options = std::get_if<VersionOptions>(&command)) print_version(*options);
  if (const auto* options = std::get_if<ManOptions>(&command)) write_man_pages(*options);
  if (const auto* options = std::get_if<CompletionOptions>(&command)) print_completion(*options);
  if (const auto* options = std::get_if<PrintText>(&command)) print(options->text);
  return 0;
}

}  // namespace

int execute(const Command& command) {
  const timespec start = time_of_files();
  try {
    return carry_out(command);
  } catch (const Error& error) {
    replace_stale_pages(command, error.what(), start);
    throw;
  }
}

}  // namespace trueshade
