// The profile mesa-llvmpipe-22.3 against the driver it is named after: the same fragments blended by OpenGL and by
// blend_pixels(), bit for bit.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "core/half.h"
#include "core/llvmpipe_srgb.h"
#include "core/small_float.h"
#include "gl/driver/blend_state.h"
#include "gl/driver/geometry_state.h"
#include "gl/driver/objects.h"
#include "gl/driver/read_back.h"
#include "gl/emit/glsl.h"
#include "oracle/blend.h"
#include "shading/blend/clear_color.h"
#include "tests/catch.hpp"
#include "tests/gl/driver.h"
#include "tests/gl/random_states.h"
#include "tests/shading/blend_pixels.h"

using namespace trueshade;
using namespace trueshade::oracle;
using namespace trueshade::testing;
using Rgba = trueshade::testing::Rgba;

namespace {

/// What a texel holds for a stored value: small floats are exact, so rounding does not matter.
uint32_t bits_of(Format format, size_t channel, float held) {
  const FormatInfo layout = info(format);
  const int bits = layout.bits[channel];
  if (layout.number_class == NumberClass::unorm) return uint32_t(held);
  if (bits == 32) return std::bit_cast<uint32_t>(held);
  return bits == 16 ? half_from_float(held, HalfRound::toward_zero)
                    : unsigned_from_float(held, bits, HalfRound::toward_zero);
}

/// A texture of our values, by glTexSubImage2D.
GlTexture texture_of(Format format, int width, int height, const PixelPlanes& pixels) {
  GlTexture texture = make_texture(format, width, height);
  const GlFormat gl = gl_format(format);
  Image image(width, height, format);  // its first row is the lowest here
  for (size_t i = 0; i < size_t(width) * size_t(height); ++i)
    for (size_t c = 0; c < size_t(info(format).channels); ++c)
      image.set_code(int(i) % width, int(i) / width, int(c), bits_of(format, c, pixels.plane[c][i]));
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, gl.external, gl.type, image.texels.data());
  return texture;
}

/// Channel c of the i-th pixel, row 0 at the bottom, as blend_pixels() holds it.
float held(const Image& image, size_t i, size_t c) {
  const int x = int(i) % image.width, y = image.height - 1 - int(i) / image.width;
  if (info(image.format).number_class == NumberClass::unorm) return float(image.code(x, y, int(c)));
  return float(image.value(x, y, int(c)));
}

/// Draws over the whole of `target` with a fragment shader. `encode`: sRGB targets; otherwise their codes are drawn.
void draw_over(GLuint program, const GlTexture& target, int width, int height, const BlendState& state,
               bool encode = true) {
  const std::array<GLuint, 1> colors{target};
  const GlTarget framebuffer = make_target(colors, 0);
  REQUIRE(framebuffer.complete);
  const GlVertexArray none = make_vertex_array();
  set_image_state(width, height);
  if (!encode) glDisable(GL_FRAMEBUFFER_SRGB);
  set_blend_state(state);
  glUseProgram(program);
  glBindVertexArray(none);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  set_blend_state({});
  check_gl("blending");
}

GlProgram fetching_program() {
  return make_program("fetch", fullscreen_vertex_text(330),
                      glsl_header(330, "what a texture holds") +
                          "uniform sampler2D source;\nlayout(location = 0) out vec4 color;\n"
                          "void main() { color = texelFetch(source, ivec2(gl_FragCoord.xy), 0); }\n");
}

/// Values on codes, on the middle between two, in and about [0, 1]; float targets get what is none of that too.
float any_value(Random& random, bool strange) {
  constexpr float kStrange[] = {kNan,  kInf,  -kInf, -0.0f,   0,     1,      -1,     2,
                                65504, 65520, 1e30f, -1e-20f, 6e-8f, 1e-40f, -3e-39f};
  const auto unit = [&] { return float(double(random() >> 11) * 0x1p-53); };
  switch (random() % 8) {
    case 0:
      return strange ? kStrange[random() % std::size(kStrange)] : unit();
    case 1:
      return 5 * unit() - 2;
    case 2:
      return float(random() % 256) / 255.0f;
    case 3:
      return (float(random() % 255) + 0.5f) / 255.0f;
    default:
      return unit();
  }
}

float any_stored(Random& random, Format format, size_t channel) {
  const FormatInfo layout = info(format);
  if (layout.number_class == NumberClass::unorm) return float(random() % (layout.largest_code(int(channel)) + 1));
  if (layout.bits[channel] == 16) return float_from_half(uint16_t(random() % 4 ? random() % 0x3C01 : random()));
  if (layout.bits[channel] != 0 && layout.small_float()) {
    const int bits = layout.bits[channel];
    return float_from_unsigned(uint32_t(random() & ((1u << bits) - 1)), bits);
  }
  return any_value(random, true);
}

constexpr int kSide = 64;

/// Components of one random picture that OpenGL blends otherwise than we do.
int different(const GlProgram& fetch, const BlendState& state, Format format, Random& random) {
  constexpr size_t kPixels = size_t(kSide) * kSide;
  PixelPlanes source(kPixels), stored(kPixels);
  for (size_t i = 0; i < kPixels; ++i)
    for (size_t c = 0; c < 4; ++c) {
      source.plane[c][i] = any_value(random, true);
      stored.plane[c][i] = any_stored(random, format, c);
    }
  const GlTexture from = texture_of(Format::rgba32f, kSide, kSide, source);
  const GlTexture target = texture_of(format, kSide, kSide, stored);
  PixelPlanes before(kPixels);
  for (size_t i = 0; i < kPixels; ++i) before.set(i, stored.at(i));
  glUseProgram(fetch);
  bind_texture(fetch, "source", 0, GL_TEXTURE_2D, from);
  draw_over(fetch, target, kSide, kSide, state);
  const Image image = read_texture(target, format, 0, 0, kSide, kSide);
  blend(state, {format, kMesa, HalfRound::toward_zero}, source, stored);
  int count = 0;
  for (size_t i = 0; i < kPixels; ++i)
    for (size_t c = 0; c < 4; ++c) {
      if (c >= size_t(info(format).channels) || same(held(image, i, c), stored.plane[c][i])) continue;
      if (++count == 1)
        UNSCOPED_INFO(text_of(state) << ", " << info(format).name << ", channel " << c << ": source "
                                     << source.plane[c][i] << " (alpha " << source.plane[3][i] << "), before "
                                     << before.plane[c][i] << " (alpha " << before.plane[3][i] << "), OpenGL "
                                     << held(image, i, c) << ", ours " << stored.plane[c][i]);
    }
  return count;
}

BlendState random_state(Random& random, const BlendTerm& term) {
  BlendState state = blending(term);
  if (random() % 2) state.alpha = random_term(random);
  for (float& constant : state.constant) constant = any_value(random, false);
  if (random() % 4 == 0)
    for (bool& channel : state.mask) channel = random() % 2 != 0;
  return state;
}

/// (s, a, d) = digits of stride * pixel number in base 256. `what` is the vec4 to write.
GlProgram triple_program(const std::string& what) {
  return make_program(
      "triples", fullscreen_vertex_text(330),
      glsl_header(330, "numbered triples of codes") +
          "uniform int width;\nuniform int stride;\nlayout(location = 0) out vec4 color;\n"
          "void main() {\n  int t = (int(gl_FragCoord.y) * width + int(gl_FragCoord.x)) * stride;\n"
          "  float s = float(t & 255) / 255.0, a = float((t >> 8) & 255) / 255.0, d = float(t >> 16) / 255.0;\n"
          "  color = " +
          what + ";\n}\n");
}

/// Triples that OpenGL blends otherwise, of all 2^24 / stride. The destination is codes, of sRGB too.
size_t different_triples(Format format, const BlendTerm& term, int width, int height, int stride) {
  const GlProgram source_program = triple_program("vec4(s, s, s, a)"),
                  before_program = triple_program("vec4(d, d, d, s)");
  const GlTexture target = make_texture(format, width, height);
  for (const GlProgram* program : {&before_program, &source_program}) {
    glUseProgram(*program);
    set_uniform(*program, "width", width);
    set_uniform(*program, "stride", stride);
    const bool before = program == &before_program;
    draw_over(*program, target, width, height, before ? BlendState{} : blending(term), !before);
  }
  const Image image = read_texture(target, format, 0, 0, width, height);
  PixelPlanes source(static_cast<size_t>(width)), stored(static_cast<size_t>(width));
  size_t count = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int t = (y * width + x) * stride;
      const float s = float(t & 255), a = float((t >> 8) & 255) / 255.0f, d = float(t >> 16);
      source.set(size_t(x), {s / 255.0f, s / 255.0f, s / 255.0f, a});
      stored.set(size_t(x), {d, d, d, s});
    }
    blend(blending(term), {format, kMesa, HalfRound::toward_zero}, source, stored);
    for (int x = 0; x < width; ++x) {
      bool equal = true;
      for (size_t c = 0; c < 4; ++c)
        equal = equal && held(image, size_t(y * width + x), c) == stored.plane[c][size_t(x)];
      count += equal ? 0 : 1;
    }
  }
  return count;
}

/// Every target whose bits this CPU has the driver draw: sRGB codes are made of the CPU's estimates.
std::vector<Format> targets() {
  std::vector<Format> all(std::begin(kTargetFormats), std::end(kTargetFormats));
  if (!estimates_as_recorded()) std::erase(all, Format::srgb8_a8);
  return all;
}
std::vector<Format> targets_of_8_bits() {
  std::vector<Format> all = targets();
  std::erase_if(all, [](Format format) { return info(format).bits[0] != 8; });
  return all;
}

}  // namespace

TEST_CASE("llvmpipe blends random states, values and formats to the profile's bits") {
  if (opened_mesa_22_3() == nullptr) return;
  const GlProgram fetch = fetching_program();
  Random random(2203);
  for (int i = 0; i < 40; ++i)  // each state is compiled; the long run takes all of them
    for (const Format format : targets())
      CHECK(different(fetch, random_state(random, random_term(random)), format, random) == 0);
  for (const Format format : targets()) CHECK(different(fetch, {}, format, random) == 0);
}

TEST_CASE("llvmpipe blends every factor with every factor under every equation to the profile's bits", "[long]") {
  if (opened_mesa_22_3() == nullptr) return;
  const GlProgram fetch = fetching_program();
  Random random(2204);
  for (size_t e = 0; e < kBlendEquations; ++e)
    for (size_t s = 0; s < kBlendFactors; ++s)
      for (size_t d = 0; d < kBlendFactors; ++d)
        for (const Format format : targets()) {
          const BlendTerm term{BlendEquation(e), BlendFactor(s), BlendFactor(d)};
          CHECK(different(fetch, random_state(random, term), format, random) == 0);
        }
}

TEST_CASE("Row 48: llvmpipe blends every 63rd triple of nine 8-bit modes to the profile's bits, plain and sRGB") {
  if (opened_mesa_22_3() == nullptr) return;
  for (const Format format : targets_of_8_bits())
    for (const NamedMode& mode : usual_modes()) {
      INFO(mode.name << ", " << info(format).name);
      CHECK(different_triples(format, mode.term, 512, 512, 63) == 0);  // odd: a power of two would leave codes out
    }
}

TEST_CASE("Row 48: llvmpipe blends all 2^24 triples of nine 8-bit modes to the profile's bits, plain and sRGB",
          "[long]") {
  if (opened_mesa_22_3() == nullptr) return;
  for (const Format format : targets_of_8_bits())
    for (const NamedMode& mode : usual_modes()) {
      INFO(mode.name << ", " << info(format).name);
      CHECK(different_triples(format, mode.term, 4096, 4096, 1) == 0);
    }
}

TEST_CASE("llvmpipe encodes every float from 0 to 1 as the sRGB code of the profile") {
  if (opened_mesa_22_3() == nullptr || !estimates_as_recorded()) return;
  constexpr int kWide = 4096;
  const GlProgram program =
      make_program("floats", fullscreen_vertex_text(330),
                   glsl_header(330, "numbered floats") +
                       "uniform int first;\nlayout(location = 0) out vec4 color;\n"
                       "void main() {\n  int bits = (int(gl_FragCoord.y) << 12) + "
                       "int(gl_FragCoord.x);\n  color = vec4(intBitsToFloat(first + bits));\n}\n");
  const GlTexture target = make_texture(Format::srgb8_a8, kWide, kWide);
  PixelPlanes source(kWide), stored(kWide);
  size_t different = 0;
  // Below 2^-13 every code is 0: 12.92 * 255 * 2^-13 < 1/2. Draws of 2^24 floats; the last begins at 1.
  for (int first = 0x39000000; first <= 0x3F800000; first += kWide * kWide) {
    const int rows = first == 0x3F000000 + kWide * kWide ? 1 : kWide;
    glUseProgram(program);
    set_uniform(program, "first", first);
    draw_over(program, target, kWide, rows, {});
    const Image image = read_texture(target, Format::srgb8_a8, 0, 0, kWide, rows);
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < kWide; ++x) source.set(size_t(x), grey(std::bit_cast<float>(first + (y << 12) + x)));
      blend({}, {Format::srgb8_a8, kMesa, HalfRound::toward_zero}, source, stored);
      const uint8_t* texel = image.texel(0, rows - 1 - y);
      for (size_t x = 0; x < kWide; ++x)
        for (size_t c = 0; c < 4; ++c) different += float(texel[4 * x + c]) == stored.plane[c][x] ? 0 : 1;
    }
  }
  CHECK(different == 0);
}

TEST_CASE("llvmpipe clears every target to what the profile's draws leave of the clear colour's stand-in") {
  if (opened_mesa_22_3() == nullptr) return;
  Random random(2205);
  for (const Format format : targets())
    for (int i = 0; i < 2000; ++i) {
      glm::vec4 color;
      for (int c = 0; c < 4; ++c) color[c] = i < 500 ? float(i) / (499 + 100 * float(c)) : any_value(random, false);
      const GlTexture target = make_texture(format, 1, 1);
      const std::array<GLuint, 1> colors{target};
      const GlTarget framebuffer = make_target(colors, 0);
      set_image_state(1, 1);
      glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.framebuffer);
      glClearBufferfv(GL_COLOR, 0, &color[0]);
      const Image image = read_texture(target, format, 0, 0, 1, 1);
      const BlendTarget ours{format, kMesa, HalfRound::toward_zero};
      const glm::vec4 drawn = drawn_clear(color, ours);
      const Rgba stored = blend({}, ours, {drawn[0], drawn[1], drawn[2], drawn[3]}, Rgba{});
      for (size_t c = 0; c < size_t(info(format).channels); ++c) {
        CAPTURE(info(format).name, i, c, color[int(c)], stored[c], held(image, 0, c));
        CHECK(same(held(image, 0, c), stored[c]));
      }
    }
}

TEST_CASE("llvmpipe clears sRGB codes upward where the profile says, one float below and one above") {
  if (opened_mesa_22_3() == nullptr || !estimates_as_recorded()) return;
  const GlTexture target = make_texture(Format::srgb8_a8, 1, 1);
  const std::array<GLuint, 1> colors{target};
  const GlTarget framebuffer = make_target(colors, 0);
  set_image_state(1, 1);
  for (uint32_t k = 0; k < 255; ++k)
    for (const uint32_t bits : {(kLlvmpipeClearStarts[k] << 12) - 1, kLlvmpipeClearStarts[k] << 12}) {
      const float x = std::bit_cast<float>(bits);
      glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.framebuffer);
      glClearBufferfv(GL_COLOR, 0, grey(x).data());
      CHECK(read_texture(target, Format::srgb8_a8, 0, 0, 1, 1).code(0, 0, 0) == (bits % 2 == 0 ? k + 1 : k));
    }
}

TEST_CASE("llvmpipe reads 8-bit codes as the profile does") {
  if (opened_mesa_22_3() == nullptr) return;
  PixelPlanes codes(256), values(256);
  for (size_t k = 0; k < 256; ++k) codes.set(k, {float(k), float(255 - k), float(k), float(k)});
  const GlProgram fetch = fetching_program();
  for (const Format format : {Format::rgba8, Format::srgb8_a8}) {
    const GlTexture from = texture_of(format, 16, 16, codes), target = make_texture(Format::rgba32f, 16, 16);
    glUseProgram(fetch);
    bind_texture(fetch, "source", 0, GL_TEXTURE_2D, from);
    draw_over(fetch, target, 16, 16, {});
    const Image image = read_texture(target, Format::rgba32f, 0, 0, 16, 16);
    fetch_pixels({format, kMesa, HalfRound::toward_zero}, codes.read().data(), values.write().data(), 256);
    for (size_t k = 0; k < 256; ++k)
      for (size_t c = 0; c < 4; ++c) CHECK(same(held(image, k, c), values.plane[c][k]));
  }
}
