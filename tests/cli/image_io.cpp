// Files are read back through OpenImageIO, which knows nothing of our Image.
#include "core/image_files/image_io.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "core/error.h"
#include "tests/catch.hpp"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

using OIIO::ImageInput;
using OIIO::TypeDesc;

Image gradient(int width, int height, Format format) {
  Image image(width, height, format);
  for (size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = uint8_t(i * 7 % 251);
  return image;
}

TEST_CASE("a PNG holds the codes of an rgba8 image untouched, whatever alpha is") {
  const ScratchFolder folder;
  const std::string path = folder.path("codes.png");
  const Image image = gradient(37, 131, Format::rgba8);
  write_image(path, image, {}, {{"trueshade:imageHash", image_hash(image)}});

  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  const auto file = ImageInput::open(path, &config);
  REQUIRE(file);
  std::vector<uint8_t> codes(image.texels.size());
  REQUIRE(file->read_image(0, 0, 0, 4, TypeDesc::UINT8, codes.data()));
  CHECK(codes == image.texels);
  CHECK(file->spec().get_string_attribute("trueshade:imageHash") == image_hash(image));
}

TEST_CASE("a PNG of a float image is sRGB-encoded with linear alpha") {
  const ScratchFolder folder;
  const std::string path = folder.path("srgb.png");
  // docs/gl_rules.md row 36, IEC 61966-2-1; then what numbers do not reach.
  const float inf = std::numeric_limits<float>::infinity();
  const float values[] = {0.5f,  0.18f, 0.75f,         0.0031308f, 0.001f, 0.2140411f,
                          -1.0f, inf,   std::nanf(""), 0.0f,       1.0f,   2.0f};
  const int codes[] = {188, 118, 225, 10, 3, 127, 0, 255, 0, 0, 255, 255};
  Image image(12, 1, Format::rgba32f);
  for (int x = 0; x < 12; ++x) {
    const float texel[4] = {values[x], values[x], values[x], values[x]};
    std::memcpy(image.texel(x, 0), texel, sizeof texel);
  }
  write_image(path, image, {}, {});
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  const auto file = ImageInput::open(path, &config);
  std::vector<uint8_t> read(12 * 4);
  REQUIRE(file->read_image(0, 0, 0, 4, TypeDesc::UINT8, read.data()));
  for (size_t x = 0; x < 12; ++x) CHECK(int(read[4 * x]) == codes[x]);
  CHECK(int(read[3]) == 128);  // alpha 0.5: 127.5 to even
}

TEST_CASE("a PNG holds 16-bit codes untouched and 10-bit ones widened") {
  const ScratchFolder folder;
  const std::string path = folder.path("deep.png");
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  const Image sixteen = gradient(37, 71, Format::rgba16);
  write_image(path, sixteen, {}, {});
  std::vector<uint16_t> codes(37 * 71 * 4);
  const auto file = ImageInput::open(path, &config);
  REQUIRE(file);
  REQUIRE(file->spec().format == TypeDesc::UINT16);
  REQUIRE(file->read_image(0, 0, 0, 4, TypeDesc::UINT16, codes.data()));
  CHECK(std::memcmp(codes.data(), sixteen.texels.data(), sixteen.texels.size()) == 0);
  CHECK(read_planes(path).front().image.texels == sixteen.texels);
  CHECK(read_planes(path).front().image.format == Format::rgba16);

  Image ten(1024, 1, Format::rgb10_a2);
  for (int x = 0; x < 1024; ++x)
    for (int c = 0; c < 4; ++c) ten.set_code(x, 0, c, uint32_t(c == 3 ? x % 4 : (x + 300 * c) % 1024));
  write_image(path, ten, {}, {});
  codes.resize(1024 * 4);
  const auto widened = ImageInput::open(path, &config);
  REQUIRE(widened);
  REQUIRE(widened->read_image(0, 0, 0, 4, TypeDesc::UINT16, codes.data()));
  for (int x = 0; x < 1024; ++x)
    for (int c = 0; c < 4; ++c)
      CHECK(int(codes[size_t(4 * x + c)]) == int(std::lround(ten.code(x, 0, c) * 65535.0 / (c == 3 ? 3 : 1023))));
}

TEST_CASE("an EXR holds every target's values, smaller floats as halves") {
  const ScratchFolder folder;
  const std::string path = folder.path("target.exr");
  for (const Format format : kTargetFormats) {
    INFO(info(format).name);
    Image image(7, 5, format);
    for (size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = uint8_t(i * 7 % 59);  // no NaN in any format
    write_image(path, image, {}, {});
    const auto file = ImageInput::open(path);
    REQUIRE(file);
    const int channels = info(format).channels;
    REQUIRE(file->spec().nchannels == channels);
    CHECK(file->spec().format == (info(format).small_float() ? TypeDesc::HALF : TypeDesc::FLOAT));
    std::vector<float> values(size_t(7 * 5 * channels));
    REQUIRE(file->read_image(0, 0, 0, channels, TypeDesc::FLOAT, values.data()));
    for (int i = 0; i < 35; ++i)
      for (int c = 0; c < channels; ++c)
        CHECK(double(values[size_t(i * channels + c)]) == image.value(i % 7, i / 7, c));
  }
}

TEST_CASE("an EXR holds colour and planes under their channel names, bit for bit") {
  const ScratchFolder folder;
  const std::string path = folder.path("planes.exr");
  Image color(5, 70, Format::rgba16f);
  for (size_t i = 0; i < color.texels.size(); i += 2) color.texels[i + 1] = uint8_t(i % 0x7c);
  std::vector<NamedImage> aovs;
  aovs.push_back({"depth", Image(5, 70, Format::d32f)});
  aovs.push_back({"position", Image(5, 70, Format::rgba32f)});
  aovs.push_back({"normal", Image(5, 70, Format::rgb16f)});
  aovs.push_back({"albedo", gradient(5, 70, Format::rgba8)});
  aovs.push_back({"uv", Image(5, 70, Format::rgba32f)});
  for (const char* name : {"id.object", "id.material", "light.count"})
    aovs.push_back({name, gradient(5, 70, Format::r32ui)});
  const float depth = 0.1f;
  std::memcpy(aovs[0].image.texel(3, 69), &depth, sizeof depth);
  write_image(path, color, aovs, {{"trueshade:scene", "b\xc3\xa4r \"x\"\n{}"}});

  const auto file = ImageInput::open(path);
  REQUIRE(file);
  const OIIO::ImageSpec& spec = file->spec();
  CHECK(spec.get_string_attribute("trueshade:scene") == "b\xc3\xa4r \"x\"\n{}");
  CHECK(spec.get_string_attribute("compression") == "zip");
  const auto type = [&spec](const char* name) { return spec.channelformat(spec.channelindex(name)); };
  CHECK(spec.nchannels == 4 + 1 + 3 + 3 + 4 + 2 + 3);
  for (const char* name : {"R", "G", "B", "A", "N.X", "N.Y", "N.Z"}) CHECK(type(name) == TypeDesc::HALF);
  for (const char* name : {"depth.Z", "P.X", "P.Z", "albedo.R", "albedo.A", "uv.X", "uv.Y"})
    CHECK(type(name) == TypeDesc::FLOAT);
  for (const char* name : {"id.object", "id.material", "light.count"}) CHECK(type(name) == TypeDesc::UINT32);

  std::vector<float> values(5 * 70);
  const auto read = [&](const char* name, TypeDesc as, void* into) {
    const int channel = spec.channelindex(name);
    REQUIRE(file->read_image(0, 0, channel, channel + 1, as, into));
  };
  read("depth.Z", TypeDesc::FLOAT, values.data());
  CHECK(values[5 * 69 + 3] == 0.1f);
  read("albedo.G", TypeDesc::FLOAT, values.data());
  for (int y = 0; y < 70; ++y)
    for (int x = 0; x < 5; ++x) REQUIRE(values[size_t(5 * y + x)] == float(aovs[3].image.texel(x, y)[1]) / 255.0f);
  std::vector<uint32_t> ids(5 * 70);
  read("light.count", TypeDesc::UINT32, ids.data());
  CHECK(std::memcmp(ids.data(), aovs[7].image.texels.data(), aovs[7].image.texels.size()) == 0);
  std::vector<uint16_t> halves(5 * 70);
  read("B", TypeDesc::HALF, halves.data());
  for (size_t i = 0; i < halves.size(); ++i) REQUIRE(std::memcmp(&halves[i], &color.texels[8 * i + 4], 2) == 0);

  const ImageFileInfo header = read_image_info(path);
  CHECK(header.width == 5);
  CHECK(header.height == 70);
  CHECK(header.channels.size() == 20);

  write_image(folder.path("header.png"), aovs[3].image, {}, {{"trueshade:scene", "builtin:x"}});
  const ImageFileInfo png = read_image_info(folder.path("header.png"));
  CHECK(png.width == 5);
  CHECK(png.height == 70);
  CHECK(png.channels == std::vector<std::string>{"R uint8", "G uint8", "B uint8", "A uint8"});
  CHECK(std::count(png.metadata.begin(), png.metadata.end(), Metadata::value_type{"trueshade:scene", "builtin:x"}) ==
        1);
}

TEST_CASE("equal images are equal files") {
  const ScratchFolder folder;
  const Image image = gradient(100, 200, Format::rgba8);
  for (const std::string ending : {".png", ".exr"}) {
    write_image(folder.path("a" + ending), image, {}, {{"trueshade:version", "x"}});
    std::filesystem::last_write_time(folder.path("a" + ending), {});
    write_image(folder.path("b" + ending), image, {}, {{"trueshade:version", "x"}});
    const std::string a = contents(folder.path("a" + ending));
    CHECK(a == contents(folder.path("b" + ending)));
    CHECK(std::string(a.begin(), a.end()).find("OpenImageIO") == std::string::npos);
  }
}

TEST_CASE("a write that fails says why and leaves the folder as it was") {
  const ScratchFolder folder;
  const Image image = gradient(4, 4, Format::rgba8);
  const auto kind_of = [&](const std::string& path) {
    try {
      write_image(path, image, {}, {});
    } catch (const Error& error) {
      return int(error.kind());
    }
    return 0;
  };
  std::filesystem::create_directory(folder.path("taken.png"));
  CHECK(kind_of(folder.path("taken.png")) == 5);
  CHECK(kind_of(folder.path("absent/x.png")) == 5);
  CHECK(kind_of(folder.path("x.tiff")) == 2);
  CHECK(folder.entries() == std::vector<std::string>{"taken.png"});
}

TEST_CASE("the header of a file that is no image is refused") {
  const ScratchFolder folder;
  const auto kind_of = [&](const std::string& contents) {
    std::ofstream(folder.path("x"), std::ios::binary) << contents;
    try {
      read_image_info(folder.path("x"));
    } catch (const Error& error) {
      return int(error.kind());
    }
    return 0;
  };
  CHECK(kind_of("") == 3);
  CHECK(kind_of("GIF89a") == 3);
  CHECK(kind_of("\x89PNG\r\n\x1a\n") == 3);
  CHECK(kind_of(std::string("\x76\x2f\x31\x01\x02\0\0\0", 8)) == 3);
  CHECK_THROWS_AS(read_image_info(folder.path("absent.png")), Error);
  CHECK_THROWS_AS(read_image_info(folder.path("")), Error);
}

}  // namespace
}  // namespace trueshade
