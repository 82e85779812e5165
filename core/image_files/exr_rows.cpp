#include "core/image_files/exr_rows.h"

#include <algorithm>
#include <cstring>

#include "core/error.h"
#include "core/image_files/exr_channels.h"
#include "core/image_rows.h"

namespace trueshade {
namespace {

ExrType type_of(const FormatInfo& layout) {
  if (layout.number_class == NumberClass::integer) return ExrType::uint;
  return layout.small_float() ? ExrType::half : ExrType::float32;  // a half holds floats of 11 and 10 bits too
}

/// Every `channels`-th word from `words` on.
template <typename Word>
void pick(const uint8_t* words, size_t channels, size_t count, uint8_t* out) {
  for (size_t i = 0; i < count; ++i) std::memcpy(out + i * sizeof(Word), words + i * channels * sizeof(Word), sizeof(Word));
}

}  // namespace

std::vector<ExrChannel> exr_channels(const std::string& where, const Image& color, std::span<const NamedImage> aovs) {
  std::vector<ExrChannel> channels;
  const auto add = [&channels](const std::string& name, const Image& image) {
    int channel = 0;
    for (const std::string& of_channel : exr_channels_of(name, info(image.format).channels))
      channels.push_back({of_channel, &image, channel++, type_of(info(image.format))});
  };
  add("color", color);
  for (const NamedImage& aov : aovs) {
    if (aov.image.width != color.width || aov.image.height != color.height)
      throw Error(ErrorKind::usage, where, "plane " + aov.name + " has another size than the colour",
                  "give it the same");
    add(aov.name, aov.image);
  }
  std::sort(channels.begin(), channels.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return channels;
}

ExrRows::ExrRows(std::span<const ExrChannel> channels) : channels_(channels) {
  for (const ExrChannel& channel : channels_) row_bytes_ += bytes_of(channel.type) * size_t(channel.image->width);
}

/// A row of a unorm image as floats. Its channels are asked for in turn, so the row is kept.
const float* ExrRows::values(const Image& image, int y) {
  if (values_of_ == &image && values_y_ == y) return values_.data();
  const int channels = info(image.format).channels;
  values_.resize(size_t(image.width) * size_t(channels));
  read_row(image, y, channels, values_.data());
  values_of_ = &image;
  values_y_ = y;
  return values_.data();
}

void ExrRows::pack(const ExrChannel& source, int y, uint8_t* out) {
  const Image& image = *source.image;
  const FormatInfo layout = info(image.format);
  const auto channels = size_t(layout.channels), channel = size_t(source.channel), count = size_t(image.width);
  if (layout.number_class == NumberClass::unorm)
    return pick<float>(reinterpret_cast<const uint8_t*>(values(image, y) + channel), channels, count, out);
  if (layout.bytes_per_channel == 4) return pick<uint32_t>(image.texel(0, y) + channel * 4, channels, count, out);
  if (layout.bytes_per_channel == 2) return pick<uint16_t>(image.texel(0, y) + channel * 2, channels, count, out);
  for (size_t x = 0; x < count; ++x) {
    const auto half = uint16_t(image.code(int(x), y, source.channel) << (15 - layout.bits[channel]));
    std::memcpy(out + 2 * x, &half, sizeof half);
  }
}

}  // namespace trueshade
