#include "core/image.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>

#include "core/fp_env.h"
#include "core/half.h"
#include "core/image_hash.h"
#include "core/image_rows.h"
#include "core/small_float.h"
#include "core/srgb.h"

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

/// The same for words of two 11-bit floats and a 10-bit one.
void make_packed_nans_one(uint8_t* bytes, size_t size) {
  for (size_t i = 0; i < size; i += sizeof(uint32_t)) {
    uint32_t word;
    std::memcpy(&word, bytes + i, sizeof word);
    for (const int first : {0, 11, 22}) {
      const uint32_t fraction = first == 22 ? 5 : 6, field = (32u << fraction) - 1, infinity = 31u << fraction;
      if (((word >> first) & field) > infinity)
        word = (word & ~(field << first)) | (infinity | 1u << (fraction - 1)) << first;
    }
    std::memcpy(bytes + i, &word, sizeof word);
  }
}

/// Where a channel of a packed word begins.
int first_bit(const FormatInfo& layout, int channel) {
  int first = 0;
  for (int c = 0; c < channel; ++c) first += layout.bits[size_t(c)];
  return first;
}

uint32_t mask_of(const FormatInfo& layout, int channel) {
  const int bits = layout.bits[size_t(channel)];
  return bits == 32 ? ~0u : (1u << bits) - 1;
}

}  // namespace

Image::Image(int w, int h, Format f) : width(w), height(h), format(f) {
  assert(w >= 0 && h >= 0);
  texels.resize(row_bytes() * size_t(h));
}

uint32_t Image::code(int x, int y, int channel) const { return code(info(format), x, y, channel); }

uint32_t Image::code(const FormatInfo& layout, int x, int y, int channel) const {
  assert(x >= 0 && x < width && y >= 0 && y < height && channel >= 0 && channel < layout.channels);
  uint32_t word = 0;
  if (layout.packed()) {
    std::memcpy(&word, texel(x, y), sizeof word);
    return (word >> first_bit(layout, channel)) & mask_of(layout, channel);
  }
  const size_t pixel = size_t(y) * size_t(width) + size_t(x), at = pixel * size_t(layout.channels) + size_t(channel);
  switch (layout.bytes_per_channel) {  // sizes that the compiler knows
    case 1:
      return texels[at];
    case 2:
      std::memcpy(&word, &texels[2 * at], 2);
      return word;
    default:
      std::memcpy(&word, &texels[4 * at], 4);
      return word;
  }
}

void Image::set_code(int x, int y, int channel, uint32_t bits) { set_code(info(format), x, y, channel, bits); }

void Image::set_code(const FormatInfo& layout, int x, int y, int channel, uint32_t bits) {
  assert(x >= 0 && x < width && y >= 0 && y < height && channel >= 0 && channel < layout.channels);
  assert((bits & ~mask_of(layout, channel)) == 0);
  if (!layout.packed()) {
    const size_t pixel = size_t(y) * size_t(width) + size_t(x), at = pixel * size_t(layout.channels) + size_t(channel);
    if (layout.bytes_per_channel == 1)
      texels[at] = uint8_t(bits);
    else if (layout.bytes_per_channel == 2)
      std::memcpy(&texels[2 * at], &bits, 2);
    else
      std::memcpy(&texels[4 * at], &bits, 4);
    return;
  }
  uint32_t word;
  std::memcpy(&word, texel(x, y), sizeof word);
  const int first = first_bit(layout, channel);
  word = (word & ~(mask_of(layout, channel) << first)) | bits << first;
  std::memcpy(texel(x, y), &word, sizeof word);
}

double Image::value(int x, int y, int channel) const {
  const FpScope fp;
  return value_of_code(info(format), channel, code(x, y, channel));
}

double value_of_code(const FormatInfo& layout, int channel, uint32_t code) {
  if (layout.srgb_channel(channel)) return double(kLinearOfSrgb8[code]);
  if (layout.number_class == NumberClass::unorm) return double(float(code) / float(layout.largest_code(channel)));
  if (layout.number_class == NumberClass::integer) return double(code);
  switch (const int size = layout.bits[size_t(channel)]) {
    case 32:
      return double(std::bit_cast<float>(code));
    case 16:
      return double(float_from_half(uint16_t(code)));
    default:
      return double(float_from_unsigned(code, size));
  }
}

void ImageHash::add(Format format, std::span<const uint8_t> texels) {
  const FpScope fp;
  const FormatInfo layout = info(format);
  if (layout.number_class != NumberClass::floating) return hash_.update(texels.data(), texels.size());
  std::vector<uint8_t> chunk;
  for (size_t done = 0; done < texels.size(); done += chunk.size()) {
    const size_t size = std::min(kChunkBytes, texels.size() - done);
    chunk.assign(texels.data() + done, texels.data() + done + size);
    if (layout.packed())
      make_packed_nans_one(chunk.data(), size);
    else if (layout.bytes_per_channel == 2)
      make_nans_one<uint16_t>(chunk.data(), size, 0x7c00, 0x7e00);
    else
      make_nans_one<uint32_t>(chunk.data(), size, 0x7f800000, 0x7fc00000);
    hash_.update(chunk.data(), size);
  }
}

std::string ImageHash::hex() { return hash_.hex(); }

std::string image_hash(const Image& image) {
  ImageHash hash;
  hash.add(image);
  return hash.hex();
}

}  // namespace trueshade
