#include "judge/stages/legal_pixel.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "judge/stages/judge.h"

namespace trueshade::oracle {
namespace {

Image one_texel(const Image& image, int x, int y) {
  Image out(1, 1, image.format);
  std::memcpy(out.texels.data(), image.texel(x, y), out.texels.size());
  return out;
}

std::vector<float> one_bound(const std::vector<float>& bounds, size_t pixel) {
  if (bounds.size() <= 1) return bounds;
  return {bounds[pixel]};
}

/// The capture's pixel as a picture of its own.
Capture one_pixel(const Capture& capture, int x, int y) {
  Capture out;
  out.driver = capture.driver, out.has_alpha = capture.has_alpha, out.name = capture.name;
  out.color = one_texel(capture.color, x, y);
  const int bottom = capture.color.height - 1 - y;
  out.drawn_at = {capture.drawn_at[0] + x, capture.drawn_at[1] + bottom};
  for (const NamedImage& plane : capture.planes) out.planes.push_back({plane.name, one_texel(plane.image, x, y)});
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

/// Bits of a channel that no range of colours holds together with `nominal`: the code at the other end, or a float far
/// away.
uint32_t far_from(const Image& nominal, int channel) {
  const FormatInfo layout = info(nominal.format);
  if (layout.number_class == NumberClass::unorm) {
    const uint32_t largest = layout.largest_code(channel), code = nominal.code(0, 0, channel);
    return code > largest / 2 ? 0 : largest;
  }
  // All bits of the exponent but the lowest, and no fraction: the largest power of two of the format but one.
  const int fraction = layout.bits[size_t(channel)] == 32   ? 23
                       : layout.bits[size_t(channel)] == 16 ? 10
                       : layout.bits[size_t(channel)] == 11 ? 6
                                                            : 5;
  const uint32_t exponent = fraction == 23 ? 0xFD : 0x1D;
  return exponent << fraction;
}

}  // namespace

LegalPixel legal_pixel(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                       const Image& nominal, int x, int y) {
  const Pipeline of_pixel = pipeline_of_pixel(pipeline, x, y);
  Capture pixel = one_pixel(capture, x, y);
  const auto judged = [&] { return judge_lighting(scene, of_pixel, profile, pixel); };
  LegalPixel out;
  const StageVerdict given = judged();
  out.pixel_class = given.classes.front();
  out.channels =
      capture.has_alpha ? info(capture.color.format).channels : std::min(3, info(capture.color.format).channels);
  if (!given.worst.empty()) out.note = given.worst.front().note;
  const Image legal = one_texel(nominal, x, y);
  for (int c = 0; c < out.channels; ++c) {
    pixel.color = legal;
    pixel.color.set_code(0, 0, c, far_from(legal, c));
    const StageVerdict far = judged();
    const auto worst = std::find_if(far.worst.begin(), far.worst.end(),
                                    [](const WorstPixel& w) { return w.pixel_class == PixelClass::violation; });
    LegalChannel& channel = out.channel[size_t(c)];
    channel.is_bounded = worst != far.worst.end();
    if (channel.is_bounded) channel.low = worst->low, channel.high = worst->high;
  }
  return out;
}

}  // namespace trueshade::oracle
