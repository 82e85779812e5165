// ITU-T T.81, "Digital compression and coding of continuous-tone still images", annex B (markers).
#include "core/image_files/jpeg_pixels.h"

#include "core/error.h"

namespace trueshade {
namespace {

Error refused(const std::string& where, const std::string& reason) {
  return {ErrorKind::bad_input, where, reason, "write the file again"};
}

constexpr uint8_t kStart = 0xD8, kJpegEnd = 0xD9, kScan = 0xDA;

/// Markers without a length behind them.
bool stands_alone(uint8_t marker) { return marker == 0x01 || (marker >= 0xD0 && marker <= 0xD7) || marker == kStart; }

/// SOF0 to SOF15, which describe a frame; C4, C8 and CC are other things.
bool starts_frame(uint8_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

size_t word_at(std::span<const uint8_t> bytes, size_t at) { return size_t(bytes[at]) << 8 | bytes[at + 1]; }

JpegSize frame_size(const std::string& where, std::span<const uint8_t> segment, uint8_t marker) {
  if (marker > 0xC2) throw refused(where, "it is neither a baseline nor a progressive JPEG");
  if (segment.size() >= 6 && segment[5] == 4) throw refused(where, "it is a JPEG of four inks, CMYK or YCCK");
  if (segment.size() < 6 || segment[0] != 8 || (segment[5] != 1 && segment[5] != 3))
    throw refused(where, "it is not a JPEG of 8 bits with one or three components");
  return {int(word_at(segment, 3)), int(word_at(segment, 1))};
}

}  // namespace

JpegSize jpeg_size(const std::string& where, std::span<const uint8_t> bytes) {
  JpegSize size{0, 0};
  bool in_scan = false;
  for (size_t at = 2; at + 1 < bytes.size();) {
    if (bytes[at] != 0xFF || bytes[at + 1] == 0x00 || bytes[at + 1] == 0xFF) {
      if (!in_scan && bytes[at] != 0xFF) throw refused(where, "its markers are damaged");
      ++at;
      if (bytes[at] == 0x00) ++at;
      continue;
    }
    const uint8_t marker = bytes[at + 1];
    at += 2;
    if (marker == kJpegEnd) {
      if (size.width < 1 || size.height < 1 || !in_scan) throw refused(where, "it has no picture");
      return size;
    }
    if (stands_alone(marker)) continue;
    if (at + 2 > bytes.size()) break;
    const size_t length = word_at(bytes, at);
    if (length < 2 || at + length > bytes.size()) break;
    if (starts_frame(marker)) {
      if (size.width != 0) throw refused(where, "it has several frames");
      size = frame_size(where, bytes.subspan(at + 2, length - 2), marker);
    }
    in_scan = in_scan || marker == kScan;
    at += length;
  }
  throw refused(where, "the JPEG ends before its picture does");
}

}  // namespace trueshade
