#include "shading/output/post_frame.h"

#include <algorithm>

#include "core/error.h"
#include "core/fp_env.h"
#include "core/image_rows.h"
#include "core/memory_cap.h"
#include "scenes/light_shapes.h"
#include "shading/output/overlay.h"
#include "shading/output/post.h"

namespace trueshade {
namespace {

constexpr int kMostPixels = 65536, kMostCoordinate = 1 << 27;

void draw_markers(const Scene& scene, const Pipeline& large, float radius, const Execution& execution,
                  const Image& depth, Picture& picture) {
  const Scene markers = light_markers(scene, radius);
  const Image object = overlay(markers, large, execution, depth);
  std::vector<uint32_t> row(size_t(object.width));
  for (int y = 0; y < picture.height; ++y) {
    read_row(object, y, row.data());
    for (int x = 0; x < picture.width; ++x) {
      if (row[size_t(x)] == 0) continue;
      const glm::vec3 color = overlay_color(markers, row[size_t(x)]);
      for (int c = 0; c < 3; ++c) picture.at(x, y)[c] = color[c];
      picture.at(x, y)[3] = 1.0f;
    }
  }
}

}  // namespace

Pipeline pipeline_before_post(const Pipeline& pipeline) {
  const int samples = pipeline.post.samples;
  Pipeline large = pipeline;
  large.post = {};
  const auto grown = [samples](int& value, int most) {
    if (std::abs(int64_t(value)) * samples > most)
      throw Error(ErrorKind::limit, "post.samples", "the frame would be over 65536 pixels a side",
                  "a smaller size or fewer samples");
    value *= samples;
  };
  grown(large.width, kMostPixels);
  grown(large.height, kMostPixels);
  Viewport& v = large.geometry.viewport;
  for (int* value : {&v.x, &v.y, &v.width, &v.height}) grown(*value, samples > 1 ? kMostCoordinate : INT32_MAX);
  return large;
}

Image finished_image(const Scene& scene, const Pipeline& pipeline, const Execution& execution, const Image& target,
                     const Image* depth) {
  const FpScope fp;
  const PostChain& chain = pipeline.post;
  require_memory(uint64_t(target.width) * uint64_t(target.height) * 4 * sizeof(float), "post", "the float picture");
  Picture picture = picture_of(target);
  if (chain.marker_radius > 0.0f)
    draw_markers(scene, pipeline_before_post(pipeline), chain.marker_radius, execution, *depth, picture);
  if (chain.samples > 1) picture = box_average(picture, chain.samples, execution.threads);
  if (chain.bloom.strength > 0.0f) add_bloom(chain.bloom, execution.threads, picture);
  if (chain.tone_map == PostChain::ToneMap::reinhard) map_tones(chain, picture);
  if (chain.encode == PostChain::Encode::srgb) encode_srgb(execution.threads, picture);
  if (chain.edge_filter) picture = smoothed_edges(picture, execution.threads);
  return stored(picture, chain.output, pipeline.gbuffer.half_round);
}

}  // namespace trueshade
