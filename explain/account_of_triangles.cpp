#include <algorithm>
#include <cstdio>

#include "explain/account_parts.h"
#include "raster/triangles/triangle_setup.h"

namespace trueshade {
namespace {

constexpr size_t kMostTrianglesListed = 64;

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

/// Whether the triangle's polygon is not the triangle as submitted.
bool was_clipped(const PixelFragment& f) {
  for (int i = 0; i < f.fan.polygon.corners; ++i)
    if (f.fan.polygon.at(i).kind != 0) return true;
  return f.fan.polygon.corners != 3;
}

/// Adds the clip positions, how many pieces clipping left, and the window coordinates and depths of the piece that
/// counts.
void add_corners(const PixelFragment& f, WindowPixel pixel, Account& to) {
  for (size_t k = 0; k < 3; ++k)
    to.add("clip" + std::to_string(k), f.clip[k].c, "clip position x, y, z, w of corner " + std::to_string(k));
  if (was_clipped(f))
    to.add("pieces", int64_t(f.fan.count),
           "triangles that clipping left of it; what follows is of the one that counts");
  to.add("window", window_coordinates(f, pixel),
         "x, y of corners 0, 1, 2, 1/256 pixel, y up; corner 0 has the least y, then x");
  const double* const z = f.fan.piece[f.piece].triangle.z;
  to.add("z_i", std::array{z[f.edges.order[0]], z[f.edges.order[1]], z[f.edges.order[2]]}, "their window depths");
}

/// Adds the edge functions, the facing, the polygon offset where it is not 0, and the depths.
void add_edges(const ExplainedFrame& frame, const PixelFragment& f, Account& to) {
  to.add("E", f.edges.e,
         "edge functions at the sample: twice an area, 1/65536 pixel^2; covered: all above 0, or 0 if owned");
  to.add("owns", f.edges.owns, "whether each edge owns samples on it");
  to.add("A", f.edges.area, "their sum");
  const GeometryState& state = frame.view.faces.of(f.instance);
  to.add("facing", is_front(state, (f.fan.facing > 0) != frame.view.window.upper_left) ? "front" : "back", "");
  if (f.offset != 0.0) to.add("offset", f.offset, "polygon offset, in the depth");
  to.add("z", f.plane_depth, "window depth in the triangle's plane");
  to.add("depth", f.depth, "as the depth format stores it");
}

/// Adds what the depth test and, where it was asked, the alpha test made of a fragment.
void add_outcome(const ExplainedFrame& frame, const PixelFragment& f, const DepthOutcome& outcome, Account& to) {
  to.add("there", outcome.there, "the depth it is compared with");
  to.add("passes", outcome.passes,
         "depth function " + std::string(depth_func_name(frame.pipeline.geometry.depth_func)));
  if (!outcome.alpha) return;
  const uint32_t material = frame.scene.instances[f.instance].material;
  to.add("alpha", *outcome.alpha, "what the material's cutoff is compared with");
  to.add("cutoff", frame.scene.materials[material].alpha_cutoff, "fragments with less alpha are not drawn");
}

/// Adds how many triangles had each fate; fates of none are left out, but for `covers`.
void add_fates(const PixelTriangles& triangles, Account& to) {
  struct Row {
    Fate fate;
    const char *name, *meaning;
  };
  constexpr Row kRows[] = {
      {Fate::elsewhere, "elsewhere", "triangles whose box is more than two pixels away from the sample"},
      {Fate::not_finite, "not_finite", "triangles with a corner whose clip position is not finite"},
      {Fate::clipped_away, "clipped", "triangles of which nothing is left between near and far plane"},
      {Fate::without_area, "no_area", "triangles without area once snapped to 1/256 pixel"},
      {Fate::culled, "culled", "triangles that face culling drops"},
      {Fate::beside, "beside", "triangles whose box is near, but that do not cover the sample"},
      {Fate::covers, "covers", "triangles that cover the sample"}};
  for (const Row& row : kRows)
    if (triangles.count[size_t(row.fate)] != 0 || row.fate == Fate::covers)
      to.add(row.name, int64_t(triangles.count[size_t(row.fate)]), row.meaning);
}

bool holds(const std::vector<size_t>& indices, size_t index) {
  return std::find(indices.begin(), indices.end(), index) != indices.end();
}

/// What became of a covering triangle, in words.
std::string outcome_words(const PixelHistory& history, Surfaces which, size_t index) {
  const bool transparent = which == Surfaces::transparent;
  const DepthOutcome& outcome = (transparent ? history.of_transparent : history.of_opaque)[index];
  if (!transparent && history.visible == index) return "visible";
  if (!transparent && holds(history.tied_at, index))
    return "at the stored depth, so that every light but the first draws it too";
  if (!outcome.passes) return "fails the depth test";
  if (!outcome.drawn) return "its alpha is below the material's cutoff";
  return transparent ? "drawn" : "drawn, and later hidden";
}

/// The covering triangles that get a part of their own, by index, in the order of submission: all, or the 64 last and
/// those that light comes from.
std::vector<size_t> listed(const PixelHistory& history, Surfaces which, Detail detail) {
  const std::vector<DepthOutcome>& outcomes =
      which == Surfaces::transparent ? history.of_transparent : history.of_opaque;
  std::vector<size_t> out;
  size_t drawn = 0;
  for (size_t i = outcomes.size(); i-- > 0;) {
    const bool lit = which == Surfaces::opaque && (history.visible == i || holds(history.tied_at, i));
    if (lit || detail == Detail::all || out.size() < kMostTrianglesListed) out.push_back(i);
    drawn += outcomes[i].drawn;
  }
  std::reverse(out.begin(), out.end());
  return out;
}

/// Adds a part for a triangle that is culled or lies beside the sample.
void add_near(const ExplainedFrame& frame, const PixelFragment& f, const std::string& words, Account& to) {
  Account& part = to.part("near_triangle", name_of(frame, f.instance, f.triangle) + ": " + words);
  part.add("object", int64_t(f.instance), "").add("index", int64_t(f.triangle), "");
  part.add("distance", f.distance, "from the sample, pixels");
  add_edges(frame, f, part);
}

}  // namespace

std::string name_of(const ExplainedFrame& frame, uint32_t instance, uint32_t triangle) {
  const std::string& mesh = frame.scene.meshes[frame.scene.instances[instance].mesh].name;
  const std::string base = mesh.substr(mesh.rfind('/') == std::string::npos ? 0 : mesh.rfind('/') + 1);
  return "object " + std::to_string(instance) + (base.empty() ? "" : " (" + base + ")") + ", triangle " +
         std::to_string(triangle);
}

Account triangles_account(const ExplainedFrame& frame, const PixelHistory& history, Surfaces which, Detail detail) {
  const bool transparent = which == Surfaces::transparent;
  const PixelTriangles& triangles = transparent ? history.transparent : history.opaque;
  const std::vector<DepthOutcome>& outcomes = transparent ? history.of_transparent : history.of_opaque;
  Account out(transparent ? "transparent_triangles" : "triangles",
              transparent ? "Transparent triangles, tested against the opaque surface (docs/arithmetic.md, section 15)"
                          : "Triangles (docs/arithmetic.md, sections 2 to 6)");
  add_fates(triangles, out);
  if (!transparent)
    out.add("clear", frame.view.window.depth.stored(frame.pipeline.geometry.clear_depth), "depth before any triangle");
  const std::vector<size_t> shown = listed(history, which, detail);
  if (shown.size() < outcomes.size())
    out.add("left_out", int64_t(outcomes.size() - shown.size()), "of those that cover it: --all prints them");
  for (const size_t i : shown) {
    const PixelFragment f = fragment_of(frame, triangles.covering[i], history.pixel);
    Account& part =
        out.part("triangle", name_of(frame, f.instance, f.triangle) + ": " + outcome_words(history, which, i));
    part.add("object", int64_t(f.instance), "index; its id is one more").add("index", int64_t(f.triangle), "");
    if (detail == Detail::all || outcomes[i].drawn) add_corners(f, history.pixel, part);
    add_edges(frame, f, part);
    add_outcome(frame, f, outcomes[i], part);
  }
  for (const PixelFragment& f : triangles.culled) add_near(frame, f, "culled; it would cover the sample", out);
  for (const PixelFragment& f : triangles.nearest) {
    char words[48];
    std::snprintf(words, sizeof words, "%.4g pixels beside the sample", f.distance);
    add_near(frame, f, words, out);
  }
  return out;
}

}  // namespace trueshade
