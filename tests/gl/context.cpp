#include "gl/driver/context.h"

#include <cstdlib>

#include "core/error.h"
#include "tests/catch.hpp"
#include "tests/gl/driver.h"

using namespace trueshade;
using namespace trueshade::testing;
using oracle::GlDriver;

TEST_CASE("llvmpipe opens without a window and says what it is") {
  const oracle::GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  CHECK(context->info().renderer.find("llvmpipe") != std::string::npos);
  CHECK(context->info().major == 4);
  CHECK(context->info().subpixel_bits == 8);
  CHECK(context->info().max_texture_size >= 8192);
}

TEST_CASE("softpipe opens in a process of its own and draws with OpenGL 3.3") {
  const oracle::GlContext* context = opened(GlDriver::softpipe);
  if (context == nullptr) return;
  CHECK(context->info().renderer.find("softpipe") != std::string::npos);
  const Planes planes = drawn_by_gl(*context, window_scene({{{{10, 10}, {200, 10}, {10, 200}}}}), window_pipeline());
  CHECK(planes.covered(50, 50));
  CHECK(!planes.covered(250, 250));
}

TEST_CASE("An EGL device, the fallback, gives the driver that the surfaceless platform gives, and the same bytes") {
  const oracle::GlContext* surfaceless = opened(GlDriver::llvmpipe);
  if (surfaceless == nullptr) return;
  CHECK(surfaceless->info().platform == oracle::GlPlatform::surfaceless);
  constexpr oracle::GlPlatform kDevice[] = {oracle::GlPlatform::device};
  const oracle::GlContext device(GlDriver::llvmpipe, kDevice);
  CHECK(device.info().platform == oracle::GlPlatform::device);
  CHECK(device.info().line() == surfaceless->info().line());
  const Scene scene = window_scene({{{{10, 10}, {200, 10}, {10, 200}}}});
  const auto drawn = [&](const oracle::GlContext& context) {
    return oracle::GlRenderer(context, scene).draw(window_pipeline()).capture;
  };
  const oracle::Capture a = drawn(*surfaceless), b = drawn(device);
  CHECK(a.color.texels == b.color.texels);
  REQUIRE(a.planes.size() == b.planes.size());
  for (size_t i = 0; i < a.planes.size(); ++i) CHECK(a.planes[i].image.texels == b.planes[i].image.texels);
  // Where no platform gives a display there is no driver.
  CHECK_THROWS_WITH(oracle::GlContext(GlDriver::llvmpipe, std::span<const oracle::GlPlatform>{}),
                    Catch::Contains("no EGL display"));
}

TEST_CASE("Without a driver opening is an error with the exit code 7 that says what to install") {
  // EGL's vendor library list is read when libEGL is loaded, so this holds in a process of its own: as ctest runs it.
  if (std::getenv("__EGL_VENDOR_LIBRARY_FILENAMES") != nullptr) return;
  setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json", 1);
  try {
    const oracle::GlContext context;
    WARN("SKIPPED: a driver was open before, or this EGL has no vendor list");
  } catch (const Error& error) {
    CHECK(int(error.kind()) == 7);
    CHECK(std::string(error.what()).find("libgl1-mesa-dri") != std::string::npos);
  }
  unsetenv("__EGL_VENDOR_LIBRARY_FILENAMES");
}
