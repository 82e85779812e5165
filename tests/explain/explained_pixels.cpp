// An explanation ends in what the frame holds: the stored pixel and every plane, bit for bit.
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "explain/explain.h"
#include "scenes/builtin/pcg32.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/judge/random_scene.h"
#include "tests/raster/random_frame.h"

namespace trueshade {
namespace {

bool same_bits(float a, float b) {
  return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b) || (a != a && b != b);
}

/// What a pixel's channel holds in the form of blend_pixels(): a code as a float, or the float.
float stored_in(const Image& image, int x, int y, int c) {
  return info(image.format).number_class == NumberClass::unorm ? float(image.code(x, y, c))
                                                               : float(image.value(x, y, c));
}

std::string number(float value) { return value_text(AccountValue(value)); }

/// A frame with every plane, and pixels of it explained.
class Comparison {
 public:
  Comparison(const Scene& scene, const Pipeline& pipeline) : explained_(scene, pipeline) {
    std::vector<std::string> planes = {"depth", "position", "normal", "albedo", "uv", "id.object"};
    if (reads_specular_plane(pipeline.light_model)) planes.push_back("specular");
    if (pipeline.light_model.emission) planes.push_back("emission");
    frame_ = render_frame(scene, explained_.pipeline, {}, planes);
  }

  /// What is wrong with the explanation of a pixel; empty if nothing is.
  std::string wrong_at(int x, int y) const {
    const PixelHistory history = history_of(explained_, x, y);
    const std::string at = "pixel " + std::to_string(x) + ',' + std::to_string(y) + ": ";
    for (int c = 0; c < info(frame_.color.format).channels; ++c) {
      const float there = stored_in(frame_.color, x, y, c), told = history.stored[size_t(c)];
      if (!same_bits(there, told))
        return at + "target channel " + std::to_string(c) + " is " + number(there) + ", explained as " + number(told) +
               '\n' + account_text(account_of(explained_, history));
    }
    for (const NamedImage& plane : frame_.aovs)
      if (const std::string wrong = wrong_plane(plane, history, x, y); !wrong.empty()) return at + wrong;
    return {};
  }

  /// Explains `count` pixels at random; the first fault, or nothing.
  std::string wrong_in(Pcg32& random, int count) const {
    for (int i = 0; i < count; ++i) {
      const int x = int(random.below(uint32_t(frame_.color.width))),
                y = int(random.below(uint32_t(frame_.color.height)));
      if (std::string wrong = wrong_at(x, y); !wrong.empty()) return wrong;
    }
    return {};
  }

  uint64_t covered() const { return frame_.stats.covered_pixels; }

 private:
  static std::vector<float> told_of(const std::string& plane, const SurfacePlanes& surface) {
    const auto all = [](const auto& values) { return std::vector<float>(values.begin(), values.end()); };
    if (plane == "position") return all(surface.position);
    if (plane == "normal") return all(surface.normal);
    if (plane == "albedo") return all(surface.albedo);
    if (plane == "uv") return all(surface.uv);
    if (plane == "specular") return all(surface.specular);
    return all(surface.emission);
  }

  std::string wrong_plane(const NamedImage& plane, const PixelHistory& history, int x, int y) const {
    if (plane.name == "depth") {
      const auto there = float(plane.image.value(x, y, 0));
      return same_bits(there, history.depth) ? ""
                                             : "depth is " + number(there) + ", explained as " + number(history.depth);
    }
    if (plane.name == "id.object") {
      const uint32_t told = history.visible ? history.opaque.covering[*history.visible].instance + 1 : 0;
      return plane.image.code(x, y, 0) == told ? "" : "another object is seen than explained";
    }
    if (!history.visible) return {};
    const std::vector<float> told = told_of(plane.name, history.surface.read);
    const bool halved = plane.name == "normal" && info(plane.image.format).number_class == NumberClass::unorm;
    for (size_t c = 0; c < std::min(told.size(), size_t(info(plane.image.format).channels)); ++c) {
      auto there = float(plane.image.value(x, y, int(c)));
      if (halved) there = (there + there) - 1.0f;
      if (!same_bits(there, told[c]))
        return plane.name + " channel " + std::to_string(c) + " is " + number(there) + ", explained as " +
               number(told[c]);
    }
    return {};
  }

  ExplainedFrame explained_;
  Frame frame_;
};

TEST_CASE("an explanation ends in the stored pixel, of every preset, strategy and target", "[slow]") {
  Pcg32 random(17);
  for (const char* spec : {"builtin:city", "builtin:lecture", "builtin:sphere", "builtin:circle", "builtin:cornell"}) {
    const Scene scene = load_scene(spec);
    for (const Preset& preset : presets())
      for (const Strategy strategy :
           {Strategy::forward_multipass, Strategy::forward_loop, Strategy::deferred_volumes, Strategy::deferred_loop}) {
        Pipeline pipeline = preset.pipeline;
        pipeline.width = 64, pipeline.height = 48;
        pipeline.strategy = strategy;
        for (const Format target : kTargetFormats) {
          pipeline.target = target;
          INFO(spec << ' ' << preset.name << ' ' << name_of(strategy) << ' ' << info(target).name);
          CHECK(Comparison(scene, pipeline).wrong_in(random, 2) == "");
        }
      }
  }
}

TEST_CASE("a light whose geometry is culled at a pixel is said to be not drawn there") {
  const Scene scene = load_scene("builtin:cornell,lights=3");
  Pipeline pipeline = *preset_pipeline("redsdk");
  pipeline.width = pipeline.height = 64;
  const ExplainedFrame frame(scene, pipeline);
  const PixelHistory history = history_of(frame, 20, 40);
  REQUIRE(history.lit.geometry.size() == 3);
  CHECK(history.lit.geometry[1] == 0);
  CHECK(history.lit.visible.lights[1].fate == LightFate::not_drawn);
  CHECK(history.lit.visible.lights[0].fate == LightFate::adds);
}

TEST_CASE("an explanation ends in the stored pixel, of random scenes and pipelines with maps and glass") {
  Pcg32 random(29);
  uint64_t covered = 0;
  for (int i = 0; i < 120; ++i) {
    const Scene scene = testing::random_scene(random);
    const Pipeline pipeline = testing::random_pipeline(random);
    INFO("try " << i << ' ' << pipeline_json(pipeline));
    const Comparison comparison(scene, pipeline);
    covered += comparison.covered();
    REQUIRE(comparison.wrong_in(random, 24) == "");
  }
  CHECK(covered > 120 * 100);
}

TEST_CASE("an explanation ends in the stored pixel, of random triangles under every state of the geometry pass") {
  testing::Random random(31);
  Pcg32 pixels(31);
  uint64_t covered = 0;
  for (int i = 0; i < 240; ++i) {
    Scene scene = testing::random_scene(random);
    if (i % 2 == 0) testing::add_maps(random, scene);
    if (i % 4 == 0) testing::add_uv_sets(random, scene);
    if (i % 3 == 0) testing::add_faces(random, scene);
    const Pipeline pipeline = testing::random_pipeline(random);
    INFO("try " << i << ' ' << pipeline_json(pipeline));
    const Comparison comparison(scene, pipeline);
    covered += comparison.covered();
    REQUIRE(comparison.wrong_in(pixels, 24) == "");
  }
  CHECK(covered > 240 * 100);
}

}  // namespace
}  // namespace trueshade
