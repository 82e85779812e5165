// The program `trueshade`: every scene, every command.
#include <variant>

#include "cli/commands.h"
#include "cli/options.h"
#include "cli/preparation.h"
#include "core/image_files/image_io.h"
#include "judge/diagnosis/finding.h"

namespace trueshade {

Scene scene_of_options(const std::string& spec, const Limits& limits) {
  return load_scene(spec, limits,
                    [&limits](std::span<const uint8_t> content, const std::string& where, uint64_t most_bytes) {
                      return decode_image(content, where, most_bytes, limits.expansion);
                    });
}

std::vector<std::string> fault_names() {
  std::vector<std::string> names;
  for (const oracle::KnownFault& fault : oracle::known_faults()) names.emplace_back(fault.name);
  return names;
}

int execute(const Command& command) {
  constexpr int kViolation = 1;
  if (const auto* options = std::get_if<RenderOptions>(&command)) render(*options);
  if (const auto* options = std::get_if<InfoOptions>(&command)) print_info(*options);
  if (const auto* options = std::get_if<ListOptions>(&command)) print_list(*options);
  if (const auto* options = std::get_if<GlslFilesOptions>(&command)) write_glsl(*options);
  if (const auto* options = std::get_if<ExportOptions>(&command)) export_scene(*options);
  if (const auto* options = std::get_if<ShadeOptions>(&command)) shade(*options);
  if (const auto* options = std::get_if<ExplainOptions>(&command)) explain(*options);
  if (const auto* options = std::get_if<BenchOptions>(&command)) bench(*options);
  if (const auto* options = std::get_if<ValidationOptions>(&command)) return judge_opengl(*options) ? 0 : kViolation;
  if (const auto* options = std::get_if<CompareOptions>(&command)) return compare_pictures(*options);
  if (const auto* options = std::get_if<VersionOptions>(&command)) print_version(*options);
  if (const auto* options = std::get_if<PrintText>(&command)) print(options->text);
  return 0;
}

}  // namespace trueshade
