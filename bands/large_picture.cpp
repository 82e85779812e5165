#include "bands/large_picture.h"

#include <algorithm>

#include "core/file_ending.h"
#include "core/memory_cap.h"
#include "shading/frame_memory.h"
#include "shading/output/target.h"

namespace trueshade {
namespace {

constexpr int kLargeSide = 16384;
constexpr uint64_t kLargePixels = uint64_t(1) << 26, kBandPixels = uint64_t(1) << 24;

/// Bytes that a band takes at once: the frame that is drawn, of which there are several where a row is too long for
/// one; the band they are put into; and what files hold of it.
uint64_t band_bytes(const LargePicture& picture, int rows) {
  const PictureRegion drawn = picture.drawn();
  Execution execution = picture.execution;
  execution.region = {drawn.x, drawn.y, std::min(drawn.width, kMostDrawnSide), std::min(rows, drawn.height)};
  uint64_t texel = uint64_t(info(picture.color()).bytes_per_texel()), encoded = 0;
  for (const Format format : picture.planes()) texel += uint64_t(info(format).bytes_per_texel());
  for (const std::string& file : picture.files)
    encoded += has_ending(file, ".exr") ? 2 * texel : 2 * uint64_t(info(picture.color()).bytes_per_texel());
  return predicted_memory(picture.scene.scene(), picture.pipeline, execution, picture.aovs) +
         uint64_t(drawn.width) * uint64_t(rows) * (texel + encoded);
}

}  // namespace

bool is_large(const Pipeline& pipeline, const PictureRegion& region) {
  const PictureRegion drawn = drawn_region(pipeline, region);
  return std::max(drawn.width, drawn.height) > kLargeSide || drawn_pixels(pipeline, region) > kLargePixels;
}

PictureRegion LargePicture::band(int index) const {
  const PictureRegion all = drawn();
  const int first = first_row(index);
  return {all.x, all.y + first, all.width, std::min(rows, all.height - first)};
}

Format LargePicture::color() const {
  if (pipeline.view != ImageView::lit) return Format::rgba8;
  return pipeline.post.active() ? pipeline.post.output : pipeline.target;
}

std::vector<Format> LargePicture::planes() const {
  std::vector<Format> formats;
  for (const std::string& name : aovs) formats.push_back(aov_format(name, surface_planes(pipeline)));
  return formats;
}

StreamedPicture LargePicture::streamed(const std::string& file) const {
  StreamedPicture out{drawn().width, drawn().height, color(), {}, metadata, file_options};
  const std::vector<Format> formats = planes();
  for (size_t i = 0; i < aovs.size() && has_ending(file, ".exr"); ++i) out.planes.emplace_back(aovs[i], formats[i]);
  return out;
}

int band_rows(const LargePicture& picture) {
  const PictureRegion drawn = picture.drawn();
  const auto strips = [](int rows) { return (rows + kStripRows - 1) / kStripRows * kStripRows; };
  int rows = strips(int(std::clamp<uint64_t>(kBandPixels / uint64_t(drawn.width), 1, uint64_t(drawn.height))));
  const uint64_t used = resident_memory();
  while (rows > kStripRows && used + band_bytes(picture, rows) > memory_cap()) rows = strips(rows / 2);
  require_memory(band_bytes(picture, rows), "size", "64 rows of the picture");
  return rows;
}

}  // namespace trueshade
