#include <algorithm>
#include <cmath>

#include "core/fp_env.h"
#include "explain/account_parts.h"
#include "explain/explain.h"

namespace trueshade {
namespace {

Account draws_account(const std::vector<TargetDraw>& draws, const BlendTarget& target, const std::string& key,
                      const std::string& title, Detail detail) {
  Account out(key, title);
  std::vector<int64_t> unchanged;
  for (const TargetDraw& draw : draws) {
    if (detail == Detail::usual && draw.blends && draw.light >= 0 && draw.after == draw.before) {
      unchanged.push_back(draw.light);
      continue;
    }
    Account& part = out.part("draw", draw.what);
    if (draw.light >= 0) part.add("light", draw.light, "index");
    part.add("source", draw.source, draw.blends ? "R, G, B, A that are blended" : "R, G, B, A that are stored");
    if (draw.blends)
      part.quantities.push_back(
          {"before", "what the pixel holds before", values_in_format(target.format, draw.before), true, {}});
    part.quantities.push_back({"after", "and after", values_in_format(target.format, draw.after), true, {}});
  }
  out.add("draws", int64_t(draws.size()), "into this pixel");
  if (unchanged.empty()) return out;
  out.add("unchanged", unchanged, "lights whose draws leave it as it is: they add nothing, or it is rounded away");
  out.quantities.back().shown = index_ranges(unchanged);
  return out;
}

std::string frame_title(const ExplainedFrame& frame, const PixelHistory& history) {
  const Pipeline& p = frame.pipeline;
  const LightProgram& program = p.light_program;
  const std::string lights = program.used() ? ", light program " + program.file : ", preset " + p.preset;
  return frame.scene.spec + lights + ", " + std::string(name_of(p.strategy)) + ", " + std::to_string(p.width) + "x" +
         std::to_string(p.height) + ", " + std::string(info(p.target).name) + ": pixel " +
         std::to_string(history.pixel.x) + ',' + std::to_string(p.height - 1 - history.pixel.y);
}

/// Adds what most people ask: the transparent surfaces in front, the surface that is seen, how many lights add to it,
/// and the eight that add most. Without a visible surface, adds that nothing is seen and leaves out the lights.
void add_summary(const ExplainedFrame& frame, const PixelHistory& history, Account& to) {
  std::vector<std::string> through;
  for (const size_t i : history.glass_at) {
    const CoveringTriangle& f = history.transparent.covering[i];
    through.push_back(name_of(frame, f.instance, f.triangle));
  }
  if (!through.empty()) to.add("through", through, "transparent, drawn over what is seen");
  if (!history.visible) {
    to.add("seen", history.draws.size() > 1 ? "no opaque surface" : "nothing: the clear colour", "");
    return;
  }
  const CoveringTriangle& f = history.opaque.covering[*history.visible];
  to.add("seen", name_of(frame, f.instance, f.triangle), "");
  const std::vector<LightAtPixel>& lights = history.lit.visible.lights;
  std::vector<int64_t> adding;
  for (size_t i = 0; i < lights.size(); ++i)
    if (lights[i].fate == LightFate::adds) adding.push_back(int64_t(i));
  to.add("adding", int64_t(adding.size()), "lights that add something, of " + std::to_string(lights.size()));
  std::stable_sort(adding.begin(), adding.end(),
                   [&](int64_t a, int64_t b) { return strength(lights[size_t(a)]) > strength(lights[size_t(b)]); });
  adding.resize(std::min<size_t>(adding.size(), 8));
  if (!adding.empty()) to.add("strongest", adding, "indices of those that add most, the strongest first");
}

/// Adds parts for every surface that light comes from: the visible one, those tied with it, and transparent ones; each
/// with its planes and its lights.
void add_surfaces(const ExplainedFrame& frame, const PixelHistory& history, Detail detail, Account& to) {
  const GBufferState planes = surface_planes(frame.pipeline);
  const LightsReach reach = blends_lights(frame.pipeline.strategy) ? LightsReach::one_by_one : LightsReach::as_a_sum;
  const auto named = [&](const CoveringTriangle& f) { return name_of(frame, f.instance, f.triangle); };
  if (history.visible) {
    const CoveringTriangle& f = history.opaque.covering[*history.visible];
    to.parts.push_back(surface_account(frame, f.instance, history.surface, planes, named(f)));
  }
  if (!history.albedo_draws.empty()) {
    const BlendTarget plane{planes.albedo.format, frame.pipeline.profile, frame.pipeline.gbuffer.half_round};
    to.parts.push_back(draws_account(history.albedo_draws, plane, "albedo_draws",
                                     "Transparent surfaces blended into the albedo (docs/arithmetic.md, section 15)",
                                     Detail::all));
  }
  if (history.visible)
    to.parts.push_back(
        lights_account(frame, history.lit.visible, reach, named(history.opaque.covering[*history.visible]), detail));
  for (size_t i = 0; i < history.tied.size(); ++i) {
    const CoveringTriangle& f = history.opaque.covering[history.tied_at[i]];
    const std::string of = "surface " + std::to_string(i) + " at this depth, " + named(f);
    to.parts.push_back(surface_account(frame, f.instance, history.tied[i], planes, of));
    to.parts.push_back(lights_account(frame, history.lit.tied[i], reach, of, detail));
  }
  Pipeline forward = frame.pipeline;
  forward.strategy = Strategy::forward_loop;
  for (size_t i = 0; i < history.glass.size(); ++i) {
    const CoveringTriangle& f = history.transparent.covering[history.glass_at[i]];
    const std::string of = "transparent surface " + std::to_string(i) + ", " + named(f);
    to.parts.push_back(surface_account(frame, f.instance, history.glass[i], surface_planes(forward), of));
    if (i < history.lit.glass.size())
      to.parts.push_back(lights_account(frame, history.lit.glass[i], LightsReach::as_a_sum, of, detail));
  }
}

}  // namespace

std::vector<AccountValue> values_in_format(Format format, const StoredPixel& stored) {
  std::vector<AccountValue> out;
  for (int c = 0; c < info(format).channels; ++c) {
    const float value = stored[size_t(c)];
    out.push_back(info(format).number_class == NumberClass::unorm ? AccountValue(int64_t(value)) : AccountValue(value));
  }
  return out;
}

Account account_of(const ExplainedFrame& frame, const PixelHistory& history, Detail detail) {
  const FpScope fp;
  Account out("pixel", frame_title(frame, history));
  const auto stored = [&]() -> Account& {
    out.quantities.push_back({"stored",
                              std::string(info(frame.pipeline.target).name) + ", R, G, B, A",
                              values_in_format(frame.target.format, history.stored),
                              true,
                              {}});
    return out;
  };
  if (detail == Detail::brief) {
    add_summary(frame, history, out);
    add_nonfinite(frame, history, out);
    return stored();
  }
  out.add("pixel", std::array{int64_t(history.pixel.x), int64_t(frame.pipeline.height - 1 - history.pixel.y)},
          "column and row from the top left");
  out.add("window", std::array{int64_t(history.pixel.x), int64_t(history.pixel.y)},
          "the same in OpenGL's window, y up");
  add_summary(frame, history, out);
  add_nonfinite(frame, history, out);
  out.parts.push_back(triangles_account(frame, history, Surfaces::opaque, detail));
  if (frame.transparency != TransparencyMode::none)
    out.parts.push_back(triangles_account(frame, history, Surfaces::transparent, detail));
  add_surfaces(frame, history, detail, out);
  Account draws = draws_account(history.draws, frame.target, "target",
                                "Target, draw by draw (docs/arithmetic.md, sections 7, 10 and 14)", detail);
  draws.add("value", values_of(frame.target, history.stored), "of the stored pixel as a shader reads it: R, G, B, A");
  out.parts.push_back(std::move(draws));
  return stored();
}

}  // namespace trueshade
