#include "cli/capture/plane_images.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/half.h"
#include "core/threads/parallel_for.h"

namespace trueshade {
namespace {

/// Whether each channel has so many bits.
bool all_bits(const PlaneChannelList& plane, int bits) {
  return std::all_of(plane.channels.begin(), plane.channels.end(),
                     [bits](const Channel* c) { return c->bits == bits; });
}

/// Whether a plane is an identifier or a count.
bool is_one_number(const std::string& plane) { return plane.starts_with("id.") || plane == "light.count"; }

/// The format of the image that holds a plane's channels: see stored_plane_image().
Format format_of_channels(const PlaneChannelList& plane) {
  const Channel& first = *plane.channels[0];
  const size_t count = plane.channels.size();
  if (count == 1 && (first.kind == ChannelKind::integer || (first.is_code() && is_one_number(plane.mapped.plane))))
    return Format::r32ui;
  const bool pads = count == 3 && plane.mapped.plane != "position" && plane.mapped.plane != "normal";
  if (first.is_code() && (count == 4 || pads)) {
    if (all_bits(plane, 8)) return first.kind == ChannelKind::srgb ? Format::srgb8_a8 : Format::rgba8;
    if (all_bits(plane, 16)) return Format::rgba16;
    if (count == 4 && first.bits == 10 && plane.channels[3]->bits == 2) return Format::rgb10_a2;
  }
  const bool halves = first.kind == ChannelKind::floating && all_bits(plane, 16);
  if (count >= 3 && halves) return count == 3 ? Format::rgb16f : Format::rgba16f;
  constexpr Format kFloats[] = {Format::d32f, Format::rg32f, Format::rgb32f, Format::rgba32f};
  return kFloats[count - 1];
}

Error bad_plane(const PlaneChannelList& plane, int x, int y, const std::string& reason, const std::string& remedy) {
  return {ErrorKind::bad_input, plane.file->path,
          plane.mapped.plane + " at " + std::to_string(x) + ',' + std::to_string(y) + ' ' + reason, remedy};
}

/// store_row() for a plane of 32-bit floats whose channels the file holds as 32-bit words of floats.
int store_floats(const PlaneChannelList& plane, int y, Image& image) {
  const size_t count = plane.channels.size(), pixel = file_pixel(plane, 0, y), width = size_t(image.width);
  uint8_t* const row = image.texel(0, y);
  size_t first = width;
  for (size_t c = 0; c < count; ++c) {
    const uint32_t* const words = &plane.channels[c]->words[pixel];
    for (size_t x = 0; x < width; ++x) {
      std::memcpy(row + (x * count + c) * sizeof(uint32_t), words + x, sizeof(uint32_t));
      if (std::isnan(std::bit_cast<float>(words[x]))) first = std::min(first, x);
    }
  }
  return first < width ? int(first) : -1;
}

/// Whether each channel of the file is of floats.
bool holds_floats(const PlaneChannelList& plane) {
  return std::all_of(plane.channels.begin(), plane.channels.end(),
                     [](const Channel* c) { return c->kind == ChannelKind::floating; });
}

/// Writes row y of the plane into the image. Returns the first x whose value is NaN, -1 where there is none.
int store_row(const PlaneChannelList& plane, int y, Image& image) {
  const FormatInfo layout = info(image.format);
  if (layout.number_class == NumberClass::floating && layout.bytes_per_channel == 4 && holds_floats(plane))
    return store_floats(plane, y, image);
  const bool keeps_codes = layout.number_class != NumberClass::floating, halves = layout.small_float();
  int first = -1;
  for (int c = 0; c < layout.channels; ++c) {
    const Channel* const channel = size_t(c) < plane.channels.size() ? plane.channels[size_t(c)] : nullptr;
    for (int x = 0; x < image.width; ++x) {
      if (channel == nullptr) {
        image.set_code(layout, x, y, c, layout.largest_code(c));
        continue;
      }
      const size_t pixel = file_pixel(plane, x, y);
      if (keeps_codes) {
        image.set_code(layout, x, y, c, channel->words[pixel]);
        continue;
      }
      const auto value = float(channel->value(pixel));
      if (std::isnan(value) && (first < 0 || x < first)) first = x;
      image.set_code(layout, x, y, c,
                     halves ? half_from_float(value, HalfRound::toward_zero) : std::bit_cast<uint32_t>(value));
    }
  }
  return first;
}

}  // namespace

Image stored_plane_image(const PlaneChannelList& plane) {
  const std::string& name = plane.mapped.plane;
  const Channel& first = *plane.channels[0];
  if (first.kind == ChannelKind::integer && !is_one_number(name))
    throw Error(ErrorKind::bad_input, plane.file->path, name + " is stored as integers",
                "save it as floats, or as codes of 8 or 16 bits");
  Image image(plane.file->width, plane.file->height, format_of_channels(plane));
  std::vector<int> nan_at(size_t(image.height), -1);  // the first x of each row that is not a number
  parallel_for(image.height, 0, [&](int y) { nan_at[size_t(y)] = store_row(plane, y, image); });
  for (int y = 0; y < image.height && name != "color"; ++y)
    if (nan_at[size_t(y)] >= 0)
      throw bad_plane(plane, nan_at[size_t(y)], y, "is not a number",
                      "find what the shader divides by, or capture another frame");
  return image;
}

}  // namespace trueshade
