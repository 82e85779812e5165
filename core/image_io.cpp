#include "core/image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <memory>
#include <new>

#include "core/error.h"
#include "core/fp_env.h"
#include "core/png_header.h"
#include "core/srgb.h"

namespace trueshade {
namespace {

constexpr int kRowsAtOnce = 64;  // a multiple of the 16 rows an EXR compresses together
constexpr uint64_t kMaxFileBytes = uint64_t(4) << 30;

/// One channel of the file, and where its values come from.
struct FileChannel {
  std::string name;
  const Image* image;
  int channel;  ///< of image
};

OIIO::TypeDesc stored_type(const FileChannel& channel) {
  const FormatInfo layout = info(channel.image->format);
  if (layout.number_class == NumberClass::integer) return OIIO::TypeDesc::UINT32;
  return layout.bytes_per_channel == 2 ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT;
}

/// The channels of an EXR an AOV becomes. Where the fourth component is a constant, it is left out.
std::vector<std::string> channel_names(std::string_view aov, int channels) {
  const std::string name(aov);
  if (name == "depth") return {"depth.Z"};
  if (name == "position") return {"P.X", "P.Y", "P.Z"};
  if (name == "normal") return {"N.X", "N.Y", "N.Z"};
  if (name == "uv") return {"uv.X", "uv.Y"};
  if (channels == 1) return {name};
  std::vector<std::string> names;
  for (int channel = 0; channel < channels; ++channel) names.push_back(name + '.' + "RGBA"[channel]);
  return names;
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
    for (const std::string& name : channel_names(aov.name, info(aov.image.format).channels))
      channels.push_back({name, &aov.image, channel++});
  }
  return channels;
}

uint8_t unorm8(float value) {
  const float clamped = value > 0.0f ? std::min(value, 1.0f) : 0.0f;  // NaN gives 0
  return uint8_t(std::nearbyint(255.0f * clamped));
}

/// Rows [first, end) as a PNG holds them: unorm codes untouched, numbers sRGB-encoded, alpha linear.
void pack_png_rows(const Image& color, int first, int end, std::vector<uint8_t>& rows) {
  rows.clear();
  if (info(color.format).number_class == NumberClass::unorm) {
    rows.assign(color.texel(0, first), color.texel(0, first) + size_t(end - first) * color.row_bytes());
    return;
  }
  for (int y = first; y < end; ++y)
    for (int x = 0; x < color.width; ++x)
      for (int channel = 0; channel < info(color.format).channels; ++channel) {
        const auto value = float(color.value(x, y, channel));
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
        if (layout.number_class == NumberClass::unorm) {
          const auto value = float(source.image->value(x, y, source.channel));
          const auto* bytes = reinterpret_cast<const uint8_t*>(&value);
          rows.insert(rows.end(), bytes, bytes + sizeof value);
        } else {
          const uint8_t* bytes = source.image->texel(x, y) + source.channel * layout.bytes_per_channel;
          rows.insert(rows.end(), bytes, bytes + layout.bytes_per_channel);
        }
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
  OIIO::ImageSpec spec(color.width, color.height, layout.channels, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);  // or the writer would divide by alpha
  if (layout.number_class == NumberClass::floating) spec.attribute("oiio:ColorSpace", "sRGB");
  Encoder png(path, "png");
  png.open("memory.png", spec, metadata);
  std::vector<uint8_t> rows;
  for (int first = 0; first < color.height; first += kRowsAtOnce) {
    const int end = std::min(first + kRowsAtOnce, color.height);
    pack_png_rows(color, first, end, rows);
    png.write(first, end, OIIO::TypeDesc::UINT8, rows);
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

/// What `job` returns, with an exception of OpenImageIO's own made one of ours. Running out of memory stays that.
template <typename Job>
auto guarded(const std::string& path, Job job) {
  try {
    return job();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& failure) {
    throw Error(ErrorKind::io, path, std::string("OpenImageIO failed: ") + failure.what(), "check the file");
  }
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

bool starts_with(const std::vector<uint8_t>& bytes, std::string_view magic) {
  return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

ImageFileInfo exr_header(const std::string& path, const std::vector<uint8_t>& bytes) {
  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  const std::unique_ptr<OIIO::ImageInput> file = OIIO::ImageInput::create("openexr");
  OIIO::ImageSpec spec;
  if (!file || !file->set_ioproxy(&memory) || !file->open(path, spec)) {
    const std::string message = file ? file->geterror() : "OpenImageIO has no reader for it";
    throw Error(ErrorKind::bad_input, path, message, "write the file again");
  }
  ImageFileInfo header{spec.width, spec.height, {}, {}};
  for (int channel = 0; channel < spec.nchannels; ++channel)
    header.channels.push_back(std::string(spec.channel_name(channel)) + " " + spec.channelformat(channel).c_str());
  for (const OIIO::ParamValue& entry : spec.extra_attribs)
    header.metadata.emplace_back(entry.name().string(), entry.get_string());
  file->close();
  return header;
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

ImageFileInfo read_image_info(const std::string& path) {
  const std::vector<uint8_t> bytes = read_bytes(path);
  if (starts_with(bytes, "\x89PNG\r\n\x1a\n")) return png_header(path, bytes);
  if (starts_with(bytes, "\x76\x2f\x31\x01")) return guarded(path, [&] { return exr_header(path, bytes); });
  throw Error(ErrorKind::bad_input, path, "it is neither PNG nor EXR", "give one of these");
}

}  // namespace trueshade
