// Pixels that a mask leaves out: whatever they hold, the verdict is the same.
#include "judge/diagnosis/finding.h"
#include "judge/stages/validate.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"
#include "tests/judge/random_scene.h"

using namespace trueshade;
using namespace trueshade::oracle;
using trueshade::testing::captured;

namespace {

PixelMask rectangle(int width, int height, int left, int top, int right, int bottom) {
  PixelMask mask{width, height, std::vector<uint8_t>(size_t(width) * size_t(height))};
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) mask.left_out[size_t(y) * size_t(width) + size_t(x)] = 1;
  return mask;
}

/// The same with other numbers where the mask leaves out: those of a pixel elsewhere, which may be of no surface or of
/// another.
Image spoiled(const Image& image, const PixelMask& mask) {
  Image out = image;
  const FormatInfo layout = info(image.format);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int k = 0; k < layout.channels && mask.has(x, y); ++k) {
        const uint32_t code = image.code((x * 7 + 3) % image.width, (y * 5 + 2) % image.height, k);
        out.set_code(x, y, k, layout.number_class == NumberClass::unorm ? layout.largest_code(k) - code : code);
      }
  return out;
}

Capture spoiled(Capture capture, const PixelMask& mask) {
  capture.color = spoiled(capture.color, mask);
  for (NamedImage& plane : capture.planes) plane.image = spoiled(plane.image, mask);
  return capture;
}

/// The same of what a driver shows after each light or object.
LightSteps spoiled(const LightSteps& steps, const PixelMask& mask) {
  return
      [=](const StepSink& sink) { steps([&](int index, const Image& target) { sink(index, spoiled(target, mask)); }); };
}

}  // namespace

TEST_CASE("Whatever is left out may hold anything: classes, tests of the whole image and profile stay the same") {
  int violated = 0, explained = 0, followed = 0;
  for (uint32_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    Pcg32 random(seed, 1);
    const Scene scene = testing::random_scene(random);
    Pipeline pipeline = testing::random_pipeline(random);
    const Capture clean = captured(scene, pipeline);
    const PixelMask mask = rectangle(pipeline.width, pipeline.height, 9, 6, 25, 17);
    Capture bad = spoiled(clean, mask), masked = clean;
    ValidateOptions options;
    options.profile.subpixel_bits = 8, options.infer = seed % 4 == 0;
    violated += validate_capture(scene, pipeline, bad, options).violations() > 0 ? 1 : 0;
    bad.mask = masked.mask = mask;
    ValidateOptions spoiled_options = options;
    if (blends_lights(pipeline.strategy)) {
      options.steps = testing::steps_of(scene, pipeline);
      spoiled_options.steps = spoiled(options.steps, mask);
    }
    if (draws_transparent(scene, pipeline) && pipeline.transparency.mode == TransparencyMode::after_lights) {
      options.objects = testing::objects_of(scene, pipeline);
      spoiled_options.objects = spoiled(options.objects, mask);
    }
    followed += options.steps || options.objects ? 1 : 0;
    const Verdict v = validate_capture(scene, pipeline, bad, spoiled_options);
    CHECK(verdict_json(v) == verdict_json(validate_capture(scene, pipeline, masked, options)));
    explained += v.violations() == 0 ? 1 : 0;
    for (const StageVerdict& stage : v.stages) {
      CHECK(stage.left_out == mask.count());
      uint64_t judged = 0;
      for (const uint64_t count : stage.counts) judged += count;
      CHECK(judged + stage.left_out == stage.classes.size());
      for (const WorstPixel& w : stage.worst) CHECK_FALSE(mask.has(w.x, w.y));
    }
  }
  CHECK(violated > 30);
  CHECK(explained == 40);
  CHECK(followed >= 5);
}

TEST_CASE("What is left out says nothing of the fault: the same findings are made, of the same pixels") {
  const Scene scene = builtin_scene("city,lights=60,objects=300");
  Pipeline pipeline = *preset_pipeline("many-lights"), wrong = pipeline;
  pipeline.width = wrong.width = 128, pipeline.height = wrong.height = 96;
  wrong.light_model.shininess *= 0.5f;
  const Capture fault = captured(scene, wrong);
  const PixelMask mask = rectangle(128, 96, 40, 40, 80, 70);
  Capture bad = fault, masked = fault;
  bad.color = spoiled(fault.color, mask);
  bad.mask = masked.mask = mask;
  Profile profile;
  profile.subpixel_bits = 8;
  const auto findings = [&](const Capture& capture) {
    const Verdict v = validate_capture(scene, pipeline, capture, {profile});
    return findings_json(diagnose(scene, pipeline, profile, capture, v.stages, {}));
  };
  const std::string found = findings(bad);
  CHECK(found.find("shininess") != std::string::npos);
  CHECK(found == findings(masked));
  bad.mask = {};
  CHECK(found != findings(bad));
}

TEST_CASE("An icon that is wrong is the worst window, at its place") {
  const Scene scene = builtin_scene("cornell");
  Pipeline pipeline;
  pipeline.width = 192, pipeline.height = 128;
  Capture capture = captured(scene, pipeline);
  for (int y = 48; y < 64; ++y)
    for (int x = 80; x < 96; ++x)
      for (int k = 0; k < 3; ++k) capture.color.set_code(x, y, k, capture.color.code(x, y, k) ^ 0x40);
  const Verdict v = validate_capture(scene, pipeline, capture);
  const StageVerdict& lighting = v.stages.back();
  REQUIRE(lighting.count(PixelClass::violation) == 256);
  const std::vector<LocalWindow> worst = worst_windows(lighting);
  REQUIRE(worst.size() == 2);
  CHECK((worst[0].x == 80 && worst[0].y == 48 && worst[0].found == 256 && worst[0].seen == 256));
  CHECK(worst[1].found == 256);
  // A code is a unit of the last place, and 64 codes are at most as many outside of what is legal.
  CHECK(worst[0].largest <= 64);
  CHECK(worst[0].mean() > 32);
  double largest = 0;
  for (const WorstPixel& w : lighting.worst) largest = std::max(largest, w.excess);
  CHECK(worst[0].largest == Approx(largest));
}
