#include <string>

#include "cli/capture/capture_map.h"
#include "core/expansion.h"
#include "core/image_files/channel_file.h"
#include "tests/fuzz/promises.h"

// Files of planes as captures bring them, and the map that says which is which.
namespace trueshade::fuzz {
namespace {

void check_channels(const ChannelFile& file, size_t bytes) {
  promise(file.width > 0 && file.height > 0 && !file.channels.empty(), "a file of channels has pixels");
  const size_t pixels = size_t(file.width) * size_t(file.height);
  promise(pixels * file.channels.size() <= 1100 * (bytes + 16), "no more than Deflate unpacks");
  for (const Channel& channel : file.channels) {
    promise(channel.words.size() == pixels, "a channel is whole");
    for (const uint32_t word : channel.words) {
      if (channel.is_code()) promise(word <= channel.largest_code(), "a code is one");
      if (channel.kind == ChannelKind::snorm) promise(int32_t(word) >= -int32_t(channel.largest_code()) - 1, "a code");
    }
    const double value = channel.value(pixels - 1);
    if (channel.is_code() || channel.kind == ChannelKind::snorm)
      promise(value >= -1 && value <= 1, "a value of a code");
  }
}

}  // namespace

void run_npy(Bytes bytes) {
  if (text_of(bytes).starts_with("\x93NUMPY"))
    read([&] { check_channels(npy_channels("p.npy", bytes), bytes.size()); });
}
void run_dds(Bytes bytes) {
  if (text_of(bytes).starts_with("DDS ")) read([&] { check_channels(dds_channels("p.dds", bytes), bytes.size()); });
}
void run_tiff(Bytes bytes) {
  const std::string_view text = text_of(bytes);
  if (text.starts_with(std::string_view("II*\0", 4)) || text.starts_with(std::string_view("MM\0*", 4)))
    read([&] { check_channels(tiff_channels("p.tif", bytes), bytes.size()); });
}

void run_hdr(Bytes bytes) {
  read([&] {
    const ChannelFile file = hdr_channels("p.hdr", bytes, kMostExpansion);
    promise(file.channels.size() == 3, "there are R, G and B");
    for (const Channel& channel : file.channels) {
      promise(channel.words.size() == size_t(file.width) * size_t(file.height), "a channel is whole");
      for (size_t i = 0; i < channel.words.size(); ++i)
        promise(channel.value(i) >= 0 && channel.value(i) <= 255 * 0x1p119, "a value is one of RGBE");
    }
  });
}

/// A map that is read names each plane once, and its text without comments is read as the same.
void run_capture_map(Bytes bytes) {
  read([&] {
    const CaptureMap map = capture_map_from_text(text_of(bytes), "map.txt", ErrorKind::bad_input);
    std::string again = map.bottom_up ? "rows=bottom_up" : "";
    for (const MappedPlane& plane : map.planes) {
      promise(channels_of_plane(plane.plane) != nullptr, "a plane is one of a capture");
      again += (again.empty() ? "" : ",") + plane.plane + (plane.source.empty() ? "" : "=" + plane.source);
    }
    const CaptureMap other = capture_map_from_text(again, "map.txt", ErrorKind::bad_input);
    promise(other.planes.size() == map.planes.size() && other.bottom_up == map.bottom_up, "a map is its text");
    for (size_t i = 0; i < map.planes.size(); ++i)
      promise(other.planes[i].plane == map.planes[i].plane && other.planes[i].source == map.planes[i].source,
              "a plane is its text");
  });
}

}  // namespace trueshade::fuzz
