// The profile of llvmpipe that a probe makes is the one in the code, which was measured by other means.
#include <map>

#include "gl/driver/renderer.h"
#include "judge/bounds/profile_file.h"
#include "judge/probe/probe.h"
#include "tests/catch.hpp"
#include "tests/judge/drivers.h"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

std::vector<ProbeFrame> drawn(const GlContext& context, const std::vector<ProbePlan>& plans) {
  std::vector<ProbeFrame> frames;
  for (const ProbePlan& plan : plans) {
    std::vector<std::pair<int, Image>> after;
    GlDraw draw;
    if (blends_lights(plan.pipeline.strategy))
      draw.after_light = [&after](int light, const Image& target) { after.emplace_back(light, target); };
    frames.push_back({&plan, GlRenderer(context, plan.scene).draw(plan.pipeline, draw).capture, {}});
    if (!after.empty())
      frames.back().steps = [after](const StepSink& sink) {
        for (const auto& [light, target] : after) sink(light, target);
      };
  }
  return frames;
}

}  // namespace

TEST_CASE("A probe of llvmpipe makes the profile that is in the code") {
  const GlContext* const context = testing::opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  if (!testing::is_of_known_profile(*context)) {
    std::puts("SKIPPED: this is another Mesa");
    return;
  }
  const std::vector<ProbePlan> plans = probe_plans(1), others = probe_plans(2);
  const std::vector<ProbeFrame> frames = drawn(*context, plans), held_out = drawn(*context, others);
  const Profile known = *profile_named("mesa-llvmpipe-22.3");
  uint64_t violations = 0;
  for (const ProbeFrame& frame : frames) {
    const ProbeCheck check = check_profile(frame, known);
    std::printf("%-45s %.3f %% EXACT by the profile in the code, %d violations\n", check.frame.c_str(),
                100.0 * double(check.exact) / double(check.pixels), int(check.violations));
    violations += check.violations;
  }
  // One position at the end of a thin triangle is 2e-7 beyond what half an ulp an operation allows: the probe finds
  // one.
  CHECK(violations <= 1);
  const Profile probed = probe_profile(frames, "probed").profile;
  CAPTURE(profile_json(probed), profile_json(known));
  CHECK(probed.subpixel_bits == known.subpixel_bits);
  CHECK(probed.snap == known.snap);
  CHECK(probed.fill == known.fill);
  CHECK(probed.plane_origin == known.plane_origin);
  CHECK(probed.least_depth_unit == known.least_depth_unit);
  CHECK(probed.most_depth_unit == known.most_depth_unit);
  CHECK(probed.half == known.half);
  CHECK(probed.blend == known.blend);
  CHECK(probed.unorm_reach == known.unorm_reach);
  CHECK(probed.srgb_reach == known.srgb_reach);
  CHECK(probed.sampling.mesa_decode == known.sampling.mesa_decode);
  CHECK(probed.sampling.wide_weight_error == known.sampling.wide_weight_error);
  CHECK(probed.sampling.srgb_codes == known.sampling.srgb_codes);
  CHECK(probed.sampling.lod_error == known.sampling.lod_error);
  CHECK(probed.sampling.lerp_codes == known.sampling.lerp_codes);
  for (const ProbeFrame& frame : held_out) {
    const ProbeCheck check = check_profile(frame, probed);
    CAPTURE(check.frame);
    CHECK(check.violations == 0);
  }
}
