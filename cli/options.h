#pragma once
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cli/limit_options.h"
#include "compare/comparison.h"
#include "compare/picture_mask.h"
#include "core/image_files/image_io.h"
#include "farm/task_sharing.h"
#include "gl/emit/glsl_terms.h"
#include "scenes/camera_changes.h"
#include "scenes/pipeline/pipeline.h"

namespace trueshade {

struct Size {
  int width, height;  ///< pixels
};

/// A number, and how it was written, like 2/255.
struct GivenNumber {
  double value = 0.0;
  std::string text{};
};

/// Frames of a timeline, first to last; frame n is at n / fps.
struct FrameRange {
  int first, last;
};

/// What every command has.
struct CommonOptions {
  bool quiet = false;  ///< neither notes nor progress nor the names of files written
};

/// What every command that reads files has.
struct LimitedOptions : CommonOptions {
  Limits limits;
};

/// A capture made elsewhere.
struct CaptureOptions {
  std::vector<std::string> gbuffer_files;  ///< files of planes
  std::optional<std::string> map;          ///< which channels are which planes, see capture_map_from_option()
  std::string image_file;                  ///< the picture; empty: that of the files, if there is one

  bool given() const { return !gbuffer_files.empty() || map.has_value(); }
};

/// How a picture is to look, as texts of options (cli/looks.h). What is absent is not asked for.
struct Looks {
  std::optional<std::string> samples, background, faces, lights, exposure, tone_map;
};

/// A scene, as it is seen.
struct SceneOptions : LimitedOptions {
  std::string scene;  ///< a file or builtin:NAME
  SceneParts parts;
  CameraChanges camera;
  /// Seconds of the scene's timeline. Nothing: 0, but export writes the scene with all that moves.
  std::optional<double> time;

  double seconds() const { return time.value_or(0.0); }
};

/// What is drawn. What is absent keeps the value of the layer below: preset, scene file, pipeline file.
struct PipelineOptions : SceneOptions {
  std::optional<std::string> preset;  ///< the lowest layer; nothing: the first row of presets()
  std::optional<std::string> pipeline_file;
  std::optional<std::string> light_shader;    ///< a light program's file, or a model that ships
  std::vector<std::string> light_parameters;  ///< NAME=VALUE[,VALUE...]
  bool no_machine_code = false;               ///< light programs are interpreted
  std::optional<Size> size;
  std::optional<Format> target;
  std::optional<NumericProfile> profile;
  std::optional<Strategy> strategy;
  std::optional<ImageView> view;
  Looks looks;
  std::string command_line;  ///< as it was given, for a shell: all after `trueshade`, with a space before each word
};

/// A cube map instead of the camera's picture.
struct CubeMapOptions {
  std::optional<glm::vec3> eye;  ///< world; nothing: the camera's
};

/// `trueshade render`
struct RenderOptions : PipelineOptions {
  std::vector<std::string> outputs;  ///< .png, .exr or .html; with `frames`, names from frame_name(); - for raw video
  std::optional<FrameRange> frames;
  std::optional<int> turntable;  ///< so many pictures around the scene; not beside `frames`
  std::optional<CubeMapOptions> cube_map;
  bool cube_cross = false;            ///< one picture of six faces, not a file for each; only beside `cube_map`
  bool raw_video = false;             ///< the codes of every picture on standard output, one after the other
  std::optional<PngEncoding> encode;  ///< of .png outputs; nothing: as the target's values are
  std::vector<std::string> aovs;      ///< planes for .exr outputs, each is_aov_name()
  std::string simd = "best";          ///< stays alive for execution.simd, see execution_of()
  Execution execution;
  SharingRules sharing;  ///< of frames and bands, by ranks that MPI has started
  bool hash = false, stats = false, json = false;
  bool resume = false;  ///< a large picture goes on where an earlier process has stopped

  /// Of pictures whose names hold numbers: frames, or pictures of a turntable. Nothing: there is one picture.
  std::optional<FrameRange> numbered() const {
    return turntable ? std::optional(FrameRange{0, *turntable - 1}) : frames;
  }
};

/// `trueshade shade`: of RenderOptions without frames, planes, views and statistics. `scene` has the lights.
struct ShadeOptions : RenderOptions {
  CaptureOptions capture;
};

/// Execution of the options; borrows options.simd.
Execution execution_of(const RenderOptions& options);

/// `trueshade info`
struct InfoOptions : PipelineOptions {  // of which the camera is read by `resolved` alone
  std::string file;                     ///< a scene or an image
  bool resolved = false;                ///< every number of the scene, as the renderer has it
  bool json = false;                    ///< which `resolved` is anyway
  std::string folder;  ///< for the files of `resolved`; made if it is not there; empty: standard output
};

/// `trueshade export`
struct ExportOptions : SceneOptions {
  std::string output;  ///< .glb, or - for standard output
};

/// `trueshade list`
struct ListOptions : CommonOptions {
  std::string name;  ///< one of kListNames, or a preset, or a light program as --light-shader has it; empty: all lists
  bool json = false;
  bool text = false;  ///< of a light program, its text alone
};

/// `trueshade glsl`: a pipeline's shaders and state, and with a scene the frame's data too.
struct GlslFilesOptions : PipelineOptions {  // `scene` may be empty
  oracle::ShaderApi api = oracle::ShaderApi::gl;
  bool maps = false;   ///< without a scene: shaders of materials with colour, specular and normal maps
  std::string folder;  ///< made if it is not there
};

/// `trueshade validate`: what OpenGL draws here, or a capture made elsewhere, against the sets of legal values.
struct ValidationOptions : PipelineOptions {
  std::optional<std::string> driver;   ///< one of kDriverNames; none of a capture
  std::optional<std::string> held_to;  ///< a profile's name or file, .json; nothing: what OpenGL promises of any
  std::optional<int> subpixel_bits;    ///< of the driver's grid; nothing: what it says, 4 for a capture
  CaptureOptions capture;              ///< empty: draw one here
  compare::MaskRules mask;             ///< pixels that are not judged
  std::vector<std::string> saved;      ///< .png, .exr: what was drawn here
  std::optional<std::string> report;   ///< .html
  bool quick = false;                  ///< neither the tightest profile nor the moved frame
  bool lenient = false;                ///< what the tests of the whole image find is no failure
  double significance = 1e-6;          ///< of these tests: how many legal images may fail them
  std::vector<std::string> supposed;   ///< names of faults, as diagnose() takes them
  bool json = false;
};

/// `trueshade probe`: what a driver does where OpenGL or Vulkan lets it choose, as a profile.
struct ProbeOptions : CommonOptions {
  std::optional<std::string> driver;  ///< one of kDriverNames
  std::string output;                 ///< the profile's file, .json; empty: none
  std::optional<std::string> name;    ///< of the profile; nothing: the driver's
  bool json = false;
};

/// `trueshade bench`
struct BenchOptions : PipelineOptions {
  std::vector<std::string> scenes;   ///< what is timed, one after the other; `scene` is not read
  std::vector<std::string> against;  ///< gl, gl=DESIGN+..., embree, and KEY=VALUE: ours drawn otherwise
  std::string simd = "best";         ///< stays alive for the execution
  Execution execution;
  bool standard = false;                         ///< scenes and sizes are those of standard_rows()
  bool quick = false;                            ///< few frames
  bool ranks = false;                            ///< how drawing scales with processes and machines, nothing else
  std::optional<FrameRange> frames;              ///< with `ranks`: frames of a sequence, not bands of a picture
  bool moving = false;                           ///< also frames of a sequence in which everything moves
  std::optional<std::string> json_file, report;  ///< files to write; the report is .html, and JSON named - is printed
};

/// `trueshade explain`: how one pixel of `render` got its value.
struct ExplainOptions : PipelineOptions {
  int x = -1, y = -1;                  ///< column and row of the pixel, from the top left
  std::optional<std::string> against;  ///< a picture whose value is to be found out
  bool all = false;                    ///< every triangle, light and draw, also those that change nothing
  bool brief = false;                  ///< what is seen and stored, and what `against` is, without the way there
  bool json = false;
};

/// `trueshade view`: a scene in a window.
struct ViewOptions : PipelineOptions {  // with `size` the picture keeps it, whatever the size of the window
  std::optional<std::string> script;    ///< what is done in the window, a line each
  double scale = 0.0;                   ///< of texts and panels; 0: as the display's dots an inch ask for
  Execution execution;
};

/// `trueshade compare`: two pictures, or two folders of them.
struct CompareOptions : LimitedOptions {
  std::string reference, test;
  compare::CompareRules rules;  ///< but for the mask, which is of the pictures' size
  compare::MaskRules mask;
  std::vector<std::string> channels;  ///< names; empty: all
  bool bottom_up = false;             ///< the test's first row is its lowest
  std::optional<GivenNumber> delta;   ///< of the criteria that have one
  std::vector<std::string> of_flip;   ///< the options of FLIP that were given
  bool no_judge = false;              ///< values are compared, although the reference carries its scene
  std::vector<std::string> outputs;   ///< .png, .exr or .html; of folders .html and one folder
  std::optional<std::string> criteria_file;  ///< of two folders: criteria by names (docs/compare.md)
  std::optional<std::string> junit;   ///< .xml
  bool accept = false;                ///< copy test pictures that do not pass over their references
  std::string command_line;           ///< as it was given, for a shell
  bool json = false;

  /// By the reference's scene, where it carries one.
  bool judges() const { return !no_judge && rules.criteria.empty() && channels.empty() && !bottom_up; }
};

/// `trueshade batch`: jobs of a file.
struct BatchOptions : CommonOptions {
  std::string file;                                     ///< .json (docs/batch.md)
  bool resumes = false;                                 ///< goes on with what is not done or has changed
  std::optional<std::string> only;                      ///< a pattern of names
  std::optional<std::string> state;                     ///< the journal; nothing: `file` with .state behind it
  std::optional<std::string> json_file, junit, report;  ///< files to write; JSON named - is printed
  int jobs = 0;                                         ///< at once; 0: as many as there are cores for their threads
  int threads = 0;                                      ///< of a job that does not say; 0: the cores, shared evenly
  SharingRules sharing;                                 ///< of jobs, by ranks that MPI has started
  std::string command_line;                             ///< as it was given, for a shell
};

/// `trueshade --version`
struct VersionOptions {
  bool json = false;
};

/// `trueshade man`
struct ManOptions : CommonOptions {
  std::string output;                  ///< `.1` or - for one page, else a folder for all, made if it is not there
  std::optional<std::string> command;  ///< whose page the one is; nothing: the program's own
};

/// `trueshade completion`
struct CompletionOptions : CommonOptions {
  std::string shell;  ///< one of kShellNames
};

/// `--help`: what to print.
struct PrintText {
  std::string text;
};

using Command =
    std::variant<RenderOptions, InfoOptions, ListOptions, GlslFilesOptions, ExportOptions, ValidationOptions,
                 ProbeOptions, BenchOptions, ShadeOptions, ExplainOptions, CompareOptions, ViewOptions, BatchOptions,
                 VersionOptions, ManOptions, CompletionOptions, PrintText>;

/// Reads a command line, and checks all of it that needs no file. Error(usage) naming the option; Error(limit) for a
/// size over 65,536 pixels a side.
Command command_from_arguments(int count, const char* const* arguments);

}  // namespace trueshade
