#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "expect_error.h"
#include "scene_text.h"
#include "scenes/builtin/texture_pattern.h"
#include "scenes/scene.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

/// A decoder that knows one format: the first byte is the width, the second the height, then RGBA codes.
Image plain(std::span<const uint8_t> content, const std::string& where, uint64_t most_bytes) {
  if (content.size() < 2) throw Error(ErrorKind::bad_input, where, "it is cut off", "write it again");
  Image image(content[0], content[1], Format::rgba8);
  if (image.texels.size() > most_bytes) throw Error(ErrorKind::limit, where, "too large", "a smaller one");
  std::copy(content.begin() + 2, content.end(), image.texels.begin());
  return image;
}

std::string tex_file(int width, int height, uint8_t step) {
  std::string bytes{char(width), char(height)};
  for (int i = 0; i < width * height * 4; ++i) bytes += char(i * step);
  return bytes;
}

Scene load_with_pictures(const std::string& text, const SceneLimits& limits = {}) {
  const ScratchFolder scratch;
  scratch.write("two.tex", tex_file(2, 2, 1));
  scratch.write("one.tex", tex_file(1, 1, 1));
  std::filesystem::create_directory(scratch.path("folder"));
  return load_scene(scratch.write("s.json", text), limits, plain);
}

std::string texture_refusal(const std::string& text, ErrorKind kind = ErrorKind::bad_input,
                            const SceneLimits& limits = {}) {
  return from_file_name(error_of(kind, [&] { load_with_pictures(text, limits); }));
}

std::string textures(const std::string& list, const std::string& material = "") {
  return R"({"version": 1, "textures": [)" + list + R"(], "materials": [)" + material + "]}";
}
std::string material_mapped(const std::string& map) {
  return R"({"name": "m", "color": [1, 1, 1], "color_map": {"texture": "t")" + map + "}}";
}

TEST_CASE("a texture's rows start at v = 0, which is a picture's bottom unless it says otherwise") {
  const Scene lower = load_with_pictures(textures(R"({"name": "t", "file": "two.tex"})"));
  const Scene upper = load_with_pictures(textures(R"({"name": "t", "file": "two.tex", "origin": "upper_left"})"));
  REQUIRE(lower.textures.size() == 1);
  CHECK(lower.textures[0].format == TextureFormat::srgb8_a8);
  CHECK(lower.textures[0].levels[0].bytes ==
        std::vector<uint8_t>{8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7});
  CHECK(upper.textures[0].levels[0].bytes ==
        std::vector<uint8_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15});
}

TEST_CASE("pictures of 16 bits a channel keep every code, linear or decoded from sRGB and rounded once") {
  const ImageDecoder every_code = [](std::span<const uint8_t>, const std::string&, uint64_t) {
    Image image(256, 256, Format::rgba16);
    for (size_t i = 0; i < image.texels.size() / 2; ++i)
      image.texels[2 * i] = uint8_t(i / 4), image.texels[2 * i + 1] = uint8_t(i / 4 >> 8);
    return image;
  };
  const ScratchFolder scratch;
  scratch.write("p.png", "read by the decoder above");
  for (const bool srgb : {false, true}) {
    const std::string about =
        srgb ? R"(, "origin": "upper_left")" : R"(, "origin": "upper_left", "encoding": "linear")";
    const std::string file = scratch.write("s.json", textures(R"({"name": "t", "file": "p.png")" + about + "}"));
    const Texture texture = load_scene(file, {}, every_code).textures.at(0);
    REQUIRE(texture.format == TextureFormat::rgba32f);
    int wrong = 0, repeated = 0;
    float last = -1.0f;
    for (int code = 0; code < 65536; ++code) {
      const std::array<float, 4> texel = texel_value(texture, 0, code % 256, code / 256);
      const long double value = code / 65535.0L;
      const long double linear = !srgb               ? value
                                 : value <= 0.04045L ? value / 12.92L
                                                     : std::pow((value + 0.055L) / 1.055L, 2.4L);  // IEC 61966-2-1
      wrong += texel[0] != float(linear) || texel[3] != float(value);
      repeated += !(texel[0] > last);
      last = texel[0];
    }
    CAPTURE(srgb);
    CHECK(wrong == 0);
    CHECK(repeated == 0);
  }
}

TEST_CASE("patterns and levels that are made count against the limit of textures") {
  SceneLimits limits;
  const std::string pattern = textures(R"({"name": "t", "pattern": {"type": "checker", "size": [16, 16]}})");
  limits.texture_bytes = 16 * 16 * 4;
  CHECK(load_with_pictures(pattern, limits).textures.size() == 1);
  limits.texture_bytes -= 1;
  CHECK_STARTS_WITH(texture_refusal(pattern, ErrorKind::limit, limits),
                    "s.json: /textures/0/pattern: with its 1024 bytes");
  const std::string mapped =
      textures(R"({"name": "t", "pattern": {"type": "checker", "size": [16, 16]}})", material_mapped(""));
  limits.texture_bytes = (256 + 64 + 16 + 4 + 1) * 4;
  CHECK(load_with_pictures(mapped, limits).textures[0].levels.size() == 5);
  limits.texture_bytes -= 1;
  CHECK_STARTS_WITH(texture_refusal(mapped, ErrorKind::limit, limits), "s.json: /materials: with its 340 bytes");
}

TEST_CASE("maps say how a texture is read") {
  const Scene scene = load_with_pictures(textures(R"({"name": "t", "file": "two.tex", "encoding": "linear"})", R"(
    {"name": "a", "color": [1, 1, 1], "alpha_cutoff": 0.25, "transparent": true, "normal_scale": -2,
     "color_map": {"texture": "t", "wrap": ["clamp_to_border", "mirrored_repeat"], "mag": "nearest", "min": "linear",
                   "mip": "nearest", "lod_bias": -1.5, "lod_min": 0, "lod_max": 3, "border": [0.5, 0.25, 1, 0.125]},
     "specular_map": {"texture": "t"}, "normal_map": {"texture": "t", "wrap": "mirror_clamp_to_edge"}})"));
  const Material& m = scene.materials.at(0);
  CHECK(scene.textures[0].format == TextureFormat::rgba8);
  CHECK(m.alpha_cutoff == 0.25f);
  CHECK(m.transparent);
  CHECK(m.normal_scale == -2.0f);
  const Sampler expected{{Wrap::clamp_to_border, Wrap::mirrored_repeat},
                         Filter::nearest,
                         Filter::linear,
                         MipFilter::nearest,
                         -1.5f,
                         0.0f,
                         3.0f,
                         {0.5f, 0.25f, 1.0f, 0.125f}};
  CHECK(m.color_map.sampler == expected);
  CHECK(m.specular_map.sampler == Sampler{});
  CHECK(m.normal_map.sampler.wrap == std::array<Wrap, 2>{Wrap::mirror_clamp_to_edge, Wrap::mirror_clamp_to_edge});
  CHECK(scene.textures[0].levels.size() == 2);  // 2x2 and 1x1: some map reads between levels
}

TEST_CASE("maps say at which coordinates they are read, and materials what glTF's have besides") {
  const Scene scene = load_with_pictures(textures(R"({"name": "t", "file": "two.tex", "encoding": "linear"})", R"(
    {"name": "a", "color": [1, 1, 1], "occlusion_strength": 0.5, "unlit": true, "double_sided": true,
     "emission_map": {"texture": "t", "uv_set": 1, "uv_offset": [1, -2], "uv_rotation_deg": 180, "uv_scale": [3, 4]},
     "metallic_roughness_map": {"texture": "t", "mip": "none"}, "occlusion_map": {"texture": "t"}}, {"name": "b", "color": [1, 1, 1]})"));
  const Material &m = scene.materials.at(0), &plain = scene.materials.at(1);
  CHECK(m.emission_map.uv_set == 1);  // sources are counted by their sets
  CHECK(m.metallic_roughness_map.used());
  CHECK(m.occlusion_map.uv_set == 0);
  CHECK(m.occlusion_strength == 0.5f);
  CHECK(m.unlit);
  CHECK(m.double_sided);
  CHECK(m.textured());
  CHECK(!plain.textured());
  CHECK(scene.textures[0].levels.size() == 2);
  const auto map = [](const std::string& more) {
    return texture_refusal(textures(R"({"name": "t", "file": "two.tex"})", material_mapped(more)));
  };
  CHECK_STARTS_WITH(map(R"(, "uv_set": 6)"), "s.json: /materials/0/color_map/uv_set: found 6");
  CHECK_STARTS_WITH(map(R"(, "uv_scale": [1])"), "s.json: /materials/0/color_map/uv_scale: found an array of 1");
  CHECK_STARTS_WITH(map(R"(, "uv_offset": [1, 1e7])"), "s.json: /materials/0/color_map/uv_offset/1: found 1e+07");
}

TEST_CASE("what glTF's materials have moves the hash of scenes that say it, and of no others") {
  Scene scene = load_with_pictures(textures(R"({"name": "t", "file": "two.tex"})", material_mapped("")));
  const std::string before = scene_hash(scene);
  const auto changed = [&](const auto& change) {
    Scene other = scene;
    change(other);
    validate(other);
    return scene_hash(other) != before;
  };
  CHECK(changed([](Scene& s) { s.materials[0].unlit = true; }));
  CHECK(changed([](Scene& s) { s.materials[0].double_sided = true; }));
  CHECK(changed([](Scene& s) { s.materials[0].occlusion_strength = 0.5f; }));
  CHECK(changed([](Scene& s) { s.materials[0].emission_map = s.materials[0].color_map; }));
  CHECK(changed([](Scene& s) { s.materials[0].color_map.uv_set = 1; }));
  CHECK(!changed([](Scene& s) { s.materials[0].normal_map.uv_set = 1; }));  // of no texture
  scene.meshes.push_back({"", {{{0.0f}, {0.0f}, {0.0f}}}, {{{0.0f}, {0.0f}, {1.0f}}}, {}, {}, {}, {}, {}});
  std::string hashes[3] = {scene_hash(scene)};
  for (size_t sets = 1; sets < 3; ++sets) {
    scene.meshes[0].more_uv.assign(sets, {});
    scene.meshes[0].more_uv.back() = {{{0.5f}, {0.25f}}};
    hashes[sets] = scene_hash(scene);
  }
  CHECK(hashes[0] != hashes[1]);
  CHECK(hashes[0] != hashes[2]);
  CHECK(hashes[1] != hashes[2]);
}

TEST_CASE("levels come from files or are made where a map reads them") {
  const Scene given = load_with_pictures(
      textures(R"({"name": "t", "levels": ["two.tex", "one.tex"], "encoding": "linear"})", material_mapped("")));
  REQUIRE(given.textures[0].levels.size() == 2);
  CHECK(given.textures[0].levels[1].bytes == std::vector<uint8_t>{0, 1, 2, 3});
  const Scene unread =
      load_with_pictures(textures(R"({"name": "t", "file": "two.tex"})", material_mapped(R"(, "mip": "none")")));
  CHECK(unread.textures[0].levels.size() == 1);
}

TEST_CASE("bad textures are refused with their place") {
  CHECK_STARTS_WITH(texture_refusal(textures(R"({"name": "t"})")),
                    "s.json: /textures/0: a texture has 'file', 'levels'");
  CHECK_STARTS_WITH(texture_refusal(textures(R"({"name": "t", "file": "/etc/passwd"})")),
                    "s.json: /textures/0/file: the path is absolute");
  CHECK_STARTS_WITH(texture_refusal(textures(R"({"name": "t", "file": "../two.tex"})")),
                    "s.json: /textures/0/file: the path leaves the scene's folder");
  CHECK_STARTS_WITH(texture_refusal(textures(R"({"name": "t", "file": "http://x/two.tex"})")),
                    "s.json: /textures/0/file: the path has a scheme");
  CHECK_STARTS_WITH(texture_refusal(textures(R"({"name": "t", "file": "absent.png"})"), ErrorKind::io),
                    "s.json: /textures/0/file: absent.png: No such file");
  CHECK_STARTS_WITH(texture_refusal(textures(R"({"name": "t", "file": "folder"})")),
                    "s.json: /textures/0/file: folder: this is no regular file");
  CHECK_STARTS_WITH(texture_refusal(textures(R"({"name": "t", "levels": ["two.tex", "two.tex"]})")),
                    "s.json: /textures/0/levels/1: the level has the wrong size");
  CHECK_STARTS_WITH(texture_refusal(textures(R"({"name": "t", "file": "one.tex"}, {"name": "t", "file": "one.tex"})")),
                    "s.json: /textures/1: a texture of this name exists");
  CHECK_STARTS_WITH(texture_refusal(textures("", material_mapped(""))),
                    "s.json: /materials/0/color_map/texture: no texture has");
  CHECK_STARTS_WITH(texture_refusal(textures(R"({"name": "t", "file": "one.tex"})",
                                             material_mapped(R"(, "lod_min": 2, "lod_max": 1)"))),
                    "s.json: /materials/0/color_map: lod_min is above lod_max");
  CHECK_STARTS_WITH(texture_refusal(textures(R"({"name": "t", "pattern": {"type": "checker", "size": [0, 4]}})")),
                    "s.json: /textures/0/pattern/size/0");
  CHECK_STARTS_WITH(texture_refusal(textures(R"({"name": "t", "pattern": {"type": "checker", "size": [16385, 4]}})")),
                    "s.json: /textures/0/pattern/size/0");
  CHECK_STARTS_WITH(texture_refusal(textures(R"({"name": "t", "file": "one.tex", "wrap": "repeat"})")),
                    "s.json: /textures/0");
  SceneLimits small;
  small.texture_bytes = 15;
  CHECK_STARTS_WITH(texture_refusal(textures(R"({"name": "t", "file": "two.tex"})"), ErrorKind::limit, small),
                    "s.json: /textures/0/file: two.tex: too large");
}

TEST_CASE("without a decoder only patterns are textures") {
  const ScratchFolder scratch;
  scratch.write("one.tex", tex_file(1, 1, 1));
  const std::string file = scratch.write("s.json", textures(R"({"name": "t", "file": "one.tex"})"));
  const std::string message = error_of(ErrorKind::bad_input, [&] { load_scene(file); });
  CHECK(message.find("this program reads no image files") != std::string::npos);
  CHECK(
      load_scene(scratch.write("p.json", textures(R"({"name": "t", "pattern": {"type": "brick"}})"))).textures.size() ==
      1);
}

Texture float_texture(int width, int height, const std::vector<float>& values) {
  Texture texture{"", TextureFormat::rgba32f, {{width, height, {}}}};
  for (const float v : values) append_texel(texture.format, {v, v, v, 1.0f}, texture.levels[0].bytes);
  return texture;
}

Scene scene_with(const Texture& texture) {
  Scene scene;
  scene.spec = "test";
  scene.textures.push_back(texture);
  Material m;
  m.color_map.texture = 0;
  scene.materials.push_back(m);
  return scene;
}

TEST_CASE("texels that are no colours, sizes that do not fit and samplers out of range are refused") {
  const Texture good = float_texture(2, 1, {0.0f, 1.0f});
  CHECK_NOTHROW(validate(scene_with(good)));
  const float kBad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1.0f, 2e18f};
  for (const float bad : kBad) {
    INFO(bad);
    CHECK_STARTS_WITH(error_of(ErrorKind::bad_input,
                               [&] {
                                 validate(scene_with(float_texture(2, 1, {0.0f, bad})));
                               }),
                      "test: texture 0: a texel is out of range");
  }
  const auto refused = [&](auto&& change) {
    Scene scene = scene_with(good);
    change(scene);
    error_of(ErrorKind::bad_input, [&] { validate(scene); });
  };
  refused([](Scene& s) { s.textures[0].levels.clear(); });
  refused([](Scene& s) { s.textures[0].levels[0].width = 0; });
  refused([](Scene& s) { s.textures[0].levels[0].width = 1 << 20; });
  refused([](Scene& s) { s.textures[0].levels[0].bytes.pop_back(); });
  refused([](Scene& s) { s.textures[0].levels.push_back(s.textures[0].levels[0]); });
  refused([](Scene& s) { s.materials[0].color_map.texture = 1; });
  refused([](Scene& s) { s.materials[0].color_map.sampler.lod_bias = std::numeric_limits<float>::quiet_NaN(); });
  refused([](Scene& s) {
    s.materials[0].color_map.sampler.lod_min = 3.0f, s.materials[0].color_map.sampler.lod_max = 2.0f;
  });
  refused([](Scene& s) { s.materials[0].color_map.sampler.border.x = -1.0f; });
  refused([](Scene& s) { s.materials[0].alpha_cutoff = 2.0f; });
  refused([](Scene& s) { s.materials[0].normal_scale = std::numeric_limits<float>::infinity(); });
  refused([](Scene& s) {  // the product would not stay in the range of colours
    s.materials[0].base_color = glm::vec4(1e18f, 1e18f, 1e18f, 1.0f);
    s.textures[0] = float_texture(1, 1, {2.0f});
  });
}

/// Mean of a row of texels over [first, end) in texels, as an integral of the step function.
long double mean(const std::vector<float>& texels, long double first, long double end) {
  long double sum = 0;
  for (size_t i = 0; i < texels.size(); ++i) {
    const long double low = std::max<long double>(first, i), high = std::min<long double>(end, i + 1);
    if (high > low) sum += (high - low) * texels[i];
  }
  return sum / (end - first);
}

TEST_CASE("a level of even sides is four texels' mean, stored as a texel is stored") {
  for (const TextureFormat format : {TextureFormat::rgba8, TextureFormat::srgb8_a8}) {
    Texture texture{"t", format, {{256, 64, {}}}};
    uint32_t state = 1;
    for (int i = 0; i < 4 * 256 * 64; ++i) {
      state = state * 1664525u + 1013904223u;
      texture.levels[0].bytes.push_back(
          uint8_t(i % 1024 < 512 ? state >> 24 : state >> 24 & 15));  // half of it is dark
    }
    build_mip_chain(texture);
    std::vector<uint8_t> expected;
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 128; ++x) {
        std::array<float, 4> mean{};
        for (size_t c = 0; c < 4; ++c) {
          const auto at = [&](int i, int j) { return double(texel_value(texture, 0, 2 * x + i, 2 * y + j)[c]); };
          mean[c] = float(((at(0, 0) + at(1, 0)) / 2 + (at(0, 1) + at(1, 1)) / 2) / 2);
        }
        append_texel(format, mean, expected);
      }
    CHECK(texture.levels[1].bytes == expected);
  }
}

TEST_CASE("a level of the mip chain is the mean of what its texels cover, whatever the size") {
  for (int n : {1, 2, 3, 4, 5, 7, 8, 15, 31, 63, 100, 127, 255, 1000}) {
    INFO("width " << n);
    std::vector<float> values;
    for (int i = 0; i < n; ++i) values.push_back(float((i * 7919 + 13) % 1009) / 1009.0f);
    Texture texture = float_texture(n, 1, values);
    build_mip_chain(texture);
    for (size_t k = 1; k < texture.levels.size(); ++k) {
      const int above = texture.levels[k - 1].width, width = texture.levels[k].width;
      REQUIRE(width == std::max(1, n >> k));
      std::vector<float> from;
      for (int i = 0; i < above; ++i) from.push_back(texel_value(texture, k - 1, i, 0)[0]);
      for (int i = 0; i < width; ++i) {
        const long double step = (long double)above / width;
        const long double exact = mean(from, step * i, step * (i + 1));
        const float got = texel_value(texture, k, i, 0)[0];
        CHECK(std::fabs(got - exact) <= 0x1p-24L * exact * 1.0001L);  // half an ulp, but for the f64 sums before
      }
    }
    CHECK(texture.levels.back().width == 1);
  }
}

TEST_CASE("a constant texture has constant levels, and a column is a row turned") {
  Texture flat = float_texture(13, 7, std::vector<float>(91, 0.37f));
  build_mip_chain(flat);
  REQUIRE(flat.levels.size() == 4);
  for (size_t k = 0; k < flat.levels.size(); ++k)
    for (int y = 0; y < flat.levels[k].height; ++y)
      for (int x = 0; x < flat.levels[k].width; ++x) CHECK(texel_value(flat, k, x, y)[0] == 0.37f);
  Texture row = float_texture(5, 1, {1, 2, 4, 8, 16}), column = float_texture(1, 5, {1, 2, 4, 8, 16});
  build_mip_chain(row), build_mip_chain(column);
  REQUIRE(row.levels.size() == column.levels.size());
  for (size_t k = 0; k < row.levels.size(); ++k) CHECK(row.levels[k].bytes == column.levels[k].bytes);
}

TEST_CASE("levels are averaged as light, not as codes") {  // docs/gl_rules.md rows 36 and 59
  Texture texture{"", TextureFormat::srgb8_a8, {{2, 1, {0, 0, 0, 0, 255, 255, 255, 255}}}};
  build_mip_chain(texture);
  CHECK(texture.levels[1].bytes == std::vector<uint8_t>{188, 188, 188, 128});
  texture.format = TextureFormat::rgba8;
  build_mip_chain(texture);
  CHECK(texture.levels[1].bytes == std::vector<uint8_t>{128, 128, 128, 128});
}

TEST_CASE("texels read as OpenGL says") {  // docs/gl_rules.md rows 37 and 38
  Texture codes{"", TextureFormat::rgba8, {{256, 1, {}}}};
  for (int k = 0; k < 256; ++k)
    for (int c = 0; c < 4; ++c) codes.levels[0].bytes.push_back(uint8_t(k));
  for (int k = 0; k < 256; ++k) CHECK(texel_value(codes, 0, k, 0)[1] == float((long double)k / 255));
  codes.format = TextureFormat::srgb8_a8;
  for (int k = 0; k < 256; ++k) {
    const long double s = (long double)k / 255;
    const long double linear = s <= 0.04045L ? s / 12.92L : std::pow((s + 0.055L) / 1.055L, 2.4L);
    const float got = texel_value(codes, 0, k, 0)[0], next = std::nextafter(got, 2.0f);
    CHECK(std::fabs(got - linear) <= (long double)next - got);
    CHECK(texel_value(codes, 0, k, 0)[3] == float((long double)k / 255));
  }
  Texture halves{"", TextureFormat::rgba16f, {{1, 1, {0x00, 0x38, 0x01, 0x00, 0xff, 0x7b, 0x00, 0x3c}}}};
  CHECK(texel_value(halves, 0, 0, 0) == std::array<float, 4>{0.5f, 0x1p-24f, 65504.0f, 1.0f});
}

TEST_CASE("patterns repeat without a seam and follow their seed") {
  TexturePattern p;
  p.width = 64, p.height = 32, p.columns = 4, p.rows = 2, p.format = TextureFormat::rgba32f;
  const Texture checker = texture_of(p);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x) CHECK(texel_value(checker, 0, x, y)[0] == ((x / 16 + y / 16) % 2 == 0 ? 1.0f : 0.2f));
  for (const Pattern pattern : {Pattern::brick, Pattern::noise}) {
    p.pattern = pattern, p.seed = 5;
    const Texture one = texture_of(p);
    p.seed = 6;
    const Texture other = texture_of(p);
    CHECK(one.levels[0].bytes != other.levels[0].bytes);
    CHECK_NOTHROW(validate(scene_with(one)));
    // Twice the cells over twice the texels, read over the first half: the lattice is the same where it has not
    // wrapped.
    float low = 2.0f, high = -1.0f;
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 64; ++x) {
        low = std::min(low, texel_value(one, 0, x, y)[0]);
        high = std::max(high, texel_value(one, 0, x, y)[0]);
      }
    CHECK(low >= 0.2f);
    CHECK(high <= 1.0f);
    CHECK(high - low > 0.3f);
  }
  float across = 0.0f, seam = 0.0f;  // noise is continuous, at the seam too
  p.width = 256;
  const Texture noise = texture_of(p);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x + 1 < 256; ++x)
      across = std::max(across, std::fabs(texel_value(noise, 0, x, y)[0] - texel_value(noise, 0, x + 1, y)[0]));
    seam = std::max(seam, std::fabs(texel_value(noise, 0, 255, y)[0] - texel_value(noise, 0, 0, y)[0]));
  }
  CHECK(seam <= across);
}

TEST_CASE("a scene's hash covers texels and samplers, and names none") {
  const Scene plain_scene = scene_with(float_texture(2, 1, {0.25f, 0.5f}));
  const std::string hash = scene_hash(plain_scene);
  const auto changed = [&](auto&& change) {
    Scene scene = plain_scene;
    change(scene);
    return scene_hash(scene) != hash;
  };
  CHECK(changed([](Scene& s) { s.textures[0] = float_texture(2, 1, {0.25f, 0.75f}); }));
  CHECK(changed([](Scene& s) { s.materials[0].color_map.sampler.lod_bias = 1.0f; }));
  CHECK(changed([](Scene& s) { s.materials[0].color_map.sampler.wrap[1] = Wrap::clamp_to_edge; }));
  CHECK(changed([](Scene& s) { s.materials[0].alpha_cutoff = 0.5f; }));
  CHECK(changed([](Scene& s) { s.materials[0].transparent = true; }));
  CHECK(changed([](Scene& s) { s.materials[0].specular_map = s.materials[0].color_map; }));
  CHECK_FALSE(changed([](Scene& s) { s.textures[0].name = "other"; }));
  Scene codes = plain_scene, values = plain_scene;  // the same values in another format
  codes.textures[0] = {"", TextureFormat::rgba8, {{1, 1, {255, 0, 255, 255}}}};
  values.textures[0] = {"", TextureFormat::rgba32f, {{1, 1, {}}}};
  append_texel(TextureFormat::rgba32f, {1.0f, 0.0f, 1.0f, 1.0f}, values.textures[0].levels[0].bytes);
  CHECK(scene_hash(codes) == scene_hash(values));
}

}  // namespace
}  // namespace trueshade
