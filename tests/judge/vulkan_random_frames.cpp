// Vulkan's devices under states drawn at random: nothing that they draw is an alarm. lavapipe is the device of a
// machine without any other; VK_DRIVER_FILES names another driver, and then `vulkan` is that.
#include "core/error.h"
#include "gl/vulkan/device.h"
#include "gl/vulkan/vulkan_renderer.h"
#include "scenes/builtin/builtin.h"
#include "tests/catch.hpp"
#include "tests/judge/random_frames.h"

using namespace trueshade;
using namespace trueshade::oracle;
using namespace trueshade::testing;

namespace {

DrawnFrame drawn_by_device(const RandomFrame& frame) {
  DrawnFrame drawn;
  drawn.shows_steps = true;
  VulkanDraw draw;
  draw.after_light = [&](int light, const Image& target) { drawn.lights.emplace_back(light, target); };
  draw.after_object = [&](int object, const Image& target) { drawn.objects.emplace_back(object, target); };
  VulkanFrame out = drawn_by_vulkan(frame.scene, frame.pipeline, true, draw);
  drawn.capture = std::move(out.capture);
  drawn.subpixel_bits = out.subpixel_bits;
  return drawn;
}

/// The software device's line; empty where there is none that is judged, and then the test has said SKIPPED.
/// SwiftShader is not: it interpolates less precisely than float32 does, as it may (docs/data/drivers.md).
std::string device() {
  try {
    const std::string line = VulkanDevice(true).info().line;
    if (line.find("SwiftShader") == std::string::npos) return line;
    WARN("SKIPPED: " << line << " interpolates less precisely than floats do");
    return "";
  } catch (const Error& error) {
    WARN("SKIPPED: " << error.what());
    return "";
  }
}

void check_device(FrameTheme theme, uint64_t first, int count) {
  if (const std::string name = device(); !name.empty())
    check_random_frames({name, "vulkan", theme, first, count}, drawn_by_device);
}

constexpr FrameTheme kThemes[] = {FrameTheme::clamped_depths, FrameTheme::sloped_depths, FrameTheme::glass_in_halves};

}  // namespace

TEST_CASE("A software device of Vulkan is not convicted under states drawn at random") {
  check_device(FrameTheme::any, 1, 16);
  for (const FrameTheme theme : kThemes) check_device(theme, 1, 4);
}

TEST_CASE("Of two thousand frames of a Vulkan device's under states drawn at random none is convicted", "[long]") {
  check_device(FrameTheme::any, long_first(1000), long_count(2000));
  for (const FrameTheme theme : kThemes) check_device(theme, long_first(1000), long_count(2000) / 10);
}
