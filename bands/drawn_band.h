#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "bands/large_picture.h"

namespace trueshade {

/// A band as it was drawn, and as each file holds it.
struct DrawnBand {
  int rows = 0;
  std::span<const uint8_t> color;                ///< texels, of `bytes`
  std::vector<std::span<const uint8_t>> planes;  ///< of the aovs; empty where they were not sent
  std::vector<EncodedRows> of_files;             ///< of LargePicture::files
  FrameStats counts;                             ///< without what lists say of tiles and loops
  std::vector<std::vector<uint8_t>> bytes;       ///< of pixels, or what another process has sent

  DrawnBand() = default;
  DrawnBand(DrawnBand&&) = default;  // a copy would show the pixels of another band
  DrawnBand& operator=(DrawnBand&&) = default;
};

/// Draws a band and encodes it. The pixels are the picture's, whatever the height of bands.
DrawnBand draw_band(const LargePicture& picture, int index);

/// A band as bytes, to be sent to another process. With SentPlanes::yes the pixels of the planes are among them; files
/// need none, because `of_files` holds the planes already, but hashes of planes do.
enum class SentPlanes : uint8_t { no, yes };
std::vector<uint8_t> bytes_of_band(const DrawnBand& band, SentPlanes planes);
/// The part of these bytes that is the same wherever the band was drawn.
std::span<const uint8_t> part_of_band_without_times(std::span<const uint8_t> bytes);
/// Error(bad_input) for bytes that are no band of this picture.
DrawnBand band_of_bytes(const LargePicture& picture, int index, std::vector<uint8_t> bytes);

/// Adds the counts and times of a part of a picture to those of others: scene and strategy stay as they are.
void add_counts(const FrameStats& part, FrameStats& sum);

/// These counts and times as words, and back; false for words that are not of counts_of().
std::vector<uint64_t> counts_of(const FrameStats& stats);
bool set_counts(std::span<const uint64_t> words, FrameStats& stats);

}  // namespace trueshade
