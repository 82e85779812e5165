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

constexpr int kMostCoordinate = 1 << 27;

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

Pipeline pipeline_before_post(const Pipeline& pipeline, const PictureRegion& region) {
  const int samples = pipeline.post.samples;
  Pipeline large = pipeline;
  large.post = {};
  const auto check = [samples](int value, int most) {
    if (std::abs(int64_t(value)) * samples > most)
      throw Error(ErrorKind::limit, "post.samples", "the frame would be over 65536 pixels a side",
                  "a smaller size or fewer samples");
  };
  const auto grown = [&](int& value, int most) {
    check(value, most);
    value *= samples;
  };
  const PictureRegion drawn = drawn_region(pipeline, region);
  check(std::max(drawn.width, drawn.height), kMostDrawnSide);
  grown(large.width, samples * kMostPictureSide);
  grown(large.height, samples * kMostPictureSide);
  Viewport& v = large.geometry.viewport;
  for (int* value : {&v.x, &v.y, &v.width, &v.height}) grown(*value, samples > 1 ? kMostCoordinate : INT32_MAX);
  return large;
}

Execution execution_before_post(const Pipeline& pipeline, const Execution& execution) {
  Execution large = execution;
  for (int* value : {&large.region.x, &large.region.y, &large.region.width, &large.region.height})
    *value *= pipeline.post.samples;
  return large;
}

Image finished_image(const Scene& scene, const Pipeline& pipeline, const Execution& execution, const Image& target,
                     const Image* depth, double mean) {
  const FpScope fp;
  const PostChain& chain = pipeline.post;
  require_memory(uint64_t(target.width) * uint64_t(target.height) * 4 * sizeof(float), "post", "the float picture");
  Picture picture = picture_of(target);
  if (chain.marker_radius > 0.0f)
    draw_markers(scene, pipeline_before_post(pipeline, execution.region), chain.marker_radius,
                 execution_before_post(pipeline, execution), *depth, picture);
  if (chain.samples > 1) picture = box_average(picture, chain.samples, execution.threads);
  if (chain.bloom.strength > 0.0f) add_bloom(chain.bloom, execution.threads, picture);
  if (chain.tone_map == PostChain::ToneMap::reinhard)
    map_tones(chain, mean != 0.0 ? mean : logarithmic_mean(picture, chain.log_offset), picture);
  if (chain.encode == PostChain::Encode::srgb) encode_srgb(execution.threads, picture);
  if (chain.edge_filter) picture = smoothed_edges(picture, execution.threads);
  return stored(picture, chain.output, pipeline.gbuffer.half_round);
}

}  // namespace trueshade
