#include "gl/emit/post_glsl.h"

#include <cstdint>

#include "core/error.h"
#include "gl/emit/glsl.h"

namespace trueshade::oracle {

namespace {

constexpr int kMostSide = 65536;
constexpr int kReduction = 4;  ///< a side of the squares that one pass of the sum adds up

std::string pass_text(int version, const std::string& purpose, const std::string& functions, const std::string& body) {
  return glsl_header(version, purpose) + "uniform sampler2D picture;\nlayout(location = 0) out vec4 result;\n" +
         functions + "\nvoid main() {\n  ivec2 pixel = ivec2(gl_FragCoord.xy);\n" + body + "}\n";
}

constexpr const char* kTame = R"(
// NaN and what is below 0 as 0, what is huge as 2^60.
float tame(float x) { return x > 0.0 ? (x < 1152921504606846976.0 ? x : 1152921504606846976.0) : 0.0; }
vec3 tame(vec3 c) { return vec3(tame(c.r), tame(c.g), tame(c.b)); }
float luminance(vec3 c) { return (0.2126 * c.r + 0.7152 * c.g) + 0.0722 * c.b; }
)";

std::string copy_text(int version, const std::string& purpose) {
  return pass_text(version, purpose, "", "  result = texelFetch(picture, pixel, 0);\n");
}

std::string average_text(int version, int samples) {
  const std::string s = std::to_string(samples);
  return pass_text(version, "each pixel the mean of its square of samples, rows from the top", "",
                   "  vec4 sum = vec4(0.0);\n  for (int j = " + s +
                       " - 1; j >= 0; --j) {\n    vec4 row = vec4(0.0);\n"
                       "    for (int i = 0; i < " +
                       s + "; ++i) row += texelFetch(picture, " + s +
                       " * pixel + ivec2(i, j), 0);\n"
                       "    sum += row;\n  }\n  result = sum / " +
                       glsl_float(float(samples * samples)) + ";\n");
}

std::string bright_text(int version, float threshold) {
  return pass_text(version, "light above the threshold", kTame,
                   "  result = vec4(tame(texelFetch(picture, pixel, 0).rgb - " + glsl_float(threshold) + "), 1.0);\n");
}

/// Binomial weights C(2r, r + k) / 4^r, rounded to float once.
std::string weights_text(int radius) {
  std::vector<double> weight(size_t(2 * radius + 1), 0.0);
  weight[0] = 1.0;
  for (int row = 1; row <= 2 * radius; ++row)
    for (size_t k = size_t(row); k > 0; --k) weight[k] += weight[k - 1];
  std::string text = "const float weight[" + std::to_string(weight.size()) + "] = float[](";
  for (size_t k = 0; k < weight.size(); ++k)
    text += (k == 0 ? "" : ", ") + glsl_float(float(weight[k] / double(uint64_t(1) << (2 * radius))));
  return text + ");\n";
}

std::string blur_text(int version, int radius, bool along_x) {
  const std::string r = std::to_string(radius);
  return pass_text(version, std::string("a blur along ") + (along_x ? "x" : "y") + ", the border's pixels go on",
                   weights_text(radius),
                   "  ivec2 most = textureSize(picture, 0) - 1;\n  vec3 sum = vec3(0.0);\n  for (int k = -" + r +
                       "; k <= " + r + "; ++k)\n    sum += weight[k + " + r + "] * texelFetch(picture, clamp(pixel + " +
                       (along_x ? "ivec2(k, 0)" : "ivec2(0, -k)") + ", ivec2(0), most), 0).rgb;\n" +
                       "  result = vec4(sum, 1.0);\n");
}

std::string bloom_text(int version, float strength) {
  return pass_text(version, "the picture and its bloom", "uniform sampler2D blurred;\n",
                   "  vec4 c = texelFetch(picture, pixel, 0);\n  result = vec4(c.rgb + " + glsl_float(strength) +
                       " * texelFetch(blurred, pixel, 0).rgb, c.a);\n");
}

std::string logarithm_text(int version, float offset) {
  return pass_text(version, "log2 of luminances", kTame,
                   "  result = vec4(log2(" + glsl_float(offset) +
                       " + luminance(tame(texelFetch(picture, pixel, 0).rgb))), 0.0, 0.0, 1.0);\n");
}

std::string sum_text(int version) {
  const std::string n = std::to_string(kReduction);
  return pass_text(
      version, "sums of squares of " + n + "x" + n + " pixels, cut at the border", "",
      "  ivec2 size = textureSize(picture, 0);\n  float sum = 0.0;\n  for (int j = 0; j < " + n +
          "; ++j) {\n    float row = 0.0;\n    for (int i = 0; i < " + n + "; ++i) {\n      ivec2 at = " + n +
          " * pixel + ivec2(i, j);\n      if (all(lessThan(at, size))) row += texelFetch(picture, at, 0).x;\n"
          "    }\n    sum += row;\n  }\n  result = vec4(sum, 0.0, 0.0, 1.0);\n");
}

std::string tones_text(int version, const PostChain& chain, double pixels) {
  std::string body = "  float mean = exp2(texelFetch(logarithms, ivec2(0), 0).x / " + glsl_float(float(pixels)) +
                     ");\n  float scale = " + glsl_float(chain.key) +
                     " / mean;\n  vec4 c = texelFetch(picture, pixel, 0);\n  vec3 light = tame(c.rgb);\n"
                     "  float l = luminance(light), v = tame(scale * l), d = v / (1.0 + v);\n";
  if (chain.white > 0.0f) body += "  d = d * (1.0 + v / " + glsl_float(chain.white * chain.white) + ");\n";
  return pass_text(version, "Reinhard's operator; logarithms: their sum",
                   std::string(kTame) + "uniform sampler2D logarithms;\n",
                   body + "  result = vec4(light * (l > 0.0 ? d / l : 0.0), c.a);\n");
}

std::string encode_text(int version) {
  return pass_text(version, "linear values as sRGB values", std::string(kTame) + R"(
float encoded(float x) {
  return x >= 1.0 ? 1.0 : x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
}
)",
                   "  vec4 c = texelFetch(picture, pixel, 0);\n  vec3 light = tame(c.rgb);\n"
                   "  result = vec4(encoded(light.r), encoded(light.g), encoded(light.b), c.a);\n");
}

/// After T. Lottes, "FXAA" (NVIDIA, 2009); docs/post.md says what is kept of it. y counts from the top in it.
constexpr const char* kEdges = R"(
vec4 texel(int x, int y) {
  ivec2 size = textureSize(picture, 0), at = clamp(ivec2(x, y), ivec2(0), size - 1);
  return texelFetch(picture, ivec2(at.x, size.y - 1 - at.y), 0);
}
float luma(int x, int y) {
  vec3 c = clamp(texel(x, y).rgb, 0.0, 1.0);
  return (0.2126 * c.r + 0.7152 * c.g) + 0.0722 * c.b;
}

// xy: the neighbour across the edge; z: the share of it to take, not above 0: leave the pixel.
vec3 blend_at(int x, int y) {
  float m = luma(x, y), n = luma(x, y - 1), s = luma(x, y + 1), w = luma(x - 1, y), e = luma(x + 1, y);
  float most = max(max(max(m, n), max(s, w)), e), least = min(min(min(m, n), min(s, w)), e);
  if (most - least < max(0.0625, 0.125 * most)) return vec3(0.0);
  float nw = luma(x - 1, y - 1), ne = luma(x + 1, y - 1), sw = luma(x - 1, y + 1), se = luma(x + 1, y + 1);
  float level = (abs((nw + sw) - 2.0 * w) + 2.0 * abs((n + s) - 2.0 * m)) + abs((ne + se) - 2.0 * e);
  float upright = (abs((nw + ne) - 2.0 * n) + 2.0 * abs((w + e) - 2.0 * m)) + abs((sw + se) - 2.0 * s);
  bool is_level = level >= upright;
  float before = is_level ? n : w, after = is_level ? s : e;
  bool first = abs(before - m) >= abs(after - m);
  int side = first ? -1 : 1, dx = is_level ? 0 : side, dy = is_level ? side : 0;
  float across = first ? before : after, middle = 0.5 * (m + across), end = 0.25 * abs(across - m);
  int steps[2] = int[](12, 12);
  float past[2] = float[](0.0, 0.0);
  bool found[2] = bool[](false, false);
  for (int way = 0; way < 2; ++way)
    for (int k = 1; k <= 12 && !found[way]; ++k) {
      int along = way == 0 ? -k : k, ex = is_level ? x + along : x, ey = is_level ? y : y + along;
      past[way] = 0.5 * (luma(ex, ey) + luma(ex + dx, ey + dy)) - middle;
      found[way] = abs(past[way]) >= end;
      if (found[way]) steps[way] = k;
    }
  if (!found[0] && !found[1]) return vec3(0.0);
  int nearer = found[0] && (!found[1] || steps[0] <= steps[1]) ? 0 : 1;
  if ((past[nearer] < 0.0) == (m < middle)) return vec3(0.0);
  return vec3(float(dx), float(dy), 0.5 - float(steps[nearer]) / float(steps[0] + steps[1]));
}
)";

std::string edges_text(int version) {
  return pass_text(version, "edges smoothed along their slope", kEdges,
                   "  int x = pixel.x, y = textureSize(picture, 0).y - 1 - pixel.y;\n  vec4 here = texel(x, y);\n"
                   "  vec3 blend = blend_at(x, y);\n  vec4 there = texel(x + int(blend.x), y + int(blend.y));\n"
                   "  result = blend.z > 0.0 ? vec4(here.rgb + blend.z * (there.rgb - here.rgb), here.a) : here;\n");
}

GlslOptions marker_options(int version) {
  GlslOptions options;
  options.version = version;
  options.ids = options.uv = options.primitive = options.vertex_color = false;
  return options;
}

/// Passes one after another over the picture, each at its size.
class Passes {
 public:
  Passes(int version, int width, int height) : version_(version), width_(width), height_(height) {}

  void resize(int width, int height) { width_ = width, height_ = height; }
  int version() const { return version_; }

  /// Makes `writes` of `reads`, and `also` by the sampler of its name.
  void add(const std::string& name, std::string frag, const std::string& reads, const std::string& writes,
           const std::string& also = {}) {
    PostPass pass{name, std::move(frag), {{"picture", reads}}, writes, width_, height_};
    if (!also.empty()) pass.reads.emplace_back(also, also);
    all_.push_back(std::move(pass));
  }
  std::vector<PostPass> all_;

 private:
  int version_, width_, height_;
};

std::string add_bloom(Passes& passes, const PostChain::Bloom& bloom, const std::string& picture) {
  const int v = passes.version();
  passes.add("bright", bright_text(v, bloom.threshold), picture, "blurred");
  for (int i = 0; i < bloom.passes; ++i) {
    passes.add("blur_x", blur_text(v, bloom.radius, true), "blurred", "blurred_along_x");
    passes.add("blur_y", blur_text(v, bloom.radius, false), "blurred_along_x", "blurred");
  }
  passes.add("bloom", bloom_text(v, bloom.strength), picture, "bloomed", "blurred");
  return "bloomed";
}

std::string add_tones(Passes& passes, const Pipeline& p, const std::string& picture) {
  const int v = passes.version();
  int width = p.width, height = p.height;
  passes.add("logarithm", logarithm_text(v, p.post.log_offset), picture, "logarithms");
  // The two pictures of sums take turns; the last is the one that is read.
  std::string from = "logarithms";
  for (int i = 0; width > 1 || height > 1; ++i) {
    width = (width + kReduction - 1) / kReduction;
    height = (height + kReduction - 1) / kReduction;
    passes.resize(width, height);
    const std::string to = "logarithms_" + std::to_string(i);
    passes.add("sum", sum_text(v), from, to);
    from = to;
  }
  passes.resize(p.width, p.height);
  passes.add("tones", tones_text(v, p.post, double(p.width) * double(p.height)), picture, "mapped");
  passes.all_.back().reads.emplace_back("logarithms", from);
  return "mapped";
}

}  // namespace

Pipeline pipeline_without_post(const Pipeline& pipeline) {
  const int samples = pipeline.post.samples;
  Pipeline large = pipeline;
  large.post = {};
  if (int64_t(pipeline.width) * samples > kMostSide || int64_t(pipeline.height) * samples > kMostSide)
    throw Error(ErrorKind::limit, "post.samples", "the frame would be over 65536 pixels a side",
                "a smaller size or fewer samples");
  Viewport& v = large.geometry.viewport;
  for (int* value : {&large.width, &large.height, &v.x, &v.y, &v.width, &v.height}) *value *= samples;
  return large;
}

std::vector<PostPass> post_passes(const Pipeline& p, int version) {
  const PostChain& chain = p.post;
  if (!chain.active()) return {};
  Passes passes(version, p.width * chain.samples, p.height * chain.samples);
  passes.add("load", copy_text(version, "the target as float32"), "target", "loaded");
  std::string picture = "loaded";
  passes.resize(p.width, p.height);
  const auto step = [&](const char* name, std::string text, const char* writes) {
    passes.add(name, std::move(text), picture, writes);
    picture = writes;
  };
  if (chain.samples > 1) step("average", average_text(version, chain.samples), "averaged");
  if (chain.bloom.strength > 0.0f) picture = add_bloom(passes, chain.bloom, picture);
  if (chain.tone_map == PostChain::ToneMap::reinhard) picture = add_tones(passes, p, picture);
  if (chain.encode == PostChain::Encode::srgb) step("encode", encode_text(version), "encoded");
  if (chain.edge_filter) step("edges", edges_text(version), "smoothed");
  step("store", copy_text(version, "the image, rounded to its format"), "image");
  passes.all_.back().format = chain.output;
  return passes.all_;
}

std::string marker_vertex_text(const Pipeline& pipeline, int version) {
  return vertex_text(drawn_pipeline(pipeline), marker_options(version));
}

std::string marker_fragment_text(const Pipeline& pipeline, int version) {
  const GlslOptions options = marker_options(version);
  return glsl_header(version, "light markers: spheres of the light's colour, unlit") +
         varyings_text(drawn_pipeline(pipeline), options, "in") +
         "layout(location = 0) out vec4 result;\n\nvoid main() { result = vec4((" + albedo_text(options) +
         ").rgb, 1.0); }\n";
}

}  // namespace trueshade::oracle
