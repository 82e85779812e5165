// Reads images of others: strictly, from memory, with the reader their first bytes name (never "whichever opens it").
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <optional>
#include <span>

#include "core/error.h"
#include "core/image_files/exr_channels.h"
#include "core/fp_env.h"
#include "core/image_files/guarded.h"
#include "core/half.h"
#include "core/image_files/image_io.h"
#include "core/image_files/jpeg_pixels.h"
#include "core/image_files/png_header.h"
#include "core/image_files/png_pixels.h"

namespace trueshade {
namespace {

constexpr uint64_t kMaxFileBytes = uint64_t(4) << 30;
constexpr uint64_t kMaxDecodedBytes = uint64_t(4) << 30;
constexpr int kMaxSide = 16384;
constexpr int kRowsAtOnce = 64;  // a multiple of the rows an EXR compresses together
constexpr std::string_view kPng = "\x89PNG\r\n\x1a\n", kExr = "\x76\x2f\x31\x01", kJpeg = "\xff\xd8\xff";

Error bad_image(const std::string& path, const std::string& reason,
                const std::string& remedy = "write the file again") {
  return {ErrorKind::bad_input, path, reason, remedy};
}

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

void check_size(const std::string& path, int width, int height, uint64_t texel_bytes) {
  if (width < 1 || height < 1) throw bad_image(path, "a side of it is 0");
  if (width > kMaxSide || height > kMaxSide || uint64_t(width) * uint64_t(height) * texel_bytes > kMaxDecodedBytes)
    throw Error(ErrorKind::limit, path, "it is over 16384 pixels a side or 4 GiB decoded", "give a part of it");
}

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

  /// Rows [first, end) of all channels, each in its own type.
  void read(int first, int end, std::vector<uint8_t>& rows) {
    rows.resize(size_t(end - first) * size_t(spec_.width) * spec_.pixel_bytes(true));
    if (!file_->read_scanlines(0, 0, first, end, 0, 0, spec_.nchannels, OIIO::TypeDesc::UNKNOWN, rows.data()))
      throw failure();
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
};

ImageFileInfo exr_header(const std::string& path, std::span<const uint8_t> bytes) {
  const ExrFile file(path, bytes);
  const OIIO::ImageSpec& spec = file.spec();
  ImageFileInfo header{spec.width, spec.height, {}, {}};
  for (int channel = 0; channel < spec.nchannels; ++channel)
    header.channels.push_back(std::string(spec.channel_name(channel)) + " " + spec.channelformat(channel).c_str());
  for (const OIIO::ParamValue& entry : spec.extra_attribs)
    header.metadata.emplace_back(entry.name().string(), entry.get_string());
  return header;
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

std::vector<NamedImage> exr_planes(const std::string& path, std::span<const uint8_t> bytes) {
  ExrFile file(path, bytes);
  const OIIO::ImageSpec& spec = file.spec();
  check_size(path, spec.width, spec.height, spec.pixel_bytes(true));
  if (spec.tile_width != 0) throw bad_image(path, "it is stored in tiles", "store scan lines");
  if (spec.deep || spec.depth != 1) throw bad_image(path, "it is a deep image", "store one sample a pixel");
  if (spec.x != 0 || spec.y != 0 || spec.full_x != 0 || spec.full_y != 0 || spec.full_width != spec.width ||
      spec.full_height != spec.height)
    throw bad_image(path, "its data window is not its display window", "store all pixels, from 0, 0 on");
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

std::vector<NamedImage> png_planes(const std::string& path, std::span<const uint8_t> bytes) {
  const ImageFileInfo header = png_header(path, bytes);
  check_size(path, header.width, header.height, 8);
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
  if (starts_with(bytes, kExr)) return guarded(path, [&] { return exr_header(path, bytes); });
  throw Error(ErrorKind::bad_input, path, "it is neither PNG nor EXR", "give one of these");
}

Image decode_image(std::span<const uint8_t> content, const std::string& where, uint64_t most_bytes) {
  const FpScope ieee;
  if (starts_with(content, kPng)) {
    const ImageFileInfo header = png_header(where, content);
    check_budget(where, header.width, header.height, 4, most_bytes);
    return png_pixels(where, content, PngKinds::any);
  }
  if (starts_with(content, kJpeg)) {
    const JpegSize size = jpeg_size(where, content);
    check_budget(where, size.width, size.height, 4, most_bytes);
    return guarded(where, [&] { return jpeg_pixels(where, content); });
  }
  if (!starts_with(content, kExr)) throw bad_image(where, "it is neither PNG, JPEG nor EXR", "give one of these");
  return guarded(where, [&] {
    const ImageFileInfo header = exr_header(where, content);
    check_budget(where, header.width, header.height, 16, most_bytes);
    return exr_color(where, content);
  });
}

std::vector<NamedImage> read_planes(const std::string& path) {
  const FpScope ieee;
  const std::vector<uint8_t> bytes = read_bytes(path);
  if (starts_with(bytes, kPng)) return png_planes(path, bytes);
  if (starts_with(bytes, kExr)) return guarded(path, [&] { return exr_planes(path, bytes); });
  throw bad_image(path, "it is neither PNG nor EXR", "give one of these");
}

}  // namespace trueshade
