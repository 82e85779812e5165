#include "judge/stages/legal_pixel.h"

#include <algorithm>
#include <bit>

#include "core/image_pixel.h"
#include "judge/stages/judge.h"
#include "judge/stages/tally.h"

namespace trueshade::oracle {
namespace {

std::vector<float> one_bound(const std::vector<float>& bounds, size_t pixel) {
  if (bounds.size() <= 1) return bounds;
  return {bounds[pixel]};
}

/// The capture's pixel as a picture of its own.
Capture capture_of_pixel(const Capture& capture, int x, int y) {
  Capture out;
  out.driver = capture.driver, out.has_alpha = capture.has_alpha, out.name = capture.name;
  out.color = one_pixel(capture.color, x, y);
  const int bottom = capture.color.height - 1 - y;
  out.drawn_at = {capture.drawn_at[0] + x, capture.drawn_at[1] + bottom};
  for (const NamedImage& plane : capture.planes) out.planes.push_back({plane.name, one_pixel(plane.image, x, y)});
  const size_t pixel = size_t(y) * size_t(capture.color.width) + size_t(x);
  for (const DecodedPlane& plane : capture.decoded) {
    out.decoded.push_back(plane);
    out.decoded.back().reading_error = one_bound(plane.reading_error, pixel);
    out.decoded.back().packing_error = one_bound(plane.packing_error, pixel);
  }
  return out;
}

/// The pipeline whose picture is that pixel alone: the window is larger, and the picture its part.
Pipeline pipeline_of_pixel(const Pipeline& pipeline, int x, int y) {
  Pipeline out = pipeline;
  Viewport& viewport = out.geometry.viewport;
  if (viewport.width == 0 && viewport.height == 0) viewport = {0, 0, pipeline.width, pipeline.height};
  viewport.x -= x, viewport.y -= pipeline.height - 1 - y;
  out.width = out.height = 1;
  return out;
}

/// Bits of a channel at both ends of its format: the least and the largest code, or 0 and the largest finite float.
/// What a range of colours leaves out is one of them, unless it leaves out nothing.
std::array<uint32_t, 2> ends_of(const FormatInfo& layout, int channel) {
  if (layout.number_class == NumberClass::unorm) return {0, layout.largest_code(channel)};
  switch (layout.bits[size_t(channel)]) {
    case 32:
      return {0, 0x7F7FFFFF};
    case 16:
      return {0, 0x7BFF};
    case 11:
      return {0, 0x7BF};
    default:
      return {0, 0x3DF};
  }
}

}  // namespace

LegalPixel legal_pixel(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                       const Image& nominal, int x, int y) {
  const Pipeline of_pixel = pipeline_of_pixel(pipeline, x, y);
  Capture pixel = capture_of_pixel(capture, x, y);
  const auto judged = [&] { return judge_lighting(scene, of_pixel, profile, pixel); };
  LegalPixel out;
  const StageVerdict given = judged();
  out.pixel_class = given.classes.front();
  out.channels =
      capture.has_alpha ? info(capture.color.format).channels : std::min(3, info(capture.color.format).channels);
  const Image legal = one_pixel(nominal, x, y);
  for (int c = 0; c < out.channels; ++c) {
    LegalChannel& channel = out.channel[size_t(c)];
    channel.is_bounded = false;
    for (const uint32_t end : ends_of(info(legal.format), c)) {
      pixel.color = legal;
      pixel.color.set_code(0, 0, c, end);
      const StageVerdict far = judged();
      const auto worst = std::find_if(far.worst.begin(), far.worst.end(), [&](const WorstPixel& w) {
        return w.pixel_class == PixelClass::violation && w.plane == channel_of("color", c);
      });
      if (worst == far.worst.end()) continue;
      channel = {worst->low, worst->high, true};
      break;
    }
  }
  return out;
}

}  // namespace trueshade::oracle
