// Reads images of others strictly, from memory, with the reader that their first bytes name.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <span>

#include "core/error.h"
#include "core/fp_env.h"
#include "core/image_files/channel_file.h"
#include "core/image_files/exr_layout.h"
#include "core/image_files/exr_planes.h"
#include "core/image_files/image_io.h"
#include "core/image_files/jpeg_pixels.h"
#include "core/image_files/png_header.h"
#include "core/image_files/png_pixels.h"
#include "core/image_files/size_limits.h"
#include "core/memory_cap.h"
#include "core/picture_kind.h"

namespace trueshade {
namespace {

constexpr uint64_t kMaxFileBytes = uint64_t(4) << 30;

std::vector<uint8_t> read_bytes(const std::string& path) {
  const auto fail = [&path](const char* step) -> Error {
    return {ErrorKind::io, path, std::string("cannot ") + step + ": " + std::strerror(errno), "check the name"};
  };
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // a pipe must not make us wait
  if (descriptor < 0) throw fail("open it");
  const std::unique_ptr<const int, void (*)(const int*)> closer(&descriptor, [](const int* file) { close(*file); });
  struct stat status {};
  if (fstat(descriptor, &status) != 0) throw fail("read it");
  if (!S_ISREG(status.st_mode))
    throw Error(ErrorKind::bad_input, path, "this is no regular file", "name an image file");
  if (uint64_t(status.st_size) > kMaxFileBytes)
    throw Error(ErrorKind::limit, path, "the file is over 4 GiB", "give a smaller one");
  require_memory(uint64_t(status.st_size), path, "the file");
  std::vector<uint8_t> bytes(size_t(status.st_size));
  for (size_t done = 0; done < bytes.size();) {
    const ssize_t got = read(descriptor, bytes.data() + done, bytes.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw fail("read it");
    if (got == 0) throw Error(ErrorKind::io, path, "it shrank while being read", "try again");
    done += size_t(got);
  }
  return bytes;
}

/// Before pixels are decoded: `texel_bytes` is what a pixel takes then, and `copies` how often it is held at once.
void check_decoded(const std::string& where, int width, int height, uint64_t texel_bytes, uint64_t copies,
                   std::span<const uint8_t> encoded, uint64_t most_expansion) {
  check_size(where, width, height, texel_bytes);
  const uint64_t decoded = uint64_t(width) * uint64_t(height) * texel_bytes;
  if (is_expanded(decoded, encoded.size(), most_expansion))
    throw Error(ErrorKind::limit, where,
                std::to_string(encoded.size()) + " bytes hold a picture of " + std::to_string(decoded) +
                    ", over --max-expansion " + std::to_string(most_expansion),
                "a smaller picture, or a higher --max-expansion");
  require_memory(copies * decoded, where, "the picture");
}

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
  check_size(where, width, height, texel_bytes);
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

ChannelFile png_channels(const std::string& path, std::span<const uint8_t> bytes, uint64_t most_expansion) {
  const ImageFileInfo header = png_header(path, bytes);
  check_decoded(path, header.width, header.height, texel_bytes_of(header), 3, bytes, most_expansion);
  const Image image = png_pixels(path, bytes);
  ChannelFile file{path, image.width, image.height, {}};
  for (const std::string& name : header.channels) {
    const size_t c = std::string_view("RGBA").find(name[0]);
    Channel channel;
    channel.name = name.substr(0, 1);
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

ChannelFile checked_parts(const std::string& path, std::span<const uint8_t> bytes, uint64_t most_expansion) {
  uint64_t texel_bytes = 0;
  const std::vector<ExrLayout> parts = exr_part_layouts(path, bytes);
  for (const ExrLayout& part : parts) {
    if (part.width != parts[0].width || part.height != parts[0].height)
      throw bad_image(path, "its parts have two sizes", "store parts of one size");
    texel_bytes += part.pixel_bytes;
  }
  check_decoded(path, parts[0].width, parts[0].height, texel_bytes, 3, bytes, most_expansion);
  require_memory(kOpenImageIo, path, "the library that reads the picture");
  return exr_part_channels(path, bytes);
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
  const std::string_view kind = picture_kind(bytes);
  if (kind == "PNG") return png_channels(path, bytes, most_expansion);
  if (kind == "OpenEXR") return checked_parts(path, bytes, most_expansion);
  if (kind == "DDS") return dds_channels(path, bytes);
  if (kind == "TIFF") return tiff_channels(path, bytes);
  if (std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()).starts_with("\x93NUMPY"))
    return npy_channels(path, bytes);
  const bool lossy = kind == "JPEG" || kind == "Radiance HDR";
  throw bad_image(path,
                  kind.empty() ? "it is neither EXR, DDS, TIFF, PNG nor .npy"
                               : "it is " + std::string(kind) + (lossy ? ", which does not keep a plane's values" : ""),
                  "save it as EXR, DDS, TIFF, PNG or .npy");
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
