// What files carry beside their pixels, and what is read of PNGs that other programs made. The others are made, and
// ours are read, by OpenImageIO.
#include <OpenImageIO/imageio.h>

#include <algorithm>

#include "core/error.h"
#include "core/image_files/image_io.h"
#include "tests/catch.hpp"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

TEST_CASE("threads change no byte of a file") {
  const ScratchFolder folder;
  Image color(301, 211, Format::rgba16f);
  for (size_t i = 0; i < color.texels.size(); ++i) color.texels[i] = uint8_t(i * i >> 7 & 0x3B);
  const std::vector<NamedImage> planes = {{"depth", Image(301, 211, Format::d32f)},
                                          {"light.count", Image(301, 211, Format::r32ui)}};
  for (const char* name : {"x.png", "x.exr"}) {
    std::vector<std::string> files;
    for (const int threads : {1, 2, 7, 0}) {
      ImageFileOptions options;
      options.threads = threads;
      write_image(folder.path(name), color, planes, {{"trueshade:scene", "x"}}, options);
      files.push_back(contents(folder.path(name)));
    }
    CHECK((files[1] == files[0] && files[2] == files[0] && files[3] == files[0]));
  }
}

TEST_CASE("metadata of any length and script comes back, and names that a format cannot hold are refused") {
  const ScratchFolder folder;
  const Image image(64, 37, Format::rgba8);
  const Metadata metadata = {{"trueshade:a_name_of_more_than_31_letters", "b\xc3\xa4r \"x\"\n{}"},
                             {"trueshade:plain", std::string(5000, 'x')}};
  for (const char* name : {"x.png", "x.exr"}) {
    INFO(name);
    write_image(folder.path(name), image, {}, metadata);
    const Metadata read = read_image_info(folder.path(name)).metadata;
    const auto file = OIIO::ImageInput::open(folder.path(name));
    REQUIRE(file);
    for (const auto& entry : metadata) {
      CHECK(std::count(read.begin(), read.end(), entry) == 1);
      CHECK(file->spec().get_string_attribute(entry.first) == entry.second);
    }
    const auto kind_of = [&](const std::string& key) {
      try {
        write_image(folder.path(name), image, {}, {{key, "x"}});
      } catch (const Error& error) {
        return int(error.kind());
      }
      return 0;
    };
    CHECK(kind_of(std::string(79, 'k')) == 0);
    CHECK(kind_of(std::string(256, 'k')) == 2);
    CHECK(kind_of("") == 2);
  }
}

/// A PNG made by another program: codes 0, 1, 2... of `channels` channels.
template <typename Code>
void write_foreign(const std::string& path, int channels, OIIO::TypeDesc type) {
  OIIO::ImageSpec spec(13, 7, channels, type);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.attribute("oiio:ColorSpace", "GammaCorrected2.2");
  std::vector<Code> codes(size_t(13 * 7 * channels));
  for (size_t i = 0; i < codes.size(); ++i) codes[i] = Code(i * 257);
  const auto file = OIIO::ImageOutput::create("png");
  REQUIRE(file->open(path, spec));
  REQUIRE(file->write_image(type, codes.data()));
  REQUIRE(file->close());
}

/// Checks that each code comes back, grey in R, G and B, and that alpha is the largest code where there is none.
template <typename Code>
void check_foreign(const std::string& path, int channels, Format format) {
  const std::vector<NamedImage> planes = read_planes(path);
  REQUIRE(planes.size() == 1);
  const Image& image = planes[0].image;
  REQUIRE(image.format == format);
  for (int pixel = 0; pixel < 13 * 7; ++pixel)
    for (int c = 0; c < 4; ++c) {
      const bool grey = channels < 3, alpha = channels % 2 == 0;
      const int from = c == 3 ? channels - 1 : grey ? 0 : c;
      const uint32_t expected = c == 3 && !alpha ? uint32_t(Code(~Code(0))) : Code((pixel * channels + from) * 257);
      REQUIRE(image.code(pixel % 13, pixel / 13, c) == expected);
    }
}

TEST_CASE("PNGs of grey, RGB and alpha, of 8 and 16 bits, are read code by code whatever their gamma is") {
  const ScratchFolder folder;
  const std::string path = folder.path("foreign.png");
  for (int channels = 1; channels <= 4; ++channels) {
    INFO(channels << " channels");
    write_foreign<uint8_t>(path, channels, OIIO::TypeDesc::UINT8);
    check_foreign<uint8_t>(path, channels, Format::rgba8);
    write_foreign<uint16_t>(path, channels, OIIO::TypeDesc::UINT16);
    check_foreign<uint16_t>(path, channels, Format::rgba16);
    CHECK(read_image_info(path).channels.size() == size_t(channels));
  }
}

}  // namespace
}  // namespace trueshade
