#include "shading/picture_region.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "core/fp_env.h"
#include "shading/output/derived_planes.h"
#include "shading/output/heat_map.h"
#include "shading/output/post.h"
#include "shading/output/post_frame.h"
#include "shading/output/view_image.h"

namespace trueshade {
namespace {

/// A region, or all of the picture, as the pixels that it begins at and ends before.
struct PixelBounds {
  int x0, y0, x1, y1;

  PixelBounds(const Pipeline& pipeline, const PictureRegion& region) {
    const PictureRegion r = drawn_region(pipeline, region);
    x0 = r.x, y0 = r.y, x1 = r.x + r.width, y1 = r.y + r.height;
  }
  void grow(int pixels) { x0 -= pixels, y0 -= pixels, x1 += pixels, y1 += pixels; }
  /// To whole squares that count from the lower left corner of a picture of `height` rows.
  void grow_to_squares(int side, int height) {
    const auto up = [side](int v) { return (v + side - 1) / side * side; };
    x0 = x0 / side * side, x1 = up(x1);
    const int bottom = (height - y1) / side * side, top = up(height - y0);
    y0 = height - top, y1 = height - bottom;
  }
  PictureRegion within(const Pipeline& pipeline) const {
    const int left = std::max(x0, 0), top = std::max(y0, 0);
    return {left, top, std::min(x1, pipeline.width) - left, std::min(y1, pipeline.height) - top};
  }
};

/// How far from a pixel the post chain looks, pixels.
int reach_of(const PostChain& post) {
  const int bloom = post.bloom.strength > 0.0f ? post.bloom.radius * post.bloom.passes : 0;
  return bloom + (post.edge_filter ? kEdgeReach : 0);
}

/// Parts of the picture that are measured one after the other: some rows, and where these are long, a part of them.
class Parts {
 public:
  explicit Parts(const Pipeline& pipeline)
      : pipeline_(pipeline),
        width_(std::min(pipeline.width, kMostDrawnSide / pipeline.post.samples)),
        rows_(std::clamp(kPixels / width_, kLeastRows, pipeline.height)) {}

  int columns() const { return (pipeline_.width + width_ - 1) / width_; }
  int bands() const { return (pipeline_.height + rows_ - 1) / rows_; }
  int count() const { return columns() * bands(); }
  /// The i-th, from the left, then from the top.
  PictureRegion operator[](int i) const {
    const int x = i % columns() * width_, y = i / columns() * rows_;
    return {x, y, std::min(width_, pipeline_.width - x), std::min(rows_, pipeline_.height - y)};
  }

 private:
  static constexpr int kPixels = 1 << 22, kLeastRows = 1;
  const Pipeline& pipeline_;
  int width_, rows_;
};

std::array<Extent, 3> measured_extents(const PreparedScene& scene, const Pipeline& pipeline, const Execution& execution,
                                       const Progress& progress) {
  const std::vector<std::string> planes = planes_of_view(pipeline.view);
  Pipeline shown = pipeline;
  shown.view = ImageView::albedo;  // any without extents, and not lit
  const Parts parts(pipeline);
  std::array<Extent, 3> extents;
  for (int i = 0; i < parts.count(); ++i) {
    Execution of_part = execution;
    of_part.region = parts[i];
    const Frame frame = render_frame(scene, shown, of_part, planes);
    const std::array<Extent, 3> more = view_extents(pipeline.view, execution.threads, frame.aovs);
    for (size_t c = 0; c < 3; ++c) extents[c].add(more[c]);
    if (progress) progress(i + 1, parts.count());
  }
  return extents;
}

uint32_t measured_scale(const PreparedScene& scene, const Pipeline& pipeline, const Execution& execution,
                        const Progress& progress) {
  const std::string plane(heat_plane(pipeline.view));
  Pipeline counted = pipeline;
  counted.view = ImageView::albedo;  // any that is no heat map, and not lit
  const Parts parts(pipeline);
  uint32_t scale = 1;
  for (int i = 0; i < parts.count(); ++i) {
    Execution of_part = execution;
    of_part.region = parts[i];
    const Frame frame = render_frame(scene, counted, of_part, {&plane, 1});
    scale = std::max(scale, heat_scale(frame.aovs[0].image));
    if (progress) progress(i + 1, parts.count());
  }
  return scale;
}

double measured_mean(const PreparedScene& scene, const Pipeline& pipeline, const Execution& execution,
                     const Progress& progress) {
  Pipeline before = pipeline;  // the chain up to the tones
  before.post.tone_map = PostChain::ToneMap::none;
  before.post.encode = PostChain::Encode::linear;
  before.post.edge_filter = false;
  before.post.output = Format::rgba32f;
  const Parts parts(pipeline);
  LogarithmicMean mean(pipeline.post.log_offset);
  std::vector<double> rows;
  for (int i = 0; i < parts.count(); ++i) {
    const PictureRegion part = parts[i];
    if (part.x == 0) rows.assign(size_t(part.height), 0.0);
    Execution of_part = execution;
    of_part.region = part;
    const Frame frame = render_frame(scene, before, of_part);
    mean.add_to_rows(picture_of(frame.color), rows);
    if (part.x + part.width == pipeline.width) mean.add(rows);
    if (progress) progress(i + 1, parts.count());
  }
  return mean.of(uint64_t(pipeline.width) * uint64_t(pipeline.height));
}

bool maps_tones(const Pipeline& pipeline) {
  return pipeline.view == ImageView::lit && pipeline.post.tone_map == PostChain::ToneMap::reinhard;
}

}  // namespace

PictureRegion region_to_draw(const Pipeline& pipeline, const PictureRegion& region,
                             std::span<const std::string> planes) {
  if (region.whole()) return region;
  PixelBounds bounds(pipeline, region);
  if (pipeline.view == ImageView::lit) bounds.grow(reach_of(pipeline.post));
  if (std::find(planes.begin(), planes.end(), "light.tile") != planes.end())
    bounds.grow_to_squares(kLightTile, pipeline.height);
  return bounds.within(pipeline);
}

Image part_of(Image from, const PictureRegion& drawn, const PictureRegion& part) {
  if (part == drawn || from.texels.empty()) return from;
  Image out(part.width, part.height, from.format);
  for (int y = 0; y < part.height; ++y)
    std::memcpy(out.texel(0, y), from.texel(part.x - drawn.x, part.y - drawn.y + y), out.row_bytes());
  return out;
}

bool has_constants(const Pipeline& pipeline) {
  return maps_tones(pipeline) || !heat_plane(pipeline.view).empty() || shows_extents(pipeline.view);
}

PictureConstants picture_constants(const PreparedScene& scene, const Pipeline& pipeline, const Execution& execution,
                                   const Progress& progress) {
  const FpScope fp;
  PictureConstants constants;
  if (maps_tones(pipeline)) constants.logarithmic_mean = measured_mean(scene, pipeline, execution, progress);
  if (!heat_plane(pipeline.view).empty()) constants.view_scale = measured_scale(scene, pipeline, execution, progress);
  if (shows_extents(pipeline.view)) constants.extents = measured_extents(scene, pipeline, execution, progress);
  return constants;
}

}  // namespace trueshade
