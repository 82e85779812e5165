// What a probe tells of renderers whose rules are known: ours, and Mesa's llvmpipe, whose profile in the code was
// measured by other means.
#include "judge/probe/probe.h"

#include <algorithm>
#include <map>

#include "judge/bounds/profile_file.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"

using namespace trueshade;
using namespace trueshade::oracle;
using State = ProbedField::State;

namespace {

/// Our own frames of the plans, as they are stored under `half_round`.
std::vector<ProbeFrame> our_frames(std::vector<ProbePlan>& plans, HalfRound half_round) {
  std::vector<ProbeFrame> frames;
  for (ProbePlan& plan : plans) {
    plan.pipeline.gbuffer.half_round = half_round;
    frames.push_back({&plan, testing::captured(plan.scene, plan.pipeline), {}});
    if (blends_lights(plan.pipeline.strategy)) frames.back().steps = testing::steps_of(plan.scene, plan.pipeline);
  }
  return frames;
}

std::map<std::string, std::string> told(const ProbeResult& result) {
  std::map<std::string, std::string> out;
  for (const ProbedField& field : result.fields)
    if (field.state == State::told) out[field.field] = field.value;
  return out;
}

}  // namespace

TEST_CASE("A probe of our own frames tells the rules that docs/arithmetic.md states") {
  for (const HalfRound half_round : {HalfRound::toward_zero, HalfRound::nearest}) {
    std::vector<ProbePlan> plans = probe_plans(1), others = probe_plans(2);
    const ProbeResult result = probe_profile(our_frames(plans, half_round), "ours");
    auto fields = told(result);
    CAPTURE(profile_json(result.profile));
    CHECK(fields["planes"] == "differences");
    CHECK(fields["subpixel_bits, snap"] == "8, nearest");
    CHECK(fields["fill"] == "left_low");
    CHECK(fields["plane_origin"] == "snapped");
    CHECK(fields["least_depth_unit, most_depth_unit"] == "1, 1");
    CHECK(fields["half"] == (half_round == HalfRound::nearest ? "nearest" : "toward_zero"));
    CHECK(fields["unorm_reach"] == "0.5");
    CHECK(fields["srgb_reach"] == "0.5");
    CHECK(fields["sampling.mesa_decode"] == "false");
    CHECK(fields["blend"] == "float_once");
    for (const ProbeFrame& frame : our_frames(others, half_round)) {
      const ProbeCheck check = check_profile(frame, result.profile);
      CAPTURE(check.frame);
      CHECK(check.violations == 0);
      CHECK(check.pixels > 0);
    }
  }
}

TEST_CASE("A profile's file reads back as the same profile, and what is wrong in one is said by its place") {
  for (const std::string_view name : kDriverProfileNames) {
    const Profile profile = *profile_named(name);
    const Profile again = profile_from_json(profile_json(profile), "p.json");
    CHECK(profile_json(again) == profile_json(profile));
    CHECK(again.name == name);
    CHECK(again.sampling == profile.sampling);
    CHECK(again.unorm_reach == profile.unorm_reach);
  }
  CHECK(profile_from_json(R"({"name": "x"})", "p.json").subpixel_bits == Profile{}.subpixel_bits);
  const auto refused = [](const char* text, const char* reason) {
    CHECK_THROWS_WITH(profile_from_json(text, "p.json"), Catch::Contains(reason));
  };
  refused(R"({"name": "x", "subpixel_bits": 3})", "p.json: /subpixel_bits");
  refused(R"({"name": "x", "snap": "near"})", "/snap");
  refused(R"({"name": "x", "snapp": "nearest"})", "snapp");
  refused(R"({"name": "x", "sampling": {"weight": 0}})", "/sampling");
  refused(R"({"subpixel_bits": 8})", "name");
  refused(R"({"name": "x", "least_depth_unit": 2, "most_depth_unit": 1})", "least_depth_unit");
}
