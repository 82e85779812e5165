// llvmpipe under states drawn at random: nothing that it draws is an alarm.
#include "gl/driver/renderer.h"
#include "tests/catch.hpp"
#include "tests/judge/drivers.h"
#include "tests/judge/random_frames.h"

using namespace trueshade;
using namespace trueshade::testing;
using trueshade::oracle::GlContext;

namespace {

DrawnFrame drawn_by(const GlContext& context, const RandomFrame& frame) {
  DrawnFrame drawn;
  drawn.shows_steps = true;
  oracle::GlDraw draw;
  draw.after_light = [&](int light, const Image& target) { drawn.lights.emplace_back(light, target); };
  draw.after_object = [&](int object, const Image& target) { drawn.objects.emplace_back(object, target); };
  drawn.capture = oracle::GlRenderer(context, frame.scene).draw(frame.pipeline, draw).capture;
  drawn.subpixel_bits = context.info().subpixel_bits;
  return drawn;
}

void check_llvmpipe(FrameTheme theme, uint64_t first, int count) {
  const GlContext* const context = opened(oracle::GlDriver::llvmpipe);
  if (context == nullptr) return;
  check_random_frames({"llvmpipe", {}, theme, first, count},
                      [context](const RandomFrame& frame) { return drawn_by(*context, frame); });
}

constexpr FrameTheme kThemes[] = {FrameTheme::clamped_depths, FrameTheme::sloped_depths, FrameTheme::glass_in_halves};

}  // namespace

TEST_CASE("llvmpipe is not convicted under states drawn at random") {
  check_llvmpipe(FrameTheme::any, 1, 24);
  for (const FrameTheme theme : kThemes) check_llvmpipe(theme, 1, 6);
}

TEST_CASE("Surfaces of one depth that llvmpipe lights in one draw are one choice, whose roundings add up") {
  check_llvmpipe(FrameTheme::any, 2357, 1);
}

TEST_CASE("Maps and glass of llvmpipe's that are off alike on few places of a frame are no evidence") {
  for (const uint64_t seed : {2644, 2918}) check_llvmpipe(FrameTheme::any, seed, 1);
}

TEST_CASE("Where a surface that says nothing may have been lit too, llvmpipe's stores are no evidence") {
  check_llvmpipe(FrameTheme::clamped_depths, 2256, 1);
}

TEST_CASE("Of two surfaces that an offset takes to one depth the one that a normal map may have bent so is seen") {
  check_llvmpipe(FrameTheme::clamped_depths, 910185, 1);
}

TEST_CASE("Ten bits that llvmpipe cleared are nearest codes, though those that it draws are not") {
  check_llvmpipe(FrameTheme::glass_in_halves, 1117, 1);
}

TEST_CASE("Codes that llvmpipe subtracts are as often others as their sources are") {
  check_llvmpipe(FrameTheme::sloped_depths, 2635, 1);
}

TEST_CASE("Of two thousand frames of llvmpipe's under states drawn at random none is convicted", "[long]") {
  check_llvmpipe(FrameTheme::any, long_first(1000), long_count(2000));
  for (const FrameTheme theme : kThemes) check_llvmpipe(theme, long_first(1000), long_count(2000) / 10);
}

TEST_CASE("llvmpipe is not convicted where it is lit by a light program at random") {
  check_llvmpipe(FrameTheme::light_program, 1, 16);
}

TEST_CASE("Of five hundred frames of llvmpipe's that are lit by a light program at random none is convicted", "[long]") {
  check_llvmpipe(FrameTheme::light_program, long_first(1000), long_count(500));
}
