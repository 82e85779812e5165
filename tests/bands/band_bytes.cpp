// Bands on their way from one process to another.
#include <algorithm>
#include <random>

#include "bands/drawn_band.h"
#include "core/error.h"
#include "tests/bands/city_picture.h"
#include "tests/catch.hpp"

using namespace trueshade;
using testing::city_picture;

TEST_CASE("A band comes out of its bytes as it was", "[bands]") {
  const Scene scene = builtin_scene("city");
  const PreparedScene prepared(scene);
  LargePicture picture = city_picture(prepared, 100, 130);
  picture.aovs = {"depth", "albedo"};
  picture.files = {"a.png", "b.exr"};
  for (const SentPlanes planes : {SentPlanes::no, SentPlanes::yes}) {
    const DrawnBand band = draw_band(picture, 2);
    CHECK(band.rows == 2);
    const DrawnBand read = band_of_bytes(picture, 2, bytes_of_band(band, planes));
    CHECK(read.rows == 2);
    CHECK(std::ranges::equal(read.color, band.color));
    CHECK(read.planes.size() == (planes == SentPlanes::yes ? 2u : 0u));
    for (size_t i = 0; i < read.planes.size(); ++i) CHECK(std::ranges::equal(read.planes[i], band.planes[i]));
    CHECK(counts_of(read.counts) == counts_of(band.counts));
    REQUIRE(read.of_files.size() == 2);
    for (size_t i = 0; i < 2; ++i) {
      CHECK(read.of_files[i].pieces == band.of_files[i].pieces);
      CHECK(read.of_files[i].checksum == band.of_files[i].checksum);
      CHECK(read.of_files[i].bytes == band.of_files[i].bytes);
    }
  }
}

TEST_CASE("Bytes that are no band of the picture are refused", "[bands]") {
  const Scene scene = builtin_scene("sphere");
  const PreparedScene prepared(scene);
  LargePicture picture = city_picture(prepared, 60, 70);
  picture.files = {"a.png"};
  const std::vector<uint8_t> bytes = bytes_of_band(draw_band(picture, 0), SentPlanes::no);
  CHECK_THROWS_AS(band_of_bytes(picture, 1, bytes), Error);  // of another height
  CHECK_THROWS_AS(band_of_bytes(picture, 0, {}), Error);
  for (size_t size = 0; size < bytes.size(); size += 97)
    CHECK_THROWS_AS(band_of_bytes(picture, 0, std::vector(bytes.begin(), bytes.begin() + std::ptrdiff_t(size))), Error);
  std::mt19937_64 random(7);
  for (int i = 0; i < 500; ++i) {
    std::vector<uint8_t> mutant = bytes;
    for (int k = 0; k < 3; ++k) mutant[random() % mutant.size()] = uint8_t(random());
    try {
      band_of_bytes(picture, 0, mutant);  // other pixels, or refused: neither crashes nor takes memory without end
    } catch (const Error&) {
    }
  }
}
