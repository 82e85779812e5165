#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "cli/options.h"

namespace trueshade {

/// Carries a command out, and returns the exit code. The program `trueshade` has every command (every_command.cpp),
/// `trueshade-picture` only `render` (picture_command.cpp), `trueshade-view` only `view` (view/window/program.cpp).
int execute(const Command& command);

// The subcommands. Each writes its files, then its answer to standard output, and throws Error where it cannot.
void render(const RenderOptions& options);
void print_info(const InfoOptions& options);
void print_list(const ListOptions& options);
void write_glsl(const GlslFilesOptions& options);
void export_scene(const ExportOptions& options);
void bench(const BenchOptions& options);
void bench_ranks(const BenchOptions& options);  ///< `bench --ranks`; on every rank
void shade(const ShadeOptions& options);
void explain(const ExplainOptions& options);
void view(const ViewOptions& options);                ///< becomes another program, or throws
int compare_pictures(const CompareOptions& options);  ///< `compare`; the exit code
int run_batch(const BatchOptions& options);           ///< `batch`; the exit code
void write_man_pages(const ManOptions& options);
void print_completion(const CompletionOptions& options);
void print_version(const VersionOptions& options);
bool judge_opengl(const ValidationOptions& options);  ///< `validate`; whether every pixel is explained
bool probe_driver(const ProbeOptions& options);       ///< `probe`; whether held-out frames are explained

/// Names of the faults that `validate` looks for; none in a program that has no judge.
std::vector<std::string> fault_names();

/// Thrown where a program that read the text has ended, as `head` does: so does the command, without a word.
struct ReaderGone {};

/// Writes text to standard output, as printable() has it, and flushes it. Error(io) where that fails, say on a full
/// disk; ReaderGone.
void print(std::string_view text);

/// The same of a file's bytes, as they are. Error(io) too where the reader has ended: the file is torn.
void print_bytes(std::span<const uint8_t> bytes);
/// Of a report all, or where --quiet is given the line that begins with `verdict`.
std::string shown_report(const std::string& text);
enum class SaidAs : uint8_t { text, note };  ///< a note begins with `trueshade: note: `, coloured on a terminal
/// Writes a line to standard error, as printable() has it.
void say(std::string_view line, SaidAs as = SaidAs::text);

}  // namespace trueshade
