// The tables of commands that judge and measure: validate, compare, bench.
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

void add_criteria(CommandTable& table, CompareOptions& options, CompareTexts& texts) {
  table.open_group = "Criteria";
  add_value(table, "--max-difference", "D", texts.difference,
            "No value differs by more than D: a number, or a fraction like 2/255");
  add_value(table, "--max-ulp", "COUNT", texts.ulp,
            "No value differs by more steps of its storage, of two the coarser: floats, halves, codes");
  add_value(table, "--pixels", "COUNT", texts.pixels, "At most so many pixels differ by more than --delta");
  add_value(table, "--delta", "D", texts.delta, "What --pixels and --window let pass; without it 0");
  add_values(table, "--window", "SIDE:SHARE", texts.windows,
             "At most this share of the pixels of any SIDExSIDE window differ by more than --delta, like 16:0.05; SIDE "
             "is 8, 16, 32, 64 or 128; may be repeated");
  add_value(table, "--psnr", "DB", texts.psnr, "Each channel's peak signal-to-noise ratio is at least so many dB");
  add_value(table, "--flip", "MEAN", texts.flip, "The mean of FLIP's map is at most MEAN; 1 never fails");
  add_value(table, "--flip-median", "BOUND", texts.flip_median, "The weighted median of FLIP's map is at most BOUND");
  add_switch(table, "--allow-nonfinite", options.rules.allow_not_finite,
             "Infinities and NaN pass where both pictures have the same");
  add_switch(table, "--no-judge", texts.no_judge,
             "Compare values although the reference carries its scene, by which pixels can be judged");
  add_choice(table, "--color-space", "NAME", texts.color_space,
             "What both pictures' R, G and B are, whatever the files say: srgb or linear", kColorSpaceNames);
  table.open_group = "What is compared";
  add_value(table, "--channels", "LIST", texts.channels,
            "These channels alone: letters like RGB, or names with commas between, like R,G,depth.Z");
  add_choice(table, "--rows", "ORDER", texts.rows,
             "How the test's rows run: top_down, or bottom_up as glReadPixels gives them", kRowOrders);
  add_mask(table, texts.mask);
  table.open_group = "FLIP";
  add_value(table, "--ppd", "COUNT", texts.ppd, "Pixels per degree of the visual field (67.02)");
  add_switch(table, "--ldr", texts.low, "Colours are what a screen shows; the default for codes");
  add_switch(table, "--hdr", texts.high, "Colours are light of any strength; the default for floats");
  add_choice(table, "--tone-mapper", "NAME", texts.mapper, "With --hdr:", compare::kToneMapperNames);
  add_value(table, "--exposures", "START,STOP[,COUNT]", texts.exposures,
            "With --hdr: factors of light as powers of 2, instead of those found from the reference");
}

}  // namespace

CommandTable validate_table(ValidationOptions& options, ValidationTexts& texts) {
  CommandTable table{"validate", "Judge what OpenGL draws, here or in a capture, pixel by pixel"};
  add_value(table, "SCENE", "SCENE", options.scene, kSceneHelp).is_required = true;
  add_validate_output(table, options);
  add_capture(
      table, options.capture, "--gbuffer",
      "Judge this capture instead: planes as .exr, .dds, .tif, .npy or .png, channels as --aov names them or as "
      "--map says; may be repeated (docs/captures.md)");
  add_mask(table, texts.mask);
  table.open_group = "Judgement";
  add_driver(table, options.driver);
  add_choice(table, "--profile", "NAME|FILE", options.held_to,
             "Hold the driver to this profile instead of what OpenGL promises of any: a file .json that `trueshade "
             "probe` wrote, or one of:",
             oracle::kDriverProfileNames);
  add_value(table, "--subpixel-bits", "COUNT", texts.subpixel_bits,
            "Fractional bits of the driver's window coordinates, 4 to 16; else what it says, 4 for a capture");
  add_switch(table, "--quick", options.quick,
             "Neither look for the tightest profile that explains the image nor draw it again, moved by whole pixels");
  add_value(table, "--significance", "CHANCE", texts.significance,
            "How many of all legal images may fail the tests of the whole image, at most 0.01 (1e-6)");
  add_switch(table, "--lenient", options.lenient,
             "What the tests of the whole image find is a remark: only pixels in no legal set fail");
  add_values(table, "--suppose", "FAULT", options.supposed,
             "Say how much of what is wrong this fault explains, beside others that are supposed; `trueshade list` "
             "names all; may be repeated")
      .known_values = fault_names();
  add_size(table, texts.size);
  add_time(table, texts.time);
  add_camera(table, texts.camera);
  add_layers(table, options);
  add_light_program(table, options);
  add_strategy(table, texts.strategy);
  add_looks(table, options.looks);
  add_trust(table, options.limits);
  add_limits(table, options.limits);
  table.details =
      "Exit codes: 0 every pixel is explained, 1 a pixel is in no legal set or no rounding that is known makes such an "
      "image, 7 there is no OpenGL driver; others as for trueshade.";
  table.examples = {
      {"trueshade validate scene.json --size 320x240 -o judged.html", "This machine's OpenGL, judged on a page."},
      {"trueshade validate scene.json --gbuffer capture.exr", "What another renderer drew elsewhere."}};
  table.see_also = {"explain", "compare", "shade"};
  table.finished = [&options, &texts]() -> Command { return finished(std::move(options), texts); };
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

CommandTable compare_table(CompareOptions& options, CompareTexts& texts) {
  CommandTable table{"compare", "Compare two pictures, or two folders of pictures"};
  add_value(table, "REFERENCE", "FILE", options.reference,
            "Picture that is right, or a folder of them: .exr, .png, .hdr, .tif, .dds, .npy, .jpg; or - for one from "
            "standard input")
      .is_required = true;
  add_value(table, "TEST", "FILE", options.test, "Picture that is in question, or a folder, or -").is_required = true;
  table.open_group = "Output";
  add_values(
      table, "-o,--output", "FILE", options.outputs,
      "Differences to write: .png as FLIP's map, .exr as numbers, .html as a page to look into; of folders "
      ".html as a gallery, and a folder for maps, and for each picture's page beside a gallery; may be repeated");
  add_value(table, "--junit", "FILE", options.junit, "JUnit XML to write, .xml, for CI services");
  add_switch(table, "--accept", options.accept,
             "Copy test pictures that do not pass over their references, but none that is not finite");
  add_switch(table, "--json", options.json, "Print all of it as one JSON document");
  add_quiet(table, options, "Print the verdict alone; say neither notes nor progress nor which files were written");
  add_criteria(table, options, texts);
  add_value(table, "--threads", "COUNT", texts.threads, "Threads, 0 for one a core; never changes a figure").group =
      "Execution";
  add_limits(table, options.limits);
  table.details =
      "Without a criterion every stored value has to be equal. Values that are not finite, and sizes, parts or "
      "channels "
      "that do not fit together, fail under every criterion.\n"
      "Exit codes: 0 they pass, 1 they do not; others as for trueshade.";
  table.examples = {{"trueshade compare golden.png now.png --max-difference 1/255", "Equal but for one code."},
                    {"trueshade compare golden now --junit result.xml", "Two folders of pictures, for a CI service."},
                    {"trueshade compare golden now -o report.html -o maps",
                     "A gallery of both, the worst first, with a page of each that differs."}};
  table.see_also = {"render", "validate"};
  table.finished = [&options, &texts]() -> Command { return finished(std::move(options), texts); };
  return table;
}

CommandTable bench_table(BenchOptions& options, BenchTexts& texts) {
  CommandTable table{
      "bench", "Time frames, in turn with others that draw the same: up to 15 of each, within some 2.5 s a contender"};
  add_values(table, "SCENE", "SCENE", options.scenes,
             "Scenes as for render; without any builtin:city, rabbits, sphere and red. Or two files that --json has "
             "written, to compare them");
  table.open_group = "Output";
  add_value(table, "-o,--output", "FILE", options.report, "Report to write, .html; also times how frames scale");
  add_value(table, "--json", "FILE", options.json_file, "JSON document to write; - prints it instead of the text");
  add_quiet(table, options, "Say neither notes nor progress nor which files were written");
  table.open_group = "Measurement";
  add_value(table, "--against", "PEERS", texts.against,
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
  add_value(table, "--frames", "FIRST-LAST", texts.frames,
            "With --ranks share frames of the timeline, not bands of one picture");
  add_size(table, texts.size);
  add_camera(table, texts.camera);
  add_layers(table, options);
  add_strategy(table, texts.strategy);
  add_light_program(table, options);
  add_value(table, "--threads", "COUNT", texts.threads, "Threads, 0 for one a core").group = "Execution";
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
  table.finished = [&options, &texts]() -> Command { return finished(std::move(options), texts); };
  return table;
}

}  // namespace trueshade
