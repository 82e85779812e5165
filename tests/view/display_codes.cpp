#include "view/display_codes.h"

#include <cstdlib>

#include "core/half.h"
#include "tests/catch.hpp"

namespace trueshade::viewer {
namespace {

/// The codes of R, G and B that a PNG of a picture holds, read back by its reader; of 16 bits the nearest of 8.
std::vector<uint32_t> words_of_png(const Image& image, PictureValues values, const DisplayTransform& display) {
  ImageFileOptions options;
  options.values = values;
  options.display = display;
  const Image png = decode_image(encode_png(image, {}, options), "test", 1 << 20);
  const bool wide = png.format == Format::rgba16;
  std::vector<uint32_t> words;
  for (int y = 0; y < png.height; ++y)
    for (int x = 0; x < png.width; ++x) {
      uint32_t word = 0;
      for (int c = 0; c < 3; ++c) {
        const uint32_t code = png.code(x, y, c);
        word = word << 8 | (wide ? (code * 255 + 32767) / 65535 : code);
      }
      words.push_back(word);
    }
  return words;
}

/// A picture whose channels have every kind of bits: 37 x 29 texels of a linear congruence.
Image scrambled(Format format) {
  Image image(37, 29, format);
  uint32_t state = 12345;
  const FormatInfo layout = info(format);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < layout.channels; ++c) {
        state = state * 1664525u + 1013904223u;
        const int bits = layout.bits[size_t(c)];
        // Floats mostly between 0 and 2, as pictures are; all codes otherwise.
        const uint32_t code = layout.number_class == NumberClass::floating && bits == 32 ? 0x30000000u + (state >> 4)
                                                                                         : state >> (32 - bits);
        image.set_code(x, y, c,
                       c == 3 ? (layout.number_class == NumberClass::unorm ? layout.largest_code(3) : 0) : code);
      }
  return image;
}

/// All words of a picture, by rows.
std::vector<uint32_t> shown_words(const Image& image, PictureValues values, DisplayCodes& codes,
                                  const DisplayTransform& display = {}) {
  std::vector<uint32_t> converted, words(size_t(image.width) * size_t(image.height));
  codes.convert(image, values, display, converted);
  for (int y = 0; y < image.height; ++y)
    read_words(image, converted, 0, y, std::span(words).subspan(size_t(y * image.width), size_t(image.width)));
  return words;
}

TEST_CASE("A screen shows the codes that a PNG of the picture holds, for every target and kind of values") {
  DisplayCodes codes;  // keeps tables from one to the next
  for (const Format format : kTargetFormats) {
    for (const auto& [values, display] :
         {std::pair(PictureValues::of_target, DisplayTransform()),
          std::pair(PictureValues::display_codes, DisplayTransform()),
          std::pair(PictureValues::of_target, DisplayTransform{0.5, ToneCurve::filmic}),
          std::pair(PictureValues::of_target, DisplayTransform{2.5, ToneCurve::clip}),
          std::pair(PictureValues::display_codes, DisplayTransform{2.5, ToneCurve::clip})}) {
      const Image image = scrambled(format);
      const std::vector<uint32_t> words = shown_words(image, values, codes, display);
      INFO(info(format).name << (values == PictureValues::of_target ? "" : " of display codes") << ", "
                             << display.scale);
      const std::vector<uint32_t> expected = words_of_png(image, values, display);
      int differing = 0;
      for (size_t i = 0; i < words.size(); ++i)
        for (const int shift : {0, 8, 16})
          differing += std::abs(int(words[i] >> shift & 255) - int(expected[i] >> shift & 255)) >
                       (info(format).bits[0] > 8 && info(format).number_class == NumberClass::unorm ? 1 : 0);
      CHECK(differing == 0);
    }
  }
}

TEST_CASE("Words hold R above G above B") {
  Image image(1, 1, Format::rgba8);
  image.texels = {0x12, 0x34, 0x56, 0xff};
  DisplayCodes codes;
  CHECK(shown_words(image, PictureValues::of_target, codes) == std::vector<uint32_t>{0x123456});
}

TEST_CASE("A part of a row has the words that the whole row has there, for every target") {
  DisplayCodes codes;
  for (const Format format : kTargetFormats) {
    const Image image = scrambled(format);
    std::vector<uint32_t> converted;
    codes.convert(image, PictureValues::of_target, {}, converted);
    std::vector<uint32_t> row(size_t(image.width));
    read_words(image, converted, 0, 11, row);
    for (const size_t count : {1u, 15u, 16u, 17u, 32u}) {
      std::vector<uint32_t> part(count + 1, 0xdeadbeefu);
      read_words(image, converted, 4, 11, std::span(part).first(count));
      CHECK(std::equal(part.begin(), part.end() - 1, row.begin() + 4));
      CHECK(part.back() == 0xdeadbeefu);
    }
  }
}

}  // namespace
}  // namespace trueshade::viewer
