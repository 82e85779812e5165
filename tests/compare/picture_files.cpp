// Radiance HDR, made here from the format's description, and what other kinds are refused.
#include "core/image_files/picture_file.h"

#include <cmath>
#include <random>

#include "core/error.h"
#include "tests/catch.hpp"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

using Pixel = std::array<uint8_t, 4>;

std::string header_of(int width, int height) {
  return "#?RADIANCE\n# made\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=1.0\n\n-Y " + std::to_string(height) + " +X " +
         std::to_string(width) + "\n";
}

/// Rows with each component by itself: runs of three bytes and more packed, all else copied.
std::string packed_rows(const std::vector<Pixel>& pixels, int width) {
  std::string out;
  for (size_t row = 0; row < pixels.size(); row += size_t(width)) {
    out += {char(2), char(2), char(width >> 8), char(width & 255)};
    for (size_t c = 0; c < 4; ++c)
      for (int x = 0; x < width;) {
        const auto at = [&](int i) { return pixels[row + size_t(i)][c]; };
        int run = 1;
        while (x + run < width && run < 127 && at(x + run) == at(x)) ++run;
        if (run > 2) {
          out += {char(128 + run), char(at(x))};
          x += run;
        } else {
          out += {char(1), char(at(x))};
          ++x;
        }
      }
  }
  return out;
}

std::string plain_rows(const std::vector<Pixel>& pixels) {
  std::string out;
  for (const Pixel& pixel : pixels) out.append(pixel.begin(), pixel.end());
  return out;
}

std::vector<Pixel> random_pixels(int count) {
  std::mt19937 random(3);
  std::vector<Pixel> pixels;
  for (int i = 0; i < count; ++i) {
    Pixel pixel;
    for (uint8_t& code : pixel) code = uint8_t(random() % 4 == 0 ? random() % 256 : 130);
    if (pixel[0] == 2 && pixel[1] == 2) pixel[0] = 3;  // would be the mark of a packed row
    if (i % 7 == 0) pixel[3] = 0;
    pixels.push_back(pixel);
  }
  return pixels;
}

void check_pixels(const PictureFile& picture, const std::vector<Pixel>& pixels) {
  REQUIRE(picture.parts.size() == 1);
  REQUIRE(picture.parts[0].channels.size() == 3);
  size_t wrong = 0;
  for (size_t c = 0; c < 3; ++c)
    for (size_t i = 0; i < pixels.size(); ++i) {
      const double expected =
          pixels[i][3] == 0 ? 0.0 : double(pixels[i][c]) * std::pow(2.0, double(pixels[i][3]) - 136.0);
      wrong += picture.parts[0].channels[c].value(i) != expected;
    }
  CHECK(wrong == 0);
}

/// What is said of a file that is refused; empty for one that is read.
std::string refusal(const ScratchFolder& folder, const std::string& content) {
  try {
    read_any_picture(folder.write("file", content), kMostExpansion);
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::bad_input);
    return error.what();
  }
  return {};
}

TEST_CASE("Radiance pictures are read in each of their three packings, to the value that the format states") {
  const ScratchFolder folder;
  const std::vector<Pixel> pixels = random_pixels(40 * 6);
  const auto read = [&](const std::string& content) {
    return read_any_picture(folder.write("picture.hdr", content), kMostExpansion);
  };
  check_pixels(read(header_of(40, 6) + packed_rows(pixels, 40)), pixels);
  check_pixels(read(header_of(40, 6) + plain_rows(pixels)), pixels);
  const Pixel grey = {128, 128, 128, 129};
  const std::string repeated = std::string("\x80\x80\x80\x81", 4) + std::string("\1\1\1\2", 4) + std::string("\1\1\1\1", 4);
  check_pixels(read(header_of(7, 1) + plain_rows(std::vector<Pixel>(7, grey))), std::vector<Pixel>(7, grey));
  check_pixels(read(header_of(259, 1) + repeated), std::vector<Pixel>(259, grey));  // 1 + 2 + 1 * 256
  const PictureFile picture = read(header_of(7, 1) + plain_rows(std::vector<Pixel>(7, grey)));
  CHECK(picture.kind == "Radiance HDR");
  CHECK(picture.color_space == ColorSpace::linear);
  CHECK(picture.parts[0].channels[0].value(0) == 1.0);
}

TEST_CASE("Radiance pictures that end early, at any byte, are refused") {
  const ScratchFolder folder;
  const std::vector<Pixel> pixels = random_pixels(20 * 3);
  const std::string whole = header_of(20, 3) + packed_rows(pixels, 20);
  CHECK(refusal(folder, whole).empty());
  for (size_t size = 2; size < whole.size(); ++size) CHECK_FALSE(refusal(folder, whole.substr(0, size)).empty());
}

TEST_CASE("Radiance pictures of other layouts, formats and widths are refused, and say why") {
  const ScratchFolder folder;
  const std::string rows = plain_rows(std::vector<Pixel>(4, {1, 2, 3, 128}));
  const auto with = [&](const std::string& size, const std::string& format = "32-bit_rle_rgbe") {
    return refusal(folder, "#?RADIANCE\nFORMAT=" + format + "\n\n" + size + "\n" + rows);
  };
  CHECK(with("-Y 2 +X 2").empty());
  CHECK(with("+Y 2 +X 2").find("do not run from the top") != std::string::npos);
  CHECK(with("-Y 2 +X 2 ").find("do not run from the top") != std::string::npos);
  CHECK(with("-Y 0 +X 2").find("do not run from the top") != std::string::npos);
  CHECK(with("-Y 99999999999 +X 2").find("do not run from the top") != std::string::npos);
  CHECK(with("-Y 2 +X 2", "32-bit_rle_xyze").find("is not 32-bit_rle_rgbe") != std::string::npos);
  CHECK(refusal(folder, "#?RADIANCE\n\n-Y 2 +X 2\n" + rows).find("names no FORMAT") != std::string::npos);
  CHECK(refusal(folder, header_of(20, 1) + "\2\2" + std::string("\0\x13", 2) + rows).find("another width") !=
        std::string::npos);
  CHECK(refusal(folder, header_of(20, 1) + std::string("\2\2\0\x14\x9f\1", 6)).find("more pixels than the picture") !=
        std::string::npos);
  CHECK(refusal(folder, header_of(2, 1) + std::string("\1\1\1\2", 4)).find("repeats a pixel that is not there") !=
        std::string::npos);
}

TEST_CASE("a Radiance picture that says it is far larger than its bytes is over the limit of expansion") {
  const ScratchFolder folder;
  try {
    read_any_picture(folder.write("bomb.hdr", header_of(16000, 16000) + "\x80\x80\x80\x81"), kMostExpansion);
    FAIL("it was read");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::limit);
    CHECK(std::string(error.what()).find("--max-expansion") != std::string::npos);
  }
}

TEST_CASE("what is no picture is refused by what it is") {
  const ScratchFolder folder;
  CHECK(refusal(folder, "").find("the file is empty") != std::string::npos);
  CHECK(refusal(folder, "hello, world\n").find("no picture of a kind that is read") != std::string::npos);
  CHECK(refusal(folder, "GIF89a" + std::string(30, '\0')).find("it is GIF, which is not read") != std::string::npos);
}

}  // namespace
}  // namespace trueshade
