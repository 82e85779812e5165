#include "explain/explain.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cli/camera_json.h"
#include "cli/capture/capture_files.h"
#include "cli/capture/plane_images.h"
#include "cli/capture/stored_planes.h"
#include "cli/commands.h"
#include "cli/looks.h"
#include "cli/notes.h"
#include "cli/preparation.h"
#include "cli/progress_bar.h"
#include "cli/written_files.h"
#include "core/error.h"
#include "core/file_ending.h"
#include "core/image_files/image_io.h"
#include "core/image_pixel.h"
#include "explain/against.h"
#include "explain/finished_pixel.h"
#include "explain/line_edits.h"
#include "judge/stages/legal_pixel.h"
#include "scenes/pipeline/presets.h"
#include "scenes/scene.h"
#include "shading/frame.h"
#include "shading/output/post_frame.h"

namespace trueshade {
namespace {

/// The planes that judging another picture reads.
std::vector<std::string> planes_to_judge(const ExplainOptions& options, const Pipeline& pipeline) {
  if (!options.against || pipeline.post.active()) return {};
  std::vector<std::string> planes = {"depth", "position", "normal", "albedo", "uv", "id.object"};
  if (reads_specular_plane(pipeline.light_model)) planes.emplace_back("specular");
  if (pipeline.light_model.emission) planes.emplace_back("emission");
  if (pipeline.light_program.used()) planes.emplace_back("id.material");
  return planes;
}

Detail detail_of(const ExplainOptions& options) {
  return options.brief ? Detail::brief : options.all ? Detail::all : Detail::usual;
}

/// What is explained: a pixel of the target before the post chain.
struct Question {
  const ExplainOptions& options;
  const Scene& scene;
  const Pipeline& pipeline;    ///< as render has it
  const ExplainedFrame frame;  ///< by the pipeline before the post chain, which may be larger
  const int x, y;              ///< of that frame
  const Frame reference;       ///< that frame, with planes_to_judge()

  Question(const ExplainOptions& o, const Scene& of_scene, const Pipeline& of_pipeline)
      : options(o),
        scene(of_scene),
        pipeline(of_pipeline),
        frame(of_scene, pipeline_before_post(of_pipeline)),
        x(o.x * of_pipeline.post.samples),
        y(o.y * of_pipeline.post.samples),
        reference(drawn()) {}

 private:
  Frame drawn() const {
    ProgressBar bar("rendering", "tiles");
    return render_frame(scene, frame.pipeline, {}, planes_to_judge(options, frame.pipeline),
                        [&bar](int done, int total) { bar.show(done, total); });
  }
};

/// The explanation is only worth its words if it ends where the frame does.
void check_explanation(const Question& q, const PixelHistory& history) {
  if (stored_difference(q.frame.target, stored_in(q.reference.color, q.x, q.y), history.stored) != 0.0)
    throw std::logic_error("the explanation of pixel " + std::to_string(q.options.x) + ',' +
                           std::to_string(q.options.y) + " does not end in the rendered value");
}

/// The asked pixel of another picture, in a format.
Image given_pixel(const Question& q, Format format) {
  const std::string& path = *q.options.against;
  const CaptureFiles files = read_picture_file(path, q.options.limits.expansion);
  if (files.width() != q.pipeline.width || files.height() != q.pipeline.height)
    throw Error(ErrorKind::bad_input, path,
                "it is " + std::to_string(files.width()) + 'x' + std::to_string(files.height()) + ", and the frame " +
                    std::to_string(q.pipeline.width) + 'x' + std::to_string(q.pipeline.height),
                "give --size as the picture has it");
  oracle::Capture capture;
  capture.color = one_pixel(stored_plane_image(files.planes.front()), q.options.x, q.options.y);
  Pipeline of_pixel = q.pipeline;
  of_pixel.width = of_pixel.height = 1, of_pixel.target = format;
  capture.name = path;
  store_as(of_pixel, capture);
  return capture.color;
}

/// How far a value is from another, as people say it.
std::string distance_words(Format format, double difference) {
  if (difference == 0.0) return "exactly what the picture has";
  if (difference == HUGE_VAL) return "infinitely far away, or no number";
  char text[48];
  if (info(format).number_class == NumberClass::unorm)
    std::snprintf(text, sizeof text, "%.0f code%s away", difference, difference == 1.0 ? "" : "s");
  else
    std::snprintf(text, sizeof text, "%.3g %% away", 100.0 * difference);
  return text;
}

/// What a picture of ours says of itself: preset, strategy and how it was seen, if it says so.
std::string record_of(const std::string& path) {
  if (!has_ending(path, ".png") && !has_ending(path, ".exr")) return {};
  std::string record;
  SceneParts parts;
  CameraChanges camera;
  try {
    for (const auto& [key, value] : read_image_info(path).metadata) {
      if (key == kCameraKey) read_camera_json(value, path, parts, camera);
      if (key == kAnimationKey) parts.animation = value;
      if (key != "trueshade:pipeline") continue;
      const Pipeline p = pipeline_from_json(value, path, presets().front().pipeline);
      const std::string lights =
          p.light_program.used() ? "light program " + p.light_program.file : "preset " + p.preset;
      record = lights + ", " + std::string(name_of(p.strategy)) + ", " + std::string(info(p.target).name);
    }
  } catch (const Error&) {
    return {};
  }
  const std::string words = camera_words(parts, camera);
  return record.empty() || words.empty() ? record : record + ',' + words;
}

/// What a picture of ours was brought to; nothing of one of others.
Looks looks_of_picture(const std::string& path) {
  if (!has_ending(path, ".png") && !has_ending(path, ".exr")) return {};
  try {
    for (const auto& [key, value] : read_image_info(path).metadata)
      if (key == "trueshade:looks") return looks_of_text(value);
  } catch (const Error&) {
  }
  return {};
}

/// What is asked for, and else what is there.
Looks over(Looks asked, const Looks& there) {
  for (const auto field :
       {&Looks::samples, &Looks::background, &Looks::faces, &Looks::lights, &Looks::exposure, &Looks::tone_map})
    if (!(asked.*field)) asked.*field = there.*field;
  return asked;
}

/// What OpenGL allows the pixel to hold, and the class of what it holds, which comes back.
oracle::PixelClass add_legal(const Question& q, const Image& given, double difference, Account& out) {
  oracle::Capture capture;
  capture.color = q.reference.color;
  for (int c = 0; c < info(given.format).channels; ++c) capture.color.set_code(q.x, q.y, c, given.code(0, 0, c));
  capture.planes = q.reference.aovs;
  const oracle::LegalPixel legal =
      oracle::legal_pixel(q.scene, q.frame.pipeline, oracle::Profile{}, capture, q.reference.color, q.x, q.y);
  constexpr const char* kChannels[] = {"legal_R", "legal_G", "legal_B", "legal_A"};
  for (int c = 0; c < legal.channels; ++c) {
    const oracle::LegalChannel& channel = legal.channel[size_t(c)];
    if (channel.is_bounded)
      out.add(kChannels[c], std::array{channel.low, channel.high},
              "least and most that OpenGL allows any GPU on this surface");
    else
      out.add(kChannels[c], "any", "the judge has no bound here");
  }
  const bool bounded = difference != 0.0 || legal.pixel_class != oracle::PixelClass::violation;
  out.add("class", bounded ? std::string(oracle::text(legal.pixel_class)) : "not bounded",
          "of its value on this surface (docs/validation.md); at an edge another surface may be legal too");
  return legal.pixel_class;
}

/// Adds a cause as a part, which comes back: a heading, and what the pixel would hold.
Account& add_cause(const Question& q, const char* key, const std::string& what, const StoredPixel& stored,
                   double difference, Account& out) {
  const Format format = q.frame.target.format;
  Account& part = out.part(key, what + ": " + distance_words(format, difference));
  part.quantities.push_back({"would_be", "what the pixel would hold", values_in_format(format, stored), true, {}});
  part.add("difference", difference, "largest over the channels: codes, or a share of the value");
  if (q.options.brief) part.shown = part.title;
  return part;
}

/// Adds an edit of a line: its text as it stands, and as it would have to read; in brief without the numbers.
void add_edit(const Question& q, const LineEdit& edit, Account& out) {
  Account& part = add_cause(q, "edit", edit.what, edit.stored, edit.difference, out);
  if (edit.it_reads.empty()) return;
  if (q.options.brief)
    part.shown.clear(), part.quantities.clear();
  else
    part.add("line", int64_t(edit.line), "of the light program's text");
  part.add("it_reads", edit.it_reads, "");
  if (!edit.drawn_as.empty()) part.add("drawn_as", edit.drawn_as, "");
}

/// Says how many other edits are as likely: a single pixel is explained by many.
void add_count_of_edits(const LineEdits& edits, Account& out) {
  const size_t more = edits.alike - edits.nearest.size();
  const std::string of = " of the " + std::to_string(edits.tried) + " edits of lines that were tried";
  std::string words = more == 0 ? "no other" + of + " comes as near"
                                : std::to_string(more) + " more" + of + (more == 1 ? " comes" : " come") +
                                      " as near here: trueshade validate finds which of them explains all pixels";
  if (edits.left_out > 0) words += "; " + std::to_string(edits.left_out) + " were left out to save time";
  Account& part = out.part("edits", words);
  part.shown = part.title;
  part.add("alike", int64_t(edits.alike), "edits of lines that come as near as the first");
  part.add("tried", int64_t(edits.tried), "edits of lines");
  part.add("left_out", int64_t(edits.left_out), "edits that would have taken too long");
}

/// What may have made the given value: other changes of the frame, and edits of the light program's lines. The nearest
/// come first; in brief those that make the value are told alone, if there are any.
void add_causes(const Question& q, const PixelHistory& history, const StoredPixel& given, Account& out) {
  std::vector<Candidate> candidates = candidates_for(q.frame, history, q.reference.color, given);
  LineEdits edits = line_edits_for(q.frame, history, given);
  if (candidates.empty() && edits.nearest.empty())
    out.add("causes",
            std::string("no single change that is tried makes this value, or nearly so") +
                (edits.tried == 0 ? "" : ", nor does an edit of a line"),
            "");
  const auto is_off = [](const auto& cause) { return cause.difference > 0; };
  if (q.options.brief && !(std::all_of(candidates.begin(), candidates.end(), is_off) &&
                           std::all_of(edits.nearest.begin(), edits.nearest.end(), is_off)))
    std::erase_if(candidates, is_off), std::erase_if(edits.nearest, is_off);
  size_t next = 0;
  const auto add_candidates_up_to = [&](double difference) {
    for (; next < candidates.size() && candidates[next].difference <= difference; ++next)
      add_cause(q, "candidate", candidates[next].what, candidates[next].stored, candidates[next].difference, out);
  };
  for (const LineEdit& edit : edits.nearest) add_candidates_up_to(edit.difference), add_edit(q, edit, out);
  add_candidates_up_to(HUGE_VAL);
  if (!edits.nearest.empty()) add_count_of_edits(edits, out);
}

/// Where another picture's value could have come from.
Account against_account(const Question& q, const PixelHistory& history) {
  Account out("against", *q.options.against + " there");
  if (const std::string record = record_of(*q.options.against); !record.empty())
    out.add("drawn_by", record, "as the picture says");
  const bool finished = q.pipeline.post.active();
  const Format format = finished ? q.pipeline.post.output : q.frame.target.format;
  const Image given = given_pixel(q, format);
  const StoredPixel value = stored_in(given, 0, 0);
  out.quantities.push_back({"given", "what that picture holds", values_in_format(format, value), true, {}});
  if (finished) {
    const Image picture = render_frame(q.scene, q.pipeline).color;
    const StoredPixel ours = stored_in(picture, q.options.x, q.options.y);
    const double difference = stored_difference({format}, value, ours);
    out.add("distance", difference == 0.0 ? "the same as here" : distance_words(format, difference),
            "after the post chain, which OpenGL's rules do not bound");
    return out;
  }
  const double difference = stored_difference(q.frame.target, value, history.stored);
  out.add("distance", difference == 0.0 ? "the same as here" : distance_words(format, difference), "");
  const oracle::PixelClass found = add_legal(q, given, difference, out);
  if (difference == 0.0) return out;
  if (found != oracle::PixelClass::violation) {
    out.add("causes", "none is looked for: OpenGL allows this value", "");
    return out;
  }
  add_causes(q, history, value, out);
  return out;
}

}  // namespace

void explain(const ExplainOptions& options) {
  check_pipeline(options);
  Scene scene = scene_of_options(options);
  Pipeline pipeline =
      pipeline_of(options.against ? PipelineOptions(options) : with_smooth_edges(options, scene), scene);
  const bool other_view = pipeline.view != ImageView::lit;
  pipeline.view = ImageView::lit;
  PipelineOptions looked_at = options;  // a picture of ours says how it looks, another has the file's own
  if (options.against) looked_at.looks = over(options.looks, looks_of_picture(*options.against));
  bring_to_looks(looked_at, pipeline, options.against ? ChosenLooks::never : ChosenLooks::by_scene, scene);
  show(scene, options.camera, pipeline, options.seconds());
  if (options.x >= pipeline.width || options.y >= pipeline.height)
    throw Error(ErrorKind::usage, "--pixel",
                std::to_string(options.x) + ',' + std::to_string(options.y) + " is not in the picture, which is " +
                    std::to_string(pipeline.width) + 'x' + std::to_string(pipeline.height),
                "columns and rows count from 0 at the top left");
  check_memory(scene, pipeline_before_post(pipeline), {}, planes_to_judge(options, pipeline));
  const Question question(options, scene, pipeline);
  const PixelHistory history = history_of(question.frame, question.x, question.y);
  check_explanation(question, history);
  Account account = account_of(question.frame, history, detail_of(options));
  if (options.against) account.parts.push_back(against_account(question, history));
  add_finished_pixel(scene, pipeline, options.x, options.y, account);
  if (options.json)
    print(account_json(account) + '\n');
  else
    print(explanation_text(account));
  Notes notes = notes_of(scene, pipeline);
  if (other_view) notes.lines.emplace_back("the pipeline has a view; what is explained is the lit picture");
  say_notes(notes.lines);
}

}  // namespace trueshade
