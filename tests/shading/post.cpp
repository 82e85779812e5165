// The post chain against independent formulas (docs/post.md): long double, exact sums, pictures that must not change.
#include "shading/output/post.h"

#include <cmath>
#include <cstring>
#include <random>

#include "core/simd/simd_target.h"
#include "core/srgb.h"
#include "scenes/pipeline/presets.h"
#include "scenes/scene.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/shading/square_mesh.h"

using namespace trueshade;

namespace {

Picture filled(int width, int height, float r, float g, float b) {
  Picture out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float value[4] = {r, g, b, 1.0f};
      std::memcpy(out.at(x, y), value, sizeof value);
    }
  return out;
}

Picture noise(int width, int height, uint64_t seed, double most) {
  std::mt19937_64 random(seed);
  Picture out(width, height);
  for (float& value : out.values) value = float(most * double(random() >> 11) * 0x1p-53);
  return out;
}

Frame frame_with_post(const Scene& scene, const Pipeline& pipeline, const Execution& execution = {}) {
  return render_frame(scene, pipeline, execution);
}

Pipeline small(int width, int height) {
  Pipeline p = *preset_pipeline("many-lights");
  p.width = width;
  p.height = height;
  p.target = Format::rgba32f;
  return p;
}

float value_at(const Image& image, int x, int y, int channel) {
  float value;
  std::memcpy(&value, image.texel(x, y) + 4 * channel, 4);
  return value;
}

}  // namespace

TEST_CASE("Supersampling is the box average of the larger render", "[post]") {
  const Scene scene = load_scene("builtin:cornell");
  for (const int samples : {2, 3}) {
    Pipeline pipeline = small(31, 23), large = small(31 * samples, 23 * samples);
    pipeline.post.samples = samples;
    pipeline.post.output = Format::rgba32f;
    const Image got = frame_with_post(scene, pipeline).color, from = frame_with_post(scene, large).color;
    for (int y = 0; y < 23; ++y)
      for (int x = 0; x < 31; ++x)
        for (int c = 0; c < 4; ++c) {
          long double sum = 0;
          for (int j = 0; j < samples; ++j)
            for (int i = 0; i < samples; ++i) sum += (long double)value_at(from, samples * x + i, samples * y + j, c);
          const long double mean = sum / (samples * samples);
          CAPTURE(samples, x, y, c);
          CHECK(std::fabs((long double)value_at(got, x, y, c) - mean) <= mean * samples * 2 * 0x1p-24L);
        }
  }
}

TEST_CASE("A pixel half covered by a white square comes out as exactly one half", "[post]") {
  Scene scene;
  scene.meshes = {testing::square_mesh()};
  scene.materials.resize(1);
  scene.instances.resize(1);
  Light ambient;
  ambient.type = LightType::ambient;
  scene.lights = {ambient};
  // x and y as they are: the square ends at ndc 1/2 and -1/2, in 10 pixels at 7.5 and 2.5.
  scene.camera.clip_from_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  Pipeline pipeline = small(10, 10);
  pipeline.post.output = Format::rgba32f;
  for (const int samples : {2, 4, 8}) {
    pipeline.post.samples = samples;
    const Image image = frame_with_post(scene, pipeline).color;
    for (int c = 0; c < 4; ++c) {
      CHECK(value_at(image, 5, 5, c) == 1.0f);
      CHECK(value_at(image, 7, 5, c) == 0.5f);
      CHECK(value_at(image, 2, 5, c) == 0.5f);
      CHECK(value_at(image, 5, 2, c) == 0.5f);
      CHECK(value_at(image, 7, 7, c) == 0.25f);
      CHECK(value_at(image, 8, 5, c) == 0.0f);
    }
  }
}

TEST_CASE("Bloom leaves constant pictures constant and keeps the energy of a point", "[post]") {
  for (const int radius : {1, 2, 5, 8, 14})
    for (const int passes : {1, 3}) {
      const PostChain::Bloom bloom{1.0f, 0.25f, radius, passes};
      Picture flat = filled(37, 21, 1.0f, 0.7f, 0.1f);
      const float expected[] = {1.0f + 0.75f, 0.7f + (0.7f - 0.25f), 0.1f};
      add_bloom(bloom, 2, flat);
      Picture point = filled(161, 161, 0.0f, 0.0f, 0.0f);
      point.at(80, 80)[1] = 1025.25f;
      add_bloom(bloom, 2, point);
      CAPTURE(radius, passes);
      for (int y = 0; y < 21; ++y)
        for (int x = 0; x < 37; ++x)
          for (int c = 0; c < 3; ++c) REQUIRE(flat.at(x, y)[c] == expected[c]);
      long double sum = 0;
      for (int y = 0; y < 161; ++y)
        for (int x = 0; x < 161; ++x) sum += (long double)point.at(x, y)[1];
      // 1024 = 2^10 times weights that add up to 1: what is missing is each blur's one rounding.
      CHECK(std::fabs(sum - 1025.25L - 1025.0L) <= 1025.0L * (2 * passes + 2) * 0x1p-24L);
    }
}

TEST_CASE("A blur of radius r spreads a point by the binomial weights", "[post]") {
  Picture point = filled(9, 9, 0.0f, 0.0f, 0.0f);
  point.at(4, 4)[0] = 1.0f;
  add_bloom({1.0f, 0.0f, 2, 1}, 1, point);
  const float row[] = {0, 0, 1, 4, 6, 4, 1, 0, 0};
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 9; ++x) CHECK(point.at(x, y)[0] == row[x] * row[y] / 256.0f + (x == 4 && y == 4 ? 1.0f : 0.0f));
}

TEST_CASE("Reinhard's operator is its formula in long double", "[post]") {
  for (const float white : {0.0f, 3.0f}) {
    PostChain chain;
    chain.tone_map = PostChain::ToneMap::reinhard;
    chain.key = 0.36f;
    chain.white = white;
    const Picture before = noise(64, 33, 7, 20.0);
    long double logs = 0;
    const auto luma = [](const float* p) {
      return 0.2126L * (long double)p[0] + 0.7152L * (long double)p[1] + 0.0722L * (long double)p[2];
    };
    for (int y = 0; y < 33; ++y)
      for (int x = 0; x < 64; ++x) logs += std::log(1e-4L + luma(before.at(x, y)));
    const long double mean = std::exp(logs / (64 * 33));
    CHECK(std::fabs((long double)logarithmic_mean(before, 1e-4f) - mean) <= mean * 1e-6L);
    Picture after = before;
    map_tones(chain, after);
    for (int y = 0; y < 33; ++y)
      for (int x = 0; x < 64; ++x) {
        const long double l = luma(before.at(x, y)), scaled = 0.36L / mean * l;
        long double mapped = scaled / (1 + scaled);
        if (white > 0) mapped *= 1 + scaled / ((long double)white * (long double)white);
        for (int c = 0; c < 3; ++c) {
          const long double exact = (long double)before.at(x, y)[c] * mapped / l;
          CAPTURE(white, x, y, c);
          REQUIRE(std::fabs((long double)after.at(x, y)[c] - exact) <= exact * 2e-6L);
        }
      }
  }
}

TEST_CASE("A constant picture is mapped to key / (1 + key), and white luminance to 1", "[post]") {
  PostChain chain;
  chain.tone_map = PostChain::ToneMap::reinhard;
  Picture flat = filled(16, 16, 5.0f, 5.0f, 5.0f);
  map_tones(chain, flat);
  CHECK(double(flat.at(3, 3)[0]) == Approx(0.18 / 1.18).epsilon(5e-5));  // the offset of 1e-4 in 5
  chain.white = 0.18f;
  Picture white = filled(16, 16, 5.0f, 5.0f, 5.0f);
  map_tones(chain, white);
  CHECK(double(white.at(3, 3)[0]) == Approx(1.0).epsilon(5e-5));
}

TEST_CASE("No step makes a NaN of hostile floats", "[post]") {
  const float hostile[] = {0.0f, -0.0f, 1e-45f, 1e-20f, 1.0f, 1e18f, 3e38f, INFINITY, -INFINITY, NAN, -1.0f};
  Picture picture(11, 11);
  for (int y = 0; y < 11; ++y)
    for (int x = 0; x < 11; ++x)
      for (int c = 0; c < 4; ++c) picture.at(x, y)[c] = c == 1 ? hostile[y] : hostile[x];
  PostChain chain;
  for (const float white : {0.0f, 1e-6f, 1e18f})
    for (const float key : {1e-6f, 0.18f, 1e6f}) {
      chain.white = white;
      chain.key = key;
      Picture mapped = picture;
      map_tones(chain, mapped);
      encode_srgb(1, mapped);
      const Picture smooth = smoothed_edges(mapped, 1);
      for (int y = 0; y < 11; ++y)
        for (int x = 0; x < 11; ++x)
          for (int c = 0; c < 3; ++c) CHECK((smooth.at(x, y)[c] >= 0.0f && smooth.at(x, y)[c] <= 1.0f));
    }
}

TEST_CASE("sRGB encoding rounds to the nearest code on both sides of every code's limits", "[post]") {
  for (const double start : kSrgbCodeStarts)
    for (const float linear : {std::nextafter(float(start), 0.0f), std::nextafter(float(start), 2.0f)}) {
      const auto code = [](float x) {
        return x <= 0.0031308L ? 12.92L * (long double)x : 1.055L * std::pow((long double)x, 1 / 2.4L) - 0.055L;
      };
      Picture one = filled(1, 1, linear, linear, linear);
      encode_srgb(1, one);
      CHECK(std::fabs((long double)one.at(0, 0)[0] - code(linear)) <= 0x1p-24L);
    }
  Picture ends = filled(1, 1, 0.0f, 1.0f, 7.0f);
  encode_srgb(1, ends);
  CHECK(ends.at(0, 0)[0] == 0.0f);
  CHECK(ends.at(0, 0)[1] == 1.0f);
  CHECK(ends.at(0, 0)[2] == 1.0f);
}

TEST_CASE("The edge filter keeps flat parts and straight level and upright edges bit for bit", "[post]") {
  const Picture flat = filled(40, 30, 0.3f, 0.6f, 0.1f);
  CHECK(smoothed_edges(flat, 1).values == flat.values);
  for (int at = 1; at < 30; ++at)
    for (const bool level : {false, true})
      for (const bool over : {false, true}) {
        Picture half(40, 30);
        for (int y = 0; y < 30; ++y)
          for (int x = 0; x < 40; ++x)
            for (int c = 0; c < 4; ++c) half.at(x, y)[c] = ((level ? y : x) < at) == over ? 0.9f : 0.1f;
        CHECK(smoothed_edges(half, 1).values == half.values);
      }
}

TEST_CASE("The edge filter brings a slanted edge nearer to its coverage, and by symmetry alike on both sides",
          "[post]") {
  // White where y < 8 + x / 8 (pixel centres): the coverage is known.
  const int width = 64, height = 24;
  Picture jagged(width, height);
  const auto line = [](double x) { return 8.0 + x / 8.0; };
  double before = 0, after = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 4; ++c) jagged.at(x, y)[c] = y + 0.5 < line(x + 0.5) ? 1.0f : 0.0f;
  const Picture smooth = smoothed_edges(jagged, 1);
  for (int y = 0; y < height; ++y)
    for (int x = 8; x < width - 8; ++x) {
      const double covered = std::min(std::max(line(x + 0.5) - y, 0.0), 1.0);
      before += std::fabs(double(jagged.at(x, y)[0]) - covered);
      after += std::fabs(double(smooth.at(x, y)[0]) - covered);
      CHECK(jagged.at(x, y)[3] == smooth.at(x, y)[3]);
    }
  CHECK(after < 0.5 * before);
  Picture turned(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 4; ++c) turned.at(x, y)[c] = jagged.at(width - 1 - x, height - 1 - y)[c];
  const Picture smooth_turned = smoothed_edges(turned, 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) CHECK(smooth_turned.at(x, y)[0] == smooth.at(width - 1 - x, height - 1 - y)[0]);
}

TEST_CASE("Light markers are discs of the light's colour where nothing is nearer", "[post]") {
  Scene scene;
  scene.meshes.resize(1);
  scene.materials.resize(1);
  scene.camera.eye = {0.0f, 0.0f, 4.0f};
  scene.camera.fov_y_rad = 1.57079633f;
  Light near, far;
  near.color = {2.0f, 0.5f, 0.25f};
  far.position = {0.0f, 0.0f, -1.0f};
  far.color = {0.0f, 0.0f, 1.0f};
  scene.lights = {far, near};
  Pipeline pipeline = small(80, 80);
  pipeline.post.marker_radius = 0.5f;
  pipeline.post.output = Format::rgba32f;
  const Image image = frame_with_post(scene, pipeline).color;
  CHECK(value_at(image, 40, 40, 0) == 1.0f);
  CHECK(value_at(image, 40, 40, 1) == 0.25f);
  CHECK(value_at(image, 40, 40, 3) == 1.0f);
  // A sphere of radius 0.5 at distance 4 under 90 degrees: 40 * 0.5 / sqrt(16 - 0.25) = 5.04 pixels.
  CHECK(value_at(image, 44, 40, 0) == 1.0f);
  CHECK(value_at(image, 46, 40, 0) == 0.0f);
  CHECK(value_at(image, 46, 40, 2) == 0.0f);
}

TEST_CASE("The chain gives one set of bits, however it is drawn", "[post]") {
  const Scene scene = load_scene("builtin:circle");
  Pipeline pipeline = small(90, 60);
  pipeline.target = Format::rgba16f;
  pipeline.post.samples = 2;
  pipeline.post.marker_radius = 0.1f;
  pipeline.post.bloom = {0.5f, 0.5f, 5, 2};
  pipeline.post.tone_map = PostChain::ToneMap::reinhard;
  pipeline.post.encode = PostChain::Encode::srgb;
  pipeline.post.edge_filter = true;
  const Image first = frame_with_post(scene, pipeline).color;
  CHECK(first.format == Format::rgba8);
  CHECK(first.width == 90);
  for (const std::string_view simd : simd_targets())
    for (const int tile : {8, 48}) {
      Execution execution;
      execution.simd = simd;
      execution.tile = tile;
      execution.threads = tile == 8 ? 3 : 1;
      execution.shuffle_tiles = execution.light_culling = execution.geometry_culling = tile == 8;
      CHECK(frame_with_post(scene, pipeline, execution).color.texels == first.texels);
    }
}
