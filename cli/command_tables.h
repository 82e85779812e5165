#pragma once
#include "cli/option_table.h"
#include "cli/option_texts.h"

namespace trueshade {

// A table for each command, whose rows fill what is named here, which must outlive it.
CommandTable render_table(RenderOptions& options, RenderTexts& texts);
CommandTable info_table(InfoOptions& options, InfoTexts& texts);
CommandTable list_table(ListOptions& options);
CommandTable glsl_table(GlslFilesOptions& options, GlslTexts& texts);
CommandTable export_table(ExportOptions& options, ExportTexts& texts);
CommandTable validate_table(ValidationOptions& options, ValidationTexts& texts);
CommandTable probe_table(ProbeOptions& options);
CommandTable shade_table(ShadeOptions& options, ShadeTexts& texts);
CommandTable explain_table(ExplainOptions& options, ExplainTexts& texts);
CommandTable view_table(ViewOptions& options, ViewTexts& texts);
CommandTable bench_table(BenchOptions& options, BenchTexts& texts);
CommandTable compare_table(CompareOptions& options, CompareTexts& texts);
CommandTable batch_table(BatchOptions& options, BatchTexts& texts);
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
  RenderTexts render_texts_;
  InfoOptions info_;
  InfoTexts info_texts_;
  ListOptions list_;
  GlslFilesOptions glsl_;
  GlslTexts glsl_texts_;
  ExportOptions export_;
  ExportTexts export_texts_;
  ValidationOptions validation_;
  ValidationTexts validation_texts_;
  ProbeOptions probe_;
  ShadeOptions shade_;
  ShadeTexts shade_texts_;
  ExplainOptions explain_;
  ExplainTexts explain_texts_;
  ViewOptions view_;
  ViewTexts view_texts_;
  BenchOptions bench_;
  BenchTexts bench_texts_;
  CompareOptions compare_;
  CompareTexts compare_texts_;
  BatchOptions batch_;
  BatchTexts batch_texts_;
  ManOptions man_;
  CompletionOptions completion_;
  std::vector<CommandTable> tables_;
};

// Rows that several commands have.
extern const char* const kSceneHelp;
inline constexpr const char* kCameraGroup = "Camera and time";
void add_layers(CommandTable& table, PipelineOptions& options);  ///< --preset and --pipeline; opens `Pipeline`
void add_size(CommandTable& table, std::optional<std::string>& size);
void add_time(CommandTable& table, std::optional<std::string>& time);
void add_camera(CommandTable& table, CameraTexts& texts);  ///< which camera sees, and which animation is played
void add_target(CommandTable& table, std::optional<std::string>& target);
void add_strategy(CommandTable& table, std::optional<std::string>& strategy);
void add_profile(CommandTable& table, std::optional<std::string>& profile);
void add_light_program(CommandTable& table, PipelineOptions& options);  ///< of commands that draw or judge lights
void add_simd(CommandTable& table, std::string& simd, const std::string& help);
/// Files of planes, under a heading of their own. `gbuffer`: the name of the option or argument of these files.
/// How ranks that MPI has started share the work of a command; opens a group.
void add_sharing(CommandTable& table, SharingRules& sharing, std::optional<std::string>& lost_after);
void add_capture(CommandTable& table, CaptureOptions& options, const char* gbuffer, const char* help);

}  // namespace trueshade
