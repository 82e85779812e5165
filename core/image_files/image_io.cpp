#include "core/image_files/image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/error.h"
#include "core/image_files/exr_channels.h"
#include "core/fp_env.h"
#include "core/image_files/guarded.h"
#include "core/image_rows.h"
#include "core/srgb.h"

namespace trueshade {
namespace {

constexpr int kRowsAtOnce = 64;  // a multiple of the 16 rows an EXR compresses together

/// One channel of the file, and where its values come from.
struct FileChannel {
  std::string name;
  const Image* image;
  int channel;  ///< of image
};

OIIO::TypeDesc stored_type(const FileChannel& channel) {
  const FormatInfo layout = info(channel.image->format);
  if (layout.number_class == NumberClass::integer) return OIIO::TypeDesc::UINT32;
  return layout.small_float() ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT;  // a half holds 11 and 10 bits too
}

std::vector<FileChannel> exr_channels(const std::string& path, const Image& color, std::span<const NamedImage> aovs) {
  std::vector<FileChannel> channels;
  for (int channel = 0; channel < info(color.format).channels; ++channel)
    channels.push_back({std::string(1, "RGBA"[channel]), &color, channel});
  for (const NamedImage& aov : aovs) {
    if (aov.image.width != color.width || aov.image.height != color.height)
      throw Error(ErrorKind::usage, path, "plane " + aov.name + " has another size than the colour",
                  "give it the same");
    int channel = 0;
    for (const std::string& name : exr_channels_of(aov.name, info(aov.image.format).channels))
      channels.push_back({name, &aov.image, channel++});
  }
  return channels;
}

uint8_t unorm8(float value) {
  const float clamped = value > 0.0f ? std::min(value, 1.0f) : 0.0f;  // NaN gives 0
  return uint8_t(std::nearbyint(255.0f * clamped));
}

template <typename Number>
void append(std::vector<uint8_t>& rows, Number number) {
  const auto* bytes = reinterpret_cast<const uint8_t*>(&number);
  rows.insert(rows.end(), bytes, bytes + sizeof number);
}

/// A code of fewer bits than 16 as the nearest of 16 bits: the PNG specification's (12.4) linear equation.
uint16_t widened_code(uint32_t code, uint32_t largest) { return uint16_t((code * 65535u + largest / 2) / largest); }

bool is_deep(const FormatInfo& layout) { return layout.number_class == NumberClass::unorm && layout.bits[0] > 8; }

/// Rows [first, end) as a PNG holds them: unorm codes untouched where they are 8 or 16 bits, widened where they are 10;
/// numbers sRGB-encoded, alpha linear.
void pack_png_rows(const Image& color, int first, int end, std::vector<uint8_t>& rows) {
  rows.clear();
  const FormatInfo layout = info(color.format);
  if (layout.number_class == NumberClass::unorm && !layout.packed()) {
    rows.assign(color.texel(0, first), color.texel(0, first) + size_t(end - first) * color.row_bytes());
    return;
  }
  for (int y = first; y < end; ++y)
    for (int x = 0; x < color.width; ++x)
      for (int channel = 0; channel < layout.channels; ++channel) {
        if (is_deep(layout)) {
          append(rows, widened_code(color.code(x, y, channel), layout.largest_code(channel)));
          continue;
        }
        const auto value = float(value_of_code(layout, channel, color.code(x, y, channel)));
        rows.push_back(channel == 3 ? unorm8(value) : srgb8_from_linear(value));
      }
}

/// Rows [first, end) as an EXR holds them: pixel after pixel, each channel in its own type.
void pack_exr_rows(std::span<const FileChannel> channels, int first, int end, std::vector<uint8_t>& rows) {
  rows.clear();
  for (int y = first; y < end; ++y)
    for (int x = 0; x < channels[0].image->width; ++x)
      for (const FileChannel& source : channels) {
        const FormatInfo layout = info(source.image->format);
        const uint32_t code = source.image->code(x, y, source.channel);
        if (layout.number_class == NumberClass::unorm)
          append(rows, float(value_of_code(layout, source.channel, code)));
        else if (layout.small_float())
          append(rows, layout.packed() ? uint16_t(code << (15 - layout.bits[size_t(source.channel)])) : uint16_t(code));
        else
          append(rows, code);
      }
}

/// OpenImageIO writes the clock into files, and its writers return true after failures that only geterror() knows.
class Encoder {
 public:
  Encoder(const std::string& path, const char* plugin) : path_(path), file_(OIIO::ImageOutput::create(plugin)) {
    if (!file_)
      throw Error(ErrorKind::io, path, std::string("OpenImageIO has no writer for ") + plugin, "install its plugin");
  }

  void open(const char* name, OIIO::ImageSpec spec, const Metadata& metadata) {
    spec.attribute("DateTime", "1970:01:01 00:00:00");
    spec.attribute("Software", "trueshade");
    for (const auto& [key, value] : metadata) spec.attribute(key, value);
    check(file_->set_ioproxy(&memory_));
    check(file_->open(name, spec));
  }
  void write(int first, int end, OIIO::TypeDesc type, const std::vector<uint8_t>& rows) {
    check(file_->write_scanlines(first, end, 0, type, rows.data()));
  }
  std::vector<uint8_t> close() {
    check(file_->close());
    return std::move(memory_.buffer());
  }

 private:
  void check(bool ok) {
    const std::string message = file_->geterror();
    if (ok && message.empty()) return;
    throw Error(ErrorKind::io, path_, "OpenImageIO could not encode it: " + message, "try another file format");
  }

  std::string path_;
  OIIO::Filesystem::IOVecOutput memory_;  // outlives file_, which writes to it when destroyed
  std::unique_ptr<OIIO::ImageOutput> file_;
};

std::vector<uint8_t> png_bytes(const std::string& path, const Image& color, const Metadata& metadata) {
  const FormatInfo layout = info(color.format);
  const OIIO::TypeDesc type = is_deep(layout) ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8;
  OIIO::ImageSpec spec(color.width, color.height, layout.channels, type);
  spec.attribute("oiio:UnassociatedAlpha", 1);  // or the writer would divide by alpha
  if (layout.number_class == NumberClass::floating || layout.srgb) spec.attribute("oiio:ColorSpace", "sRGB");
  Encoder png(path, "png");
  png.open("memory.png", spec, metadata);
  std::vector<uint8_t> rows;
  for (int first = 0; first < color.height; first += kRowsAtOnce) {
    const int end = std::min(first + kRowsAtOnce, color.height);
    pack_png_rows(color, first, end, rows);
    png.write(first, end, type, rows);
  }
  return png.close();
}

std::vector<uint8_t> exr_bytes(const std::string& path, const Image& color, std::span<const NamedImage> aovs,
                               const Metadata& metadata) {
  const std::vector<FileChannel> channels = exr_channels(path, color, aovs);
  OIIO::ImageSpec spec(color.width, color.height, int(channels.size()), OIIO::TypeDesc::FLOAT);
  for (size_t i = 0; i < channels.size(); ++i) {
    spec.channelnames[i] = channels[i].name;
    spec.channelformats.push_back(stored_type(channels[i]));
  }
  spec.attribute("compression", "zip");
  Encoder exr(path, "openexr");
  exr.open("memory.exr", spec, metadata);
  std::vector<uint8_t> rows;
  for (int first = 0; first < color.height; first += kRowsAtOnce) {
    const int end = std::min(first + kRowsAtOnce, color.height);
    pack_exr_rows(channels, first, end, rows);
    exr.write(first, end, OIIO::TypeDesc::UNKNOWN, rows);
  }
  return exr.close();
}

}  // namespace

void write_image(const std::string& path, const Image& color, std::span<const NamedImage> aovs,
                 const Metadata& metadata) {
  const FpScope ieee;
  if (path.ends_with(".png")) {
    write_file(path, guarded(path, [&] { return png_bytes(path, color, metadata); }));
  } else if (path.ends_with(".exr")) {
    write_file(path, guarded(path, [&] { return exr_bytes(path, color, aovs, metadata); }));
  } else {
    throw Error(ErrorKind::usage, path, "no image format has this ending", "end the name in .png or .exr");
  }
}

std::vector<uint8_t> encode_png(const Image& color, const Metadata& metadata) {
  const FpScope ieee;
  return guarded("PNG", [&] { return png_bytes("PNG", color, metadata); });
}

}  // namespace trueshade
