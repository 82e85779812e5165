// The profile mesa-llvmpipe-22.3 against the driver it is named after: snapping and filling of triangles wholly inside
// the viewport, pixel for pixel.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "gl/driver/blend_state.h"
#include "gl/driver/geometry_state.h"
#include "gl/emit/glsl.h"
#include "gl/driver/objects.h"
#include "gl/driver/read_back.h"
#include "raster/visibility/coverage_count.h"
#include "tests/catch.hpp"
#include "tests/gl/driver.h"

using namespace trueshade;
using namespace trueshade::oracle;
using namespace trueshade::testing;

namespace {

using Random = std::mt19937_64;
double uniform(Random& random, double low, double high) {
  return low + (high - low) * (double(random() >> 11) * 0x1p-53);
}

constexpr int kBatch = 20;  // few enough that two wrong triangles hardly make one right sum

struct Window {
  int width, height;
};

/// How often each pixel is drawn, row 0 at the bottom.
std::vector<uint16_t> counted_by_gl(GLuint program, const std::vector<ClipTriangle>& triangles, const Window& window) {
  const GlTexture target = make_texture(Format::rgba32f, window.width, window.height);
  const std::array<GLuint, 1> colors{target};
  const GlTarget framebuffer = make_target(colors, 0);
  const GlVertexArray array = make_vertex_array();
  glBindVertexArray(array);
  const GlBuffer vertices = make_buffer(GL_ARRAY_BUFFER, std::span<const ClipTriangle>(triangles));
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
  set_image_state(window.width, window.height);
  constexpr std::array<GLfloat, 4> kNothing{};
  glClearBufferfv(GL_COLOR, 0, kNothing.data());
  set_blend_state({true, kAccumulate, kAccumulate, {}, {true, true, true, true}});
  glUseProgram(program);
  glDrawArrays(GL_TRIANGLES, 0, GLsizei(3 * triangles.size()));
  set_blend_state({});
  check_gl("counting coverage");
  const Image image = read_texture(target, Format::rgba32f, 0, 0, window.width, window.height);
  std::vector<uint16_t> counts;
  for (int y = window.height - 1; y >= 0; --y)
    for (int x = 0; x < window.width; ++x) {
      float count;
      std::memcpy(&count, image.texel(x, y), 4);
      counts.push_back(uint16_t(count));
    }
  return counts;
}

enum Kind { kAny, kSmall, kAligned, kSliver, kPerspective, kKinds };

/// A triangle of one kind, all of it inside the viewport.
ClipTriangle triangle_inside(Kind kind, const Window& window, Random& random) {
  ClipTriangle out{};
  const double cx = uniform(random, 12, window.width - 12), cy = uniform(random, 12, window.height - 12);
  const double angle = uniform(random, 0, 6.28), length = uniform(random, 1, 100);
  for (int i = 0; i < 3; ++i) {
    double x = uniform(random, 0.01, window.width - 0.01), y = uniform(random, 0.01, window.height - 0.01);
    if (kind == kSmall) x = cx + uniform(random, -4, 4), y = cy + uniform(random, -4, 4);
    if (kind == kAligned) x = std::floor(x) + 0.5, y = std::floor(y) + 0.5;
    if (kind == kSliver) {
      x = cx + (i - 1) * length * std::cos(angle) + uniform(random, -0.02, 0.02);
      y = cy + (i - 1) * length * std::sin(angle) + uniform(random, -0.02, 0.02);
    }
    x = std::clamp(x, 0.01, window.width - 0.01);
    y = std::clamp(y, 0.01, window.height - 0.01);
    const double w = kind == kPerspective ? uniform(random, 0.5, 60) : 1;
    out.vertex[i][0] = float((2 * x / window.width - 1) * w);
    out.vertex[i][1] = float((2 * y / window.height - 1) * w);
    out.vertex[i][2] = 0;
    out.vertex[i][3] = float(w);
  }
  return out;
}

struct Differences {
  uint64_t covered = 0, mesa = 0, ideal = 0;  ///< pixels, over all triangles
};

Differences compare(Kind kind, const Window& window, int triangles, uint64_t seed) {
  const GlProgram program = make_program(
      "count",
      glsl_header(330, "clip coordinates as they come") +
          "layout(location = 0) in vec4 position;\nvoid main() { gl_Position = position; }\n",
      glsl_header(330, "one") + "layout(location = 0) out vec4 color;\nvoid main() { color = vec4(1.0); }\n");
  Random random(seed);
  Differences found;
  for (int from = 0; from < triangles; from += kBatch) {
    std::vector<ClipTriangle> batch;
    for (int i = 0; i < kBatch; ++i) batch.push_back(triangle_inside(kind, window, random));
    const std::vector<uint16_t> gl = counted_by_gl(program, batch, window);
    std::vector<uint16_t> mesa(gl.size()), ideal(gl.size());
    count_coverage(batch, {}, window.width, window.height, {}, mesa, NumericProfile::mesa_llvmpipe_22_3);
    count_coverage(batch, {}, window.width, window.height, {}, ideal, NumericProfile::ideal);
    for (size_t i = 0; i < gl.size(); ++i) {
      found.covered += gl[i];
      found.mesa += gl[i] != mesa[i] ? 1 : 0;
      found.ideal += gl[i] != ideal[i] ? 1 : 0;
    }
  }
  return found;
}

const char* const kNames[kKinds] = {"any", "small", "through pixel centres", "slivers", "in perspective"};

void check_kinds(int triangles, uint64_t seed) {
  if (opened_mesa_22_3() == nullptr) return;
  for (const Window& window : {Window{256, 256}, Window{801, 603}})
    for (int kind = 0; kind < kKinds; ++kind) {
      const Differences found = compare(Kind(kind), window, triangles, seed + uint64_t(kind));
      UNSCOPED_INFO(window.width << " x " << window.height << ", " << kNames[kind] << ": " << triangles
                                 << " triangles, " << found.covered << " pixels; different: profile " << found.mesa
                                 << ", ideal " << found.ideal);
      CHECK(found.covered > 0);
      CHECK(found.mesa == 0);
    }
}

}  // namespace

TEST_CASE("llvmpipe covers the profile's pixels: 2,400 triangles inside the viewport") { check_kinds(240, 1); }

TEST_CASE("llvmpipe covers the profile's pixels: 48,000 triangles inside the viewport", "[long]") {
  check_kinds(4800, 2);
}
