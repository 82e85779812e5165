// Vulkan's devices under states drawn at random: nothing that they draw is an alarm. lavapipe is the software device of
// a machine with Mesa; VK_DRIVER_FILES names another one. SwiftShader is held to its own profile.
#include <cmath>
#include <fstream>
#include <iterator>

#include "core/error.h"
#include "gl/vulkan/device.h"
#include "gl/vulkan/vulkan_renderer.h"
#include "judge/bounds/profile_file.h"
#include "judge/legal/store.h"
#include "judge/probe/probe.h"
#include "scenes/builtin/builtin.h"
#include "tests/catch.hpp"
#include "tests/judge/random_frames.h"

using namespace trueshade;
using namespace trueshade::oracle;
using namespace trueshade::testing;

namespace {

FrameDrawer drawn_by(VulkanDriver driver) {
  return [driver](const RandomFrame& frame) {
    DrawnFrame drawn;
    drawn.shows_steps = true;
    VulkanDraw draw;
    draw.after_light = [&](int light, const Image& target) { drawn.lights.emplace_back(light, target); };
    draw.after_object = [&](int object, const Image& target) { drawn.objects.emplace_back(object, target); };
    VulkanFrame out = drawn_by_vulkan(frame.scene, frame.pipeline, driver, draw);
    drawn.capture = std::move(out.capture);
    drawn.subpixel_bits = out.subpixel_bits;
    return drawn;
  };
}

/// The device's line; empty where there is none, and then the test has said SKIPPED.
std::string device(VulkanDriver driver) {
  try {
    return VulkanDevice(driver).info().line;
  } catch (const Error& error) {
    WARN("SKIPPED: " << error.what());
    return "";
  }
}

void check_software(FrameTheme theme, uint64_t first, int count) {
  const std::string name = device(VulkanDriver::software);
  if (!name.empty())
    check_random_frames({name, *profile_named("vulkan"), theme, first, count}, drawn_by(VulkanDriver::software));
}

/// What `trueshade probe --driver swiftshader` made of Chromium 156's.
Profile swiftshader_profile() {
  const std::string path = TRUESHADE_SOURCE_DIR "/docs/data/profiles/swiftshader-chromium-156.json";
  std::ifstream in(path);
  return profile_from_json(std::string(std::istreambuf_iterator<char>(in), {}), path);
}

bool has_nan_of_halves(const Image& target) {
  const FormatInfo layout = info(target.format);
  if (!layout.small_float()) return false;
  for (int y = 0; y < target.height; ++y)
    for (int x = 0; x < target.width; ++x)
      for (int k = 0; k < layout.channels; ++k)
        if (std::isnan(target.value(x, y, k))) return true;
  return false;
}

/// Where SwiftShader draws what no Vulkan may, by its source.
/// - Values beyond the largest half are stored as NaN (System/Half.hpp), floats of 11 and 10 bits too, which it makes
/// of
///   halves.
/// - The unit of a float depth's offset is 2^-23 of the largest power of two among near + (z - z0) range, instead of
///   that among the depths z. Here z0 is the depth of one vertex (Pipeline/SetupRoutine.cpp takes it off the others).
std::string wrong_of_swiftshader(const RandomFrame& frame, const DrawnFrame& drawn) {
  if (has_nan_of_halves(drawn.capture.color)) return "values beyond the largest half are stored as NaN";
  const GeometryState& state = frame.pipeline.geometry;
  const bool is_float = info(state.depth_format).number_class == NumberClass::floating;
  return is_float && state.polygon_offset_units != 0 ? "units of an offset of float depths are wrong" : "";
}

void check_swiftshader(FrameTheme theme, uint64_t first, int count) {
  const std::string name = device(VulkanDriver::swiftshader);
  if (name.empty()) return;
  RandomFrames frames{name, swiftshader_profile(), theme, first, count};
  frames.most_refused = 0.8;  // it has no depth of 24 bits
  frames.left_out = wrong_of_swiftshader;
  check_random_frames(frames, drawn_by(VulkanDriver::swiftshader));
}

constexpr FrameTheme kThemes[] = {FrameTheme::clamped_depths, FrameTheme::sloped_depths, FrameTheme::glass_in_halves};

}  // namespace

TEST_CASE("A software device of Vulkan is not convicted under states drawn at random") {
  check_software(FrameTheme::any, 1, 16);
  for (const FrameTheme theme : kThemes) check_software(theme, 1, 4);
}

TEST_CASE("Frames that were convicted though a device may draw them are not") {
  const auto judged = [](uint64_t seed) { check_software(FrameTheme::any, seed, 1); };
  judged(920643);  // rgb16f holds emission, and a map its share of ambient light: what stands in has an alpha of 1
  judged(920717);  // a blend of src_alpha_saturate upon rgb16f, which has no alpha
  judged(931461);  // light passes that wrote an alpha where rgba16f stands in for rgb16f, read by one_minus_dst_alpha
  judged(930726);  // NaN in floats without a sign, where the shader's value may be any
  judged(931176);  // a blend that reads an alpha of two bits
  judged(931186);  // glass of one value upon values that differ
  judged(940515);  // a light that may be at the surface, whose window is 0 in the middle of its range
  judged(950765);  // a power beyond the largest float
}

TEST_CASE("Frames of SwiftShader's that were convicted though it may draw them are not") {
  const auto judged = [](uint64_t seed) { check_swiftshader(FrameTheme::any, seed, 1); };
  judged(1084);  // planes whose bounds reach the stored value's neighbours on both sides
  judged(1041);  // the nearest texel of a place next to a border
  judged(1594);  // a tie of halves
}

TEST_CASE("SwiftShader is not convicted by its profile under states drawn at random") {
  check_swiftshader(FrameTheme::any, 1, 24);
  for (const FrameTheme theme : kThemes) check_swiftshader(theme, 1, 8);
}

TEST_CASE("Floats of 11 and 10 bits by way of halves are the nearest half, cut") {
  Profile profile;
  profile.half = HalfStore::through_halves;
  const auto stored = [&profile](double x, Format format, int channel) {
    const LegalTexel t = legal_texel({x, x, x}, format, channel, profile);
    CHECK(t.low == t.nominal);
    CHECK(t.high == t.nominal);
    return t.nominal;
  };
  // From 1 the steps are 1/1024 of halves, 1/64 of 11 bits, 1/32 of 10.
  CHECK(stored(1 + 15.4 / 1024, Format::r11g11b10f, 0) == 1);
  CHECK(stored(1 + 15.6 / 1024, Format::r11g11b10f, 0) == 1 + 1.0 / 64);
  CHECK(stored(1 + 31.4 / 1024, Format::r11g11b10f, 2) == 1);
  CHECK(stored(1 + 31.6 / 1024, Format::r11g11b10f, 2) == 1 + 1.0 / 32);
  const LegalTexel tie = legal_texel({1 + 0.5 / 1024, 1 + 0.5 / 1024, 1 + 0.5 / 1024}, Format::rgba16f, 0, profile);
  CHECK(tie.low == 1);
  CHECK(tie.high == 1 + 1.0 / 1024);
  const LegalTexel below =
      legal_texel({-1 - 0.5 / 1024, -1 - 0.5 / 1024, -1 - 0.5 / 1024}, Format::rgba16f, 0, profile);
  CHECK(below.low == -1 - 1.0 / 1024);
  CHECK(below.high == -1);
}

TEST_CASE("A probe of SwiftShader tells how it differs from Mesa") {
  if (device(VulkanDriver::swiftshader).empty()) return;
  const std::vector<ProbePlan> plans = probe_plans(1);
  std::vector<ProbeFrame> frames;
  for (const ProbePlan& plan : plans)
    if (!blends_lights(plan.pipeline.strategy) && plan.pipeline.geometry.depth_format != Format::d24)
      frames.push_back({&plan, drawn_by_vulkan(plan.scene, plan.pipeline, VulkanDriver::swiftshader).capture, {}});
  const Profile told = probe_profile(frames, "told").profile, known = swiftshader_profile();
  CHECK(told.planes == PlaneForm::homogeneous);
  CHECK(told.planes == known.planes);
  CHECK(told.subpixel_bits == known.subpixel_bits);
  CHECK(told.snap == known.snap);
  CHECK(told.fill == known.fill);
  CHECK(told.plane_origin == known.plane_origin);
  CHECK(told.half == known.half);
  CHECK(told.least_depth_unit == known.least_depth_unit);
  CHECK(told.sampling.lod_error == known.sampling.lod_error);
}

TEST_CASE("Of two thousand frames of a Vulkan device's under states drawn at random none is convicted", "[long]") {
  check_software(FrameTheme::any, long_first(1000), long_count(2000));
  for (const FrameTheme theme : kThemes) check_software(theme, long_first(1000), long_count(2000) / 10);
}

TEST_CASE("Of two hundred frames of SwiftShader's under states drawn at random none is convicted", "[long]") {
  check_swiftshader(FrameTheme::any, long_first(1), long_count(200));
  for (const FrameTheme theme : kThemes) check_swiftshader(theme, long_first(1), long_count(200) / 10);
}

TEST_CASE("A Vulkan device is not convicted where it is lit by a light program at random") {
  check_software(FrameTheme::light_program, 1, 16);
}

TEST_CASE("Of five hundred frames of a Vulkan device that are lit by a light program at random none is convicted",
          "[long]") {
  check_software(FrameTheme::light_program, long_first(1000), long_count(500));
}

TEST_CASE("Of two hundred frames of SwiftShader's that are lit by a light program at random none is convicted",
          "[long]") {
  check_swiftshader(FrameTheme::light_program, long_first(1000), long_count(200));
}
