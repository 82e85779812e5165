// Where another picture's value comes from: what was changed is named, and named first.
#include "explain/against.h"

#include <string>

#include "judge/stages/legal_pixel.h"
#include "scenes/builtin/pcg32.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"

namespace trueshade {
namespace {

struct Explained {
  Scene scene;
  Pipeline pipeline = presets().front().pipeline;
  explicit Explained(const char* spec = "builtin:city") : scene(load_scene(spec)) {
    pipeline.width = 160, pipeline.height = 120;
  }
};

/// The candidates for what another frame holds at a pixel.
std::vector<Candidate> candidates(const Explained& e, const Image& reference, const Image& other, int x, int y) {
  const ExplainedFrame frame(e.scene, e.pipeline);
  return candidates_for(frame, history_of(frame, x, y), reference, stored_in(other, x, y));
}

TEST_CASE("a light that another renderer leaves out is named, wherever it makes a difference") {
  const Explained e("builtin:sphere");
  const Image reference = render_frame(e.scene, e.pipeline).color;
  // The light that adds most at the middle of the picture.
  const PixelHistory middle = history_of(ExplainedFrame(e.scene, e.pipeline), 80, 60);
  size_t left_out = 0;
  for (size_t i = 0; i < middle.lit.visible.lights.size(); ++i)
    if (middle.lit.visible.lights[i].term[0] > middle.lit.visible.lights[left_out].term[0]) left_out = i;
  Scene without = e.scene;
  without.lights[left_out].color = glm::vec3(0.0f);
  const Image other = render_frame(without, e.pipeline).color;
  int changed = 0, named = 0;
  for (int y = 30; y < 90; y += 3)
    for (int x = 40; x < 120; x += 3) {
      if (stored_in(other, x, y) == stored_in(reference, x, y)) continue;
      ++changed;
      const std::vector<Candidate> found = candidates(e, reference, other, x, y);
      for (const Candidate& candidate : found)
        if (candidate.difference == 0.0 && candidate.what == "light " + std::to_string(left_out) + " left out") ++named;
    }
  CHECK(changed > 20);
  CHECK(named == changed);
}

TEST_CASE("a light model of another kind, and a picture upside down, are named") {
  const Explained e;
  const Image reference = render_frame(e.scene, e.pipeline).color;
  Explained dull;
  dull.pipeline.light_model.specular = Specular::none;
  const Image other = render_frame(dull.scene, dull.pipeline).color;
  Image turned = reference;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x)
      for (int c = 0; c < 4; ++c) turned.set_code(x, y, c, reference.code(x, 119 - y, c));
  const auto names = [&](const Image& image, int x, int y, const std::string& what) {
    for (const Candidate& candidate : candidates(e, reference, image, x, y))
      if (candidate.difference == 0.0 && candidate.what.find(what) != std::string::npos) return true;
    return false;
  };
  Pcg32 random(3);
  int dulled = 0;
  for (int i = 0; i < 200; ++i) {
    const int x = int(random.below(160)), y = int(random.below(120));
    if (stored_in(other, x, y) != stored_in(reference, x, y)) {
      ++dulled;
      CHECK(names(other, x, y, "no specular term"));
    }
    if (i < 20 && stored_in(turned, x, y) != stored_in(reference, x, y)) CHECK(names(turned, x, y, "upside down"));
  }
  CHECK(dulled > 20);
}

TEST_CASE("the value that the frame has needs no candidate") {
  const Explained e;
  const Image reference = render_frame(e.scene, e.pipeline).color;
  CHECK(candidates(e, reference, reference, 80, 50).empty());
}

oracle::Capture captured(const Scene& scene, const Pipeline& pipeline) {
  const std::vector<std::string> planes = {"depth", "position", "normal", "albedo", "id.object"};
  Frame frame = render_frame(scene, pipeline, {}, planes);
  oracle::Capture capture;
  capture.color = std::move(frame.color), capture.planes = std::move(frame.aovs);
  return capture;
}

TEST_CASE("what one pixel may hold is an interval about the frame's value, and what is outside is a violation") {
  const Explained e;
  for (const Strategy strategy : {Strategy::deferred_loop, Strategy::deferred_volumes}) {
    Pipeline pipeline = e.pipeline;
    pipeline.strategy = strategy;
    oracle::Capture capture = captured(e.scene, pipeline);
    const Image reference = capture.color;
    Pcg32 random(5);
    for (int i = 0; i < 12; ++i) {
      const int x = int(random.below(160)), y = int(random.below(120));
      CAPTURE(name_of(strategy), x, y);
      const auto legal = oracle::legal_pixel(e.scene, pipeline, {}, capture, reference, x, y);
      CHECK(legal.pixel_class == oracle::PixelClass::exact);
      CHECK(legal.channels == 4);
      for (int c = 0; c < 3; ++c) {
        const double code = reference.code(x, y, c);
        const auto& channel = legal.channel[size_t(c)];
        REQUIRE(channel.is_bounded);
        CHECK(channel.low <= code);
        CHECK(channel.high >= code);
        CHECK(channel.high - channel.low <= (strategy == Strategy::deferred_loop ? 1.0 : 64.0));
        if (channel.high >= 255.0) continue;
        capture.color.set_code(x, y, c, uint32_t(channel.high) + 1);
        CHECK(oracle::legal_pixel(e.scene, pipeline, {}, capture, reference, x, y).pixel_class ==
              oracle::PixelClass::violation);
        capture.color = reference;
      }
    }
  }
}

}  // namespace
}  // namespace trueshade
