// Reads images of others strictly, from memory, with the reader that their first bytes name.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <memory>
#include <optional>
#include <span>

#include "core/error.h"
#include "core/file_notes.h"
#include "core/fp_env.h"
#include "core/image_files/channel_file.h"
#include "core/image_files/exr_layout.h"
#include "core/image_files/exr_planes.h"
#include "core/image_files/image_io.h"
#include "core/image_files/jpeg_pixels.h"
#include "core/image_files/picture_file.h"
#include "core/image_files/png_header.h"
#include "core/image_files/png_pixels.h"
#include "core/image_files/size_limits.h"
#include "core/memory_cap.h"
#include "core/picture_kind.h"
#include "core/standard_input.h"

namespace trueshade {
namespace {

std::vector<uint8_t> read_bytes(const std::string& path) {
  if (path == kStandardInputName) return read_standard_input(UINT64_MAX, "");
  const auto fail = [&path](const char* step) -> Error {
    return {ErrorKind::io, path, std::string("cannot ") + step + ": " + std::strerror(errno), "check the name"};
  };
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // a pipe must not make us wait
  if (descriptor < 0) {
    const Error failure = fail("open it");
    note_read(path, kAbsent);
    throw failure;
  }
  const std::unique_ptr<const int, void (*)(const int*)> closer(&descriptor, [](const int* file) { close(*file); });
  struct stat status {};
  if (fstat(descriptor, &status) != 0) throw fail("read it");
  if (!S_ISREG(status.st_mode))
    throw Error(ErrorKind::bad_input, path, "this is no regular file", "name an image file");
  require_memory(uint64_t(status.st_size), path, "the file");
  std::vector<uint8_t> bytes(size_t(status.st_size));
  for (size_t done = 0; done < bytes.size();) {
    const ssize_t got = read(descriptor, bytes.data() + done, bytes.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw fail("read it");
    if (got == 0) throw Error(ErrorKind::io, path, "it shrank while being read", "try again");
    done += size_t(got);
  }
  note_read(path, bytes);
  return bytes;
}

/// Before pixels are decoded to so many bytes, which are held `copies` times at once.
void check_bytes(const std::string& where, uint64_t decoded, uint64_t copies, std::span<const uint8_t> encoded,
                 uint64_t most_expansion) {
  if (is_expanded(decoded, encoded.size(), most_expansion))
    throw Error(ErrorKind::limit, where,
                std::to_string(encoded.size()) + " bytes hold a picture of " + std::to_string(decoded) +
                    ", over --max-expansion " + std::to_string(most_expansion),
                "a smaller picture, or a higher --max-expansion");
  require_memory(copies * decoded, where, "the picture");
}

/// The same of a picture whose pixels take `texel_bytes` then.
void check_decoded(const std::string& where, int width, int height, uint64_t texel_bytes, uint64_t copies,
                   std::span<const uint8_t> encoded, uint64_t most_expansion) {
  check_size(where, width, height);
  check_bytes(where, uint64_t(width) * uint64_t(height) * texel_bytes, copies, encoded, most_expansion);
}

constexpr std::string_view kNumPy = "NumPy";

constexpr uint64_t kOpenImageIo = uint64_t(140) << 20;  ///< what loading it takes

/// exr_planes() of a file whose header is right, after it is known what that takes.
std::vector<NamedImage> checked_planes(const std::string& where, std::span<const uint8_t> bytes,
                                       uint64_t most_expansion) {
  const ExrLayout layout = exr_layout(where, bytes);
  check_decoded(where, layout.width, layout.height, layout.pixel_bytes, 2, bytes, most_expansion);
  require_memory(kOpenImageIo, where, "the library that reads the picture");
  return exr_planes(where, bytes);
}

/// What decoding a PNG makes of a texel.
uint64_t texel_bytes_of(const ImageFileInfo& png) { return png.channels[0].ends_with("uint16") ? 8 : 4; }

std::vector<NamedImage> png_planes(const std::string& path, std::span<const uint8_t> bytes, uint64_t most_expansion) {
  const ImageFileInfo header = png_header(path, bytes);
  check_decoded(path, header.width, header.height, texel_bytes_of(header), 1, bytes, most_expansion);
  std::vector<NamedImage> planes;
  planes.push_back({"color", png_pixels(path, bytes)});
  return planes;
}

/// Three channels with an alpha of 1 behind them.
Image with_alpha(const Image& rgb) {
  const bool half = rgb.format == Format::rgb16f;
  Image rgba(rgb.width, rgb.height, half ? Format::rgba16f : Format::rgba32f);
  const size_t from = size_t(info(rgb.format).bytes_per_texel()), to = size_t(info(rgba.format).bytes_per_texel());
  const uint16_t half_one = 0x3C00;
  const float one = 1.0f;
  for (size_t i = 0; i < size_t(rgb.width) * size_t(rgb.height); ++i) {
    std::memcpy(rgba.texels.data() + i * to, rgb.texels.data() + i * from, from);
    std::memcpy(rgba.texels.data() + i * to + from, half ? static_cast<const void*>(&half_one) : &one, to - from);
  }
  return rgba;
}

void check_budget(const std::string& where, int width, int height, uint64_t texel_bytes, uint64_t most_bytes) {
  check_texture_size(where, width, height, texel_bytes);
  if (uint64_t(width) * uint64_t(height) * texel_bytes > most_bytes)
    throw Error(ErrorKind::limit, where, "with it the pictures are over the limit of decoded bytes",
                "smaller ones, or a higher --max-texture-memory");
}

Error wrong_kind(const std::string& where, std::string_view kind, const std::string& readable) {
  return bad_image(where, kind.empty() ? "it is neither " + readable : "the picture is " + std::string(kind),
                   "give one that is " + (readable == "PNG nor EXR" ? std::string("PNG or EXR") : "PNG, JPEG or EXR"));
}

Image exr_color(const std::string& where, std::span<const uint8_t> content, uint64_t most_expansion) {
  for (NamedImage& plane : checked_planes(where, content, most_expansion)) {
    if (plane.name != "color") continue;
    return info(plane.image.format).channels == 3 ? with_alpha(plane.image) : std::move(plane.image);
  }
  throw bad_image(where, "it has no colour", "name its channels R, G, B and A");
}

/// The channels that a PNG stores, and how many of an image's four they are taken from.
std::string png_channel_names(const ImageFileInfo& header, bool has_transparency) {
  std::string names;
  for (const std::string& channel : header.channels) names += channel[0];
  if (names == "P") names = "RGB";
  return has_transparency ? names + 'A' : names;
}

ChannelFile png_channels(const std::string& path, std::span<const uint8_t> bytes, uint64_t most_expansion) {
  const ImageFileInfo header = png_header(path, bytes);
  check_decoded(path, header.width, header.height, texel_bytes_of(header), 3, bytes, most_expansion);
  const Image image = png_pixels(path, bytes);
  ChannelFile file{path, image.width, image.height, {}};
  for (const char name : png_channel_names(header, png_has_chunk(bytes, "tRNS"))) {
    const size_t c = name == 'Y' ? 0 : std::string_view("RGBA").find(name);  // grey is in all three
    Channel channel;
    channel.name = name;
    channel.kind = ChannelKind::unorm;
    channel.bits = info(image.format).bits[0];
    const size_t pixels = size_t(image.width) * size_t(image.height), bytes_each = size_t(channel.bits / 8);
    channel.words.resize(pixels);
    for (size_t i = 0; i < pixels; ++i)
      std::memcpy(&channel.words[i], image.texels.data() + (4 * i + c) * bytes_each, bytes_each);
    file.channels.push_back(std::move(channel));
  }
  return file;
}

ChannelFile jpeg_channels(const std::string& path, std::span<const uint8_t> bytes, uint64_t most_expansion) {
  const JpegSize size = jpeg_size(path, bytes);
  check_decoded(path, size.width, size.height, 4, 4, bytes, most_expansion);
  require_memory(kOpenImageIo, path, "the library that reads the picture");
  const Image image = jpeg_pixels(path, bytes);
  ChannelFile file{path, image.width, image.height, {}};
  for (size_t c = 0; c < 3; ++c) {
    Channel channel;
    channel.name = channel_name(c, 3);
    channel.kind = ChannelKind::unorm;
    channel.bits = 8;
    for (size_t i = 0; i < image.texels.size(); i += 4) channel.words.push_back(image.texels[i + c]);
    file.channels.push_back(std::move(channel));
  }
  return file;
}

std::vector<ChannelFile> checked_parts(const std::string& path, std::span<const uint8_t> bytes,
                                       uint64_t most_expansion) {
  uint64_t decoded = 0;
  for (const ExrLayout& part : exr_part_layouts(path, bytes)) {
    check_size(path, part.width, part.height);
    decoded += uint64_t(part.width) * uint64_t(part.height) * part.pixel_bytes;
  }
  check_bytes(path, decoded, 3, bytes, most_expansion);
  require_memory(kOpenImageIo, path, "the library that reads the picture");
  return exr_part_channels(path, bytes);
}

/// The channels of all parts, which are of one size, and whole.
ChannelFile parts_as_one(const std::string& path, std::vector<ChannelFile> parts) {
  ChannelFile file = std::move(parts.front());
  for (const ChannelFile& part : parts)
    if (part.is_window() || file.is_window())
      throw bad_image(path, "its data window is not its display window", "store all pixels, from 0, 0 on");
  for (ChannelFile& part : std::span(parts).subspan(1)) {
    if (part.width != file.width || part.height != file.height)
      throw bad_image(path, "its parts have two sizes", "store parts of one size");
    file.channels.insert(file.channels.end(), std::make_move_iterator(part.channels.begin()),
                         std::make_move_iterator(part.channels.end()));
  }
  return file;
}

/// What is the same for planes and for pictures. Nothing for the other kinds.
std::optional<ChannelFile> lossless_channels(const std::string& path, std::span<const uint8_t> bytes,
                                             std::string_view kind, uint64_t most_expansion) {
  if (kind == "PNG") return png_channels(path, bytes, most_expansion);
  if (kind == "DDS") return dds_channels(path, bytes);
  if (kind == "TIFF") return tiff_channels(path, bytes);
  if (kind == kNumPy) return npy_channels(path, bytes);
  return std::nullopt;
}

/// picture_kind(), or kNumPy.
std::string_view file_kind(std::span<const uint8_t> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return text.starts_with("\x93NUMPY") ? kNumPy : picture_kind(bytes);
}

/// Fills in what the colours stand for: what the file says, else sRGB of codes and linear light of all else.
void find_color_space(PictureFile& picture) {
  const std::vector<Channel>& channels = picture.parts.front().channels;
  const auto tag = std::find_if(picture.metadata.begin(), picture.metadata.end(),
                                [](const auto& entry) { return entry.first == "oiio:ColorSpace"; });
  if (tag != picture.metadata.end()) {
    picture.color_space =
        tag->second.starts_with("Lin") || tag->second.starts_with("lin") ? ColorSpace::linear : ColorSpace::srgb;
    picture.color_source = "it says " + tag->second;
  } else if (std::any_of(channels.begin(), channels.end(), [](const Channel& c) { return c.is_code(); })) {
    picture.color_space = ColorSpace::srgb;
    picture.color_source = "assumed of codes";
  } else {
    picture.color_source = "assumed of floats";
  }
}

}  // namespace

ImageFileInfo read_image_info(const std::string& path) {
  const FpScope fp;
  const std::vector<uint8_t> bytes = read_bytes(path);
  const std::string_view kind = picture_kind(bytes);
  if (kind == "PNG") return png_header(path, bytes);
  if (kind != "OpenEXR") throw wrong_kind(path, kind, "PNG nor EXR");
  exr_layout(path, bytes);
  require_memory(kOpenImageIo, path, "the library that reads the picture");
  return exr_header(path, bytes);
}

Image decode_image(std::span<const uint8_t> content, const std::string& where, uint64_t most_bytes,
                   uint64_t most_expansion) {
  const FpScope ieee;
  const std::string_view kind = picture_kind(content);
  if (kind == "PNG") {
    const ImageFileInfo header = png_header(where, content);
    check_budget(where, header.width, header.height, texel_bytes_of(header), most_bytes);
    check_decoded(where, header.width, header.height, texel_bytes_of(header), 1, content, most_expansion);
    return png_pixels(where, content);
  }
  if (kind == "JPEG") {
    const JpegSize size = jpeg_size(where, content);
    check_budget(where, size.width, size.height, 4, most_bytes);
    check_decoded(where, size.width, size.height, 4, 2, content, most_expansion);
    require_memory(kOpenImageIo, where, "the library that reads the picture");
    return jpeg_pixels(where, content);
  }
  if (kind != "OpenEXR") throw wrong_kind(where, kind, "PNG, JPEG nor EXR");
  const ExrLayout layout = exr_layout(where, content);
  check_budget(where, layout.width, layout.height, 16, most_bytes);
  return exr_color(where, content, most_expansion);
}

ChannelFile read_channel_file(const std::string& path, uint64_t most_expansion) {
  const FpScope ieee;
  const std::vector<uint8_t> bytes = read_bytes(path);
  const std::string_view kind = file_kind(bytes);
  if (kind == "OpenEXR") return parts_as_one(path, checked_parts(path, bytes, most_expansion));
  if (std::optional<ChannelFile> file = lossless_channels(path, bytes, kind, most_expansion)) return std::move(*file);
  const bool lossy = kind == "JPEG" || kind == "Radiance HDR";
  throw bad_image(path,
                  kind.empty() ? "it is neither EXR, DDS, TIFF, PNG nor .npy"
                               : "it is " + std::string(kind) + (lossy ? ", which does not keep a plane's values" : ""),
                  "save it as EXR, DDS, TIFF, PNG or .npy");
}

PictureFile read_any_picture(const std::string& path, uint64_t most_expansion) {
  const FpScope ieee;
  const std::vector<uint8_t> bytes = read_bytes(path);
  PictureFile picture;
  picture.path = path;
  picture.kind = file_kind(bytes);
  if (picture.kind == "OpenEXR") {
    picture.parts = checked_parts(path, bytes, most_expansion);
    picture.metadata = exr_header(path, bytes).metadata;
  } else if (picture.kind == "Radiance HDR") {
    picture.parts.push_back(hdr_channels(path, bytes, most_expansion));
  } else if (picture.kind == "JPEG") {
    picture.parts.push_back(jpeg_channels(path, bytes, most_expansion));
  } else if (auto file = lossless_channels(path, bytes, picture.kind, most_expansion)) {
    picture.parts.push_back(std::move(*file));
    if (picture.kind == "PNG") picture.metadata = png_header(path, bytes).metadata;
  } else {
    throw bad_image(path,
                    bytes.empty()          ? "the file is empty"
                    : picture.kind.empty() ? "it is no picture of a kind that is read"
                                           : "it is " + std::string(picture.kind) + ", which is not read",
                    "give EXR, PNG, TIFF, HDR, DDS, .npy or JPEG");
  }
  find_color_space(picture);
  return picture;
}

void check_png(const std::string& path, uint64_t most_expansion) {
  const std::vector<uint8_t> bytes = read_bytes(path);
  const ImageFileInfo header = png_header(path, bytes);
  check_bytes(path, uint64_t(header.width) * uint64_t(header.height) * texel_bytes_of(header), 0, bytes,
              most_expansion);
  check_png_pixels(path, bytes);
}

std::vector<NamedImage> read_planes(const std::string& path, uint64_t most_expansion) {
  const FpScope ieee;
  const std::vector<uint8_t> bytes = read_bytes(path);
  const std::string_view kind = picture_kind(bytes);
  if (kind == "PNG") return png_planes(path, bytes, most_expansion);
  if (kind == "OpenEXR") return checked_planes(path, bytes, most_expansion);
  throw wrong_kind(path, kind, "PNG nor EXR");
}

}  // namespace trueshade
