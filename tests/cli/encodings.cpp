// What the codes of a PNG stand for and how it says so; what an EXR says; what of both comes back. PNGs are taken apart
// by this file's own reader of chunks, EXRs are read by OpenImageIO.
#include <OpenImageIO/imageio.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>

#include "core/image_files/image_io.h"
#include "core/image_files/png_codes.h"
#include "tests/catch.hpp"
#include "tests/cli/run_command.h"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

using Bytes = std::vector<uint8_t>;

struct Chunk {
  std::string type;
  Bytes data;
};

uint32_t word_at(const Bytes& bytes, size_t at) {
  return uint32_t(bytes[at]) << 24 | uint32_t(bytes[at + 1]) << 16 | uint32_t(bytes[at + 2]) << 8 | bytes[at + 3];
}

/// ISO 3309's CRC, a bit at a time.
uint32_t crc_of(const uint8_t* bytes, size_t count) {
  uint32_t crc = 0xFFFFFFFFu;
  for (size_t i = 0; i < count; ++i) {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xEDB88320u : 0);
  }
  return ~crc;
}

std::vector<Chunk> chunks_of(const Bytes& png) {
  REQUIRE(png.size() > 8);
  REQUIRE(std::memcmp(png.data(), "\x89PNG\r\n\x1a\n", 8) == 0);
  std::vector<Chunk> chunks;
  for (size_t at = 8; at < png.size();) {
    const size_t length = word_at(png, at);
    REQUIRE(at + 12 + length <= png.size());
    REQUIRE(crc_of(&png[at + 4], 4 + length) == word_at(png, at + 8 + length));
    const auto data = png.begin() + std::ptrdiff_t(at) + 8;
    chunks.push_back({std::string(data - 4, data), Bytes(data, data + std::ptrdiff_t(length))});
    at += 12 + length;
  }
  return chunks;
}

/// Chunks of the header and of colour, in the order of the file: `IHDR sRGB:0 gAMA:45455 IDAT IEND`. All of the
/// picture, which may be in several chunks, is one IDAT here.
std::string outline_of(const Bytes& png) {
  std::string text;
  for (const Chunk& chunk : chunks_of(png)) {
    if (chunk.type == "tEXt" || chunk.type == "iTXt") continue;
    if (chunk.type == "IDAT" && text.ends_with("IDAT")) continue;
    text += (text.empty() ? "" : " ") + chunk.type;
    if (chunk.type == "gAMA") text += ":" + std::to_string(word_at(chunk.data, 0));
    if (chunk.type == "sRGB") text += ":" + std::to_string(int(chunk.data[0]));
  }
  return text;
}

const std::string kTaggedSrgb = "IHDR sRGB:0 gAMA:45455 IDAT IEND", kTaggedLinear = "IHDR gAMA:100000 IDAT IEND";

/// The codes of a PNG, channel after channel, by OpenImageIO.
std::vector<int> png_codes(const ScratchFolder& folder, const Bytes& png) {
  const std::string path = folder.path("codes.png");
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(png.data()), std::streamsize(png.size()));
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  const auto file = OIIO::ImageInput::open(path, &config);
  REQUIRE(file);
  const OIIO::ImageSpec& spec = file->spec();
  const size_t count = size_t(spec.width) * size_t(spec.height) * size_t(spec.nchannels);
  if (spec.format == OIIO::TypeDesc::UINT16) {
    std::vector<uint16_t> codes(count);
    REQUIRE(file->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT16, codes.data()));
    return {codes.begin(), codes.end()};
  }
  REQUIRE(spec.format == OIIO::TypeDesc::UINT8);
  std::vector<uint8_t> codes(count);
  REQUIRE(file->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, codes.data()));
  return {codes.begin(), codes.end()};
}

/// Every target format with stored codes of all kinds, none of them NaN.
Image codes_image(Format format) {
  Image image(64, 37, format);
  for (size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = uint8_t(i * 37 % 59);
  if (info(format).number_class == NumberClass::unorm)
    for (size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = uint8_t(i * i * 31 + i);
  return image;
}

/// IEC 61966-2-1 by long double.
long double srgb_by_pow(long double x) {
  return x <= 0.0031308L ? 12.92L * x : 1.055L * std::pow(x, 1.0L / 2.4L) - 0.055L;
}

enum class Expected { stored, encoded, quantised };

/// What a screen is to show of light (docs/looks.md).
long double shown_by(const DisplayTransform& display, long double light) {
  const long double x = light * static_cast<long double>(display.scale);
  if (display.curve == ToneCurve::clip || !(x > 0)) return x;
  const long double y = 0.6L * std::min(x, 1e12L);  // also of infinities
  return (y * (2.51L * y + 0.03L)) / (y * (2.43L * y + 0.59L) + 0.14L);
}

/// Checks each code of `png` against the value of the image's channel, to half a code and the rounding of a float.
void check_codes(const ScratchFolder& folder, const Image& image, const Bytes& png, Expected expected,
                 const DisplayTransform& display = {}) {
  const FormatInfo layout = info(image.format);
  const std::vector<int> codes = png_codes(folder, png);
  REQUIRE(codes.size() == size_t(image.width * image.height * layout.channels));
  const bool deep = layout.number_class == NumberClass::unorm && layout.bits[0] > 8;
  const long double most = deep ? 65535 : 255;
  for (size_t i = 0; i < codes.size(); ++i) {
    const int channel = int(i % size_t(layout.channels)), pixel = int(i / size_t(layout.channels));
    const int x = pixel % image.width, y = pixel / image.width;
    long double value = image.value(x, y, channel);
    const long double alpha = layout.channels == 4 ? image.value(x, y, 3) : 1;
    if (channel < 3 && display.divides_by_alpha && alpha > 0) value /= alpha;
    if (channel < 3) value = shown_by(display, value);
    value = value > 1 ? 1 : value > 0 ? value : 0;
    if (expected == Expected::encoded && channel < 3) value = srgb_by_pow(value);
    if (expected == Expected::stored)
      value = static_cast<long double>(image.code(x, y, channel)) / layout.largest_code(channel);
    INFO(layout.name << " at " << x << ',' << y << " channel " << channel << ": code " << codes[i]);
    REQUIRE(std::fabs(double(value * most - static_cast<long double>(codes[i]))) <= 0.5001);
  }
}

ImageFileOptions encoded_as(PngEncoding encoding) {
  ImageFileOptions options;
  options.encoding = encoding;
  return options;
}

TEST_CASE("without an option a PNG holds display codes: fixed-point targets as stored, floats sRGB-encoded") {
  const ScratchFolder folder;
  for (const Format format : kTargetFormats) {
    const Image image = codes_image(format);
    const Bytes png = encode_png(image, {});
    CHECK(outline_of(png) == kTaggedSrgb);
    const bool fixed_point = info(format).number_class == NumberClass::unorm;
    check_codes(folder, image, png, fixed_point ? Expected::stored : Expected::encoded);
  }
}

TEST_CASE("encoded as srgb, a PNG takes every target's values as linear light") {
  const ScratchFolder folder;
  for (const Format format : kTargetFormats) {
    const Image image = codes_image(format);
    const Bytes png = encode_png(image, {}, encoded_as(PngEncoding::srgb));
    CHECK(outline_of(png) == kTaggedSrgb);
    check_codes(folder, image, png, Expected::encoded);
  }
}

TEST_CASE("raw, a PNG holds every target's values without a transfer function, and says so") {
  const ScratchFolder folder;
  for (const Format format : kTargetFormats) {
    const Image image = codes_image(format);
    const Bytes png = encode_png(image, {}, encoded_as(PngEncoding::raw));
    CHECK(outline_of(png) == kTaggedLinear);
    check_codes(folder, image, png, Expected::quantised);
  }
}

TEST_CASE(
    "light is divided by alpha, scaled and passes the tone curve before a PNG holds it, whatever the target and the "
    "encoding") {
  const ScratchFolder folder;
  for (const Format format : kTargetFormats)
    for (const DisplayTransform& display : {DisplayTransform{0.25, ToneCurve::clip},
                                            {3.0, ToneCurve::filmic},
                                            {1.0, ToneCurve::clip, true},
                                            {0.5, ToneCurve::filmic, true}})
      for (const PngEncoding encoding : {PngEncoding::by_values, PngEncoding::srgb, PngEncoding::raw}) {
        const Image image = codes_image(format);
        ImageFileOptions options = encoded_as(encoding);
        options.display = display;
        const Bytes png = encode_png(image, {}, options);
        CHECK(outline_of(png) == (encoding == PngEncoding::raw ? kTaggedLinear : kTaggedSrgb));
        const FormatInfo layout = info(format);
        const bool holds_codes = layout.number_class == NumberClass::unorm && !layout.srgb;
        const bool encodes = encoding == PngEncoding::srgb || (encoding == PngEncoding::by_values && !holds_codes);
        check_codes(folder, image, png, encodes ? Expected::encoded : Expected::quantised, display);
        write_image(folder.path("x.exr"), image, {}, {}, options);
        CHECK(read_planes(folder.path("x.exr"))[0].image.value(17, 23, 0) == image.value(17, 23, 0));
      }
}

TEST_CASE("the light behind what is shown is shown so") {
  for (const DisplayTransform& display : {DisplayTransform{0.25, ToneCurve::clip}, {3e4, ToneCurve::filmic}})
    for (int i = 0; i <= 255; ++i)
      if (std::fabs(shown_light(light_behind(i / 255.0, display), display) - i / 255.0) > 1e-12) FAIL("at " << i);
}

TEST_CASE("pictures of display codes are never encoded again") {
  const ScratchFolder folder;
  for (const Format format : {Format::rgba8, Format::rgba16f, Format::rgba32f})
    for (const PngEncoding encoding : {PngEncoding::by_values, PngEncoding::srgb, PngEncoding::raw}) {
      const Image image = codes_image(format);
      ImageFileOptions options = encoded_as(encoding);
      options.values = PictureValues::display_codes;
      options.display = {2.0, ToneCurve::filmic};  // which is of light
      const Bytes png = encode_png(image, {}, options);
      CHECK(outline_of(png) == kTaggedSrgb);
      check_codes(folder, image, png, Expected::quantised);
    }
}

TEST_CASE("the sRGB value of a linear one inverts the linear value of an sRGB one") {
  for (int i = 0; i <= 65535; ++i) {
    const double x = double(i) / 65535.0;
    if (std::fabs(double(srgb_by_pow(x)) - srgb_from_linear(x)) > 1e-14) FAIL("at " << x);
  }
}

TEST_CASE("an EXR holds the target's values under every encoding, and says what they stand for") {
  const ScratchFolder folder;
  const std::string path = folder.path("x.exr");
  const auto color_space = [&] {
    const auto file = OIIO::ImageInput::open(path);
    REQUIRE(file);
    return std::string(file->spec().get_string_attribute("oiio:ColorSpace"));
  };
  for (const Format format : kTargetFormats) {
    INFO(info(format).name);
    const Image image = codes_image(format);
    const std::vector<NamedImage> planes = {{"albedo", codes_image(Format::rgba8)}};
    write_image(path, image, planes, {});
    const bool codes = info(format).number_class == NumberClass::unorm && !info(format).srgb;
    CHECK(color_space() == (codes ? "sRGB" : "Linear"));
    const std::vector<NamedImage> read = read_planes(path);
    REQUIRE(read.size() == 2);
    for (size_t i = 0; i < 2; ++i) {
      const Image& from = i == 0 ? image : planes[0].image;
      for (int c = 0; c < info(from.format).channels; ++c)
        CHECK(read[i].image.value(17, 23, c) == from.value(17, 23, c));
    }
    for (const PngEncoding encoding : {PngEncoding::srgb, PngEncoding::raw}) {
      write_image(folder.path("y.exr"), image, planes, {}, encoded_as(encoding));
      const auto bytes = [&](const char* name) { return contents(folder.path(name)); };
      CHECK(bytes("x.exr") == bytes("y.exr"));
    }
  }
  ImageFileOptions options;
  options.values = PictureValues::display_codes;
  write_image(path, codes_image(Format::rgba16f), {}, {}, options);
  CHECK(color_space() == "sRGB");
}

TEST_CASE("files of every size are read back whole, noise and flat colour alike") {
  const ScratchFolder folder;
  uint32_t random = 1;
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 17}, {3, 16}, {257, 1}, {640, 33}})
    for (const bool noise : {false, true}) {
      Image image(width, height, Format::rgba32f), codes(width, height, Format::rgba8);
      for (size_t i = 0; i < image.texels.size(); ++i) {
        random = random * 1664525u + 1013904223u;
        image.texels[i] = noise && i % 4 != 3 ? uint8_t(random >> 24) : 0;  // no NaN
        codes.texels[i / 4] = noise ? uint8_t(random >> 16) : 7;
      }
      INFO(width << 'x' << height << (noise ? " noise" : " flat"));
      write_image(folder.path("x.exr"), image, {}, {});
      CHECK(read_planes(folder.path("x.exr"))[0].image.texels == image.texels);
      write_image(folder.path("x.png"), codes, {}, {});
      CHECK(read_planes(folder.path("x.png"))[0].image.texels == codes.texels);
      CHECK(png_codes(folder, encode_png(codes, {})) == std::vector<int>(codes.texels.begin(), codes.texels.end()));
    }
}

/// The mean code of R, G and B in a PNG that the command draws of the cornell box.
double mean_of(const ScratchFolder& folder, std::vector<std::string> options, const std::string& outline) {
  options.insert(options.begin(), {"render", "builtin:cornell", "--size", "60x45", "-o", "x.png"});
  const Outcome outcome = run_command(options, folder.path(""));
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  const std::string file = contents(folder.path("x.png"));
  const Bytes png(file.begin(), file.end());
  CHECK(outline_of(png) == outline);
  const std::vector<int> codes = png_codes(folder, png);
  double sum = 0.0;
  for (size_t i = 0; i < codes.size(); ++i) sum += i % 4 == 3 ? 0.0 : codes[i];
  return sum / 255.0 / double(codes.size() / 4 * 3);
}

TEST_CASE("The option --encode makes fixed-point and float targets of one scene equally bright") {
  const ScratchFolder folder;
  const auto mean = [&](const char* target, const char* encoding) {
    return mean_of(folder, {"--target", target, "--encode", encoding},
                   std::string(encoding) == "raw" ? kTaggedLinear : kTaggedSrgb);
  };
  const double raw = mean("rgba8", "raw"), srgb = mean("rgba8", "srgb");
  CHECK(srgb > 1.2 * raw);
  for (const char* target : {"rgba16f", "rgba32f", "srgb8_a8"}) {
    INFO(target);
    CHECK(std::fabs(mean(target, "raw") - raw) < 0.01);
    CHECK(std::fabs(mean(target, "srgb") - srgb) < 0.02);
  }
  CHECK(mean_of(folder, {"--target", "rgba8"}, kTaggedSrgb) == raw);
  CHECK(mean_of(folder, {"--target", "rgba16f"}, kTaggedSrgb) == mean("rgba16f", "srgb"));
}

TEST_CASE("the hash is that of the stored bytes under every encoding, and info shows what a file is tagged as") {
  const ScratchFolder folder;
  const auto run = [&](const std::vector<std::string>& arguments) {
    const Outcome outcome = run_command(arguments, folder.path(""));
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    return outcome.out;
  };
  const std::vector<std::string> render = {
      "render", "builtin:cornell", "--size", "30x20", "--hash", "--target", "rgba16f", "-o", "x.png", "-o", "x.exr"};
  const std::string hash = run(render);
  for (const auto& [encoding, tag] : {std::pair("srgb", "sRGB"), {"raw", "Linear"}}) {
    std::vector<std::string> arguments = render;
    arguments.insert(arguments.end(), {"--encode", encoding});
    CHECK(run(arguments) == hash);
    const auto row = [](const std::string& space) { return "oiio:ColorSpace       " + space + '\n'; };
    CHECK(run({"info", "x.png"}).find(row(tag)) != std::string::npos);
    CHECK(run({"info", "x.exr"}).find(row("Linear")) != std::string::npos);
  }
  CHECK(run_command({"render", "builtin:cornell", "-o", "x.exr", "--encode", "srgb"}, folder.path("")).exit_code == 2);
  CHECK(run_command({"render", "builtin:cornell", "-o", "x.png", "--encode", "linear"}, folder.path("")).exit_code ==
        2);
}

TEST_CASE("a note names the encoding that was chosen for a float target's PNG, and none is said where none was") {
  const ScratchFolder folder;
  std::ofstream(folder.path("post.json")) << R"({"version": 1, "target": "rgba16f",
      "post": {"encode": "srgb", "output": "rgba16f"}})";
  const auto notes = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"render", "builtin:cornell", "--size", "16x12"});
    const Outcome outcome = run_command(options, folder.path(""));
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    return outcome.err;
  };
  const std::string said = notes({"--target", "rgba16f", "-o", "x.png"});
  CHECK(said.starts_with("trueshade: note: The target rgba16f "));
  CHECK(std::count(said.begin(), said.end(), '\n') == 1);
  CHECK(notes({"--target", "rgba16f", "-o", "x.png", "--encode", "srgb"}).empty());
  CHECK(notes({"--target", "rgba16f", "-o", "x.exr"}).empty());
  CHECK(notes({"--target", "rgba16f", "-o", "x.png", "--view", "albedo"}).empty());
  CHECK(notes({"--target", "rgba8", "-o", "x.png"}).empty());
  CHECK(notes({"--pipeline", "post.json", "-o", "x.png"}).empty());
}

TEST_CASE("what a post chain has encoded is not encoded again") {
  const ScratchFolder folder;
  const auto pipeline = [&](const char* output) {
    std::ofstream(folder.path("post.json"))
        << R"({"version": 1, "target": "rgba16f", "post": {"encode": "srgb", "output": ")" << output << "\"}}";
  };
  pipeline("rgba8");
  const double mean = mean_of(folder, {"--pipeline", "post.json"}, kTaggedSrgb);
  CHECK(mean_of(folder, {"--pipeline", "post.json", "--encode", "srgb"}, kTaggedSrgb) == mean);
  pipeline("rgba32f");
  CHECK(std::fabs(mean_of(folder, {"--pipeline", "post.json"}, kTaggedSrgb) - mean) < 0.001);
  CHECK(std::fabs(mean_of(folder, {"--pipeline", "post.json", "--encode", "srgb"}, kTaggedSrgb) - mean) < 0.001);
}

}  // namespace
}  // namespace trueshade
