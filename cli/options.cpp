#include "cli/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/option_texts.h"
#include "cli/option_values.h"
#include "cli/shell_words.h"
#include "cli/unknown_option.h"
#include "cli/version.h"
#include "core/error.h"
#include "core/file_ending.h"
#include "judge/bounds/profile_names.h"
#include "scenes/pipeline/presets.h"
#include "scenes/scene.h"
#include "shading/frame.h"

namespace trueshade {
namespace {

/// Adds an option of one value, which help calls `value_name`. Values are taken as text.
template <typename Text>
CLI::Option* add_value(CLI::App* command, const char* names, const char* value_name, Text& text,
                       const std::string& help) {
  const auto take = [&text](const CLI::results_t& given) {
    text = given.back();
    return true;
  };
  return command->add_option(names, CLI::callback_t(take), help)->type_name(value_name);
}

/// The same for an option that may be repeated.
CLI::Option* add_values(CLI::App* command, const char* names, const char* value_name, std::vector<std::string>& texts,
                        const std::string& help) {
  const auto take = [&texts](const CLI::results_t& given) {
    texts = given;
    return true;
  };
  return command->add_option(names, CLI::callback_t(take), help)
      ->type_name(value_name)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_switch(CLI::App* command, const char* names, bool& on, const char* help) {
  command->add_flag_callback(
      names, [&on] { on = true; }, help);
}

/// The group `Limits`. Values are taken where they stand, which throws Error(usage).
void add_limit_options(CLI::App* command, LimitedOptions& options) {
  for (const LimitOption& limit : limit_options()) {
    const auto take = [&options, &limit](const CLI::results_t& given) {
      options.limits.*limit.limit = limit_from_text(limit, given.back());
      return true;
    };
    command->add_option(limit.name, CLI::callback_t(take), help_of(limit))
        ->type_name(limit.unit == LimitOption::Unit::bytes ? "SIZE" : "COUNT")
        ->group("Limits");
  }
}

/// The layers of a pipeline, and the size of the picture.
void add_preset_options(CLI::App* command, PipelineOptions& options, std::optional<std::string>& size) {
  std::string names;
  for (const Preset& preset : presets()) names += (names.empty() ? "" : ", ") + std::string(preset.name);
  add_value(command, "--preset", "NAME", options.preset, "Row of numbers the pipeline starts from: " + names);
  add_value(command, "--pipeline", "FILE", options.pipeline_file,
            "JSON file of values that replace the preset's and the scene's");
  add_value(command, "--size", "WxH", size, "Image size in pixels, WIDTHxHEIGHT");
}

/// The options of PipelineOptions but for the target. Returns that of the scene.
CLI::Option* add_pipeline_options(CLI::App* command, PipelineOptions& options, std::optional<std::string>& size) {
  CLI::Option* scene =
      add_value(command, "SCENE", "FILE", options.scene,
                "Scene file (.json, .gltf, .glb, .obj, .obj.gz, .ply, .ply.gz) or builtin:NAME[,KEY=VALUE...]")
          ->required();
  add_preset_options(command, options, size);
  return scene;
}

CLI::App* add_render(CLI::App& app, RenderOptions& options, RenderTexts& texts) {
  CLI::App* render = app.add_subcommand("render", "Draw a scene");
  add_pipeline_options(render, options, texts.size);
  add_values(render, "-o,--output", "FILE", options.outputs,
             "File to write: .png, .exr, or .html for a report; may be repeated");
  add_value(render, "--time", "SECONDS", texts.time, "Time of the scene's timeline, seconds");
  add_value(render, "--frames", "FIRST-LAST", texts.frames,
            "Frames FIRST-LAST of the timeline; output names hold %04d or ####, or get .0000 before the ending");
  add_value(render, "--target", "FORMAT", texts.target, "Format the image is stored in: " + joined(target_names()));
  add_value(render, "--strategy", "NAME", texts.strategy, "How lights come to pixels: " + joined(kStrategyNames));
  add_value(render, "--profile", "NAME", texts.profile,
            "Whose bits where OpenGL leaves a choice: ideal, mesa-llvmpipe-22.3");
  add_value(render, "--aov", "PLANES", texts.aov, "Planes for the EXR, with commas: " + plane_names());
  add_value(render, "--encode", "CODES", texts.encode,
            "Codes of a PNG. srgb: values taken as linear light and sRGB-encoded; raw: values as they are, "
            "tagged gAMA 1.0; without it fixed-point targets as they are, floats sRGB-encoded");
  add_value(render, "--view", "NAME", texts.view, "Show this instead of the lit picture: " + joined(kViewNames));
  add_value(render, "--threads", "COUNT", texts.threads, "Threads, 0 for one a core; never changes a pixel");
  add_value(render, "--simd", "NAME", options.simd, "best, scalar, sse4, avx2 or avx512; never changes a pixel");
  add_value(render, "--tile", "PIXELS", texts.tile,
            "Tile side: 8, 16, 32, 48 or 64; without it by size and threads; never changes a pixel");
  add_switch(render, "--no-light-culling", texts.no_light_culling,
             "Try every light on every pixel; never changes a pixel");
  add_switch(render, "--hash", options.hash, "Print the hash of the image's stored bytes");
  add_switch(render, "--stats", options.stats, "Print counts and times");
  add_switch(render, "--json", options.json, "Print all of it as one JSON document");
  add_switch(render, "-q,--quiet", options.quiet, "Say neither notes nor which files were written");
  add_limit_options(render, options);
  return render;
}

CLI::App* add_info(CLI::App& app, InfoOptions& options, InfoTexts& texts) {
  CLI::App* info = app.add_subcommand("info", "Say what is in a scene or an image");
  add_value(info, "FILE", "NAME", options.file, "Scene (as for render), or image (.png, .exr)")->required();
  add_switch(info, "--resolved", options.resolved,
             "Print every number of a scene as the renderer has it, as JSON (docs/resolved.md)");
  add_value(info, "-o,--output", "FOLDER", texts.folder,
            "Folder for resolved.json and resolved.bin; made if it is not there");
  add_preset_options(info, options, texts.size);
  add_value(info, "--strategy", "NAME", texts.strategy, "How lights come to pixels: " + joined(kStrategyNames));
  add_value(info, "--target", "FORMAT", texts.target, "Format the image is stored in, as for render");
  add_value(info, "--profile", "NAME", texts.profile, "Whose bits where OpenGL leaves a choice, as for render");
  add_value(info, "--time", "SECONDS", texts.time, "Time of the scene's timeline, seconds");
  add_limit_options(info, options);
  return info;
}

CLI::App* add_glsl(CLI::App& app, GlslFilesOptions& options, GlslTexts& texts) {
  CLI::App* glsl = app.add_subcommand("glsl", "Write a pipeline, or a whole frame, as shaders and state for a GPU");
  add_pipeline_options(glsl, options, texts.size)->required(false);
  add_value(glsl, "--api", "NAME", texts.api,
            "Whose GLSL and state, without it gl: " + joined(oracle::kShaderApiNames));
  add_value(glsl, "--strategy", "NAME", texts.strategy, "How lights come to pixels: " + joined(kStrategyNames));
  add_value(glsl, "--time", "SECONDS", texts.time, "Time of the scene's timeline, seconds");
  add_switch(glsl, "--maps", options.maps,
             "Without a scene: materials with colour, specular and normal maps and alpha masks");
  add_value(glsl, "-o,--output", "FOLDER", options.folder, "Folder for the files; made if it is not there")->required();
  add_limit_options(glsl, options);
  return glsl;
}

CLI::App* add_export(CLI::App& app, ExportOptions& options, std::optional<std::string>& time) {
  CLI::App* command = app.add_subcommand("export", "Write a scene as a GLB file, for other programs and for this one");
  add_value(command, "SCENE", "FILE", options.scene, "Scene as for render")->required();
  add_value(command, "-o,--output", "FILE", options.output, "File to write: .glb, or - for standard output")
      ->required();
  add_value(command, "--time", "SECONDS", time, "Write the scene as it stands at this time, without what moves");
  add_switch(command, "-q,--quiet", options.quiet, "Say neither notes nor which file was written");
  add_limit_options(command, options);
  return command;
}

/// `gbuffer`: the name of the option or argument of files of planes.
void add_capture_options(CLI::App* command, CaptureOptions& options, const char* gbuffer, const char* help) {
  add_values(command, gbuffer, "FILE", options.gbuffer_files, help);
  add_value(command, "--map", "PLANES", options.map,
            "Which channels are which planes, and how they are packed: PLANE=FILE.CHANNELS[:WORD]... with commas, say "
            "position=gbuf2.RGB,normal=gbuf1.RG:octahedral,depth=depth.R:reversed; or @FILE with such entries. Words: "
            "octahedral, spheremap, unorm, unorm8, unorm10, unorm16, unit; view, view_z_away, view_y_down_z_away; "
            "window, reversed, linear, distance; bottom_up. rows=bottom_up turns every plane over");
  add_value(command, "--image", "FILE", options.image_file,
            "The picture of the capture, as a file of its own; else the channels R G B A, or color of --map");
}

CLI::App* add_validate(CLI::App& app, ValidationOptions& options, ValidationTexts& texts) {
  CLI::App* command = app.add_subcommand("validate", "Judge what OpenGL draws, here or in a capture, pixel by pixel");
  add_pipeline_options(command, options, texts.size);
  add_value(command, "--strategy", "NAME", texts.strategy, "How lights come to pixels: " + joined(kStrategyNames));
  add_value(command, "--time", "SECONDS", texts.time, "Time of the scene's timeline, seconds");
  add_value(command, "--driver", "NAME", options.driver,
            "Driver to open: default, llvmpipe or softpipe of OpenGL, vulkan, or lavapipe");
  add_capture_options(command, options.capture, "--gbuffer",
                      "Judge this capture instead: planes as .exr, .dds, .tif, .npy or .png, channels as --aov names "
                      "them or as --map says; may be repeated (docs/captures.md)");
  add_value(
      command, "--profile", "NAME", options.held_to,
      "Hold the driver to this profile instead of what OpenGL promises of any: " + joined(oracle::kDriverProfileNames));
  add_value(command, "--subpixel-bits", "COUNT", texts.subpixel_bits,
            "Fractional bits of the driver's window coordinates, 4 to 16; else what it says, 4 for a capture");
  add_values(command, "--save", "FILE", options.saved,
             "Write what the driver drew: .png the picture, .exr its planes too");
  add_switch(command, "--quick", options.quick,
             "Neither look for the tightest profile that explains the image nor draw it again, moved by whole pixels");
  add_value(command, "--significance", "CHANCE", texts.significance,
            "How many of all legal images may fail the tests of the whole image, at most 0.01 (1e-6)");
  add_switch(command, "--lenient", options.lenient,
             "What the tests of the whole image find is a remark: only pixels in no legal set fail");
  add_values(
      command, "--suppose", "FAULT", options.supposed,
      "Say how much of what is wrong this fault explains, beside others that are supposed; `trueshade list` names "
      "all; may be repeated");
  add_switch(command, "--json", options.json, "Print all of it as one JSON document");
  add_value(command, "-o,--output", "FILE", options.report, "Report to write, .html");
  add_limit_options(command, options);
  command->footer(
      "Exit codes: 0 every pixel is explained, 1 a pixel is in no legal set or no rounding that is known makes such an "
      "image, 7 there is no OpenGL driver; others as for trueshade.");
  return command;
}

CLI::App* add_shade(CLI::App& app, ShadeOptions& options, ShadeTexts& texts) {
  CLI::App* command = app.add_subcommand("shade", "Light a G-buffer that something else has drawn");
  add_capture_options(command, options.capture, "GBUFFER",
                      "Files of planes: .exr, .dds, .tif, .npy or .png, channels as --aov names them or as --map says");
  add_value(command, "--lights", "SCENE", options.scene,
            "Scene file or builtin:NAME, whose lights, camera and clear colour are taken")
      ->required();
  add_value(command, "--preset", "NAME", options.preset, "Row of numbers, as for render");
  add_value(command, "--pipeline", "FILE", options.pipeline_file, "JSON file of values, as for render");
  add_value(command, "--time", "SECONDS", texts.time, "Time of the scene's timeline, seconds");
  add_value(command, "--target", "FORMAT", texts.target, "Format the image is stored in, as for render");
  add_value(command, "--strategy", "NAME", texts.strategy,
            "How lights come to pixels: forward-loop, deferred-volumes or deferred-loop");
  add_value(command, "--profile", "NAME", texts.profile, "Whose bits where OpenGL leaves a choice, as for render");
  add_value(command, "--threads", "COUNT", texts.threads, "Threads, 0 for one a core; never changes a pixel");
  add_values(command, "-o,--output", "FILE", options.outputs, "File to write: .png or .exr; may be repeated");
  add_switch(command, "--hash", options.hash, "Print the hash of the image's stored bytes");
  add_switch(command, "-q,--quiet", options.quiet, "Say neither notes nor which files were written");
  add_limit_options(command, options);
  return command;
}

CLI::App* add_explain(CLI::App& app, ExplainOptions& options, ExplainTexts& texts) {
  CLI::App* command = app.add_subcommand(
      "explain", "Say how one pixel got its value: every triangle, light, blend and rounding, with their numbers");
  add_pipeline_options(command, options, texts.size);
  add_value(command, "--pixel", "X,Y", texts.pixel, "Column and row of the pixel, from the top left");
  add_value(command, "--time", "SECONDS", texts.time, "Time of the scene's timeline, seconds");
  add_value(command, "--target", "FORMAT", texts.target, "Format the image is stored in, as for render");
  add_value(command, "--strategy", "NAME", texts.strategy, "How lights come to pixels: " + joined(kStrategyNames));
  add_value(command, "--profile", "NAME", texts.profile, "Whose bits where OpenGL leaves a choice, as for render");
  add_value(command, "--against", "IMAGE", options.against,
            "A picture of the same frame, .png, .exr, .tif, .dds or .npy: whether its value is legal there, and what "
            "would have made it");
  add_switch(command, "--all", options.all,
             "Print every covering triangle, every light and every draw, also those that change nothing");
  add_switch(command, "--json", options.json, "Print all of it as one JSON document");
  add_limit_options(command, options);
  add_switch(command, "-q,--quiet", options.quiet, "Say no notes");
  command->footer("The last line is the stored pixel, as render stores it.");
  return command;
}

CLI::App* add_bench(CLI::App& app, BenchOptions& options, BenchTexts& texts) {
  CLI::App* bench = app.add_subcommand(
      "bench", "Time frames, in turn with others that draw the same: up to 15 of each, within some 2.5 s a contender");
  add_values(bench, "SCENE", "FILE", options.scenes,
             "Scenes as for render; without any builtin:city, rabbits, sphere and red")
      ->expected(-1);
  add_value(bench, "--preset", "NAME", options.preset, "Row of numbers, as for render");
  add_value(bench, "--pipeline", "FILE", options.pipeline_file, "JSON file of values, as for render");
  add_value(bench, "--size", "WxH", texts.size, "Image size in pixels, WIDTHxHEIGHT");
  add_value(bench, "--strategy", "NAME", texts.strategy, "How lights come to pixels: " + joined(kStrategyNames));
  add_value(bench, "--threads", "COUNT", texts.threads, "Threads, 0 for one a core");
  add_value(bench, "--simd", "NAME", options.simd, "best, scalar, sse4, avx2 or avx512");
  add_value(bench, "--against", "PEERS", texts.against,
            "Peers in the same run, with commas: gl (every design) or gl=DESIGN+DESIGN, embree (visibility), "
            "and ours otherwise: "
            "strategy=S, target=F, view=V, threads=N, tile=N, simd=NAME, aov=PLANE+PLANE");
  add_switch(
      bench, "--moving", options.moving,
      "Also time frames of a sequence in which camera, lights and objects move, each against itself drawn again");
  add_value(bench, "--json", "FILE", options.json_file, "JSON document to write; - prints it instead of the text");
  add_value(bench, "-o,--output", "FILE", options.report, "Report to write, .html; also times how frames scale");
  add_limit_options(bench, options);
  return bench;
}

CLI::App* add_compare(CLI::App& app, CompareOptions& options, CompareTexts& texts) {
  CLI::App* command = app.add_subcommand("compare", "Compare two pictures, or two folders of pictures");
  add_value(command, "REFERENCE", "FILE", options.reference,
            "Picture that is right, or a folder of them: .exr, .png, .hdr, .tif, .dds, .npy, .jpg")
      ->required();
  add_value(command, "TEST", "FILE", options.test, "Picture that is in question, or a folder")->required();
  add_value(command, "--max-difference", "D", texts.difference,
            "No value differs by more than D: a number, or a fraction like 2/255");
  add_value(command, "--max-ulp", "COUNT", texts.ulp,
            "No value differs by more steps of its storage: floats, halves, codes");
  add_value(command, "--pixels", "COUNT", texts.pixels, "At most so many pixels differ by more than --delta");
  add_value(command, "--delta", "D", texts.delta, "What --pixels lets pass; without it 0");
  add_value(command, "--psnr", "DB", texts.psnr, "Each channel's peak signal-to-noise ratio is at least so many dB");
  add_value(command, "--flip", "MEAN", texts.flip, "The mean of FLIP's map is at most MEAN; 1 never fails");
  add_value(command, "--flip-median", "BOUND", texts.flip_median,
            "The weighted median of FLIP's map is at most BOUND");
  add_value(command, "--ppd", "COUNT", texts.ppd, "Of FLIP: pixels per degree of the visual field (67.02)");
  add_switch(command, "--ldr", texts.low, "Of FLIP: colours are what a screen shows; the default for codes");
  add_switch(command, "--hdr", texts.high, "Of FLIP: colours are light of any strength; the default for floats");
  add_value(command, "--tone-mapper", "NAME", texts.mapper, "Of FLIP --hdr: " + joined(compare::kToneMapperNames));
  add_value(command, "--exposures", "START,STOP[,COUNT]", texts.exposures,
            "Of FLIP --hdr: factors of light as powers of 2, instead of those found from the reference");
  add_value(command, "--color-space", "NAME", texts.color_space,
            "What both pictures' R, G and B are, whatever the files say: srgb or linear");
  add_switch(command, "--allow-nonfinite", options.rules.allow_not_finite,
             "Infinities and NaN pass where both pictures have the same");
  add_switch(command, "--no-judge", texts.no_judge,
             "Compare values although the reference carries its scene, by which pixels can be judged");
  add_values(command, "-o,--output", "FILE", options.outputs,
             "Differences to write: .png as FLIP's map, .exr as numbers, .html as a page to look into; of folders a folder for "
             "maps; may be repeated");
  add_value(command, "--junit", "FILE", options.junit, "JUnit XML to write, .xml, for CI services");
  add_switch(command, "--accept", options.accept,
             "Copy test pictures that do not pass over their references, but none that is not finite");
  add_switch(command, "--json", options.json, "Print all of it as one JSON document");
  add_value(command, "--threads", "COUNT", texts.threads, "Threads, 0 for one a core; never changes a figure");
  add_limit_options(command, options);
  command->footer(
      "Without a criterion every stored value has to be equal. Values that are not finite, and sizes, parts or channels "
      "that do not fit together, fail under every criterion.\n"
      "Exit codes: 0 they pass, 1 they do not; others as for trueshade.");
  return command;
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
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
  if (!first_unknown_option({&first, 1}, option_names(app)).empty()) throw unexpected_argument(app, {first});
  if (first[0] != '-' && std::find(commands.begin(), commands.end(), first) == commands.end()) {
    std::string names;
    for (const std::string& name : commands) names += (names.empty() ? "" : " ") + name;
    throw usage("command line", "there is no command '" + first + "'", "one of: " + names);
  }
}

}  // namespace

Execution execution_of(const RenderOptions& options) {
  Execution execution = options.execution;
  execution.simd = options.simd;
  return execution;
}

Command command_from_arguments(int count, const char* const* arguments) {
  CLI::App app(
      "Trueshade draws scenes of many lights on the CPU, to the same bits on every machine.\n"
      "`trueshade help COMMAND` names the options of a command.",
      "trueshade");
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("trueshade ") + kVersion);
  app.footer(
      "Exit codes: 0 ok, 1 a violation was found, 2 usage, 3 bad input, 4 limit exceeded, 5 input or output failed, "
      "6 out of memory, 7 no OpenGL driver, 70 our fault.");
  RenderOptions render;
  RenderTexts texts;
  InfoOptions info;
  InfoTexts info_texts;
  ListOptions list;
  GlslFilesOptions glsl;
  GlslTexts glsl_texts;
  ExportOptions exported;
  std::optional<std::string> export_time;
  ValidationOptions validation;
  ValidationTexts validation_texts;
  ShadeOptions shaded;
  ShadeTexts shade_texts;
  ExplainOptions explained;
  ExplainTexts explain_texts;
  BenchOptions benchmark;
  BenchTexts bench_texts;
  CompareOptions comparison;
  CompareTexts compare_texts;
  const CLI::App* render_command = add_render(app, render, texts);
  const CLI::App* info_command = add_info(app, info, info_texts);
  CLI::App* list_command = app.add_subcommand("list", "List scenes, presets, formats, planes and SIMD targets");
  add_switch(list_command, "--json", list.json, "As one JSON document");
  const CLI::App* glsl_command = add_glsl(app, glsl, glsl_texts);
  const CLI::App* export_command = add_export(app, exported, export_time);
  const CLI::App* validate_command = add_validate(app, validation, validation_texts);
  const CLI::App* shade_command = add_shade(app, shaded, shade_texts);
  const CLI::App* explain_command = add_explain(app, explained, explain_texts);
  const CLI::App* bench_command = add_bench(app, benchmark, bench_texts);
  const CLI::App* compare_command = add_compare(app, comparison, compare_texts);
  std::vector<std::string> words(arguments + 1, arguments + std::max(count, 1));
  if (!words.empty() && words[0] == "help") {  // `help COMMAND` is `COMMAND --help`
    words.erase(words.begin());
    words.push_back("--help");
  }
  if (!words.empty()) check_first_argument(app, words[0]);
  std::string command_line;
  for (const std::string& word : words) command_line += ' ' + for_shell(word);
  render.command_line = validation.command_line = benchmark.command_line = comparison.command_line = command_line;
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  try {
    app.parse(words);
  } catch (const CLI::CallForHelp&) {
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    return PrintText{chosen.empty() ? app.help() : chosen[0]->help("trueshade")};
  } catch (const CLI::CallForVersion& version) {
    return PrintText{std::string(version.what()) + "\n"};
  } catch (const CLI::ExtrasError&) {
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    throw unexpected_argument(chosen.empty() ? app : *chosen[0], app.remaining(true));
  } catch (const CLI::ParseError& error) {
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    throw usage("command line", one_line(error.what()),
                "see trueshade " + (chosen.empty() ? std::string() : chosen[0]->get_name() + " ") + "--help");
  }
  if (render_command->parsed()) return finished(std::move(render), texts);
  if (info_command->parsed()) return finished(std::move(info), info_texts);
  if (glsl_command->parsed()) return finished(std::move(glsl), glsl_texts);
  if (export_command->parsed()) return finished(std::move(exported), export_time);
  if (validate_command->parsed()) return finished(std::move(validation), validation_texts);
  if (shade_command->parsed()) return finished(std::move(shaded), shade_texts);
  if (explain_command->parsed()) return finished(std::move(explained), explain_texts);
  if (bench_command->parsed()) return finished(std::move(benchmark), bench_texts);
  if (compare_command->parsed()) return finished(std::move(comparison), compare_texts);
  return list;
}

}  // namespace trueshade
