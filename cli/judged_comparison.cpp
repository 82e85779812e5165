#include "cli/judged_comparison.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "cli/camera_json.h"
#include "cli/capture/captured_planes.h"
#include "cli/capture/stored_planes.h"
#include "cli/looks.h"
#include "cli/named_file.h"
#include "cli/notes.h"
#include "cli/preparation.h"
#include "cli/shaded_gbuffer.h"
#include "cli/shell_words.h"
#include "core/error.h"
#include "core/file_ending.h"
#include "scenes/pipeline/light_model.h"
#include "scenes/pipeline/presets.h"
#include "scenes/pipeline/shipped_models.h"
#include "shading/frame.h"
#include "shading/program/program_frame.h"

namespace trueshade {
namespace {

const std::string* metadata_value(const PictureFile& picture, std::string_view key) {
  for (const auto& [name, value] : picture.metadata)
    if (name == key) return &value;
  return nullptr;
}

double time_of(const PictureFile& reference) {
  const std::string* const text = metadata_value(reference, "trueshade:time");
  double time = 0.0;
  if (text != nullptr) std::from_chars(text->data(), text->data() + text->size(), time);
  return time;
}

Error not_judged(const std::string& reason) {
  return {ErrorKind::bad_input, "the reference's scene", reason, "--no-judge compares values alone"};
}

/// The scene that a reference names. No word of a file that is no scene is repeated: whoever made the reference has
/// chosen the file.
Scene named_scene(const std::string& name, const std::string& reference, const Limits& limits,
                  const SceneParts& parts) {
  const bool is_built_in = name.starts_with("builtin:");
  const std::optional<std::string> file = is_built_in ? name : file_named_by(reference, name);
  if (!file) throw not_judged("there is no " + name + " in the folder where the command runs, nor in its own");
  try {
    return scene_of_options(*file, limits, parts);
  } catch (const Error& error) {
    if (is_built_in || error.kind() == ErrorKind::limit) throw;
    throw not_judged(*file + " is no scene that can be drawn (`trueshade info` says why)");
  }
}

class SceneJudge {
 public:
  SceneJudge(const ComparedPictures& pictures, const CompareOptions& options)
      : pictures_(pictures), options_(options) {}

  Validation judge() {
    load();
    const bool shaded = is_shaded(pictures_.reference.metadata);
    if (shaded)
      find_shaded();
    else
      find_capture();
    const oracle::Capture& capture = v_.capture;
    oracle::ValidateOptions asked{v_.profile};
    asked.surfaces = !shaded;
    v_.verdict = oracle::validate_capture(scene_, v_.pipeline, capture, asked);
    v_.is_diagnosed = v_.verdict.violations() > 0 || v_.verdict.convicted();
    if (v_.is_diagnosed) find_explanation(scene_, v_);
    for (oracle::Finding& finding : v_.findings) {
      if (finding.name.starts_with("light-shader-")) continue;  // which cannot be supposed
      finding.command = "trueshade validate " + for_shell(scene_.spec) + camera_words_ +
                        " --gbuffer PLANES.exr --image " + for_shell(pictures_.test.path) + mask_words() +
                        " --suppose " + finding.name;
    }
    return std::move(v_);
  }

 private:
  /// The options of the mask, as a shell takes them.
  std::string mask_words() const {
    std::string words = options_.mask.file.empty() ? "" : " --mask " + for_shell(options_.mask.file);
    for (const compare::IgnoredIds& ignored : options_.mask.ignored) words += " --ignore " + ignored.text();
    return words + (options_.mask.allow ? " --allow-mask" : "");
  }

  void load() {
    const std::string *const spec = metadata_value(pictures_.reference, "trueshade:scene"),
                             *const hash = metadata_value(pictures_.reference, "trueshade:sceneHash"),
                             *const pipeline = metadata_value(pictures_.reference, "trueshade:pipeline");
    if (hash == nullptr || pipeline == nullptr) throw not_judged("its hash or its pipeline is not named");
    if (is_lenient(pictures_.reference.metadata)) throw not_judged("its file has faults, and was drawn with --lenient");
    SceneParts parts;
    CameraChanges camera;
    if (const std::string* const text = metadata_value(pictures_.reference, kAnimationKey)) parts.animation = *text;
    if (const std::string* const text = metadata_value(pictures_.reference, kCameraKey))
      read_camera_json(*text, "the reference's camera", parts, camera);
    camera_words_ = camera_words(parts, camera);
    scene_ = named_scene(*spec, pictures_.reference.path, options_.limits, parts);
    v_.pipeline = pipeline_from_json(*pipeline, "the reference's pipeline", default_pipeline(scene_));
    try {
      give_text(v_.pipeline.light_program);
    } catch (const Error& error) {
      throw not_judged(error.what());
    }
    validate(v_.pipeline);
    bring_to_reference_looks();
    show(scene_, camera, v_.pipeline, time_of(pictures_.reference));
    if ("sha256:" + scene_hash(scene_) != *hash)
      throw not_judged(scene_.spec + " is another scene today: its hash is not the one that the reference names");
    if (v_.pipeline.post.samples > 1)
      throw not_judged("a pixel is an average of samples, which has no legal set: --samples 1 draws one that has");
    if (v_.pipeline.view != ImageView::lit || v_.pipeline.post.active())
      throw not_judged("a view, and a picture behind a post chain, have no legal sets");
    if (v_.pipeline.light_program.used() && v_.pipeline.light_program.text.empty())
      throw not_judged("a light program is not in the picture's file: validate takes its file");
    v_.pipeline = with_planes_of_program(v_.pipeline);
    constexpr uint64_t kPixel = 480;  // bytes, as of validate
    check_memory(scene_, v_.pipeline, {}, {}, uint64_t(v_.pipeline.width) * uint64_t(v_.pipeline.height) * kPixel);
  }

  /// A picture without the key has the scene as its file has it.
  void bring_to_reference_looks() {
    const std::string* const text = metadata_value(pictures_.reference, "trueshade:looks");
    if (text == nullptr) return;
    PipelineOptions options;
    try {
      options.looks = looks_of_text(*text);
      bring_to_looks(options, v_.pipeline, ChosenLooks::never, scene_);
    } catch (const Error&) {
      throw not_judged("its looks are none that this version knows");
    }
    if (display_of(options.looks, v_.pipeline, scene_) != DisplayTransform() &&
        !has_ending(pictures_.reference.path, ".exr"))
      throw not_judged(
          "its values are not the target's: --exposure, --tone-map or a transparent background has changed them");
  }

  void find_capture() {
    const ChannelFile& test = pictures_.test.parts.front();
    const bool has_planes = std::any_of(test.channels.begin(), test.channels.end(), [](const Channel& channel) {
      return std::string_view("RGBAY").find(channel.name) == std::string_view::npos;
    });
    const CaptureFiles files = has_planes ? read_capture_files({test.path}, "", {}, options_.limits.expansion)
                                          : read_picture_file(test.path, options_.limits.expansion);
    CapturedPlanes planes = captured_planes(files, scene_, v_.pipeline);
    v_.capture = std::move(planes.capture);
    if (!has_planes) draw_planes();
    store_as(v_.pipeline, v_.capture);
    v_.capture.mask = pictures_.mask, v_.left_out_by = pictures_.left_out_by;
    if (!v_.capture.has_alpha) v_.notes.push_back("the picture has no alpha channel, so alpha is not judged");
    v_.notes.insert(v_.notes.end(), planes.notes.begin(), planes.notes.end());
    if (!has_planes)
      v_.notes.push_back(
          "the test is a picture alone: its planes are drawn here, so a renderer whose edges or depths differ shows "
          "violations there (write planes into an EXR to have them judged)");
  }

  /// Of a reference that was lit from a G-buffer: the picture of the test, and the planes of that one.
  void find_shaded() {
    StoredPlanes planes =
        found_gbuffer(pictures_.reference.metadata, pictures_.reference.path, options_.limits, scene_, v_.pipeline);
    v_.pipeline.transparency.mode = TransparencyMode::none;  // glass is in no G-buffer
    const std::string& test = pictures_.test.path;
    v_.capture = captured_planes(read_picture_file(test, options_.limits.expansion), scene_, v_.pipeline).capture;
    v_.capture.planes = std::move(planes.capture.planes), v_.capture.decoded = std::move(planes.capture.decoded);
    store_as(v_.pipeline, v_.capture);
    v_.capture.mask = pictures_.mask, v_.left_out_by = pictures_.left_out_by;
    v_.notes.push_back("judged by the G-buffer that the reference was shaded of, " + planes.capture.name);
    v_.notes.insert(v_.notes.end(), planes.notes.begin(), planes.notes.end());
  }

  void draw_planes() {
    std::vector<std::string> names = {"depth", "position", "normal", "albedo", "uv", "id.object", "id.material"};
    if (reads_specular_plane(v_.pipeline.light_model)) names.push_back("specular");
    if (v_.pipeline.light_model.emission) names.push_back("emission");
    Frame frame = render_frame(scene_, v_.pipeline, {}, names);
    v_.capture.planes = std::move(frame.aovs);
  }

  const ComparedPictures& pictures_;
  const CompareOptions& options_;
  Scene scene_;
  std::string camera_words_;  // the options that say how the reference is seen
  Validation v_;
};

}  // namespace

JudgedPicture judged_by_scene(const ComparedPictures& pictures, const CompareOptions& options) {
  if (metadata_value(pictures.reference, "trueshade:scene") == nullptr) return {};
  if (metadata_value(pictures.reference, "trueshade:cubeMap") != nullptr)
    return {};  // not what the scene's camera sees
  try {
    return {SceneJudge(pictures, options).judge(), ""};
  } catch (const Error& error) {
    return {std::nullopt, error.what()};
  }
}

}  // namespace trueshade
