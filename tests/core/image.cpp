#include "core/image.h"

#include <cstring>

#include "core/half.h"
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

TEST_CASE("a long image is hashed in chunks to the same digest as at once") {
  Image image(257, 311, Format::rgb32f);
  for (size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = uint8_t((i * 37) & 0x3f);  // no NaN among these
  Sha256 hash;
  hash.update(image.texels.data(), image.texels.size());
  CHECK(image_hash(image) == hash.hex());
}

}  // namespace
}  // namespace trueshade
