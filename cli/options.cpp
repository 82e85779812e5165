#include "cli/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/option_values.h"
#include "cli/unknown_option.h"
#include "cli/version.h"
#include "core/error.h"
#include "judge/bounds/profile.h"
#include "scenes/pipeline/presets.h"
#include "scenes/scene.h"
#include "shading/frame.h"

namespace trueshade {
namespace {

/// One file cannot hold two documents, and who wants two has mistyped a name.
void check_named_once(const std::string& option, std::vector<std::string> files) {
  std::sort(files.begin(), files.end());
  const auto twice = std::adjacent_find(files.begin(), files.end());
  if (twice != files.end()) throw usage(option, "'" + *twice + "' is named twice", "give each file a name of its own");
}

void check_outputs(const RenderOptions& options) {
  check_named_once("-o", options.outputs);
  bool exr = false, png = false;
  for (const std::string& path : options.outputs) {
    exr = exr || path.ends_with(".exr");
    png = png || path.ends_with(".png");
    if (!path.ends_with(".png") && !path.ends_with(".exr") && !path.ends_with(".html"))
      throw usage("-o", "no format has the ending of '" + path + "'", "end the name in .png, .exr or .html");
  }
  if (!options.aovs.empty() && !exr && !options.json)
    throw usage("--aov", "planes go into an EXR only", "add -o FILE.exr");
  if (options.encode && !png)
    throw usage("--encode", "it says how a PNG stores the picture, and an EXR holds the target's values",
                "add -o FILE.png");
}

/// Option values as text, read by us so that every error is of one form.
struct RenderTexts {
  std::optional<std::string> size, time, frames, target, strategy, profile, view, aov, encode, threads, tile;
  bool no_light_culling = false;
};

/// The options of PipelineOptions but for the target.
void add_pipeline_options(CLI::App* command, PipelineOptions& options, std::optional<std::string>& size) {
  command->add_option("SCENE", options.scene, "Scene file (.json, .ply, .ply.gz) or builtin:NAME[,KEY=VALUE...]")
      ->required();
  command->add_option(
      "--preset", options.preset, "Row of numbers the pipeline starts from: " + [] {
        std::string names;
        for (const Preset& preset : presets()) names += (names.empty() ? "" : ", ") + std::string(preset.name);
        return names;
      }());
  command->add_option("--pipeline", options.pipeline_file,
                      "JSON file of values that replace the preset's and the scene's");
  command->add_option("--size", size, "Image size in pixels, WIDTHxHEIGHT");
}

CLI::App* add_render(CLI::App& app, RenderOptions& options, RenderTexts& texts) {
  CLI::App* render = app.add_subcommand("render", "Draw a scene");
  add_pipeline_options(render, options, texts.size);
  render
      ->add_option("-o,--output", options.outputs, "File to write: .png, .exr, or .html for a report; may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  render->add_option("--time", texts.time, "Time of the scene's timeline, seconds");
  render->add_option(
      "--frames", texts.frames,
      "Frames FIRST-LAST of the timeline; output names hold %04d or ####, or get .0000 before the ending");
  render->add_option("--target", texts.target, "Format the image is stored in: " + joined(target_names()));
  render->add_option("--strategy", texts.strategy, "How lights come to pixels: " + joined(kStrategyNames));
  render->add_option("--profile", texts.profile, "Whose bits where OpenGL leaves a choice: ideal, mesa-llvmpipe-22.3");
  render->add_option("--aov", texts.aov, "Planes for the EXR, with commas: " + plane_names());
  render->add_option("--encode", texts.encode,
                     "Codes of a PNG. srgb: values taken as linear light and sRGB-encoded; raw: values as they are, "
                     "tagged gAMA 1.0; without it fixed-point targets as they are, floats sRGB-encoded");
  render->add_option("--view", texts.view, "Show this instead of the lit picture: " + joined(kViewNames));
  render->add_option("--threads", texts.threads, "Threads, 0 for one a core; never changes a pixel");
  render->add_option("--simd", options.simd, "best, scalar, sse4, avx2 or avx512; never changes a pixel");
  render->add_option("--tile", texts.tile,
                     "Tile side: 8, 16, 32, 48 or 64; without it by size and threads; never changes a pixel");
  render->add_flag("--no-light-culling", texts.no_light_culling,
                   "Try every light on every pixel; never changes a pixel");
  render->add_flag("--hash", options.hash, "Print the hash of the image's stored bytes");
  render->add_flag("--stats", options.stats, "Print counts and times");
  render->add_flag("--json", options.json, "Print all of it as one JSON document");
  return render;
}

RenderOptions finished(RenderOptions options, const RenderTexts& texts) {
  if (texts.size) options.size = size_from_text(*texts.size);
  if (texts.time && texts.frames) throw usage("--frames", "--time and --frames exclude each other", "give one of them");
  if (texts.time) options.time = time_from_text(*texts.time);
  if (texts.frames) options.frames = frames_from_text(*texts.frames);
  if (texts.target) options.target = target_from_text("--target", *texts.target);
  if (texts.strategy) options.strategy = strategy_from_text("--strategy", *texts.strategy);
  if (texts.profile) options.profile = profile_from_text(*texts.profile);
  if (texts.view) options.view = view_from_text("--view", *texts.view);
  if (texts.encode) options.encode = encoding_from_text(*texts.encode);
  if (texts.aov) options.aovs = aovs_from_text("--aov", *texts.aov);
  if (texts.threads) options.execution.threads = integer_in("--threads", *texts.threads, 0, 1024);
  if (texts.tile) options.execution.tile = tile_from_text("--tile", *texts.tile);
  options.execution.light_culling = !texts.no_light_culling;
  options.execution.count_as_gl = options.stats || options.json;
  check_preset(options.preset);
  check_simd("--simd", options.simd);
  validate(execution_of(options));
  check_outputs(options);
  if (options.outputs.empty() && !options.hash && !options.stats && !options.json)
    throw usage("render", "nothing would come of it", "add -o FILE, --hash, --stats or --json");
  return options;
}

CLI::App* add_glsl(CLI::App& app, GlslFilesOptions& options, std::optional<std::string>& strategy) {
  CLI::App* glsl = app.add_subcommand("glsl", "Write a preset as GLSL shaders and a list of OpenGL state");
  glsl->add_option("--preset", options.preset, "Row of numbers, as for render")->required();
  glsl->add_option("--pipeline", options.pipeline_file, "Pipeline in JSON, over the preset");
  glsl->add_option("--strategy", strategy, "How lights come to pixels: " + joined(kStrategyNames));
  glsl->add_flag("--maps", options.maps, "Materials with colour, specular and normal maps and alpha masks");
  glsl->add_option("-o,--output", options.folder, "Folder for the files; made if it is not there")->required();
  return glsl;
}

GlslFilesOptions finished(GlslFilesOptions options, const std::optional<std::string>& strategy) {
  check_preset(options.preset);
  if (strategy) options.strategy = strategy_from_text("--strategy", *strategy);
  return options;
}

/// Option values of validate as text.
struct ValidationTexts {
  std::optional<std::string> size, subpixel_bits, strategy, time;
};

CLI::App* add_validate(CLI::App& app, ValidationOptions& options, ValidationTexts& texts) {
  CLI::App* command = app.add_subcommand("validate", "Judge what OpenGL draws, here or in a capture, pixel by pixel");
  add_pipeline_options(command, options, texts.size);
  command->add_option("--strategy", texts.strategy, "How lights come to pixels: " + joined(kStrategyNames));
  command->add_option("--time", texts.time, "Time of the scene's timeline, seconds");
  command->add_option("--driver", options.driver, "OpenGL driver to open: default, llvmpipe or softpipe");
  command->add_option(
      "--gbuffer", options.gbuffer_file,
      "Judge this capture instead: an EXR of planes, channels as --aov names them (docs/validation.md)");
  command->add_option("--image", options.image_file,
                      "The picture of the capture, .exr or .png; else R G B A of --gbuffer");
  command->add_option(
      "--profile", options.held_to,
      "Hold the driver to this profile instead of what OpenGL promises of any: " + joined(oracle::profile_names()));
  command->add_option(
      "--subpixel-bits", texts.subpixel_bits,
      "Fractional bits of the driver's window coordinates, 4 to 16; else what it says, 4 for a capture");
  command->add_option("--save", options.saved, "Write what the driver drew: .png the picture, .exr its planes too");
  command->add_flag(
      "--quick", options.quick,
      "Neither look for the tightest profile that explains the image nor draw it again, moved by whole pixels");
  command->add_flag("--json", options.json, "Print all of it as one JSON document");
  command->add_option("-o,--output", options.report, "Report to write, .html");
  command->footer(
      "Exit codes: 0 every pixel is explained, 1 a pixel is in no legal set, 7 there is no OpenGL driver; "
      "others as for trueshade.");
  return command;
}

ValidationOptions finished(ValidationOptions options, const ValidationTexts& texts) {
  constexpr std::string_view kDrivers[] = {"default", "llvmpipe", "softpipe"};
  if (texts.size) options.size = size_from_text(*texts.size);
  if (texts.strategy) options.strategy = strategy_from_text("--strategy", *texts.strategy);
  if (texts.time) options.time = time_from_text(*texts.time);
  if (texts.subpixel_bits) options.subpixel_bits = integer_in("--subpixel-bits", *texts.subpixel_bits, 4, 16);
  check_preset(options.preset);
  if (options.driver && std::find(std::begin(kDrivers), std::end(kDrivers), *options.driver) == std::end(kDrivers))
    throw usage("--driver", "there is no driver '" + *options.driver + "'", "one of: " + joined(kDrivers));
  if (options.driver && !options.gbuffer_file.empty())
    throw usage("--driver", "a capture is judged, no driver is opened", "leave out --driver or --gbuffer");
  if (options.held_to && !oracle::profile_named(*options.held_to))
    throw usage("--profile", "there is no profile '" + *options.held_to + "'",
                "one of: " + joined(oracle::profile_names()));
  if (options.gbuffer_file.empty() && !options.image_file.empty())
    throw usage("--image", "a picture alone cannot be judged", "add --gbuffer FILE.exr, the planes it was lit from");
  for (const std::string& path : options.saved)
    if (!path.ends_with(".png") && !path.ends_with(".exr"))
      throw usage("--save", "no format has the ending of '" + path + "'", "end the name in .png or .exr");
  check_named_once("--save", options.saved);
  if (!options.saved.empty() && !options.gbuffer_file.empty())
    throw usage("--save", "a capture is judged, nothing is drawn", "leave out --save or --gbuffer");
  if (options.report && !options.report->ends_with(".html"))
    throw usage("-o", "a report does not end like '" + *options.report + "'", "end the name in .html");
  return options;
}

/// Option values of bench as text.
struct BenchTexts {
  std::optional<std::string> size, strategy, threads, against;
};

CLI::App* add_bench(CLI::App& app, BenchOptions& options, BenchTexts& texts) {
  CLI::App* bench = app.add_subcommand(
      "bench", "Time frames, in turn with others that draw the same: up to 15 of each, within some 2.5 s a contender");
  bench->add_option("SCENE", options.scenes, "Scenes as for render; without any builtin:city, rabbits, sphere and red");
  bench->add_option("--preset", options.preset, "Row of numbers, as for render");
  bench->add_option("--pipeline", options.pipeline_file, "JSON file of values, as for render");
  bench->add_option("--size", texts.size, "Image size in pixels, WIDTHxHEIGHT");
  bench->add_option("--strategy", texts.strategy, "How lights come to pixels: " + joined(kStrategyNames));
  bench->add_option("--threads", texts.threads, "Threads, 0 for one a core");
  bench->add_option("--simd", options.simd, "best, scalar, sse4, avx2 or avx512");
  bench->add_option("--against", texts.against,
                    "Peers in the same run, with commas: gl (every design) or gl=DESIGN+DESIGN, embree (visibility), "
                    "and ours otherwise: "
                    "strategy=S, target=F, view=V, threads=N, tile=N, simd=NAME, aov=PLANE+PLANE");
  bench->add_option("--json", options.json_file, "JSON document to write; - prints it instead of the text");
  bench->add_option("-o,--output", options.report, "Report to write, .html; also times how frames scale");
  return bench;
}

BenchOptions finished(BenchOptions options, const BenchTexts& texts) {
  if (options.scenes.empty()) options.scenes = {"builtin:city", "builtin:rabbits", "builtin:sphere", "builtin:red"};
  if (texts.size) options.size = size_from_text(*texts.size);
  if (texts.strategy) options.strategy = strategy_from_text("--strategy", *texts.strategy);
  if (texts.threads) options.execution.threads = integer_in("--threads", *texts.threads, 0, 1024);
  if (texts.against) options.against = peers_from_text(*texts.against);
  check_preset(options.preset);
  check_simd("--simd", options.simd);
  if (options.report && !options.report->ends_with(".html"))
    throw usage("-o", "a report does not end like '" + *options.report + "'", "end the name in .html");
  if (options.report && options.json_file) check_named_once("--json", {*options.report, *options.json_file});
  return options;
}

/// CLI11's message without the line breaks that some have.
std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// The names of a command's options, with their dashes.
std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

/// What is wrong with arguments of a command that no option takes: an option that does not exist, with the name that
/// was probably meant, or one value too many.
Error unexpected_argument(const CLI::App& command, const std::vector<std::string>& arguments) {
  const std::vector<std::string> known = option_names(command);
  const std::string unknown = first_unknown_option(arguments, known), meant = likeliest_name(unknown, known);
  const std::string help =
      "`" + (command.get_parent() ? "trueshade " : std::string()) + command.get_name() + " --help` names all options";
  if (unknown.empty()) return usage("command line", "'" + arguments.front() + "' is one argument too many", help);
  return usage(unknown, "there is no such option", meant.empty() ? help : "did you mean " + meant + "? " + help);
}

/// The first argument is a command, or an option of the program itself. Error(usage) for any other.
void check_first_argument(const CLI::App& app, const std::string& first) {
  constexpr std::string_view kCommands[] = {"render", "info", "list", "glsl", "validate", "bench"};
  if (!first_unknown_option({&first, 1}, option_names(app)).empty()) throw unexpected_argument(app, {first});
  if (first[0] != '-' && std::find(std::begin(kCommands), std::end(kCommands), first) == std::end(kCommands))
    throw usage("command line", "there is no command '" + first + "'", "one of: " + joined(kCommands));
}

}  // namespace

Execution execution_of(const RenderOptions& options) {
  Execution execution = options.execution;
  execution.simd = options.simd;
  return execution;
}

Command command_from_arguments(int count, const char* const* arguments) {
  CLI::App app("Trueshade draws scenes of many lights on the CPU, to the same bits on every machine.", "trueshade");
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("trueshade ") + kVersion);
  app.footer(
      "Exit codes: 0 ok, 1 a violation was found, 2 usage, 3 bad input, 4 limit exceeded, 5 input or output failed, "
      "6 out of memory, 7 no OpenGL driver, 70 our fault.");
  RenderOptions render;
  RenderTexts texts;
  InfoOptions info;
  ListOptions list;
  GlslFilesOptions glsl;
  std::optional<std::string> glsl_strategy;
  ValidationOptions validation;
  ValidationTexts validation_texts;
  BenchOptions benchmark;
  BenchTexts bench_texts;
  const CLI::App* render_command = add_render(app, render, texts);
  CLI::App* info_command = app.add_subcommand("info", "Say what is in a scene or an image");
  info_command->add_option("FILE", info.file, "Scene (as for render), or image (.png, .exr)")->required();
  CLI::App* list_command = app.add_subcommand("list", "List scenes, presets, formats, planes and SIMD targets");
  list_command->add_flag("--json", list.json, "As one JSON document");
  const CLI::App* glsl_command = add_glsl(app, glsl, glsl_strategy);
  const CLI::App* validate_command = add_validate(app, validation, validation_texts);
  const CLI::App* bench_command = add_bench(app, benchmark, bench_texts);
  if (count > 1) check_first_argument(app, arguments[1]);
  try {
    app.parse(count, arguments);
  } catch (const CLI::CallForHelp&) {
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    return PrintText{chosen.empty() ? app.help() : chosen[0]->help("trueshade")};
  } catch (const CLI::CallForVersion& version) {
    return PrintText{std::string(version.what()) + "\n"};
  } catch (const CLI::ExtrasError&) {
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    throw unexpected_argument(chosen.empty() ? app : *chosen[0], app.remaining(true));
  } catch (const CLI::ParseError& error) {
    throw usage("command line", one_line(error.what()), "see trueshade --help");
  }
  if (render_command->parsed()) return finished(std::move(render), texts);
  if (info_command->parsed()) return info;
  if (glsl_command->parsed()) return finished(std::move(glsl), glsl_strategy);
  if (validate_command->parsed()) return finished(std::move(validation), validation_texts);
  if (bench_command->parsed()) return finished(std::move(benchmark), bench_texts);
  return list;
}

}  // namespace trueshade
