#include "oracle/gl/context.h"

#include "tests/catch.hpp"
#include "tests/gl/driver.h"

using namespace trueshade;
using namespace trueshade::testing;
using oracle::GlDriver;

TEST_CASE("llvmpipe opens without a window and says what it is") {
  const oracle::GlContext* context = driver(GlDriver::llvmpipe);
  if (context == nullptr) return;
  CHECK(context->info().renderer.find("llvmpipe") != std::string::npos);
  CHECK(context->info().major == 4);
  CHECK(context->info().subpixel_bits == 8);
  CHECK(context->info().max_texture_size >= 8192);
}

TEST_CASE("softpipe opens in a process of its own and draws with OpenGL 3.3") {
  const oracle::GlContext* context = driver(GlDriver::softpipe);
  if (context == nullptr) return;
  CHECK(context->info().renderer.find("softpipe") != std::string::npos);
  const Planes planes = drawn_by_gl(*context, window_scene({{{{10, 10}, {200, 10}, {10, 200}}}}), window_pipeline());
  CHECK(planes.covered(50, 50));
  CHECK(!planes.covered(250, 250));
}
