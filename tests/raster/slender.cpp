// Triangles a few samples wide drawn upon a depth plane: a lane a step, against the general path.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/fp_env.h"
#include "core/simd/simd_target.h"
#include "scenes/builtin/pcg32.h"
#include "shading/output/overlay.h"
#include "tests/catch.hpp"
#include "tests/raster/window_scene.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

/// A triangle whose third corner lies at most `width` pixels from the side between the others, which goes anywhere.
Corners slender_triangle(Pcg32& random, double width) {
  const auto place = [&](double reach) { return random.between(128 - reach, 128 + reach); };
  const double reach = random.below(4) == 0 ? std::exp2(random.between(8, 19)) : 140.0;  // beyond vectors' range too
  Corners out{};
  for (Corner* corner : {&out[0], &out[1]}) corner->x = place(reach), corner->y = place(reach);
  if (random.below(6) == 0) out[1].x = out[0].x;
  if (random.below(6) == 0) out[1].y = out[0].y + random.between(-2, 2);
  if (random.below(6) == 0) out[1].x = out[0].x + random.between(-6, 6), out[1].y = out[0].y + random.between(-6, 6);
  const double along = random.between(-0.1, 1.1), off = random.between(-width, width);
  out[2].x = out[0].x + along * (out[1].x - out[0].x), out[2].y = out[0].y + along * (out[1].y - out[0].y);
  (std::abs(out[1].x - out[0].x) > std::abs(out[1].y - out[0].y) ? out[2].y : out[2].x) += off;
  // Of few values: depths tie, those of a step of 16 bits once they are stored.
  const auto height = [&] { return std::round(random.between(-8, 8)) / 9; };
  const bool flat = random.below(2) == 0;
  const double level = height();
  for (Corner& corner : out) {
    if (random.below(3) == 0) corner.x = std::round(corner.x * 2) / 2, corner.y = std::round(corner.y * 2) / 2;
    corner.z = flat ? level + random.between(-2e-5, 2e-5) : height();
  }
  return out;
}

/// Codes of the format, as many of them those of a height above.
Image random_depths(Pcg32& random, Format format) {
  const double steps = format == Format::d16 ? 0xFFFF : 0xFFFFFF;
  Image out(kWindow, kWindow, Format::d32f);
  for (int y = 0; y < kWindow; ++y)
    for (int x = 0; x < kWindow; ++x) {
      const double height =
          0.5 + double(random.below(8)) / 18 + (random.below(2) == 0 ? random.between(-1e-5, 1e-5) : 0);
      const double code = format == Format::d32f ? height : std::round(height * steps) / steps;
      const float depth = random.below(8) == 0 ? 1.0f : float(code);
      std::memcpy(out.texel(x, y), &depth, sizeof depth);
    }
  return out;
}

size_t unlike_bytes(const Image& a, const Image& b) {
  size_t count = 0;
  for (size_t i = 0; i < a.texels.size(); ++i) count += a.texels[i] != b.texels[i];
  return count;
}

}  // namespace

TEST_CASE("Slender triangles have the general path's samples and depths on every target, in every tile", "[slender]") {
  const FpScope fp;
  Pcg32 random(8);
  size_t turn = 0;
  for (const double width : {0.3, 1.0, 1.5, 4.2}) {
    std::vector<std::vector<Corners>> objects(1500);
    for (auto& object : objects) object = {slender_triangle(random, width), slender_triangle(random, width)};
    const Scene scene = window_objects(objects);
    for (const DepthFunc func : {DepthFunc::less, DepthFunc::lequal}) {
      Pipeline pipeline = window_pipeline();
      pipeline.geometry.depth_format = kDepthFormats[turn++ % std::size(kDepthFormats)];
      const Image depth = random_depths(random, pipeline.geometry.depth_format);
      pipeline.geometry.depth_func = func;
      if (width > 1.0) pipeline.geometry.viewport = {7, 5, 230, 241};
      if (width < 1.0) pipeline.geometry.clip_origin = ClipOrigin::upper_left;
      const Image general = overlay(scene, pipeline, {.geometry_culling = false, .fast_geometry = false}, depth);
      CHECK(std::count_if(general.texels.begin(), general.texels.end(), [](uint8_t byte) { return byte != 0; }) > 5000);
      for (const std::string_view simd : simd_targets())
        for (const int tile : {8, 48, 64}) {
          CAPTURE(width, int(func), int(pipeline.geometry.depth_format), simd, tile);
          const Image fast = overlay(scene, pipeline, {.tile = tile, .simd = simd}, depth);
          CHECK(unlike_bytes(fast, general) == 0);
        }
    }
  }
}
