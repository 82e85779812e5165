#include "core/image.h"

#include <cstring>

#include "core/half.h"
#include "core/image_rows.h"
#include "core/sha256.h"
#include "tests/catch.hpp"

namespace trueshade {
namespace {

template <typename Word>
Image one_texel(Format format, Word word) {
  Image image(1, 1, format);
  for (int channel = 0; channel < info(format).channels; ++channel)
    std::memcpy(image.texel(0, 0) + channel * int(sizeof(Word)), &word, sizeof(Word));
  return image;
}

TEST_CASE("a texel's value is what its format says") {
  CHECK(one_texel<uint8_t>(Format::rgba8, 3).value(0, 0, 3) == double(3.0f / 255.0f));
  CHECK(one_texel<uint8_t>(Format::rgba8, 255).value(0, 0, 0) == 1.0);
  CHECK(one_texel<uint16_t>(Format::rgb16f, 0x7bff).value(0, 0, 2) == 65504.0);
  CHECK(one_texel<float>(Format::d32f, 0.1f).value(0, 0, 0) == double(0.1f));
  CHECK(one_texel<uint32_t>(Format::r32ui, 0xffffffff).value(0, 0, 0) == 4294967295.0);
}

TEST_CASE("packed texels are little-endian words with red in the lowest bits") {
  Image tens(1, 1, Format::rgb10_a2);
  const uint32_t word = 0x3FFu | 1u << 10 | 512u << 20 | 2u << 30;
  std::memcpy(tens.texels.data(), &word, 4);
  CHECK(tens.texels == std::vector<uint8_t>{0xFF, 0x07, 0x00, 0xA0});
  CHECK(tens.value(0, 0, 0) == 1.0);
  CHECK(tens.value(0, 0, 1) == double(1.0f / 1023.0f));
  CHECK(tens.code(0, 0, 2) == 512);
  CHECK(tens.value(0, 0, 3) == double(2.0f / 3.0f));
  Image floats(1, 1, Format::r11g11b10f);
  floats.set_code(0, 0, 0, 0x3C0);
  floats.set_code(0, 0, 1, 0x7BF);
  floats.set_code(0, 0, 2, 0x3DF);
  CHECK(floats.value(0, 0, 0) == 1.0);
  CHECK(floats.value(0, 0, 1) == 65024.0);
  CHECK(floats.value(0, 0, 2) == 64512.0);
  CHECK(floats.texels == std::vector<uint8_t>{0xC0, 0xFB, 0xFD, 0xF7});
}

TEST_CASE("16-bit codes, sRGB codes and fixed-point depths stand for their values") {
  CHECK(one_texel<uint16_t>(Format::rgba16, 1).value(0, 0, 3) == double(1.0f / 65535.0f));
  CHECK(one_texel<uint16_t>(Format::rgba16, 65535).value(0, 0, 0) == 1.0);
  CHECK(one_texel<uint8_t>(Format::srgb8_a8, 188).value(0, 0, 1) == Approx(.502886458).epsilon(6e-8));
  CHECK(one_texel<uint8_t>(Format::srgb8_a8, 188).value(0, 0, 3) == double(188.0f / 255.0f));
  CHECK(one_texel<uint32_t>(Format::d24, 0x800000).value(0, 0, 0) == double(8388608.0f / 16777215.0f));
  CHECK(one_texel<uint16_t>(Format::d16, 0x8000).value(0, 0, 0) == double(32768.0f / 65535.0f));
}

TEST_CASE("a row's values are those of its texels one by one, in every format and of any number of channels") {
  uint32_t state = 1;
  for (const Format format : kFormats) {
    Image image(67, 3, format);
    for (uint8_t& byte : image.texels) byte = uint8_t((state = state * 1664525u + 1013904223u) >> 24);
    for (int channels = 1; channels <= info(format).channels && format != Format::r32ui; ++channels) {
      std::vector<float> row(size_t(image.width * channels));
      read_row(image, 1, channels, row.data());
      for (int x = 0; x < image.width; ++x)
        for (int c = 0; c < channels; ++c) {
          const auto expected = float(image.value(x, 1, c));
          const float found = row[size_t(channels * x + c)];
          INFO(info(format).name << " channel " << c << " of " << channels);
          REQUIRE((found == expected || (found != found && expected != expected)));
        }
    }
  }
  const Image counts = one_texel<uint32_t>(Format::r32ui, 0xfffffffe);
  uint32_t count = 0;
  read_row(counts, 0, &count);
  CHECK(count == 0xfffffffe);
}

TEST_CASE("an image is hashed as its bytes, rows from the top, without padding") {
  Image image(3, 2, Format::rgba8);
  for (size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = uint8_t(i);
  CHECK(image.texel(1, 1)[2] == 18);
  Sha256 hash;
  hash.update(image.texels.data(), 24);
  CHECK(image_hash(image) == hash.hex());
}

TEST_CASE("all NaNs hash alike, infinities and numbers do not") {
  const std::string quiet = image_hash(one_texel<uint32_t>(Format::rgba32f, 0x7fc00000));
  for (const uint32_t nan : {0x7f800001u, 0xffc00000u, 0xffffffffu, 0x7fc12345u})
    CHECK(image_hash(one_texel(Format::rgba32f, nan)) == quiet);
  CHECK(image_hash(one_texel<uint32_t>(Format::rgba32f, 0x7f800000)) != quiet);
  CHECK(image_hash(one_texel<uint32_t>(Format::r32ui, 0x7f800001)) !=
        image_hash(one_texel<uint32_t>(Format::r32ui, 0x7fc00000)));
  CHECK(image_hash(one_texel<uint16_t>(Format::rgba16f, 0xfc01)) ==
        image_hash(one_texel<uint16_t>(Format::rgba16f, 0x7e00)));
  CHECK(image_hash(one_texel<uint16_t>(Format::rgba16f, 0xfc00)) !=
        image_hash(one_texel<uint16_t>(Format::rgba16f, 0x7c00)));
}

TEST_CASE("NaNs of 11 and 10 bits hash alike too") {
  const auto word = [](uint32_t r, uint32_t g, uint32_t b) {
    Image image(1, 1, Format::r11g11b10f);
    const uint32_t bits = r | g << 11 | b << 22;
    std::memcpy(image.texels.data(), &bits, sizeof bits);
    return image_hash(image);
  };
  CHECK(word(0x7C1, 0x7FF, 0x3E1) == word(0x7E0, 0x7E0, 0x3F0));
  CHECK(word(0x7C0, 0x7E0, 0x3F0) != word(0x7E0, 0x7E0, 0x3F0));
  CHECK(word(1, 0x7C0, 0x3E0) != word(1, 0x7C0, 0x3F0));
}

TEST_CASE("a long image is hashed in chunks to the same digest as at once") {
  Image image(257, 311, Format::rgb32f);
  for (size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = uint8_t((i * 37) & 0x3f);  // no NaN among these
  Sha256 hash;
  hash.update(image.texels.data(), image.texels.size());
  CHECK(image_hash(image) == hash.hex());
}

}  // namespace
}  // namespace trueshade
