#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/image.h"

namespace trueshade {

/// The types of channels, by the numbers that OpenEXR gives them.
enum class ExrType : int32_t { uint = 0, half = 1, float32 = 2 };

constexpr size_t bytes_of(ExrType type) { return type == ExrType::half ? 2 : 4; }

/// One channel of the file, and where its values come from.
struct ExrChannel {
  std::string name;
  const Image* image;
  int channel;  ///< of image
  ExrType type;
};

/// Channels of colour and planes in the order in which a scan line holds them: by name. Integers stay integers, floats
/// of 16 bits or fewer become halves, and all else becomes float. Error(usage) naming `where` for planes of another size
/// than the colour.
std::vector<ExrChannel> exr_channels(const std::string& where, const Image& color, std::span<const NamedImage> aovs);

/// Packs rows of several images as scan lines hold them: all pixels of the first channel, then all of the next.
/// One thread at a time.
class ExrRows {
 public:
  explicit ExrRows(std::span<const ExrChannel> channels);

  size_t row_bytes() const { return row_bytes_; }

  std::span<const ExrChannel> channels() const { return channels_; }
  size_t channel_bytes(const ExrChannel& channel) const {
    return bytes_of(channel.type) * size_t(channel.image->width);
  }

  /// The samples of one channel in a row. Channels of an image are best asked for in turn.
  void pack(const ExrChannel& channel, int y, uint8_t* out);

 private:
  std::span<const ExrChannel> channels_;
  size_t row_bytes_ = 0;
  std::vector<float> values_;             ///< a row of values_of_, pixel after pixel
  const Image* values_of_ = nullptr;
  int values_y_ = -1;

  const float* values(const Image& image, int y);
};

}  // namespace trueshade
