// Layers of pages, unpacked again by another program than wrote them: zlib and PNG's filter Paeth from its text.
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "cli/pages/page.h"
#include "cli/pages/viewer.h"
#include "tests/catch.hpp"
#include "tests/cli/paeth.h"

namespace trueshade {
namespace {

using Codes = std::vector<uint32_t>;

std::string bytes_of_base64(const std::string& text) {
  static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    REQUIRE(digits.find(c) != std::string::npos);
    bits = bits << 6 | uint32_t(digits.find(c)), count += 6;
    if (count >= 8) bytes += char(bits >> (count -= 8));
  }
  return bytes;
}

std::string inflated(const std::string& bytes, size_t size) {
  std::string out(size, '\0');
  uLongf length = uLongf(size);
  REQUIRE(uncompress(reinterpret_cast<Bytef*>(out.data()), &length, reinterpret_cast<const Bytef*>(bytes.data()),
                     uLong(bytes.size())) == Z_OK);
  REQUIRE(length == size);
  return out;
}

std::vector<std::string> script_lines(const std::string& elements, const std::string& id) {
  const std::string start = "<script type=\"text/plain\" id=\"" + id + "\">";
  const size_t begin = elements.find(start) + start.size();
  REQUIRE(elements.find(start) != std::string::npos);
  const std::string content = elements.substr(begin, elements.find('<', begin) - begin);
  std::vector<std::string> lines(1);
  for (const char c : content) c == '\n' ? lines.emplace_back() : lines.back() += c, void();
  return lines;
}

/// All pixels of one level of a layer. `base`: those of the layer that it is stored against.
Codes unpacked(const WrittenLayer& layer, size_t level, const Codes& base = {}) {
  const auto json = nlohmann::json::parse(layer.json);
  const auto& spec = json["levels"][level];
  const size_t width = spec["width"], height = spec["height"], channels = json["channels"], bits = json["bits"];
  const std::vector<std::string> lines = script_lines(layer.elements, spec["data"]);
  const size_t columns = (width + kTileSide - 1) / kTileSide;
  REQUIRE(lines.size() == columns * ((height + kTileSide - 1) / kTileSide));
  Codes all(width * height * channels);
  const uint32_t mask = bits == 32 ? ~0u : (1u << bits) - 1;
  for (size_t t = 0; t < lines.size(); ++t) {
    const size_t x0 = t % columns * kTileSide, y0 = t / columns * kTileSide;
    const size_t w = std::min<size_t>(kTileSide, width - x0), h = std::min<size_t>(kTileSide, height - y0);
    std::string bytes(w * h * channels * bits / 8, '\0');
    if (!lines[t].empty()) bytes = inflated(bytes_of_base64(lines[t]), bytes.size());
    Codes tile(w * h * channels);
    for (size_t k = 0, at = 0; k < channels; ++k)
      for (size_t shift = 0; shift < bits; shift += 8)
        for (size_t i = 0; i < w * h; ++i) tile[i * channels + k] |= uint32_t(uint8_t(bytes[at++])) << shift;
    for (size_t y = 0; y < h; ++y)
      for (size_t x = 0; x < w; ++x)
        for (size_t k = 0; k < channels; ++k) {
          const auto known = [&](size_t dx, size_t dy) -> int64_t {
            return x < dx || y < dy ? 0 : tile[((y - dy) * w + x - dx) * channels + k];
          };
          uint32_t& code = tile[(y * w + x) * channels + k];
          const size_t place = ((y0 + y) * width + x0 + x) * channels + k;
          code = uint32_t(code + (base.empty() ? paeth(known(1, 0), known(0, 1), known(1, 1)) : base[place])) & mask;
          all[place] = code;
        }
  }
  return all;
}

/// An image of noise with flat parts.
Image image_of(int width, int height, Format format, uint32_t seed) {
  Image image(width, height, format);
  std::mt19937 random(seed);
  const FormatInfo layout = info(format);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int k = 0; k < layout.channels; ++k) {
        const uint32_t most = layout.bits[size_t(k)] == 32 ? ~0u : layout.largest_code(k);
        image.set_code(x, y, k, (x / 40 + y / 30) % 2 == 0 ? most / 3 : uint32_t(random()) & most);
      }
  return image;
}

Codes image_codes(const Image& image) {
  Codes codes;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int k = 0; k < info(image.format).channels; ++k) codes.push_back(image.code(x, y, k));
  return codes;
}

}  // namespace

TEST_CASE("A page's layer holds every code of an image of any format, over more than one tile") {
  for (const Format format : kFormats) {
    CAPTURE(info(format).name);
    const Image image = image_of(530, 519, format, 7);
    const WrittenLayer layer = written(layer_of_image("a", "A", "", image), nullptr, 2);
    CHECK(unpacked(layer, 0) == image_codes(image));
  }
}

TEST_CASE("A layer stored against another holds every code too, and nothing where both are equal") {
  const Image one = image_of(600, 40, Format::rgba8, 1), other = image_of(600, 40, Format::rgba8, 2);
  const PageLayer base = layer_of_image("base", "Base", "", one);
  PageLayer same = layer_of_image("same", "Same", "", one), apart = layer_of_image("apart", "Apart", "", other);
  same.base = apart.base = "base";
  CHECK(unpacked(written(apart, &base, 2), 0, image_codes(one)) == image_codes(other));
  CHECK(written(same, &base, 2).elements == "<script type=\"text/plain\" id=\"pixels-same-1\">\n</script>\n");
}

TEST_CASE("A large picture comes reduced too: codes averaged, and of differences and classes the largest") {
  Image dark(4096, 16, Format::rgba8), bright(4096, 16, Format::rgba8);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 4096; ++x)
      for (int k = 0; k < 4; ++k) bright.set_code(x, y, k, 100), dark.set_code(x, y, k, x % 2 == 0 ? 100 : 50);
  dark.set_code(2001, 9, 1, 97);
  REQUIRE(reduction_of(4096, 16) == 4);
  const PageLayer a = layer_of_image("a", "A", "", bright), b = layer_of_image("b", "B", "", dark);
  const Codes averages = unpacked(written(b, nullptr, 1), 1);
  REQUIRE(averages.size() == 1024 * 4 * 4);
  CHECK(averages[0] == 75);
  const Codes largest = unpacked(written(layer_of_difference("D", "", a, b), nullptr, 1), 0);
  CHECK(std::all_of(largest.begin(), largest.end(), [](uint32_t code) { return code == 50; }));
  PageLayer classes = a;
  classes.look = Look::classes, classes.reduction = Reduction::largest;
  classes.channel_names = {""}, classes.widths = {8};
  classes.classes = {{"usual", "", {}, 0, 0}, {"rare", "", {}, 0, 2}, {"less so", "", {}, 0, 1}};
  classes.read = [](int x, int y, int count, uint32_t* codes) {
    for (int i = 0; i < count; ++i) codes[i] = y == 5 && x + i == 4 ? 1 : x + i > 4092 ? 2 : 0;
  };
  const Codes worst = unpacked(written(classes, nullptr, 1), 1);
  CHECK(std::count(worst.begin(), worst.end(), 1u) == 1);
  CHECK(worst[1024 + 1] == 1);
  CHECK(std::count(worst.begin(), worst.end(), 2u) == 4);
}

TEST_CASE("Reduced differences of floats are floats, and infinite where one of both alone is not a number") {
  Image one(2052, 1, Format::rgba16f), other(2052, 1, Format::rgba16f);
  one.set_code(0, 0, 0, 0x3C00), other.set_code(0, 0, 0, 0x3800);  // 1 and 0.5
  one.set_code(9, 0, 2, 0x7E00);                                   // NaN and 0
  one.set_code(2051, 0, 1, 0x8000);                                // -0 and 0 are one value
  const PageLayer a = layer_of_image("a", "A", "", one), b = layer_of_image("b", "B", "", other);
  const Codes codes = unpacked(written(layer_of_difference("D", "", a, b), nullptr, 1), 0);
  CHECK(codes[0] == std::bit_cast<uint32_t>(0.5f));
  CHECK(codes[4 * 3 + 2] == 0x7F800000);
  CHECK(std::count(codes.begin(), codes.end(), 0u) == int64_t(codes.size()) - 2);
}

TEST_CASE("Names end no element of a page, whatever is in them") {
  const Image image(3, 2, Format::rgba8);
  const std::string name = "</script><script>alert(1)</script><img src=x onerror=alert(1)>\"'&";
  PageViewer viewer;
  viewer.add(layer_of_image("a", name, name, image));
  viewer.explanations.push_back({0, 0, name, name});
  viewer.places.push_back({name, name, {{0, 0, "a"}}});
  viewer.explain_command = name;
  const std::string html = viewer_part(viewer, figure(image, name, escaped(name)), 1) + fact(name, name, name) +
                           reproduce_part(name) + heading_part(name) + page_head(name);
  CHECK(html.find("alert(1)</script>") == std::string::npos);
  CHECK(html.find("<img src=x") == std::string::npos);
  const std::string start = "id=\"viewer-manifest\">";
  const size_t begin = html.find(start) + start.size();
  const auto manifest = nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin));
  CHECK(manifest["layers"][0]["name"] == name);
  const std::string packed = bytes_of_base64(script_lines(html, "viewer-explanations")[0]);
  std::string text(10000, '\0');
  uLongf length = uLongf(text.size());
  REQUIRE(uncompress(reinterpret_cast<Bytef*>(text.data()), &length, reinterpret_cast<const Bytef*>(packed.data()),
                     uLong(packed.size())) == Z_OK);
  CHECK(nlohmann::json::parse(text.substr(0, length))[0]["text"] == name);
  CHECK(manifest["explain"] == name);
}

}  // namespace trueshade
