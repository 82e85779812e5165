// The reading of EXR files, by OpenImageIO.
#include "core/image_files/exr_planes.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <future>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "core/error.h"
#include "core/half.h"
#include "core/image_files/exr_channels.h"
#include "core/image_files/guarded.h"
#include "core/image_files/size_limits.h"

namespace trueshade {
namespace {

constexpr int kRowsAtOnce = 64;  // a multiple of the rows an EXR compresses together

/// An EXR opened for reading. OpenImageIO borrows the bytes.
class ExrFile {
 public:
  ExrFile(const std::string& path, std::span<const uint8_t> bytes)
      : path_(path),
        memory_(const_cast<uint8_t*>(bytes.data()), bytes.size()),
        file_(OIIO::ImageInput::create("openexr")) {
    if (!file_ || !file_->set_ioproxy(&memory_) || !file_->open(path, spec_)) throw failure();
  }

  const OIIO::ImageSpec& spec() const { return spec_; }
  bool has_more_parts() { return file_->seek_subimage(1, 0); }

  /// Goes on to the part of that number; false where there is none.
  bool seek(int part) {
    if (!file_->seek_subimage(part, 0)) return false;
    part_ = part;
    spec_ = file_->spec(part, 0);
    return true;
  }

  /// Rows [first, end) of the data window, all channels, each in its own type.
  void read(int first, int end, std::vector<uint8_t>& rows) {
    rows.resize(size_t(end - first) * size_t(spec_.width) * spec_.pixel_bytes(true));
    const int left = spec_.x, top = spec_.y;
    const bool done = spec_.tile_width == 0
                          ? file_->read_scanlines(part_, 0, top + first, top + end, 0, 0, spec_.nchannels,
                                                  OIIO::TypeDesc::UNKNOWN, rows.data())
                          : file_->read_tiles(part_, 0, left, left + spec_.width, top + first, top + end, 0, 1, 0,
                                              spec_.nchannels, OIIO::TypeDesc::UNKNOWN, rows.data());
    if (!done) throw failure();
  }

 private:
  /// What OpenImageIO says is wrong, in one line.
  Error failure() {
    std::string message = file_ ? file_->geterror() : "OpenImageIO has no reader for it";
    std::replace(message.begin(), message.end(), '\n', ' ');
    return bad_image(path_, message.empty() ? "OpenImageIO cannot read it" : message);
  }

  std::string path_;
  OIIO::Filesystem::IOMemReader memory_;
  std::unique_ptr<OIIO::ImageInput> file_;
  OIIO::ImageSpec spec_;
  int part_ = 0;
};

ImageFileInfo header_of(const std::string& path, std::span<const uint8_t> bytes) {
  const ExrFile file(path, bytes);
  const OIIO::ImageSpec& spec = file.spec();
  ImageFileInfo header{spec.width, spec.height, {}, {}};
  for (int channel = 0; channel < spec.nchannels; ++channel)
    header.channels.push_back(std::string(spec.channel_name(channel)) + " " + spec.channelformat(channel).c_str());
  for (const OIIO::ParamValue& entry : spec.extra_attribs)
    header.metadata.emplace_back(entry.name().string(), entry.get_string());
  return header;
}

/// Refuses what is too large, deep, or not all of a picture.
void check_window(const std::string& path, const OIIO::ImageSpec& spec) {
  check_size(path, spec.width, spec.height);
  if (spec.deep || spec.depth != 1) throw bad_image(path, "it is a deep image", "store one sample a pixel");
  if (spec.x != 0 || spec.y != 0 || spec.full_x != 0 || spec.full_y != 0 || spec.full_width != spec.width ||
      spec.full_height != spec.height)
    throw bad_image(path, "its data window is not its display window", "store all pixels, from 0, 0 on");
}

/// A plane to be filled from channels of a file.
struct PlaneSource {
  std::string name;
  Image image;
  std::vector<size_t> offsets;  ///< of each component in a pixel of the file, bytes
  bool widened = false;         ///< half in the file, float in the image: there is no format of so few halves
};

int channel_index(const OIIO::ImageSpec& spec, const std::string& name) {
  const auto found = std::find(spec.channelnames.begin(), spec.channelnames.end(), name);
  return found == spec.channelnames.end() ? -1 : int(found - spec.channelnames.begin());
}

/// Components of a plane in a file: how many there must be, and how many there may be.
struct PlaneLayout {
  std::string_view name;
  int least, most;
};
constexpr PlaneLayout kPlanes[] = {{"color", 3, 4},     {"depth", 1, 1},       {"position", 3, 3},   {"normal", 3, 3},
                                   {"albedo", 3, 4},    {"specular", 3, 4},    {"emission", 3, 4},   {"uv", 2, 2},
                                   {"id.object", 1, 1}, {"id.material", 1, 1}, {"light.count", 1, 1}};

Format format_of(const std::string& path, const std::string& channel, OIIO::TypeDesc type, int components,
                 bool& widened) {
  if (type == OIIO::TypeDesc::UINT32 && components == 1) return Format::r32ui;
  constexpr Format kFloats[] = {Format::d32f, Format::rg32f, Format::rgb32f, Format::rgba32f};
  if (type == OIIO::TypeDesc::HALF && components >= 3) return components == 3 ? Format::rgb16f : Format::rgba16f;
  widened = type == OIIO::TypeDesc::HALF;
  if (widened || type == OIIO::TypeDesc::FLOAT) return kFloats[components - 1];
  throw bad_image(path, "channel " + channel + " is " + type.c_str(), "store it as float or half, identifiers as uint");
}

/// The plane of that layout, if the file has it.
std::optional<PlaneSource> plane_in(const std::string& path, const OIIO::ImageSpec& spec, const PlaneLayout& layout) {
  const std::vector<std::string> names = exr_channels_of(layout.name, layout.most);
  std::vector<int> indices;
  for (const std::string& name : names) indices.push_back(channel_index(spec, name));
  if (std::all_of(indices.begin(), indices.end(), [](int index) { return index < 0; })) return std::nullopt;
  if (indices.back() < 0 && layout.least < layout.most) indices.pop_back();
  PlaneSource plane{std::string(layout.name), {}, {}, false};
  for (size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] < 0) throw bad_image(path, "channel " + names[i] + " is missing", "write all of " + plane.name);
    if (spec.channelformat(indices[i]) != spec.channelformat(indices[0]))
      throw bad_image(path, "channels " + names[0] + " and " + names[i] + " have two types", "store a plane in one");
    plane.offsets.push_back(spec.pixel_bytes(0, indices[i], true));
  }
  plane.image.format = format_of(path, names[0], spec.channelformat(indices[0]), int(indices.size()), plane.widened);
  plane.image.width = spec.width, plane.image.height = spec.height;
  return plane;
}

/// Appends rows of the file to a plane: memory grows with what was really decoded, not with what a header claims.
void append_rows(const std::vector<uint8_t>& rows, size_t pixel_bytes, PlaneSource& plane) {
  const auto bytes = size_t(info(plane.image.format).bytes_per_channel);
  std::vector<uint8_t>& texels = plane.image.texels;
  for (size_t at = 0; at < rows.size(); at += pixel_bytes)
    for (const size_t offset : plane.offsets) {
      const uint8_t* value = rows.data() + at + offset;
      if (!plane.widened) {
        texels.insert(texels.end(), value, value + bytes);
        continue;
      }
      const float wide = float_from_half(uint16_t(value[0] | value[1] << 8));
      const auto* wide_bytes = reinterpret_cast<const uint8_t*>(&wide);
      texels.insert(texels.end(), wide_bytes, wide_bytes + sizeof wide);
    }
}

std::vector<NamedImage> planes_of(const std::string& path, std::span<const uint8_t> bytes) {
  ExrFile file(path, bytes);
  const OIIO::ImageSpec& spec = file.spec();
  if (spec.tile_width != 0) throw bad_image(path, "it is stored in tiles", "store scan lines");
  check_window(path, spec);
  std::vector<PlaneSource> planes;
  for (const PlaneLayout& layout : kPlanes)
    if (auto plane = plane_in(path, spec, layout)) planes.push_back(std::move(*plane));
  if (planes.empty())
    throw bad_image(path, "no channel has a name of ours", "name them R G B A, depth.Z, P.X, N.X, albedo.R, ...");
  std::vector<uint8_t> rows;
  for (int first = 0; first < spec.height; first += kRowsAtOnce) {
    file.read(first, std::min(first + kRowsAtOnce, spec.height), rows);
    for (PlaneSource& plane : planes) append_rows(rows, spec.pixel_bytes(true), plane);
  }
  if (file.has_more_parts()) throw bad_image(path, "it has several parts", "store one, with all channels");
  std::vector<NamedImage> result;
  for (PlaneSource& plane : planes) result.push_back({std::move(plane.name), std::move(plane.image)});
  return result;
}

Channel exr_channel_of(const std::string& path, const OIIO::ImageSpec& spec, int index) {
  Channel channel;
  channel.part = spec.get_string_attribute("oiio:subimagename");
  channel.name = spec.channel_name(index);
  const OIIO::TypeDesc type = spec.channelformat(index);
  if (type == OIIO::TypeDesc::UINT32) channel.kind = ChannelKind::integer;
  if (type == OIIO::TypeDesc::HALF) channel.bits = 16;
  if (type != OIIO::TypeDesc::UINT32 && type != OIIO::TypeDesc::HALF && type != OIIO::TypeDesc::FLOAT)
    throw bad_image(path, "channel " + channel.name + " is " + type.c_str(), "store it as float, half or uint");
  return channel;
}

/// Appends rows to every channel. Pixels are taken some at a time, so that they are at hand for all channels.
///   offsets: of each channel, bytes into a pixel
void append_words(const std::vector<uint8_t>& rows, size_t pixel_bytes, std::span<const size_t> offsets,
                  std::vector<Channel>& channels) {
  constexpr size_t kAtOnce = 512;
  const size_t pixels = rows.size() / pixel_bytes, before = channels.empty() ? 0 : channels[0].words.size();
  for (Channel& channel : channels) channel.words.resize(before + pixels);
  for (size_t first = 0; first < pixels; first += kAtOnce)
    for (size_t c = 0; c < channels.size(); ++c) {
      const bool is_half = channels[c].bits == 16;
      const uint8_t* value = rows.data() + first * pixel_bytes + offsets[c];
      uint32_t* word = channels[c].words.data() + before + first;
      for (size_t left = std::min(kAtOnce, pixels - first); left > 0; --left, value += pixel_bytes, ++word) {
        std::memcpy(word, value, is_half ? 2 : 4);
        if (is_half) *word = std::bit_cast<uint32_t>(float_from_half(uint16_t(*word)));
      }
    }
}

ChannelFile channels_of_part(const std::string& path, ExrFile& exr) {
  const OIIO::ImageSpec& spec = exr.spec();
  check_size(path, spec.width, spec.height);
  if (spec.deep || spec.depth != 1) throw bad_image(path, "it is a deep image", "store one sample a pixel");
  ChannelFile file{path, spec.width, spec.height, {}};
  if (spec.x != spec.full_x || spec.y != spec.full_y || spec.full_width != spec.width ||
      spec.full_height != spec.height)
    file.frame_width = spec.full_width, file.frame_height = spec.full_height, file.left = spec.x - spec.full_x,
    file.top = spec.y - spec.full_y;
  for (int c = 0; c < spec.nchannels; ++c) file.channels.push_back(exr_channel_of(path, spec, c));
  std::vector<size_t> offsets;
  for (int c = 0; c < spec.nchannels; ++c) offsets.push_back(spec.pixel_bytes(0, c, true));
  const int at_once = spec.tile_width == 0 ? kRowsAtOnce : spec.tile_height;
  std::vector<uint8_t> rows, next;
  exr.read(0, std::min(at_once, spec.height), rows);
  for (int end = at_once; !rows.empty(); end += at_once) {
    std::future<void> coming;  // read while the rows before are taken apart, or after it where no thread starts
    next.clear();
    if (end < spec.height) coming = std::async([&] { exr.read(end, std::min(end + at_once, spec.height), next); });
    append_words(rows, spec.pixel_bytes(true), offsets, file.channels);
    if (coming.valid()) coming.get();
    std::swap(rows, next);
  }
  return file;
}

std::vector<ChannelFile> channels_of_parts(const std::string& path, std::span<const uint8_t> bytes) {
  ExrFile exr(path, bytes);
  std::vector<ChannelFile> parts;
  for (int part = 0; part == 0 || exr.seek(part); ++part) parts.push_back(channels_of_part(path, exr));
  return parts;
}

}  // namespace

std::vector<ChannelFile> exr_part_channels(const std::string& path, std::span<const uint8_t> bytes) {
  return guarded(path, [&] { return channels_of_parts(path, bytes); });
}

ImageFileInfo exr_header(const std::string& path, std::span<const uint8_t> bytes) {
  return guarded(path, [&] { return header_of(path, bytes); });
}

std::vector<NamedImage> exr_planes(const std::string& path, std::span<const uint8_t> bytes) {
  return guarded(path, [&] { return planes_of(path, bytes); });
}

}  // namespace trueshade
