#pragma once
#include "cli/option_checks.h"
#include "cli/option_table.h"

namespace trueshade {

// A table for each command, whose rows fill what is named here, which must outlive it.
CommandTable render_table(RenderOptions& options);
CommandTable info_table(InfoOptions& options);
CommandTable list_table(ListOptions& options);
CommandTable glsl_table(GlslFilesOptions& options);
CommandTable export_table(ExportOptions& options);
CommandTable validate_table(ValidationOptions& options);
CommandTable probe_table(ProbeOptions& options);
CommandTable shade_table(ShadeOptions& options);
CommandTable explain_table(ExplainOptions& options);
CommandTable view_table(ViewOptions& options);
CommandTable bench_table(BenchOptions& options);
CommandTable compare_table(CompareOptions& options);
CommandTable batch_table(BatchOptions& options);
CommandTable man_table(ManOptions& options, const std::vector<std::string>& commands);  ///< names of all
CommandTable completion_table(CompletionOptions& options);

/// Every command's table, in the order of help, and what their rows fill.
class CommandTables {
 public:
  CommandTables();
  CommandTables(const CommandTables&) = delete;
  CommandTables& operator=(const CommandTables&) = delete;

  const std::vector<CommandTable>& all() const { return tables_; }
  std::vector<std::string> names() const;
  const CommandTable* named(const std::string& name) const;  ///< null: there is no such command

 private:
  RenderOptions render_;
  InfoOptions info_;
  ListOptions list_;
  GlslFilesOptions glsl_;
  ExportOptions export_;
  ValidationOptions validation_;
  ProbeOptions probe_;
  ShadeOptions shade_;
  ExplainOptions explain_;
  ViewOptions view_;
  BenchOptions bench_;
  CompareOptions compare_;
  BatchOptions batch_;
  ManOptions man_;
  CompletionOptions completion_;
  std::vector<CommandTable> tables_;
};

// Rows that several commands have.
extern const char* const kSceneHelp;
inline constexpr const char* kCameraGroup = "Camera and time";
void add_layers(CommandTable& table, PipelineOptions& options);  ///< --preset and --pipeline; opens `Pipeline`
void add_size(CommandTable& table, std::optional<Size>& size, int most = kMostDrawnSide);  ///< pixels a side
void add_time(CommandTable& table, SceneOptions& options);
void add_camera(CommandTable& table, SceneOptions& options);  ///< which camera sees, and which animation is played
void add_target(CommandTable& table, PipelineOptions& options);
void add_strategy(CommandTable& table, PipelineOptions& options);
void add_profile(CommandTable& table, PipelineOptions& options);
void add_view(CommandTable& table, PipelineOptions& options);
void add_threads(CommandTable& table, int& threads, const char* help);
void add_light_program(CommandTable& table, PipelineOptions& options);  ///< of commands that draw or judge lights
void add_simd(CommandTable& table, std::string& simd, const std::string& help);
/// How ranks that MPI has started share the work of a command; opens a group.
void add_sharing(CommandTable& table, SharingRules& sharing);
/// Files of planes, under a heading of their own. `gbuffer`: the name of the option or argument of these files.
void add_capture(CommandTable& table, CaptureOptions& options, const char* gbuffer, const char* help);

}  // namespace trueshade
