#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/fp_env.h"
#include "explain/account_parts.h"
#include "explain/explain.h"
#include "raster/triangles/triangle_setup.h"

namespace trueshade {
namespace {

std::string name_of(const ExplainedFrame& frame, const PixelFragment& f) {
  const Mesh& mesh = frame.scene.meshes[frame.scene.instances[f.instance].mesh];
  const std::string mesh_name = mesh.name.empty() ? "" : " (" + mesh.name + ")";
  return "object " + std::to_string(f.instance) + mesh_name + ", triangle " + std::to_string(f.triangle);
}

/// The window coordinates of a fragment's piece, in 1/256 pixel, corners in canonical order: x, y of each.
std::vector<int64_t> window_coordinates(const PixelFragment& f, WindowPixel pixel) {
  std::vector<int64_t> out;
  const WindowTriangle& t = f.fan.piece[f.piece].triangle;
  for (const int k : f.edges.order) {
    out.push_back(t.x[k] + int64_t(pixel.x) * 256 + 128);
    out.push_back(t.y[k] + int64_t(pixel.y) * 256 + 128);
  }
  return out;
}

bool was_clipped(const PixelFragment& f) {
  for (int i = 0; i < f.fan.polygon.corners; ++i)
    if (f.fan.polygon.at(i).kind != 0) return true;
  return f.fan.polygon.corners != 3;
}

void add_corners(const PixelFragment& f, WindowPixel pixel, Account& to) {
  for (size_t k = 0; k < 3; ++k)
    to.add("clip" + std::to_string(k), f.clip[k].c, "clip position x, y, z, w of corner " + std::to_string(k));
  if (was_clipped(f))
    to.add("pieces", int64_t(f.fan.count),
           "triangles that clipping left of it; what follows is of the one that counts");
  to.add("window", std::span<const int64_t>(window_coordinates(f, pixel)),
         "x, y of corners 0, 1, 2 in canonical order, 1/256 pixel, y up");
}

void add_edges(const ExplainedFrame& frame, const PixelFragment& f, Account& to) {
  to.add("E", f.edges.e, "edge functions at the sample, twice an area in 1/65536 pixel^2");
  to.add("owns", f.edges.owns, "whether each edge owns samples on it");
  to.add("A", f.edges.area, "their sum");
  const GeometryState& state = frame.view.faces.of(f.instance);
  to.add("facing", is_front(state, (f.fan.facing > 0) != frame.view.window.upper_left) ? "front" : "back", "");
}

std::string outcome_words(const DepthOutcome& outcome, bool is_visible, const char* drawn_and_kept) {
  if (!outcome.passes) return "fails the depth test";
  if (!outcome.drawn) return "its alpha is below the material's cutoff";
  return is_visible ? drawn_and_kept : "drawn, and later hidden";
}

void add_outcome(const ExplainedFrame& frame, const PixelFragment& f, const DepthOutcome& outcome, Account& to) {
  if (f.offset != 0.0) to.add("offset", f.offset, "polygon offset, in the depth");
  to.add("z", f.plane_depth, "window depth in the triangle's plane");
  to.add("depth", f.depth, "as the depth format stores it");
  to.add("there", outcome.there, "the depth it is compared with");
  to.add("passes", outcome.passes,
         "depth function " + std::string(depth_func_name(frame.pipeline.geometry.depth_func)));
  if (!outcome.alpha) return;
  const uint32_t material = frame.scene.instances[f.instance].material;
  to.add("alpha", *outcome.alpha, "what the material's cutoff is compared with");
  to.add("cutoff", frame.scene.materials[material].alpha_cutoff, "fragments with less alpha are not drawn");
}

void add_fates(const PixelTriangles& triangles, Account& to) {
  constexpr const char* kNames[kFates] = {"elsewhere", "not_finite", "clipped", "no_area",
                                          "culled",    "beside",     "covers"};
  constexpr const char* kMeanings[kFates] = {"triangles whose box is more than two pixels away from the sample",
                                             "triangles with a corner whose clip position is not finite",
                                             "triangles of which nothing is left between the near and the far plane",
                                             "triangles without area once snapped to 1/256 pixel",
                                             "triangles that face culling drops",
                                             "triangles that come near but do not cover the sample",
                                             "triangles that cover the sample"};
  for (size_t i = 0; i < kFates; ++i)
    if (triangles.count[i] != 0 || Fate(i) == Fate::covers)
      to.add(kNames[i], int64_t(triangles.count[i]), kMeanings[i]);
}

Account triangles_account(const ExplainedFrame& frame, const PixelHistory& history, bool transparent) {
  const PixelTriangles& triangles = transparent ? history.transparent : history.opaque;
  const std::vector<DepthOutcome>& outcomes = transparent ? history.of_transparent : history.of_opaque;
  Account out(transparent ? "transparent_triangles" : "triangles",
              transparent ? "Transparent triangles, tested against the opaque surface (docs/arithmetic.md, section 15)"
                          : "Triangles (docs/arithmetic.md, sections 2 to 6)");
  add_fates(triangles, out);
  if (!transparent)
    out.add("clear", frame.view.window.depth.stored(frame.pipeline.geometry.clear_depth), "depth before any triangle");
  for (size_t i = 0; i < triangles.covering.size(); ++i) {
    const PixelFragment& f = triangles.covering[i];
    const bool kept = transparent || history.visible == i;
    const std::string words = outcome_words(outcomes[i], kept, transparent ? "drawn" : "visible");
    Account& part = out.part("triangle", name_of(frame, f) + ": " + words);
    part.add("object", int64_t(f.instance), "index; its id is one more").add("index", int64_t(f.triangle), "");
    if (kept) add_corners(f, history.pixel, part);
    add_edges(frame, f, part);
    add_outcome(frame, f, outcomes[i], part);
  }
  for (const PixelFragment& f : triangles.nearest) {
    char outside[32];
    std::snprintf(outside, sizeof outside, "%.4g", f.edges.pixels_outside());
    Account& part = out.part("near_triangle", name_of(frame, f) + ": " + outside + " pixels beside the sample");
    part.add("object", int64_t(f.instance), "").add("index", int64_t(f.triangle), "");
    part.add("E", f.edges.e,
             "edge functions; one below 0, or 0 on an edge that does not own it, leaves the sample out");
    part.add("owns", f.edges.owns, "whether each edge owns samples on it");
  }
  return out;
}

Account draws_account(const std::vector<TargetDraw>& draws, const BlendTarget& target, const std::string& key,
                      const std::string& title, LightDetail detail) {
  Account out(key, title);
  int64_t unchanged = 0;
  for (const TargetDraw& draw : draws) {
    if (detail == LightDetail::adding && draw.light >= 0 && draw.after == draw.before) {
      ++unchanged;
      continue;
    }
    Account& part = out.part("draw", draw.what);
    if (draw.light >= 0) part.add("light", draw.light, "index");
    part.add("source", draw.source, "R, G, B, A that the shader hands to the blender");
    part.quantities.push_back({"before", "what the pixel holds before", values_in_format(target.format, draw.before)});
    part.quantities.push_back({"after", "and after", values_in_format(target.format, draw.after)});
  }
  out.add("draws", int64_t(draws.size()), "into this pixel");
  if (unchanged > 0) out.add("unchanged", unchanged, "of them leave it as it is");
  return out;
}

std::string frame_title(const ExplainedFrame& frame, const PixelHistory& history) {
  const Pipeline& p = frame.pipeline;
  return frame.scene.spec + ", preset " + p.preset + ", " + std::string(name_of(p.strategy)) + ", " +
         std::to_string(p.width) + "x" + std::to_string(p.height) + ", " + std::string(info(p.target).name) +
         ": pixel " + std::to_string(history.pixel.x) + ',' + std::to_string(p.height - 1 - history.pixel.y);
}

/// What most people ask: what is seen, and which lights make it bright.
void add_summary(const ExplainedFrame& frame, const PixelHistory& history, Account& to) {
  if (!history.visible) {
    to.add("seen", "nothing: the clear colour", "");
    return;
  }
  to.add("seen", name_of(frame, history.opaque.covering[*history.visible]), "");
  const std::vector<LightAtPixel>& lights = history.target.visible.lights;
  std::vector<size_t> adding;
  for (size_t i = 0; i < lights.size(); ++i)
    if (lights[i].fate == LightFate::adds) adding.push_back(i);
  to.add("lights", std::to_string(adding.size()) + " of " + std::to_string(lights.size()), "lights that add something");
  const auto strength = [&](size_t i) {
    return std::fabs(lights[i].term[0]) + std::fabs(lights[i].term[1]) + std::fabs(lights[i].term[2]);
  };
  std::stable_sort(adding.begin(), adding.end(), [&](size_t a, size_t b) { return strength(a) > strength(b); });
  adding.resize(std::min<size_t>(adding.size(), 8));
  if (!adding.empty())
    to.add("strongest", std::vector<int64_t>(adding.begin(), adding.end()),
           "indices of those that add most, the strongest first");
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

Account account_of(const ExplainedFrame& frame, const PixelHistory& history, LightDetail detail) {
  const FpScope fp;
  Account out("pixel", frame_title(frame, history));
  out.add("pixel", std::array{int64_t(history.pixel.x), int64_t(frame.pipeline.height - 1 - history.pixel.y)},
          "column and row from the top left");
  out.add("window", std::array{int64_t(history.pixel.x), int64_t(history.pixel.y)},
          "the same in OpenGL's window, y up");
  add_summary(frame, history, out);
  out.parts.push_back(triangles_account(frame, history, false));
  if (frame.transparency != TransparencyMode::none) out.parts.push_back(triangles_account(frame, history, true));
  if (history.visible)
    out.parts.push_back(surface_account(frame, history.opaque.covering[*history.visible], history.surface));
  if (!history.albedo_draws.empty()) {
    const BlendTarget plane{surface_planes(frame.pipeline).albedo.format, frame.pipeline.profile,
                            frame.pipeline.gbuffer.half_round};
    out.parts.push_back(draws_account(history.albedo_draws, plane, "albedo_draws",
                                      "Transparent surfaces blended into the albedo (docs/arithmetic.md, section 15)",
                                      detail));
  }
  if (history.visible) out.parts.push_back(lights_account(frame, history.target.visible, "lights", detail));
  for (size_t i = 0; i < history.target.glass.size(); ++i)
    out.parts.push_back(
        lights_account(frame, history.target.glass[i], "lights_of_transparent_" + std::to_string(i), detail));
  Account draws = draws_account(history.target.draws, frame.target, "target",
                                "Target, draw by draw (docs/arithmetic.md, sections 7, 10 and 14)", detail);
  draws.add("value", values_of(frame.target, history.target.stored),
            "of the stored pixel as a shader reads it: R, G, B, A");
  out.parts.push_back(std::move(draws));
  out.quantities.push_back({"stored", std::string(info(frame.target.format).name) + ", R, G, B, A",
                            values_in_format(frame.target.format, history.target.stored)});
  return out;
}

}  // namespace trueshade
