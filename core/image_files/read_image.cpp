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
#include "core/image_files/exr_planes.h"
#include "core/image_files/image_io.h"
#include "core/image_files/jpeg_pixels.h"
#include "core/image_files/png_header.h"
#include "core/image_files/png_pixels.h"
#include "core/image_files/size_limits.h"

namespace trueshade {
namespace {

constexpr uint64_t kMaxFileBytes = uint64_t(4) << 30;
constexpr std::string_view kPng = "\x89PNG\r\n\x1a\n", kExr = "\x76\x2f\x31\x01", kJpeg = "\xff\xd8\xff";

std::vector<uint8_t> read_bytes(const std::string& path) {
  const auto fail = [&path](const char* step) -> Error {
    return {ErrorKind::io, path, std::string("cannot ") + step + ": " + std::strerror(errno), "check the name"};
  };
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // a pipe must not make us wait
  if (descriptor < 0) throw fail("open it");
  const std::unique_ptr<const int, void (*)(const int*)> closer(&descriptor, [](const int* file) { close(*file); });
  struct stat status {};
  if (fstat(descriptor, &status) != 0) throw fail("read it");
  if (!S_ISREG(status.st_mode)) throw Error(ErrorKind::io, path, "it is not a regular file", "name an image file");
  if (uint64_t(status.st_size) > kMaxFileBytes)
    throw Error(ErrorKind::limit, path, "the file is over 4 GiB", "give a smaller one");
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

bool starts_with(std::span<const uint8_t> bytes, std::string_view magic) {
  return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

std::vector<NamedImage> png_planes(const std::string& path, std::span<const uint8_t> bytes) {
  const ImageFileInfo header = png_header(path, bytes);
  check_size(path, header.width, header.height, 8);
  std::vector<NamedImage> planes;
  planes.push_back({"color", png_pixels(path, bytes, PngDepths::of_8_or_16)});
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
    throw Error(ErrorKind::limit, where, "with it the pictures are over the limit of decoded bytes", "smaller ones");
}

Image exr_color(const std::string& where, std::span<const uint8_t> content) {
  for (NamedImage& plane : exr_planes(where, content)) {
    if (plane.name != "color") continue;
    return info(plane.image.format).channels == 3 ? with_alpha(plane.image) : std::move(plane.image);
  }
  throw bad_image(where, "it has no colour", "name its channels R, G, B and A");
}

}  // namespace

ImageFileInfo read_image_info(const std::string& path) {
  const FpScope fp;
  const std::vector<uint8_t> bytes = read_bytes(path);
  if (starts_with(bytes, kPng)) return png_header(path, bytes);
  if (starts_with(bytes, kExr)) return exr_header(path, bytes);
  throw Error(ErrorKind::bad_input, path, "it is neither PNG nor EXR", "give one of these");
}

Image decode_image(std::span<const uint8_t> content, const std::string& where, uint64_t most_bytes) {
  const FpScope ieee;
  if (starts_with(content, kPng)) {
    const ImageFileInfo header = png_header(where, content);
    check_budget(where, header.width, header.height, 4, most_bytes);
    return png_pixels(where, content, PngDepths::of_8);
  }
  if (starts_with(content, kJpeg)) {
    const JpegSize size = jpeg_size(where, content);
    check_budget(where, size.width, size.height, 4, most_bytes);
    return jpeg_pixels(where, content);
  }
  if (!starts_with(content, kExr)) throw bad_image(where, "it is neither PNG, JPEG nor EXR", "give one of these");
  const ImageFileInfo header = exr_header(where, content);
  check_budget(where, header.width, header.height, 16, most_bytes);
  return exr_color(where, content);
}

std::vector<NamedImage> read_planes(const std::string& path) {
  const FpScope ieee;
  const std::vector<uint8_t> bytes = read_bytes(path);
  if (starts_with(bytes, kPng)) return png_planes(path, bytes);
  if (starts_with(bytes, kExr)) return exr_planes(path, bytes);
  throw bad_image(path, "it is neither PNG nor EXR", "give one of these");
}

}  // namespace trueshade
