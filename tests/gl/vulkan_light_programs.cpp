// Light programs on a driver of Vulkan.
#include "core/error.h"
#include "gl/vulkan/vulkan_renderer.h"
#include "scenes/builtin/builtin.h"
#include "tests/catch.hpp"
#include "tests/gl/program_frames.h"

using namespace trueshade;
using namespace trueshade::testing;
using namespace trueshade::oracle;

namespace {

Capture drawn_by_lavapipe(const Scene& scene, const Pipeline& pipeline) {
  return drawn_by_vulkan(scene, pipeline, VulkanDriver::software).capture;
}

/// Whether there is a software device; otherwise the test has said SKIPPED.
bool has_lavapipe() {
  try {
    Pipeline tiny;
    tiny.width = tiny.height = 1;
    drawn_by_lavapipe(builtin_scene("cornell"), tiny);
    return true;
  } catch (const Error& error) {
    WARN("SKIPPED: " << error.what());
    return false;
  }
}

}  // namespace

TEST_CASE("lavapipe draws many-lights as a program within a code of our frame of it") {
  if (has_lavapipe()) check_many_lights(drawn_by_lavapipe);
}

TEST_CASE("lavapipe draws programs of every kind as we do") {
  if (has_lavapipe()) check_program_kinds(drawn_by_lavapipe);
}

TEST_CASE("lavapipe draws lights with an area as we do") {
  if (has_lavapipe()) check_area_lights(drawn_by_lavapipe);
}

TEST_CASE("lavapipe gives a program every field that we give it") {
  if (has_lavapipe()) check_program_fields(drawn_by_lavapipe);
}
