#include "core/image_rows.h"

#include <array>
#include <cassert>
#include <cstring>

#include "core/half.h"

namespace trueshade {
namespace {

/// RN(code / 255).
constexpr std::array<float, 256> kOfCode = [] {
  std::array<float, 256> values{};
  for (size_t code = 0; code < values.size(); ++code) values[code] = float(code) / 255.0f;
  return values;
}();

template <typename Code, typename Value>
void read_codes(const Image& image, int y, int channels, const Value& value, float* out) {
  const int step = info(image.format).channels;
  const uint8_t* row = image.texel(0, y);
  for (int x = 0; x < image.width; ++x)
    for (int c = 0; c < channels; ++c) {
      Code code;
      std::memcpy(&code, row + size_t(step * x + c) * sizeof(Code), sizeof code);
      out[channels * x + c] = value(code, c);
    }
}

}  // namespace

void read_row(const Image& image, int y, int channels, float* out) {
  const FormatInfo layout = info(image.format);
  assert(layout.number_class != NumberClass::integer && channels <= layout.channels);
  const bool floats = layout.number_class == NumberClass::floating;
  if (floats && layout.bytes_per_channel == 4) {
    if (channels == layout.channels)
      std::memcpy(out, image.texel(0, y), image.row_bytes());
    else
      read_codes<float>(
          image, y, channels, [](float value, int) { return value; }, out);
    return;
  }
  if (floats && layout.bytes_per_channel == 2)
    return read_codes<uint16_t>(
        image, y, channels, [](uint16_t half, int) { return float_from_half(half); }, out);
  if (layout.bytes_per_channel == 1 && !layout.srgb) {
    return read_codes<uint8_t>(
        image, y, channels, [](uint8_t code, int) { return kOfCode[code]; }, out);
  }
  for (int x = 0; x < image.width; ++x)
    for (int c = 0; c < channels; ++c) out[channels * x + c] = float(value_of_code(layout, c, image.code(x, y, c)));
}

void read_row(const Image& image, int y, uint32_t* out) {
  assert(image.format == Format::r32ui);
  std::memcpy(out, image.texel(0, y), image.row_bytes());
}

}  // namespace trueshade
