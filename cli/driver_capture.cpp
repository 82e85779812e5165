#include "cli/driver_capture.h"

#include <utility>

#include "oracle/gl/context.h"
#include "oracle/gl/renderer.h"

namespace trueshade {
namespace {

oracle::GlDriver driver_named(std::string_view name) {
  if (name == "llvmpipe") return oracle::GlDriver::llvmpipe;
  if (name == "softpipe") return oracle::GlDriver::softpipe;
  return oracle::GlDriver::any;
}

}  // namespace

DriverFrame drawn_by_driver(std::string_view driver, const Scene& scene, const Pipeline& pipeline) {
  const oracle::GlContext context(driver_named(driver));
  oracle::GlFrame frame = oracle::GlRenderer(context, scene).draw(pipeline);
  DriverFrame drawn{std::move(frame.capture), context.info().subpixel_bits, {}, std::move(frame.notes)};
  for (const oracle::GlPass& pass : frame.passes) drawn.passes.push_back({pass.name, pass.ms});
  return drawn;
}

}  // namespace trueshade
