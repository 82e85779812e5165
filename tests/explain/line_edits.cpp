// Where another picture's value comes from a slip in a line of the light program, the line is named.
#include "explain/line_edits.h"

#include <algorithm>
#include <string>

#include "explain/against.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "scenes/pipeline/program_inputs.h"
#include "shading/frame.h"
#include "tests/catch.hpp"

namespace trueshade {
namespace {

constexpr const char* kLambert = R"glsl(
layout(std140) uniform Parameters { float gain; };
vec3 light(Surface s, Light l, View v) {
  vec3 d = l.position - s.position, n = normalize(s.normal), to = normalize(d);
  float d2 = dot(d, d), part = d2 / (l.range * l.range), window = clamp(1.0 - part * part, 0.0, 1.0);
  float nl = max(dot(n, to), 0.0);
  return gain * s.albedo.rgb * l.color * (nl * window / (d2 + 1.0));
}
)glsl";

Pipeline lit_by(const std::string& text, Strategy strategy, Format target) {
  Pipeline pipeline = presets().front().pipeline;
  pipeline.width = 96, pipeline.height = 64;
  pipeline.strategy = strategy, pipeline.target = target;
  pipeline.light_program = {"lambert.glsl", text, {}, {{"gain", {4}}}};
  return pipeline;
}

std::string with(const std::string& right, const std::string& wrong) {
  std::string text = kLambert;
  return text.replace(text.find(right), right.size(), wrong);
}

TEST_CASE("A slip in a line of the light program is among the edits that make a pixel's value, under every strategy") {
  struct Slip {
    const char *right, *wrong, *drawn_as;
  };
  constexpr Slip kSlips[] = {
      {"part * part", "part",
       "float d2 = dot(d, d), part = d2 / (l.range * l.range), window = clamp(1.0 - part, 0.0, 1.0);"},
      {"normalize(d);", "d;", "vec3 d = l.position - s.position, n = normalize(s.normal), to = d;"},
      {"nl * window", "nl", "return gain * s.albedo.rgb * l.color * (nl / (d2 + 1.0));"}};
  const Scene scene = builtin_scene("cornell");
  for (const Strategy strategy : {Strategy::deferred_loop, Strategy::deferred_volumes, Strategy::forward_multipass})
    for (const auto& [right, wrong, drawn_as] : kSlips) {
      const Pipeline pipeline = lit_by(kLambert, strategy, Format::rgba16f);
      const Image reference = render_frame(scene, pipeline).color,
                  other = render_frame(scene, lit_by(with(right, wrong), strategy, Format::rgba16f)).color;
      const ExplainedFrame frame(scene, pipeline);
      int changed = 0, made = 0, named = 0;
      for (int y = 8; y < 64; y += 32)
        for (int x = 8; x < 96; x += 36) {
          const StoredPixel given = stored_in(other, x, y);
          if (given == stored_in(reference, x, y)) continue;
          const PixelHistory history = history_of(frame, x, y);
          const LineEdits edits = line_edits_for(frame, history, given, 8);
          ++changed, made += !edits.nearest.empty() && edits.nearest[0].difference == 0;
          CHECK(edits.left_out == 0);
          CHECK(edits.alike >= 1);
          named += std::any_of(edits.nearest.begin(), edits.nearest.end(), [&, &line = drawn_as](const LineEdit& edit) {
            return edit.difference == 0 && edit.drawn_as == line && edit.stored == given;
          });
        }
      INFO(name_of(strategy) << ", " << right << " as " << wrong);
      CHECK(changed >= 3);
      CHECK(made == changed);
      CHECK(named == changed);
    }
}

TEST_CASE("A parameter that was another is named where no slip makes the value") {
  const Scene scene = builtin_scene("cornell");
  const Pipeline pipeline = lit_by(kLambert, Strategy::deferred_loop, Format::rgba32f);
  Pipeline brighter = pipeline;
  brighter.light_program.parameters[0].value[0] = 5;
  const Image other = render_frame(scene, brighter).color;
  const ExplainedFrame frame(scene, pipeline);
  const LineEdits edits = line_edits_for(frame, history_of(frame, 40, 40), stored_in(other, 40, 40));
  REQUIRE(!edits.nearest.empty());
  CHECK(edits.nearest[0].what == "the parameter `gain` was 1.25 times the value that is given here");
  CHECK(edits.nearest[0].line == 0);
  CHECK(edits.nearest[0].difference < 1e-3);
}

TEST_CASE("Where no light program draws, and where nothing is seen, no line is tried") {
  const Scene scene = builtin_scene("cornell");
  Pipeline preset = presets().front().pipeline;
  preset.width = 96, preset.height = 64;
  for (const Pipeline& pipeline : {preset, lit_by(kLambert, Strategy::deferred_loop, Format::rgba8)}) {
    Scene empty = scene;
    if (pipeline.light_program.used()) empty.instances.clear();
    const ExplainedFrame frame(empty, pipeline);
    CHECK(line_edits_for(frame, history_of(frame, 40, 40), {1, 2, 3, 4}).tried == 0);
  }
}

}  // namespace
}  // namespace trueshade
