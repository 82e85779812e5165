// Lights as buffers: sample i is light i, from numbers, tables and pictures; and what is not so is refused in one line.
#include "scenes/files/light_buffers.h"

#include <cmath>
#include <cstring>

#include "expect_error.h"
#include "scenes/builtin/pcg32.h"
#include "scenes/scene.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

using Samples = std::vector<glm::vec3>;

Samples from_csv(std::string_view text, uint64_t most = 100) { return samples_from_csv(text, "l.csv", most); }

TEST_CASE("a table's line i is sample i, however its numbers are set apart") {
  const Samples expected{{1.0f, -2.5f, 3e4f}, {0.0f, 1.0f, 0.125f}};
  for (const char* text : {"1,-2.5,3e4\n0,1,0.125\n", "1;-2.5;3e4\r\n0;1;.125\r\n",
                           "tx\tty\ttz\n1\t-2.5\t3e4\n0\t1\t0.125", "r, g, b\n 1 , -2.5 , 3e4 \n\n0 1  0.125\n\n"}) {
    INFO(text);
    CHECK(from_csv(text) == expected);
  }
  CHECK(from_csv("").empty());
  CHECK(from_csv("x,y,z\n").empty());
}

TEST_CASE("tables that are no three numbers a line are refused with the line") {
  const std::pair<const char*, const char*> cases[] = {
      {"1,2\n", "l.csv: line 1: found 2 values"},
      {"1,2,3\n4,5,6,7\n", "l.csv: line 2: found 4 values"},
      {"1,2,3\nx,y,z\n", "l.csv: line 2: found 'x'"},
      {"x,y,1\n", "l.csv: line 1: found 'x'"},
      {"1,2,3\n1,,3\n", "l.csv: line 2: found ''"},
      {"1,2,3,\n", "l.csv: line 1: found 4 values"},
      {"1,2,nan\n", "l.csv: line 1: found 'nan'"},
      {"1,inf,3\n", "l.csv: line 1: found 'inf'"},
      {"1,2,1e999\n", "l.csv: line 1: found '1e999'"},
      {"1,2,0x10\n", "l.csv: line 1: found '0x10'"},
      {"1,2,3\n1,2,3\x1b[2J\n", "l.csv: line 2: found '3?[2J'"},
      {"a,b,c\nd,e,f\n", "l.csv: line 2: found 'd'"},
  };
  for (const auto& [text, start] : cases) {
    INFO(text);
    CHECK_STARTS_WITH(error_of(ErrorKind::bad_input, [&, t = text] { from_csv(t); }), start);
  }
  CHECK_STARTS_WITH(error_of(ErrorKind::limit, [] { from_csv("1,2,3\n1,2,3\n1,2,3\n", 2); }), "l.csv: the lights");
}

TEST_CASE("a table of any bytes is read or refused, and what is read is finite") {
  constexpr std::string_view kAlphabet = "0123456789.,;\t -+eEnainf\r\nx\"\x80\x00";
  Pcg32 random(7);
  size_t read = 0, refused = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string text = round % 2 == 0 ? "1,2,3\n4,5,6\n" : "";
    for (uint32_t i = random.below(round % 2 == 0 ? 3 : 24); i > 0; --i)
      text.insert(random.below(uint32_t(text.size()) + 1), 1, kAlphabet[random.below(uint32_t(kAlphabet.size()))]);
    try {
      for (const glm::vec3& sample : from_csv(text))
        for (int k = 0; k < 3; ++k) REQUIRE(std::isfinite(sample[k]));
      ++read;
    } catch (const Error& error) {
      REQUIRE(error.kind() == ErrorKind::bad_input);
      REQUIRE(std::string(error.what()).find('\n') == std::string::npos);
      ++refused;
    }
  }
  CHECK(read > 1000);
  CHECK(refused > 1000);
}

Image float_picture(int width, int height) {
  Image image(width, height, Format::rgba32f);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float texel[4] = {float(x), float(y), 0.5f, 1.0f};
      std::memcpy(image.texel(x, y), texel, sizeof texel);
    }
  return image;
}

TEST_CASE("a picture's texels are samples, rows top first") {
  CHECK(samples_from_image(float_picture(2, 2), "p.exr", 9) ==
        Samples{{0.0f, 0.0f, 0.5f}, {1.0f, 0.0f, 0.5f}, {0.0f, 1.0f, 0.5f}, {1.0f, 1.0f, 0.5f}});
  error_of(ErrorKind::bad_input, [] { samples_from_image(Image(1, 1, Format::rgba8), "p.png", 9); });
  error_of(ErrorKind::limit, [] { samples_from_image(float_picture(4, 3), "p.exr", 11); });
}

/// A decoder that knows one picture.
Image decoded(std::span<const uint8_t> content, const std::string& where, uint64_t) {
  if (content.size() != 11) throw Error(ErrorKind::bad_input, where, "it is no picture", "one");
  return float_picture(3, 1);
}

Scene load_lights(const std::string& lights, const ImageDecoder& decode = decoded) {
  const ScratchFolder scratch;
  scratch.write("p.csv", "tx,ty,tz\n1,2,3\n4,5,6\n7,8,9\n");
  scratch.write("two.csv", "1,1,1\n1,1,1\n");
  scratch.write("dark.csv", "1,1,1\n1,-1,1\n1,1,1\n");
  scratch.write("c.exr", "\x76\x2f\x31\x01picture");
  scratch.write("torn.exr", "\x76\x2f\x31\x01");
  scratch.write("empty.exr", "");
  scratch.write("text.exr", "1,2,3\n4,5,6\n");
  scratch.write("png.exr", "\x89PNG\r\n\x1a\n");
  return load_scene(scratch.write("s.json", R"({"version": 1, "lights": [)" + lights + "]}"), {}, decode);
}

TEST_CASE("sample i of each buffer is light i, from numbers, a table and a picture alike") {
  const Scene scene = load_lights(R"({"type": "ambient"}, {"type": "buffers", "position": "p.csv", "color": "c.exr",
      "falloff": [[1, 0, 1], [1, 0, 2], [1, 0, 3]], "intensity": 2, "range": 9})");
  REQUIRE(scene.lights.size() == 4);
  for (int i = 0; i < 3; ++i) {
    const Light& light = scene.lights[size_t(i) + 1];
    CHECK(light.type == LightType::point);
    CHECK(light.position == glm::vec3(float(3 * i + 1), float(3 * i + 2), float(3 * i + 3)));
    CHECK(light.color == glm::vec3(2.0f * float(i), 0.0f, 1.0f));
    CHECK(light.attenuation == glm::vec3(1.0f, 0.0f, float(i + 1)));
    CHECK(light.range == 9.0f);
  }
  const Scene bare = load_lights(R"({"type": "buffers", "position": [[0, 0, 0]]})");
  CHECK(bare.lights[0].color == glm::vec3(1.0f));
  CHECK(bare.lights[0].attenuation == glm::vec3(1.0f, 0.0f, 0.0f));
  CHECK(load_lights(R"({"type": "buffers", "position": []})").lights.empty());
}

TEST_CASE("buffers that do not fit are refused at their place") {
  const std::pair<const char*, const char*> cases[] = {
      {R"({"type": "buffers"})", "s.json: /lights/0: 'position' is missing"},
      {R"({"type": "buffers", "position": [[0, 0]]})", "s.json: /lights/0/position/0: found an array of 2"},
      {R"({"type": "buffers", "position": 3})", "s.json: /lights/0/position: found 3 (a string)"},
      {R"({"type": "buffers", "position": "p.csv", "color": "two.csv"})",
       "s.json: /lights/0: 'color' has 2 samples, 'position' 3"},
      {R"({"type": "buffers", "position": "p.csv", "falloff": []})", "s.json: /lights/0: 'falloff' has 0 samples"},
      {R"({"type": "buffers", "position": "p.csv", "color": "dark.csv"})",
       "s.json: /lights/0/color: sample 1 is out of range"},
      {R"({"type": "buffers", "position": "p.txt"})", "s.json: /lights/0/position: the ending names no format"},
      {R"({"type": "buffers", "position": "../p.csv"})", "s.json: /lights/0/position: the path leaves"},
      {R"({"type": "buffers", "position": "torn.exr"})", "s.json: /lights/0/position: torn.exr: it is no picture"},
      {R"({"type": "buffers", "position": "empty.exr"})",
       "s.json: /lights/0/position: empty.exr: it is no EXR (a .csv table or an .exr)"},
      {R"({"type": "buffers", "position": "text.exr"})",
       "s.json: /lights/0/position: text.exr: it is no EXR (a .csv table or an .exr)"},
      {R"({"type": "buffers", "position": "p.csv", "color": "png.exr"})",
       "s.json: /lights/0/color: png.exr: it is no EXR (a .csv table or an .exr)"},
      {R"({"type": "buffers", "position": "p.csv", "intensity": 1e18, "color": [[1, 1, 1], [2, 1, 1], [1, 1, 1]]})",
       "s.json: light 1: 'color' is out of range"},
  };
  for (const auto& [lights, start] : cases) {
    INFO(lights);
    const std::string message = error_of(ErrorKind::bad_input, [&, l = lights] { load_lights(l); });
    CHECK_STARTS_WITH(message.substr(message.find("s.json")), start);
  }
  error_of(ErrorKind::io, [] { load_lights(R"({"type": "buffers", "position": "absent.csv"})"); });
  error_of(ErrorKind::bad_input, [] { load_lights(R"({"type": "buffers", "position": "c.exr"})", {}); });
}

}  // namespace
}  // namespace trueshade
