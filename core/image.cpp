#include "core/image.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>

#include "core/half.h"
#include "core/sha256.h"

namespace trueshade {
namespace {

static_assert(std::endian::native == std::endian::little, "texels are little-endian, and are stored as they are");

constexpr size_t kChunkBytes = size_t(1) << 16;

template <typename Word>
void make_nans_one(uint8_t* bytes, size_t size, Word infinity, Word quiet_nan) {
  for (size_t i = 0; i < size; i += sizeof(Word)) {
    Word word;
    std::memcpy(&word, bytes + i, sizeof(Word));
    if (Word(word & Word(~(Word(1) << (8 * sizeof(Word) - 1)))) <= infinity) continue;
    std::memcpy(bytes + i, &quiet_nan, sizeof(Word));
  }
}

}  // namespace

Image::Image(int w, int h, Format f) : width(w), height(h), format(f) {
  assert(w >= 0 && h >= 0);
  texels.resize(row_bytes() * size_t(h));
}

double Image::value(int x, int y, int channel) const {
  const FormatInfo layout = info(format);
  assert(x >= 0 && x < width && y >= 0 && y < height && channel >= 0 && channel < layout.channels);
  const uint8_t* bytes = texel(x, y) + channel * layout.bytes_per_channel;
  if (layout.number_class == NumberClass::unorm) return double(float(*bytes) / 255.0f);
  if (layout.bytes_per_channel == 2) {
    uint16_t half;
    std::memcpy(&half, bytes, sizeof half);
    return double(float_from_half(half));
  }
  uint32_t word;
  std::memcpy(&word, bytes, sizeof word);
  return layout.number_class == NumberClass::integer ? double(word) : double(std::bit_cast<float>(word));
}

std::string image_hash(const Image& image) {
  const FormatInfo layout = info(image.format);
  Sha256 hash;
  if (layout.number_class != NumberClass::floating) {
    hash.update(image.texels.data(), image.texels.size());
    return hash.hex();
  }
  std::vector<uint8_t> chunk;
  for (size_t done = 0; done < image.texels.size(); done += chunk.size()) {
    const size_t size = std::min(kChunkBytes, image.texels.size() - done);
    chunk.assign(image.texels.data() + done, image.texels.data() + done + size);
    if (layout.bytes_per_channel == 2)
      make_nans_one<uint16_t>(chunk.data(), size, 0x7c00, 0x7e00);
    else
      make_nans_one<uint32_t>(chunk.data(), size, 0x7f800000, 0x7fc00000);
    hash.update(chunk.data(), size);
  }
  return hash.hex();
}

}  // namespace trueshade
