// The tables of commands that judge and measure: validate, probe, bench.
#include "cli/command_tables.h"
#include "cli/commands.h"
#include "cli/looks.h"
#include "cli/mask_options.h"
#include "cli/option_values.h"
#include "judge/bounds/profile_names.h"

namespace trueshade {
namespace {

void add_validate_output(CommandTable& table, ValidationOptions& options) {
  table.open_group = "Output";
  add_value(table, "-o,--output", "FILE", options.report, "Report to write, .html");
  add_values(table, "--save", "FILE", options.saved,
             "Write what the driver drew: .png the picture, .exr its planes too");
  add_switch(table, "--json", options.json, "Print all of it as one JSON document");
  add_quiet(table, options, "Print the verdict alone; say neither progress nor which files were written");
}

void add_driver(CommandTable& table, std::optional<std::string>& driver) {
  add_choice(table, "--driver", "NAME", driver,
             "Driver to open: default, llvmpipe or softpipe of OpenGL; vulkan, lavapipe or swiftshader", kDriverNames);
}

}  // namespace

CommandTable validate_table(ValidationOptions& options) {
  CommandTable table{"validate", "Judge what OpenGL draws, here or in a capture, pixel by pixel"};
  add_value(table, "SCENE", "SCENE", options.scene, kSceneHelp).is_required = true;
  add_validate_output(table, options);
  add_capture(
      table, options.capture, "--gbuffer",
      "Judge this capture instead: planes as .exr, .dds, .tif, .npy or .png, channels as --aov names them or as "
      "--map says; may be repeated (docs/captures.md)");
  add_mask(table, options.mask);
  table.open_group = "Judgement";
  add_driver(table, options.driver);
  add_choice(table, "--profile", "NAME|FILE", options.held_to,
             "Hold the driver to this profile instead of what OpenGL promises of any: a file .json that `trueshade "
             "probe` wrote, or one of:",
             oracle::kDriverProfileNames);
  const auto read_bits = [](const std::string& text) { return integer_in("--subpixel-bits", text, 4, 16); };
  add_read(table, "--subpixel-bits", "COUNT", options.subpixel_bits, read_bits,
           "Fractional bits of the driver's window coordinates, 4 to 16; else what it says, 4 for a capture");
  add_switch(table, "--quick", options.quick,
             "Neither look for the tightest profile that explains the image nor draw it again, moved by whole pixels");
  const auto read_chance = [](const std::string& text) { return chance_from_text("--significance", text); };
  add_read(table, "--significance", "CHANCE", options.significance, read_chance,
           "How many of all legal images may fail the tests of the whole image, at most 0.01 (1e-6)");
  add_switch(table, "--lenient", options.lenient,
             "What the tests of the whole image find is a remark: only pixels in no legal set fail");
  add_values(table, "--suppose", "FAULT", options.supposed,
             "Say how much of what is wrong this fault explains, beside others that are supposed; `trueshade list` "
             "names all; may be repeated")
      .known_values = fault_names();
  add_size(table, options.size);
  add_time(table, options);
  add_camera(table, options);
  add_layers(table, options);
  add_light_program(table, options);
  add_target(table, options);
  add_strategy(table, options);
  add_looks(table, options.looks);
  add_trust(table, options.limits);
  add_limits(table, options.limits);
  table.details =
      "Lights and objects are counted from 0, in the scene's order, in which info --resolved lists them.\n"
      "Exit codes: 0 every pixel is explained, 1 a pixel is in no legal set or no rounding that is known makes such an "
      "image, 7 there is no OpenGL driver; others as for trueshade.";
  table.examples = {
      {"trueshade validate scene.json --size 320x240 -o judged.html", "This machine's OpenGL, judged on a page."},
      {"trueshade validate scene.json --gbuffer capture.exr", "What another renderer drew elsewhere."}};
  table.see_also = {"explain", "compare", "shade"};
  table.finished = [&options]() -> Command { return finished(std::move(options)); };
  return table;
}

CommandTable probe_table(ProbeOptions& options) {
  CommandTable table{"probe", "Measure what a driver does where OpenGL lets it choose, as a profile for validate"};
  table.open_group = "Output";
  add_value(table, "-o,--output", "FILE", options.output, "Profile to write, .json, for validate --profile FILE");
  add_value(table, "--name", "NAME", options.name, "Name of the profile; without it the driver's own");
  add_switch(table, "--json", options.json, "Print all of it as one JSON document");
  add_quiet(table, options, "Print the verdict alone; say neither progress nor which files were written");
  table.open_group = "Driver";
  add_driver(table, options.driver);
  table.details =
      "Small frames are drawn, and for each field of a profile the tightest value is found that no frame speaks "
      "against. What the frames cannot tell stays as open as OpenGL leaves it. Then other frames are judged by the "
      "profile.\n"
      "Exit codes: 0 the profile explains these, 1 it does not, 7 there is no driver; others as for trueshade.";
  table.examples = {
      {"trueshade probe --driver llvmpipe -o profile.json", "A profile of Mesa's llvmpipe, as it is here."},
      {"trueshade validate scene.json --profile profile.json", "The same driver, held to that."}};
  table.see_also = {"validate"};
  table.finished = [&options]() -> Command { return finished(std::move(options)); };
  return table;
}

CommandTable bench_table(BenchOptions& options) {
  CommandTable table{
      "bench", "Time frames, in turn with others that draw the same: up to 100 of each, within some 2.5 s a contender"};
  add_values(table, "SCENE", "SCENE", options.scenes,
             "Scenes as for render; without any builtin:city, rabbits, sphere and red. Or two files that --json has "
             "written, to compare them");
  table.open_group = "Output";
  add_value(table, "-o,--output", "FILE", options.report, "Report to write, .html; also times how frames scale");
  add_value(table, "--json", "FILE", options.json_file, "JSON document to write; - prints it instead of the text");
  add_quiet(table, options, "Print the times alone; say neither notes nor progress nor which files were written");
  table.open_group = "Measurement";
  add_read(table, "--against", "PEERS", options.against, peers_from_text,
           "Peers in the same run, with commas: gl (every design) or gl=DESIGN+DESIGN, embree (visibility), "
           "and ours otherwise: strategy=S, target=F, view=V, threads=N, tile=N, simd=NAME, aov=PLANE+PLANE");
  add_switch(table, "--standard", options.standard,
             "Fixed built-in scenes and sizes on every SIMD target, and a score of each: some two minutes on 2 cores");
  add_switch(table, "--quick", options.quick, "Draw few frames, for a look: figures that are not to be quoted");
  add_switch(
      table, "--moving", options.moving,
      "Also time frames of a sequence in which camera, lights and objects move, each against itself drawn again");
  add_switch(
      table, "--ranks", options.ranks,
      "Measure instead how drawing into a file scales with the processes that MPI has started, and with machines "
      "by a model (docs/farm.md)");
  add_read(table, "--frames", "FIRST-LAST", options.frames, frames_from_text,
           "With --ranks share frames of the timeline, not bands of one picture");
  add_size(table, options.size, kMostPictureSide);
  add_camera(table, options);
  add_layers(table, options);
  add_strategy(table, options);
  add_light_program(table, options);
  add_threads(table, options.execution.threads, "Threads, 0 for one a core");
  add_simd(table, options.simd, "best, scalar, sse4, avx2 or avx512");
  add_trust(table, options.limits);
  add_limits(table, options.limits);
  table.details =
      "Where others kept the machine busy, or frames of a kind took unlike times, each figure is followed by why it is "
      "not to be quoted.";
  table.examples = {{"trueshade bench builtin:city --against gl", "Our frames and this machine's OpenGL, in turn."},
                    {"trueshade bench --standard --json here.json", "A score for each SIMD target."},
                    {"trueshade bench here.json there.json", "What differs between two machines, or two commits."}};
  table.see_also = {"render"};
  table.finished = [&options]() -> Command { return finished(std::move(options)); };
  return table;
}

}  // namespace trueshade
