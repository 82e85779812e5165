// The post chain as passes on a real driver against ours, both of the driver's own target: equal where both do the same
// operations, else within what GLSL's operations may differ by (docs/gl_rules.md section 6), u = 2^-23.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "gl/emit/post_glsl.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "shading/output/post_frame.h"
#include "tests/catch.hpp"
#include "tests/gl/driver.h"

using namespace trueshade;
using namespace trueshade::testing;
using namespace trueshade::oracle;

namespace {

constexpr double kU = 0x1p-23;
constexpr const char* kScenes[] = {"circle", "lecture", "city,lights=100"};

Pipeline pipeline_with(const PostChain& post) {
  Pipeline pipeline = presets().front().pipeline;
  pipeline.width = 150, pipeline.height = 110;
  pipeline.target = Format::rgba32f;
  pipeline.light_model.damping = 3.0f;  // light beyond 1
  pipeline.post = post;
  pipeline.post.output = Format::rgba32f;
  return pipeline;
}

struct Pictures {
  Image gl, ours;
};

/// Both chains over the target that the driver drew.
Pictures finished(const GlContext& context, const Scene& scene, const Pipeline& pipeline) {
  GlDraw draw;
  draw.post = true;
  const GlFrame frame = GlRenderer(context, scene).draw(pipeline, draw);
  return {frame.finished, finished_image(scene, pipeline, {}, frame.capture.color, frame.capture.plane("depth"))};
}

/// The largest channel.
double most_of(const Image& image) {
  double most = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) most = std::max(most, image.value(x, y, c));
  return most;
}

int pixels_unlike(const Image& a, const Image& b) {
  int count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) count += std::memcmp(a.texel(x, y), b.texel(x, y), 16) != 0 ? 1 : 0;
  return count;
}

/// Channels further apart than bound(value), and the worst distance by its bound.
template <class BoundOf>
int channels_beyond(const Pictures& p, const BoundOf& bound, double& worst) {
  int count = 0;
  worst = 0;
  for (int y = 0; y < p.gl.height; ++y)
    for (int x = 0; x < p.gl.width; ++x)
      for (int c = 0; c < 4; ++c) {
        const double right = p.ours.value(x, y, c), apart = std::fabs(p.gl.value(x, y, c) - right), most = bound(right);
        worst = std::max(worst, apart / most);
        count += apart <= most ? 0 : 1;
      }
  return count;
}

/// Two blurs a pass, each a sum of 2 r + 1 products of a weight rounded once: 2 r + 3 roundings of at most the
/// brightest.
double blurred_bound(const PostChain::Bloom& b, double most) { return 2 * b.passes * (2 * b.radius + 3) * kU * most; }

/// Relative error of Reinhard's operator. The mean of logarithms no larger than `log_most`: 4 roundings before each, 3
/// ulp of its own or 2^-21, 6 a pass of the sum; exp2 3 + 2 |x|. The scale goes into v / (1 + v), and twice into its
/// product with 1 + v / white^2, beside 24 roundings.
double mapped_bound(const Pipeline& p, double log_most) {
  const double passes = std::ceil(std::log2(double(std::max(p.width, p.height))) / 2);
  const double mean =
      4 * kU / std::log(2.0) + std::max(3 * kU * log_most, 0x1p-21) + (6 * passes + 2.5) * kU * log_most;
  const double scale = std::log(2.0) * mean + (3 + 2 * log_most) * kU + 2.5 * kU;
  return 2 * scale + 24 * kU;
}

double log_most(const PostChain& chain, double most) {
  return std::max(std::fabs(std::log2(double(chain.log_offset))), std::fabs(std::log2(most + 1)));
}

/// Of an encoded value whose linear one is off by `relative`: x^(1/2.4) by 1 / 2.4 of it, pow as GLSL's exp2 and log2.
double encoded_bound(double value, double relative) {
  const double log_value = 12;  // at most, above 0.0031308; below it the value is 12.92 x
  const double power = std::log(2.0) / 2.4 * std::max(3 * kU * log_value, 0x1p-21) + (3 + 2 * log_value / 2.4) * kU;
  return (std::fabs(value) + 0.055) * (relative + power + 3 * kU) + 1e-7;  // the last: both branches at 0.0031308
}

PostChain reinhard(float white) {
  PostChain post;
  post.tone_map = PostChain::ToneMap::reinhard;
  post.key = 0.3f;
  post.white = white;
  return post;
}

}  // namespace

TEST_CASE("Supersampling and the edge filter on llvmpipe are ours, bit for bit") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  for (const char* name : kScenes)
    for (const int samples : {1, 2, 3})
      for (const bool edges : {false, true}) {
        PostChain post;
        post.samples = samples;
        post.edge_filter = edges;
        if (!post.active()) continue;
        const Pipeline pipeline = pipeline_with(post);
        const Scene scene = builtin_scene(name);
        const Pictures pictures = finished(*context, scene, pipeline);
        INFO(name << ", " << samples << " samples, edges " << edges);
        CHECK(pictures.gl.width == pipeline.width);
        CHECK(pixels_unlike(pictures.gl, pictures.ours) == 0);
        if (samples == 1) {  // it does something
          const Image before = GlRenderer(*context, scene).draw(pipeline).capture.color;
          CHECK(pixels_unlike(before, pictures.gl) > 100);
        }
      }
}

TEST_CASE("Bloom on llvmpipe is ours within the roundings of its float sums") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  for (const char* name : kScenes)
    for (const int radius : {1, 8, 14}) {
      PostChain post;
      post.bloom = {0.5f, 0.25f, radius, 3};
      const Pictures pictures = finished(*context, builtin_scene(name), pipeline_with(post));
      const double most = most_of(pictures.ours);
      const double light = double(post.bloom.strength) * (blurred_bound(post.bloom, most) + 3 * kU * most);
      double worst = 0;
      INFO(name << ", radius " << radius);
      CHECK(channels_beyond(
                pictures, [&](double v) { return light + kU * v + 1e-30; }, worst) == 0);
      CHECK(most > 0.5);
      post.bloom.strength = 0.51f;  // a wrong one is seen
      const Pictures wrong{pictures.gl, finished(*context, builtin_scene(name), pipeline_with(post)).ours};
      CHECK(channels_beyond(
                wrong, [&](double v) { return light + kU * v + 1e-30; }, worst) > 1000);
    }
}

TEST_CASE("Reinhard's operator and sRGB codes on llvmpipe are ours within GLSL's log2, exp2 and pow") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  for (const char* name : kScenes)
    for (const float white : {0.0f, 2.0f})
      for (const bool srgb : {false, true}) {
        PostChain post = reinhard(white);
        if (srgb) post.encode = PostChain::Encode::srgb;
        const Pipeline pipeline = pipeline_with(post);
        const Scene scene = builtin_scene(name);
        const Pictures pictures = finished(*context, scene, pipeline);
        const double most = most_of(GlRenderer(*context, scene).draw(pipeline).capture.color);
        const double relative = mapped_bound(pipeline, log_most(post, most));
        const auto bound = [&](double v) { return srgb ? encoded_bound(v, relative) : relative * v + 1e-30; };
        double worst = 0;
        INFO(name << ", white " << white << ", srgb " << srgb);
        CAPTURE(relative);
        CHECK(channels_beyond(pictures, bound, worst) == 0);
        CHECK(relative < 1e-3);
        Pipeline other = pipeline;  // half a percent is seen
        other.post.key = 0.3015f;
        const Pictures wrong{pictures.gl, finished(*context, scene, other).ours};
        CHECK(channels_beyond(wrong, bound, worst) > 1000);
      }
}

TEST_CASE("A whole chain into codes: each is one that the bound allows") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  for (const char* name : kScenes) {
    PostChain post = reinhard(4.0f);
    post.samples = 2;
    post.encode = PostChain::Encode::srgb;
    Pipeline pipeline = pipeline_with(post);
    const Scene scene = builtin_scene(name);
    GlDraw draw;
    draw.post = true;
    pipeline.post.output = Format::rgba8;
    const GlFrame frame = GlRenderer(*context, scene).draw(pipeline, draw);
    pipeline.post.output = Format::rgba32f;
    const Image ours = finished_image(scene, pipeline, {}, frame.capture.color, frame.capture.plane("depth"));
    const double relative = mapped_bound(pipeline, log_most(post, most_of(frame.capture.color))) + 8 * kU;
    int illegal = 0, two = 0;
    for (int y = 0; y < ours.height; ++y)
      for (int x = 0; x < ours.width; ++x)
        for (int c = 0; c < 3; ++c) {
          const double v = ours.value(x, y, c), e = encoded_bound(v, relative);
          const double low = std::nearbyint(255 * std::clamp(v - e, 0.0, 1.0) - 1e-4);
          const double high = std::nearbyint(255 * std::clamp(v + e, 0.0, 1.0) + 1e-4);
          const double code = std::nearbyint(255 * frame.finished.value(x, y, c));
          illegal += code < low || code > high ? 1 : 0;
          two += low < high ? 1 : 0;
        }
    INFO(name);
    CHECK(frame.finished.format == Format::rgba8);
    CHECK(illegal == 0);
    CHECK(two < 3 * ours.width * ours.height / 20);
  }
}

TEST_CASE("Light markers on llvmpipe are where ours are, but for their edges and depth's ties") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  for (const char* name : {"circle", "city,lights=100"}) {
    PostChain post;
    post.marker_radius = std::string(name) == "circle" ? 0.15f : 4.0f;
    const Pipeline pipeline = pipeline_with(post);
    const Scene scene = builtin_scene(name);
    const Pictures pictures = finished(*context, scene, pipeline);
    const Image before = GlRenderer(*context, scene).draw(pipeline).capture.color;
    const auto is_marker = [&](int x, int y) {
      x = std::clamp(x, 0, before.width - 1), y = std::clamp(y, 0, before.height - 1);
      return std::memcmp(pictures.ours.texel(x, y), before.texel(x, y), 16) != 0;
    };
    int markers = 0, unlike = 0, unexplained = 0;
    for (int y = 0; y < before.height; ++y)
      for (int x = 0; x < before.width; ++x) {
        markers += is_marker(x, y) ? 1 : 0;
        if (std::memcmp(pictures.gl.texel(x, y), pictures.ours.texel(x, y), 16) == 0) continue;
        ++unlike;
        bool edge = false;
        for (int k = 0; k < 9; ++k)
          edge = edge || is_marker(x + k % 3 - 1, y + k / 3 - 1) != is_marker(x, y) ||
                 std::memcmp(pictures.ours.texel(std::clamp(x + k % 3 - 1, 0, before.width - 1),
                                                 std::clamp(y + k / 3 - 1, 0, before.height - 1)),
                             pictures.gl.texel(x, y), 16) == 0;
        unexplained += edge ? 0 : 1;
      }
    INFO(name);
    CAPTURE(markers, unlike);
    CHECK(markers > 200);
    CHECK(unexplained == 0);
    CHECK(unlike <= markers / 50);  // 0.4 of 100 crossings (docs/gl_rules.md section 9)
  }
}

TEST_CASE("Constant damping scales every light's colour on llvmpipe as in ours") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  KeptPrograms programs;
  for (const char* name : {"cornell", "city,objects=300,lights=30"}) {
    const Scene scene = builtin_scene(name);
    GlRenderer renderer(*context, scene, 0, &programs);
    Pipeline pipeline = pipeline_with({});
    pipeline.light_model.damping = 1.0f;
    const Capture whole = renderer.draw(pipeline).capture;
    const Image &one = whole.color, &ids = *whole.plane("id.object");
    pipeline.light_model.damping = 0.25f;  // a power of two: every product and sum is a quarter, exactly
    const Image quarter = renderer.draw(pipeline).capture.color;
    int off = 0, lit = 0;
    for (int y = 0; y < one.height; ++y)
      for (int x = 0; x < one.width; ++x)
        for (int c = 0; c < 3 && ids.value(x, y, 0) != 0; ++c) {
          off += quarter.value(x, y, c) == 0.25 * one.value(x, y, c) ? 0 : 1;
          lit += one.value(x, y, c) > 0 ? 1 : 0;
        }
    INFO(name);
    CHECK(lit > 10000);
    CHECK(off == 0);
  }
}
