// Pictures as textures come from anywhere: what is decoded is what was encoded, and a bad one is one line, in time.
#include <OpenImageIO/imageio.h>

#include <cstring>
#include <fstream>
#include <optional>

#include "core/error.h"
#include "core/image_files/image_io.h"
#include "tests/catch.hpp"
#include "tests/cli/refused.h"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

constexpr uint64_t kMost = uint64_t(1) << 30;

/// A picture as OpenImageIO writes it.
std::vector<uint8_t> written(const std::string& kind, int width, int height, int channels, OIIO::TypeDesc type,
                             const void* texels) {
  const ScratchFolder scratch;
  const std::string path = scratch.path("picture." + kind);
  const auto file = OIIO::ImageOutput::create(kind == "exr" ? "openexr" : kind == "jpg" ? "jpeg" : kind);
  OIIO::ImageSpec spec(width, height, channels, type);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.attribute("Compression", kind == "jpg" ? "jpeg:100" : "zip");
  REQUIRE(file->open(path, spec));
  REQUIRE(file->write_image(type, texels));
  file->close();
  const std::string bytes = contents(path);
  return {bytes.begin(), bytes.end()};
}

std::optional<ErrorKind> decoding_refusal(std::span<const uint8_t> content, uint64_t most = kMost) {
  try {
    decode_image(content, "picture", most);
    return std::nullopt;
  } catch (const Error& error) {
    INFO(error.what());
    CHECK(std::string(error.what()).starts_with("picture: "));
    CHECK(std::string(error.what()).find('\n') == std::string::npos);
    return error.kind();
  }
}

std::vector<uint8_t> ramp(size_t count) {
  std::vector<uint8_t> values(count);
  for (size_t i = 0; i < count; ++i) values[i] = uint8_t(i * 11 + i / 7);
  return values;
}

TEST_CASE("PNG of 8 bits a channel decode to the codes that were written") {
  for (const int channels : {1, 2, 3, 4}) {
    INFO(channels << " channels");
    const std::vector<uint8_t> texels = ramp(size_t(5 * 3 * channels));
    const Image image = decode_image(written("png", 5, 3, channels, OIIO::TypeDesc::UINT8, texels.data()), "p", kMost);
    REQUIRE((image.width == 5 && image.height == 3 && image.format == Format::rgba8));
    for (size_t i = 0; i < 15; ++i) {
      const uint8_t* from = texels.data() + i * size_t(channels);
      for (size_t c = 0; c < 3; ++c) CHECK(image.texels[4 * i + c] == from[channels >= 3 ? c : 0]);
      CHECK(image.texels[4 * i + 3] == (channels % 2 == 0 ? from[channels - 1] : 255));
    }
  }
}

TEST_CASE("EXR decode to their halves or floats, with alpha 1 where they have none") {
  const float texels[2 * 4] = {0.25f, 1.0f, 2.5f, 0.5f, 0.0f, 3.0f, 0.125f, 1.0f};
  const Image rgba = decode_image(written("exr", 2, 1, 4, OIIO::TypeDesc::FLOAT, texels), "p", kMost);
  CHECK(rgba.format == Format::rgba32f);
  CHECK(std::memcmp(rgba.texels.data(), texels, sizeof texels) == 0);
  const uint16_t halves[2 * 3] = {0x3400, 0x3C00, 0x4100, 0x0000, 0x4200, 0x3000};
  const Image rgb = decode_image(written("exr", 2, 1, 3, OIIO::TypeDesc::HALF, halves), "p", kMost);
  REQUIRE(rgb.format == Format::rgba16f);
  const uint16_t expected[2 * 4] = {0x3400, 0x3C00, 0x4100, 0x3C00, 0x0000, 0x4200, 0x3000, 0x3C00};
  CHECK(std::memcmp(rgb.texels.data(), expected, sizeof expected) == 0);
}

TEST_CASE("JPEG decode to about what was written") {
  std::vector<uint8_t> texels(16 * 16 * 3);
  for (size_t i = 0; i < texels.size(); ++i) texels[i] = uint8_t(i % 3 == 0 ? 200 : i % 3 == 1 ? 100 : 50);
  const Image image = decode_image(written("jpg", 16, 16, 3, OIIO::TypeDesc::UINT8, texels.data()), "p", kMost);
  REQUIRE((image.width == 16 && image.height == 16));
  for (size_t i = 0; i < 256; ++i) {
    for (size_t c = 0; c < 3; ++c) CHECK(std::abs(int(image.texels[4 * i + c]) - int(texels[3 * i + c])) <= 2);
    CHECK(image.texels[4 * i + 3] == 255);
  }
}

TEST_CASE("cut-off pictures are refused at every length") {
  const std::vector<uint8_t> texels = ramp(24 * 24 * 4);
  const std::vector<uint8_t> files[] = {written("png", 24, 24, 4, OIIO::TypeDesc::UINT8, texels.data()),
                                        written("jpg", 24, 24, 3, OIIO::TypeDesc::UINT8, texels.data()),
                                        written("exr", 24, 8, 3, OIIO::TypeDesc::HALF, texels.data())};
  for (const std::vector<uint8_t>& file : files) {
    CHECK_FALSE(decoding_refusal(file));
    for (size_t length = 0; length < file.size(); ++length) {
      // The last 12 bytes of a PNG are its end alone, which adds nothing to the texels before it.
      if (file[0] == 0x89 && length >= file.size() - 12) break;
      INFO("first byte " << int(file[0]) << ", " << length << " of " << file.size() << " bytes");
      CHECK(decoding_refusal(std::span(file).first(length)).has_value());
    }
  }
}

TEST_CASE("damaged pictures end in an answer or a refusal") {
  const std::vector<uint8_t> texels = ramp(24 * 24 * 4);
  for (const char* kind : {"png", "jpg", "exr"}) {
    const std::vector<uint8_t> file =
        written(kind, 24, 8, 3, kind[0] == 'e' ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::UINT8, texels.data());
    for (size_t at = 0; at < file.size(); ++at) {
      std::vector<uint8_t> damaged = file;
      damaged[at] = uint8_t(damaged[at] ^ (1u << (at % 8)));
      decoding_refusal(damaged);
    }
  }
}

TEST_CASE("sizes are refused before they are allocated") {
  const std::vector<uint8_t> texels = ramp(8 * 8 * 4);
  const std::vector<uint8_t> png = written("png", 8, 8, 4, OIIO::TypeDesc::UINT8, texels.data()),
                             jpg = written("jpg", 8, 8, 3, OIIO::TypeDesc::UINT8, texels.data()),
                             exr = written("exr", 8, 8, 3, OIIO::TypeDesc::HALF, texels.data());
  CHECK(decoding_refusal(png, 255) == ErrorKind::limit);
  CHECK(decoding_refusal(jpg, 255) == ErrorKind::limit);
  CHECK(decoding_refusal(exr, 255) == ErrorKind::limit);
  CHECK_FALSE(decoding_refusal(png, 256));
  std::vector<uint8_t> huge = png;  // IHDR's width is at byte 16
  huge[16] = 0x7f;
  CHECK(decoding_refusal(huge) == ErrorKind::limit);
  std::vector<uint8_t> none = png;
  none[19] = 0;
  CHECK(decoding_refusal(none) == ErrorKind::bad_input);
  std::vector<uint8_t> wide = jpg;
  for (size_t at = 0; at + 8 < wide.size(); ++at)
    if (wide[at] == 0xFF && wide[at + 1] == 0xC0) wide[at + 5] = wide[at + 7] = 0xff;  // 65288 x 65288
  CHECK(decoding_refusal(wide) == ErrorKind::limit);
  CHECK(decoding_refusal(std::vector<uint8_t>{'G', 'I', 'F', '8', '9', 'a'}) == ErrorKind::bad_input);
  CHECK(decoding_refusal({}) == ErrorKind::bad_input);
}

TEST_CASE("the command refuses bad textures in one line") {
  const ScratchFolder scratch;
  std::filesystem::create_directory(scratch.path("folder.png"));
  std::ofstream(scratch.path("torn.png"), std::ios::binary) << "\x89PNG\r\n\x1a\n";
  const auto refused = [&](const std::string& file, int exit_code, const std::string& about) {
    std::ofstream(scratch.path("s.json"))
        << R"({"version": 1, "textures": [{"name": "t", "file": ")" << file << "\"}]}";
    check_refused(run_command({"render", "s.json", "--hash"}, scratch.path(".")), exit_code, about);
  };
  refused("absent.png", 5, "/textures/0/file: absent.png");
  refused("folder.png", 3, "this is no regular file");
  refused("torn.png", 3, "torn.png");
  refused("../s.json", 3, "the path leaves the scene's folder");
  refused("s.json", 3, "it is neither PNG, JPEG nor EXR");
}

}  // namespace
}  // namespace trueshade
