#include "explain/explain.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cli/capture/capture_files.h"
#include "cli/capture/plane_images.h"
#include "cli/capture/stored_planes.h"
#include "cli/commands.h"
#include "cli/preparation.h"
#include "cli/progress_bar.h"
#include "core/error.h"
#include "explain/against.h"
#include "judge/stages/legal_pixel.h"
#include "scenes/pipeline/fit_lights.h"
#include "scenes/scene.h"
#include "shading/frame.h"
#include "shading/output/post_frame.h"

namespace trueshade {
namespace {

/// What is explained: a pixel of the target before the post chain, and of the reference frame what it takes to judge
/// another picture there.
struct Question {
  const ExplainOptions& options;
  const Scene& scene;
  const Pipeline& pipeline;  ///< as render has it
  const Pipeline large;      ///< before its post chain
  const ExplainedFrame frame;
  const int x, y;         ///< of `large`
  const Frame reference;  ///< by `large`, with the planes that judging reads

  Question(const ExplainOptions& o, const Scene& of_scene, const Pipeline& of_pipeline)
      : options(o),
        scene(of_scene),
        pipeline(of_pipeline),
        large(pipeline_before_post(of_pipeline)),
        frame(of_scene, large),
        x(o.x * of_pipeline.post.samples),
        y(o.y * of_pipeline.post.samples),
        reference(drawn()) {}

 private:
  Frame drawn() const {
    std::vector<std::string> planes;
    if (options.against) planes = {"depth", "position", "normal", "albedo", "uv", "id.object"};
    if (options.against && reads_specular_plane(large.light_model)) planes.emplace_back("specular");
    if (options.against && large.light_model.emission) planes.emplace_back("emission");
    ProgressBar bar("rendering", "tiles");
    return render_frame(scene, frame.pipeline, {}, planes, [&bar](int done, int total) { bar.show(done, total); });
  }
};

/// The explanation is only worth its words if it ends where the frame does.
void check_explanation(const Question& q, const PixelHistory& history) {
  if (stored_difference(q.frame.target, stored_in(q.reference.color, q.x, q.y), history.target.stored) != 0.0)
    throw std::logic_error("the explanation of pixel " + std::to_string(q.options.x) + ',' +
                           std::to_string(q.options.y) + " does not end in the rendered value");
}

std::string words_of(const std::vector<AccountValue>& values) {
  std::string text;
  for (const AccountValue& value : values) text += (text.empty() ? "" : ", ") + value_text(value);
  return text;
}

oracle::Capture picture_of(const Question& q) {
  const CaptureFiles files = read_picture_file(*q.options.against, q.options.limits.expansion);
  if (files.width() != q.large.width || files.height() != q.large.height)
    throw Error(ErrorKind::bad_input, *q.options.against,
                "it is " + std::to_string(files.width()) + 'x' + std::to_string(files.height()) + ", and the frame " +
                    std::to_string(q.large.width) + 'x' + std::to_string(q.large.height),
                "give --size as the picture has it");
  oracle::Capture capture;
  capture.driver = *q.options.against;
  capture.color = stored_plane_image(files.planes.front());
  capture.has_alpha = files.planes.front().channels.size() > 3;
  store_as(q.frame.pipeline, files.name, capture);
  return capture;
}

/// How far a value is from another, as people say it.
std::string distance_words(const BlendTarget& target, double difference) {
  if (difference == 0.0) return "exactly what the picture has";
  char text[48];
  const bool codes = info(target.format).number_class == NumberClass::unorm;
  std::snprintf(text, sizeof text, codes ? "%.0f code%s away" : "%.3g of the value away%s", difference,
                codes && difference != 1.0 ? "s" : "");
  return text;
}

/// Where another picture's value could have come from.
Account against_account(const Question& q, const PixelHistory& history) {
  oracle::Capture capture = picture_of(q);
  const StoredPixel given = stored_in(capture.color, q.x, q.y);
  const Format format = q.frame.target.format;
  Account out("against", *q.options.against + " there");
  out.quantities.push_back({"given", "what that picture holds", values_in_format(format, given)});
  const double difference = stored_difference(q.frame.target, given, history.target.stored);
  out.add("distance", difference == 0.0 ? "the same as here" : distance_words(q.frame.target, difference), "");
  capture.planes = q.reference.aovs;
  const oracle::LegalPixel legal =
      oracle::legal_pixel(q.scene, q.frame.pipeline, oracle::Profile{}, capture, q.reference.color, q.x, q.y);
  constexpr const char* kChannels[] = {"legal_R", "legal_G", "legal_B", "legal_A"};
  for (int c = 0; c < legal.channels; ++c) {
    const oracle::LegalChannel& channel = legal.channel[size_t(c)];
    if (channel.is_bounded)
      out.add(kChannels[c], std::array{channel.low, channel.high},
              "least and most that OpenGL allows any GPU on this surface");
  }
  out.add("class", std::string(oracle::text(legal.pixel_class)),
          "of its value on this surface, as trueshade validate has it");
  if (difference == 0.0) return out;
  for (const Candidate& candidate : candidates_for(q.frame, history, q.reference.color, given)) {
    Account& part = out.part("candidate", candidate.what + ": " + distance_words(q.frame.target, candidate.difference));
    part.quantities.push_back({"would_be", "what the pixel would hold", values_in_format(format, candidate.stored)});
    part.add("difference", candidate.difference, "largest over the channels");
  }
  return out;
}

/// What the post chain makes of the target.
std::vector<AccountValue> finished_pixel(const Question& q) {
  const Image picture = render_frame(q.scene, q.pipeline).color;
  return values_in_format(picture.format, stored_in(picture, q.options.x, q.options.y));
}

/// Where a post chain follows, what is explained is the target, and the picture's value comes last.
void add_finished_pixel(const Question& q, Account& account) {
  if (!q.pipeline.post.active()) return;
  const int n = q.pipeline.post.samples;
  const std::string which =
      n > 1 ? "the upper left of the pixel's " + std::to_string(n) + 'x' + std::to_string(n) + " samples, " : "";
  Quantity& target = account.quantities.back();
  target.name = "target";
  target.meaning = which + target.meaning + ", before the post chain";
  account.quantities.push_back(
      {"stored", std::string(info(q.pipeline.post.output).name) + ", after the post chain (docs/post.md)",
       finished_pixel(q)});
}

}  // namespace

void explain(const ExplainOptions& options) {
  check_pipeline(options);
  Scene scene = scene_of_options(options.scene, options.limits);
  set_time(scene, options.time);
  Pipeline pipeline = pipeline_of(options, scene);
  pipeline.view = ImageView::lit;
  fit_lights_of_ours(scene, pipeline.light_model);
  check_memory(scene, pipeline, {}, {});
  if (options.x >= pipeline.width || options.y >= pipeline.height)
    throw Error(ErrorKind::usage, "--pixel",
                std::to_string(options.x) + ',' + std::to_string(options.y) + " is not in the picture, which is " +
                    std::to_string(pipeline.width) + 'x' + std::to_string(pipeline.height),
                "columns and rows count from 0 at the top left");
  const Question question(options, scene, pipeline);
  const PixelHistory history = history_of(question.frame, question.x, question.y);
  check_explanation(question, history);
  Account account = account_of(question.frame, history, options.all_lights ? LightDetail::every : LightDetail::adding);
  if (options.against) account.parts.push_back(against_account(question, history));
  add_finished_pixel(question, account);
  if (options.json) return print(account_json(account) + '\n');
  // The stored pixel is a line at the top, where it is looked for first, and at the end, where programs find it.
  const Quantity& stored = account.quantities.back();
  print(account_text(account) + "\nstored  " + words_of(stored.values) + "  " + stored.meaning + '\n');
}

}  // namespace trueshade
