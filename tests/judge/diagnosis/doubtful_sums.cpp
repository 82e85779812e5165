// Lights that are converted to codes one by one, of which a capture holds the sum alone: what hardware within 0.6 of a
// code makes is legal, and roots of 12 bits are told from it.
#include <algorithm>
#include <cmath>

#include "judge/stages/validate.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"
#include "tests/judge/diagnosis/planted.h"

namespace trueshade::testing {

using namespace trueshade::oracle;

namespace {

constexpr const char* kCity = "city,lights=60,objects=300";

/// What converts to codes: what a light adds, or the sum that the target becomes.
enum class Converts : uint8_t { what_is_added, the_sum };

/// A value in codes, by thresholds up to 0.1 of a code beside the middles.
double code_of(double value, int channel) {
  const double lower = std::floor(value), off = 0.1 * std::sin(lower * 12.9 + channel);
  return value - lower >= 0.5 + off ? lower + 1 : lower;
}

/// The picture of such hardware.
Image drawn_by_hardware(const Scene& scene, const Pipeline& pipeline, const Capture& right, Converts converts) {
  Pipeline floats = pipeline;
  floats.strategy = Strategy::deferred_loop, floats.target = Format::rgba32f;
  Image out = right.color;
  const Image& ids = *right.plane("id.object");
  Scene part = scene;
  for (size_t i = 0; i <= scene.lights.size(); ++i) {
    part.lights.clear();  // first the target without any light
    if (i > 0) part.lights.push_back(scene.lights[i - 1]);
    const Image light = captured(part, floats).color;
    for (int y = 0; y < out.height; ++y)
      for (int x = 0; x < out.width; ++x)
        for (int k = 0; k < 3 && ids.code(x, y, 0) != 0; ++k) {
          const double value = std::clamp(light.value(x, y, k), 0.0, 1.0) * 255;
          const double before = i > 0 ? double(out.code(x, y, k)) : 0.0;
          const double sum = converts == Converts::the_sum ? code_of(before + value, k) : before + code_of(value, k);
          out.set_code(x, y, k, uint32_t(std::min(sum, 255.0)));
        }
  }
  return out;
}

}  // namespace

TEST_CASE("A city whose lights are converted within 0.6 of a code one by one, or in their sum, is not convicted") {
  const Scene scene = builtin_scene(kCity);
  Pipeline pipeline = *preset_pipeline("many-lights");
  pipeline.width = 128, pipeline.height = 96;
  pipeline.strategy = Strategy::deferred_volumes, pipeline.target = Format::rgba8;
  const Capture right = captured(scene, pipeline);
  Profile profile;
  profile.subpixel_bits = 8;
  for (const Converts converts : {Converts::what_is_added, Converts::the_sum}) {
    Capture capture = right;
    capture.color = drawn_by_hardware(scene, pipeline, right, converts);
    int changed = 0;
    for (int y = 0; y < pipeline.height; ++y)
      for (int x = 0; x < pipeline.width; ++x) changed += capture.color.code(x, y, 1) != right.color.code(x, y, 1);
    const Verdict v = validate_capture(scene, pipeline, capture, {profile, false, {}, {}});
    CAPTURE(int(converts), changed, verdict_json(v));
    CHECK(changed > 500);
    CHECK(v.violations() == 0);
    CHECK_FALSE(v.convicted());
    CHECK(v.evidence.back().rule.code_reach == 0.6);
  }
}

TEST_CASE("Roots of 12 bits that change a hundred pixels of a city by a code are convicted in the sums of its lights") {
  for (const Plant& plant : plants()) {
    if (plant.name != "estimated roots") continue;
    for (const int view : {0, 1}) {
      const PlantedTry t =
          planted_try({kCity, "many-lights", Strategy::deferred_volumes, Format::rgba8, view}, plant, 1);
      CAPTURE(view, t.changed, t.found);
      CHECK(t.changed > 100);
      CHECK(t.changed < 200);
      CHECK(t.convicted);
      CHECK(t.first);
    }
  }
}

}  // namespace trueshade::testing
