// Every kind of JPEG that is read: made and judged by libjpeg itself, which nothing of ours has called before.

// clang-format off: jpeglib.h needs what stands before it
#include <cstddef>
#include <cstdio>
#include <jpeglib.h>
// clang-format on
#include <cstdlib>

#include "core/error.h"
#include "core/image_files/image_io.h"
#include "tests/catch.hpp"

namespace trueshade {
namespace {

using Bytes = std::vector<uint8_t>;

struct JpegKind {
  const char* name;
  int components;
  J_COLOR_SPACE stored;
  int sampling;  ///< of the first component, both ways
  bool progressive, optimized;
  int restart_rows;
};

constexpr int kJpegWidth = 37, kJpegHeight = 21;

Bytes encoded(const JpegKind& kind) {
  jpeg_compress_struct encoder{};
  jpeg_error_mgr errors{};
  encoder.err = jpeg_std_error(&errors);
  jpeg_create_compress(&encoder);
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&encoder, &buffer, &size);
  encoder.image_width = kJpegWidth, encoder.image_height = kJpegHeight;
  encoder.input_components = kind.components;
  encoder.in_color_space = kind.components == 1 ? JCS_GRAYSCALE : kind.components == 3 ? JCS_RGB : JCS_CMYK;
  jpeg_set_defaults(&encoder);
  jpeg_set_colorspace(&encoder, kind.stored);
  jpeg_set_quality(&encoder, 90, TRUE);
  encoder.comp_info[0].h_samp_factor = encoder.comp_info[0].v_samp_factor = kind.sampling;
  encoder.optimize_coding = kind.optimized;
  encoder.restart_in_rows = kind.restart_rows;
  if (kind.progressive) jpeg_simple_progression(&encoder);
  jpeg_start_compress(&encoder, TRUE);
  Bytes row(size_t(kJpegWidth * kind.components));
  for (int y = 0; y < kJpegHeight; ++y) {
    for (size_t i = 0; i < row.size(); ++i) row[i] = uint8_t(int(i) * 5 + y * 11);
    JSAMPROW rows[] = {row.data()};
    jpeg_write_scanlines(&encoder, rows, 1);
  }
  jpeg_finish_compress(&encoder);
  Bytes bytes(buffer, buffer + size);
  jpeg_destroy_compress(&encoder);
  std::free(buffer);
  return bytes;
}

/// R, G, B of each pixel, by libjpeg's default decompression.
Bytes decoded_by_libjpeg(const Bytes& bytes) {
  jpeg_decompress_struct decoder{};
  jpeg_error_mgr errors{};
  decoder.err = jpeg_std_error(&errors);
  jpeg_create_decompress(&decoder);
  jpeg_mem_src(&decoder, bytes.data(), bytes.size());
  REQUIRE(jpeg_read_header(&decoder, TRUE) == JPEG_HEADER_OK);
  decoder.out_color_space = JCS_RGB;
  jpeg_start_decompress(&decoder);
  Bytes texels(size_t(kJpegWidth * kJpegHeight * 3));
  while (decoder.output_scanline < decoder.output_height) {
    JSAMPROW rows[] = {texels.data() + decoder.output_scanline * size_t(kJpegWidth * 3)};
    jpeg_read_scanlines(&decoder, rows, 1);
  }
  jpeg_finish_decompress(&decoder);
  jpeg_destroy_decompress(&decoder);
  return texels;
}

TEST_CASE("JPEG of every kind that is read are what libjpeg decodes, and those of four inks are refused by name") {
  const JpegKind kKinds[] = {{"grey", 1, JCS_GRAYSCALE, 1, false, false, 0},
                             {"grey, progressive", 1, JCS_GRAYSCALE, 1, true, true, 0},
                             {"YCbCr 4:4:4", 3, JCS_YCbCr, 1, false, false, 0},
                             {"YCbCr 4:2:0", 3, JCS_YCbCr, 2, false, true, 0},
                             {"YCbCr 4:2:0, progressive", 3, JCS_YCbCr, 2, true, true, 0},
                             {"YCbCr with restarts", 3, JCS_YCbCr, 2, false, false, 1},
                             {"RGB of Adobe", 3, JCS_RGB, 1, false, false, 0}};
  for (const JpegKind& kind : kKinds) {
    const Bytes bytes = encoded(kind), expected = decoded_by_libjpeg(bytes);
    const Image image = decode_image(bytes, "picture", 1 << 20);
    REQUIRE((image.width == kJpegWidth && image.height == kJpegHeight && image.format == Format::rgba8));
    size_t wrong = 0;
    for (size_t i = 0; i < size_t(kJpegWidth * kJpegHeight); ++i) {
      for (size_t c = 0; c < 3; ++c) wrong += image.texels[4 * i + c] != expected[3 * i + c];
      wrong += image.texels[4 * i + 3] != 255;
    }
    INFO(kind.name);
    CHECK(wrong == 0);
  }
  for (const J_COLOR_SPACE inks : {JCS_CMYK, JCS_YCCK}) try {
      decode_image(encoded({"inks", 4, inks, 1, false, false, 0}), "picture", 1 << 20);
      FAIL("four inks were read");
    } catch (const Error& error) {
      CHECK(std::string(error.what()).starts_with("picture: it is a JPEG of four inks, CMYK or YCCK"));
    }
}

TEST_CASE("pictures of other formats are refused by their names") {
  const std::pair<std::string, const char*> kKinds[] = {{"\xabKTX 20\xbb\r\n\x1a\n....", "KTX2"},
                                                        {"RIFF....WEBPVP8 ", "WebP"},
                                                        {"GIF89a..........", "GIF"},
                                                        {"BM..............", "BMP"},
                                                        {"DDS ............", "DDS"},
                                                        {"#?RADIANCE......", "Radiance HDR"},
                                                        {std::string("II*\0", 4) + "....", "TIFF"}};
  for (const auto& [bytes, name] : kKinds) try {
      decode_image({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, "picture", 1 << 20);
      FAIL("read as a picture");
    } catch (const Error& error) {
      CHECK(std::string(error.what()).starts_with("picture: the picture is " + std::string(name) + " ("));
    }
}

}  // namespace
}  // namespace trueshade
