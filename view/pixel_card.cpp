#include "view/pixel_card.h"

#include <algorithm>

#include "core/error.h"
#include "explain/explain.h"
#include "explain/finished_pixel.h"
#include "shading/output/post_frame.h"

namespace trueshade::viewer {
namespace {

std::vector<AddedLight> added_lights(const PixelHistory& history) {
  std::vector<AddedLight> added;
  if (!history.visible) return added;
  const std::vector<LightAtPixel>& lights = history.lit.visible.lights;
  for (size_t i = 0; i < lights.size(); ++i)
    if (lights[i].fate == LightFate::adds)
      added.push_back({uint32_t(i), {lights[i].term[0], lights[i].term[1], lights[i].term[2]}});
  std::stable_sort(added.begin(), added.end(), [&](const AddedLight& a, const AddedLight& b) {
    return strength(lights[a.light]) > strength(lights[b.light]);
  });
  return added;
}

}  // namespace

PixelCard pixel_card(const EditedScene& scene, const DrawnPicture& picture, int x, int y) {
  Pipeline pipeline = picture.pipeline;
  pipeline.view = ImageView::lit;
  const int samples = pipeline.post.samples;
  if (x < 0 || y < 0 || x >= pipeline.width || y >= pipeline.height)
    throw Error(ErrorKind::usage, "click", std::to_string(x) + ',' + std::to_string(y) + " is not in the picture",
                "columns and rows count from 0 at the top left");
  const ExplainedFrame frame(scene.scene(), pipeline_before_post(pipeline));
  const PixelHistory history = history_of(frame, x * samples, y * samples);
  PixelCard card;
  card.x = x, card.y = y;
  card.revision = picture.state.revision;
  read_words(picture.frame.color, picture.words, x, y, {&card.word, 1});
  card.account = account_of(frame, history);
  add_finished_pixel(scene.scene(), pipeline, x, y, card.account);
  card.text = explanation_text(card.account);
  card.lights = added_lights(history);
  card.has_surface = history.visible.has_value();
  if (card.has_surface)
    for (int c = 0; c < 3; ++c) card.position[c] = history.surface.read.position[size_t(c)];
  return card;
}

}  // namespace trueshade::viewer
