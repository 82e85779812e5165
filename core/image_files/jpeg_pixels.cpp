#include "core/image_files/jpeg_pixels.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "core/error.h"
#include "core/image_files/guarded.h"
#include "core/image_files/size_limits.h"

namespace trueshade {
namespace {

Image decoded(const std::string& where, std::span<const uint8_t> bytes) {
  OIIO::Filesystem::IOMemReader memory(const_cast<uint8_t*>(bytes.data()), bytes.size());
  const auto file = OIIO::ImageInput::create("jpeg");
  OIIO::ImageSpec spec;
  const auto failure = [&] {
    std::string message = file ? file->geterror() : "OpenImageIO has no reader for it";
    std::replace(message.begin(), message.end(), '\n', ' ');
    return bad_image(where, message.empty() ? "OpenImageIO cannot read it" : message);
  };
  if (!file || !file->set_ioproxy(&memory) || !file->open(where, spec)) throw failure();
  const JpegSize size = jpeg_size(where, bytes);
  if (spec.width != size.width || spec.height != size.height || (spec.nchannels != 1 && spec.nchannels != 3))
    throw bad_image(where, "OpenImageIO reads another size than its header's");
  std::vector<uint8_t> texels(size_t(spec.width) * size_t(spec.height) * size_t(spec.nchannels));
  if (!file->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, texels.data()) || file->has_error())
    throw failure();
  Image image(spec.width, spec.height, Format::rgba8);
  const auto channels = size_t(spec.nchannels);
  for (size_t i = 0; i < image.texels.size() / 4; ++i) {
    for (size_t c = 0; c < 3; ++c) image.texels[4 * i + c] = texels[channels * i + (channels == 3 ? c : 0)];
    image.texels[4 * i + 3] = 255;
  }
  return image;
}

}  // namespace

Image jpeg_pixels(const std::string& where, std::span<const uint8_t> bytes) {
  return guarded(where, [&] { return decoded(where, bytes); });
}

}  // namespace trueshade
