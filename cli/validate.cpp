#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "cli/activity.h"
#include "cli/capture/captured_planes.h"
#include "cli/capture/stored_planes.h"
#include "cli/capture_options.h"
#include "cli/commands.h"
#include "cli/driver_capture.h"
#include "cli/judged_mask.h"
#include "cli/looks.h"
#include "cli/misread_capture.h"
#include "cli/notes.h"
#include "cli/option_values.h"
#include "cli/picture_output.h"
#include "cli/preparation.h"
#include "cli/shell_words.h"
#include "cli/validation.h"
#include "cli/vulkan_capture.h"
#include "cli/written_files.h"
#include "core/file_ending.h"
#include "core/image_files/image_io.h"
#include "core/image_files/picture_file.h"
#include "core/printable_text.h"
#include "judge/bounds/profile_file.h"
#include "scenes/files/content/scene_files.h"
#include "scenes/scene.h"
#include "shading/program/program_frame.h"

namespace trueshade {
namespace {

/// Milliseconds that `job` takes.
template <typename Job>
double timed(Job job) {
  const auto start = std::chrono::steady_clock::now();
  job();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// Of a name that is known, or of a file.
oracle::Profile profile_of(const std::string& held_to) {
  if (const auto known = oracle::profile_named(held_to)) return *known;
  constexpr uint64_t kMostBytes = uint64_t(1) << 16;
  const Bytes bytes = read_user_file(held_to, kMostBytes, "");
  return oracle::profile_from_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, held_to);
}

DriverFrame draw_here(const ValidationOptions& options, const Scene& scene, Validation& v) {
  DriverFrame frame = drawn_by(options.driver, scene, v.pipeline);
  v.capture = std::move(frame.capture);
  v.passes = std::move(frame.passes);
  v.timed_frames = frame.timed_frames;
  v.notes = std::move(frame.notes);
  // A lower bound of the driver's grid (GL 4.6, table 23.53): finer ones lie inside it.
  if (!options.subpixel_bits) v.profile.subpixel_bits = std::max(v.profile.subpixel_bits, frame.subpixel_bits);
  return frame;
}

/// Bytes that judging takes besides the frame, from peaks of built-in scenes (tests/cli/memory.cpp): the driver's
/// libraries, and what is known of each pixel.
uint64_t judging_memory(const ValidationOptions& options, const Pipeline& pipeline) {
  constexpr uint64_t kDriver = uint64_t(85) << 20, kPixel = 480, kQuickPixel = 420;
  return uint64_t(pipeline.width) * uint64_t(pipeline.height) * (options.quick ? kQuickPixel : kPixel) +
         (options.capture.given() ? 0 : kDriver);
}

/// A capture that `--gbuffer` takes, but for the planes that no file holds.
void save(const oracle::Capture& capture, const std::string& path) {
  constexpr std::string_view kPlanes[] = {"depth",    "position", "normal",    "albedo",     "specular",
                                          "emission", "uv",       "id.object", "id.material"};
  std::vector<NamedImage> planes;
  for (const NamedImage& plane : capture.planes)
    if (std::find(std::begin(kPlanes), std::end(kPlanes), plane.name) != std::end(kPlanes)) planes.push_back(plane);
  make_folder_of(path);
  write_image(path, capture.color, planes, {{"trueshade:driver", capture.driver}});
}

/// Makes the capture that was read one of the pipeline.
void fit_capture(const ValidationOptions& options, const CaptureFiles& files, const Scene& scene, Validation& v) {
  CapturedPlanes planes = captured_planes(files, scene, v.pipeline);
  v.capture = std::move(planes.capture);
  store_as(v.pipeline, v.capture);
  if (v.capture.color.width > 0 && !v.capture.has_alpha)
    v.notes.push_back("the picture has no alpha channel, so alpha is not judged");
  v.notes.insert(v.notes.end(), planes.notes.begin(), planes.notes.end());
  if (!options.held_to && !options.subpixel_bits)
    v.notes.push_back(
        "a file does not tell its driver's subpixel bits: held to OpenGL's least, 4 (--subpixel-bits tells)");
}

/// The pixels of a capture that are not judged.
PixelMask left_out_of(const oracle::Capture& capture, const ValidationOptions& options, const Scene& scene,
                      const Validation& v, std::vector<std::string>* notes = nullptr) {
  if (!options.mask.any()) return {};
  std::optional<PictureFile> mask;
  if (!options.mask.file.empty()) mask = read_any_picture(options.mask.file, options.limits.expansion);
  return judged_mask(options.mask, mask ? &*mask : nullptr, scene, v.pipeline, capture, notes);
}

/// The file of a capture's picture, as far as its name tells: a file of planes may hold one.
std::string picture_of(const CaptureOptions& capture) {
  if (!capture.image_file.empty()) return capture.image_file;
  return capture.gbuffer_files.size() == 1 && !capture.map ? capture.gbuffer_files.front() : std::string();
}

/// Our own frame of what was judged, with the planes that a page shows. Nothing of a capture without a target unless
/// one of these is in it.
Frame reference_of(const Scene& scene, const Validation& v) {
  Pipeline pipeline = v.pipeline;
  pipeline.post = {};
  std::vector<std::string> planes{"id.object", "light.count"};
  if (v.capture.color.width == 0)
    for (const char* name : {"albedo", "normal", "position", "uv"})
      if (v.capture.plane(name) != nullptr) planes.push_back(name);
  return render_frame(scene, pipeline, {}, planes);
}

void say_files(const ValidationOptions& options, const Validation& v) {
  const StandardOutput output = options.json ? StandardOutput::answer : StandardOutput::files;
  const Image& color = v.capture.color;
  for (const std::string& path : options.saved)
    say_written(path,
                std::to_string(color.width) + 'x' + std::to_string(color.height) + ' ' +
                    std::string(info(color.format).name) + ", " + kind_of_file(path),
                output);
  if (options.report) say_written(*options.report, "HTML report", output);
}

void check_outputs(const ValidationOptions& options) {
  if (options.report) check_file_output(*options.report);
  std::error_code unknown;
  for (const std::string& path : options.saved) {
    check_file_output(path);
    if (std::filesystem::equivalent(path, options.mask.file, unknown))
      throw usage("--save", "'" + path + "' is the mask", "give it another name");
  }
}

}  // namespace

/// The metadata of a capture's files that may be pictures of ours: those have one part.
static std::vector<std::pair<std::string, Metadata>> metadata_of(const CaptureFiles& files) {
  std::vector<std::pair<std::string, Metadata>> all;
  for (const ChannelFile& file : files.files) {
    if (!has_ending(file.path, ".exr") && !has_ending(file.path, ".png")) continue;
    try {
      all.emplace_back(file.path, read_image_info(file.path).metadata);
    } catch (const Error&) {
      continue;  // others write files that this reader does not take
    }
  }
  return all;
}

/// Error(bad_input) of a picture of ours that shows a scene otherwise than its file has it.
static void check_not_lenient(const CaptureFiles& files) {
  for (const auto& [path, metadata] : metadata_of(files))
    if (is_lenient(metadata))
      throw Error(ErrorKind::bad_input, path,
                  "it was drawn with --lenient of a file with faults, so nothing is held to it",
                  "a capture of a scene that is read without");
}

/// What a file of ours says that its picture was brought to; nothing of files of others.
static Looks looks_of_capture(const CaptureFiles& files, std::vector<std::string>& notes) {
  for (const auto& [path, metadata] : metadata_of(files)) {
    for (const auto& [key, value] : metadata) {
      if (key != "trueshade:looks") continue;
      try {
        const Looks looks = looks_of_text(value);
        notes.push_back("as the capture says of itself, the scene is judged with" + looks_text(looks));
        return looks;
      } catch (const Error&) {
        notes.push_back("what the capture says of its looks is of no version that is known");
      }
    }
  }
  return {};
}

bool judge_opengl(const ValidationOptions& options) {
  check_pipeline(options);
  check_outputs(options);
  Validation v;
  v.lenient = options.lenient;
  std::optional<Activity> activity("reading the capture");
  std::optional<CaptureFiles> files;
  if (options.capture.given()) files = capture_files_of(options.capture, options.limits);
  if (files) check_not_lenient(*files);
  activity->now("reading the scene");
  Scene scene = scene_of_options(options);
  Pipeline asked = pipeline_of(options, scene);
  if (files && !options.size) asked.width = files->width(), asked.height = files->height();
  // An engine's picture has the lights and the background of the file; one of ours says what it has.
  ValidationOptions as_captured = options;
  if (files && looks_text(options.looks).empty()) as_captured.looks = looks_of_capture(*files, v.notes);
  const Looks looks = bring_to_looks(as_captured, asked, files ? ChosenLooks::never : ChosenLooks::by_scene, scene);
  v.pipeline = with_planes_of_program(asked);
  show(scene, options.camera, asked, options.seconds());
  check_memory(scene, v.pipeline, {}, {}, judging_memory(options, v.pipeline));
  if (names_vulkan(options.driver)) v.profile = *oracle::profile_named("vulkan");
  if (options.held_to) v.profile = profile_of(*options.held_to);
  if (options.subpixel_bits) v.profile.subpixel_bits = *options.subpixel_bits;
  v.scene_notes = notes_of(scene, v.pipeline);
  if (v.pipeline.post.active())
    v.notes.push_back(
        "the post chain is not judged: drawn and judged is the target before it, and a captured picture "
        "must be that target");
  DriverFrame drawn;
  activity->now(files ? "unpacking the planes" : "drawing");
  v.draw_ms = timed([&] {
    if (!files)
      drawn = draw_here(options, scene, v);
    else
      fit_capture(options, *files, scene, v);
  });
  files.reset();
  v.capture.mask = left_out_of(v.capture, options, scene, v, &v.notes);
  v.left_out_by = options.mask.any() ? options.mask.text() : "";
  for (const std::string& path : options.saved) {
    activity->now("writing " + printable(path, Lines::one));
    save(v.capture, path);
  }
  const auto begins = [&](const char* part) { activity->now("judging " + std::string(part)); };
  v.judge_ms = timed([&] {
    v.verdict =
        oracle::validate_capture(scene, v.pipeline, v.capture,
                                 {v.profile, !options.quick, drawn.steps, drawn.objects, options.significance, begins});
  });
  activity->now("finding what explains it");
  v.is_diagnosed = v.verdict.violations() > 0 || v.verdict.convicted() || !options.supposed.empty();
  if (options.capture.given() && options.supposed.empty() && v.verdict.violations() > 0)
    v.findings = misread_findings(options, scene, v,
                                  [&](const oracle::Capture& c) { return left_out_of(c, options, scene, v); });
  if (v.is_diagnosed && v.findings.empty()) find_explanation(scene, v, options.supposed);
  for (size_t i = 0; i < v.findings.size(); ++i) {
    // An edit of the text, or another way to read the files: nothing to suppose.
    if (v.findings[i].name.starts_with("light-shader-") || v.findings[i].plane == "capture") continue;
    v.findings[i].command = "trueshade" + options.command_line;
    if (!options.supposed.empty()) continue;
    const bool is_second = v.findings[i].together && !v.findings[i - 1].command.empty();
    if (is_second) v.findings[i].command = v.findings[i - 1].command;
    v.findings[i].command += " --suppose " + v.findings[i].name;
  }
  activity->now("drawing it again");
  if (drawn.repeat_changes) v.repeat_changes = drawn.repeat_changes(v.capture);
  if (drawn.move_changes && !options.quick) v.move_changes = drawn.move_changes(v.capture);
  activity->now("writing the report");
  if (options.report) {
    v.command = "trueshade" + options.command_line;
    v.reference = reference_of(scene, v);
    const std::string against = !options.saved.empty() ? options.saved.front() : picture_of(options.capture);
    ValidationOptions as_drawn = options;
    as_drawn.looks = looks;
    v.explain_command = explain_command(as_drawn, options.camera, v.pipeline, options.seconds(), against);
    const std::string page = validation_page(v, scene);
    write_text(*options.report, page);
  }
  const std::string text = options.json ? validation_json(v) + '\n' : shown_report(validation_text(v));
  activity.reset();
  print(text);
  say_files(options, v);
  say_notes(v.scene_notes.lines);
  return passes(v);
}

}  // namespace trueshade
