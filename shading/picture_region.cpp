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

constexpr int kPixelsOfPart = 1 << 22;  // that are measured at a time

bool maps_tones(const Pipeline& pipeline) {
  return pipeline.view == ImageView::lit && pipeline.post.tone_map == PostChain::ToneMap::reinhard;
}

/// Adds the logarithms of a part of some rows to their sums, from the left.
void add_logarithms(const PreparedScene& scene, const Pipeline& pipeline, const Execution& of_part,
                    std::vector<double>& rows) {
  Pipeline before = pipeline;  // the chain up to the tones
  before.post.tone_map = PostChain::ToneMap::none;
  before.post.encode = PostChain::Encode::linear;
  before.post.edge_filter = false;
  before.post.output = Format::rgba32f;
  const Frame frame = render_frame(scene, before, of_part);
  LogarithmicMean(pipeline.post.log_offset).add_to_rows(picture_of(frame.color), rows);
}

/// Planes of a part, under a view that shows none of the numbers that are measured and is not lit.
std::vector<NamedImage> planes_of_part(const PreparedScene& scene, const Pipeline& pipeline, const Execution& of_part,
                                       std::span<const std::string> names) {
  Pipeline shown = pipeline;
  shown.view = ImageView::albedo;
  return render_frame(scene, shown, of_part, names).aovs;
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

PictureMeasurement::PictureMeasurement(const PreparedScene& scene, const Pipeline& pipeline)
    : scene_(scene),
      pipeline_(pipeline),
      width_(std::min(pipeline.width, kMostDrawnSide / pipeline.post.samples)),
      rows_(std::clamp(kPixelsOfPart / width_, 1, pipeline.height)),
      logarithms_(pipeline.post.log_offset) {
  if (!heat_plane(pipeline.view).empty()) constants_.view_scale = 1;
}

int PictureMeasurement::parts() const { return (pipeline_.height + rows_ - 1) / rows_; }

/// Of a part, from the left: where rows are long, more than one.
std::vector<PictureRegion> PictureMeasurement::regions(int part) const {
  const int y = part * rows_, rows = std::min(rows_, pipeline_.height - y);
  std::vector<PictureRegion> regions;
  for (int x = 0; x < pipeline_.width; x += width_)
    regions.push_back({x, y, std::min(width_, pipeline_.width - x), rows});
  return regions;
}

MeasuredRows PictureMeasurement::measure(int part, const Execution& execution) const {
  const FpScope fp;
  MeasuredRows measured;
  for (const PictureRegion& region : regions(part)) {
    Execution of_part = execution;
    of_part.region = region;
    if (maps_tones(pipeline_)) {
      measured.logarithms.resize(size_t(region.height), 0.0);
      add_logarithms(scene_, pipeline_, of_part, measured.logarithms);
    }
    if (const std::string plane(heat_plane(pipeline_.view)); !plane.empty()) {
      const auto planes = planes_of_part(scene_, pipeline_, of_part, {&plane, 1});
      measured.view_scale = std::max(measured.view_scale, heat_scale(planes[0].image));
    }
    if (shows_extents(pipeline_.view)) {
      const auto planes = planes_of_part(scene_, pipeline_, of_part, planes_of_view(pipeline_.view));
      const std::array<Extent, 3> more = view_extents(pipeline_.view, execution.threads, planes);
      for (size_t c = 0; c < 3; ++c) measured.extents[c].add(more[c]);
    }
  }
  return measured;
}

void PictureMeasurement::add(const MeasuredRows& rows) {
  const FpScope fp;
  logarithms_.add(rows.logarithms);
  if (!heat_plane(pipeline_.view).empty()) constants_.view_scale = std::max(constants_.view_scale, rows.view_scale);
  for (size_t c = 0; c < 3; ++c) constants_.extents[c].add(rows.extents[c]);
}

PictureConstants PictureMeasurement::constants() const {
  const FpScope fp;
  PictureConstants constants = constants_;
  if (maps_tones(pipeline_))
    constants.logarithmic_mean = logarithms_.of(uint64_t(pipeline_.width) * uint64_t(pipeline_.height));
  return constants;
}

PictureConstants picture_constants(const PreparedScene& scene, const Pipeline& pipeline, const Execution& execution) {
  PictureMeasurement measurement(scene, pipeline);
  for (int part = 0; part < measurement.parts(); ++part) measurement.add(measurement.measure(part, execution));
  return measurement.constants();
}

}  // namespace trueshade
