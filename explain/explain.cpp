#include "explain/explain.h"

#include "core/error.h"
#include "core/fp_env.h"

namespace trueshade {
namespace {

/// Whether depth z passes the depth test against the stored depth `there` (GL 4.6 core, 17.3.4).
bool passes_depth(DepthFunc func, float z, float there) {
  switch (func) {
    case DepthFunc::never:
      return false;
    case DepthFunc::less:
      return z < there;
    case DepthFunc::equal:
      return z == there;
    case DepthFunc::lequal:
      return z <= there;
    case DepthFunc::greater:
      return z > there;
    case DepthFunc::notequal:
      return z != there;
    case DepthFunc::gequal:
      return z >= there;
    case DepthFunc::always:
      return true;
  }
  return false;
}

/// Tests a fragment against the stored depth `there`, then, where it passes, its alpha against the material's cutoff.
DepthOutcome tested(const ExplainedFrame& frame, const CoveringTriangle& fragment, WindowPixel pixel, DepthFunc func,
                    float there) {
  DepthOutcome out{there, passes_depth(func, fragment.depth, there), std::nullopt, false};
  if (!out.passes) return out;
  if (has_alpha_test(frame, fragment.instance)) out.alpha = tested_alpha(frame, fragment_of(frame, fragment, pixel));
  const uint32_t material = frame.scene.instances[fragment.instance].material;
  out.drawn = !out.alpha || *out.alpha >= frame.scene.materials[material].alpha_cutoff;
  return out;
}

/// Draws the opaque fragments in order: sets out.of_opaque, out.visible and out.depth, which is the clear depth where
/// none is drawn.
void find_visible(const ExplainedFrame& frame, PixelHistory& out) {
  const GeometryState& state = frame.pipeline.geometry;
  out.depth = frame.view.window.depth.stored(state.clear_depth);
  for (size_t i = 0; i < out.opaque.covering.size(); ++i) {
    out.of_opaque.push_back(tested(frame, out.opaque.covering[i], out.pixel, state.depth_func, out.depth));
    if (!out.of_opaque.back().drawn) continue;
    out.depth = out.opaque.covering[i].depth;
    out.visible = i;
  }
}

/// For forward-multipass: sets out.tied_at and out.tied to the fragments at the stored depth, which every light but the
/// first draws. Leaves them empty where the visible fragment is the only one.
void find_tied(const ExplainedFrame& frame, const GBufferState& planes, PixelHistory& out) {
  for (size_t i = 0; i < out.opaque.covering.size(); ++i)
    if (tested(frame, out.opaque.covering[i], out.pixel, DepthFunc::equal, out.depth).drawn) out.tied_at.push_back(i);
  if (out.tied_at.size() == 1 && out.visible) out.tied_at.clear();
  for (const size_t i : out.tied_at)
    out.tied.push_back(surface_of(frame, fragment_of(frame, out.opaque.covering[i], out.pixel), planes, out.pixel));
}

/// Tests the transparent fragments against the opaque depth: sets out.of_transparent and, of those that are drawn,
/// out.glass_at and out.glass.
void find_glass(const ExplainedFrame& frame, PixelHistory& out) {
  Pipeline forward = frame.pipeline;
  forward.strategy = Strategy::forward_loop;
  const GBufferState floats = surface_planes(forward);
  for (size_t i = 0; i < out.transparent.covering.size(); ++i) {
    const CoveringTriangle& fragment = out.transparent.covering[i];
    out.of_transparent.push_back(tested(frame, fragment, out.pixel, frame.pipeline.geometry.depth_func, out.depth));
    if (!out.of_transparent.back().drawn) continue;
    out.glass_at.push_back(i);
    out.glass.push_back(surface_of(frame, fragment_of(frame, fragment, out.pixel), floats, out.pixel));
  }
}

/// Blends the transparent fragments into out.surface.read.albedo, which lights read, and records the draws in
/// out.albedo_draws.
void tint_albedo(const ExplainedFrame& frame, const GBufferState& planes, PixelHistory& out) {
  const BlendTarget plane{planes.albedo.format, frame.pipeline.profile, planes.half_round};
  StoredPixel stored = stored_alone(plane, out.surface.computed.albedo);
  for (const PixelSurface& glass : out.glass) {
    const std::array<float, 4>& source = glass.read.albedo;
    const StoredPixel after = after_draw(frame.pipeline.transparency.blend, plane, source, stored);
    out.albedo_draws.push_back({"transparent surface " + std::to_string(out.albedo_draws.size()), -1,
                                frame.pipeline.transparency.blend.enabled, source, stored, after});
    stored = after;
  }
  if (!out.glass.empty()) out.surface.read.albedo = values_of(plane, stored);
}

}  // namespace

PixelSurfaces surfaces_to_light(const ExplainedFrame& frame, const PixelHistory& history) {
  PixelSurfaces out;
  out.pixel = history.pixel;
  out.covered = history.visible.has_value();
  out.visible = history.surface.read;
  for (const PixelSurface& tied : history.tied) out.tied.push_back(tied.read);
  if (frame.transparency == TransparencyMode::after_lights)
    for (const PixelSurface& glass : history.glass) out.glass.push_back(glass.read);
  return out;
}

PixelHistory history_of(const ExplainedFrame& frame, int x, int y) {
  const FpScope fp;
  const int width = frame.pipeline.width, height = frame.pipeline.height;
  if (x < 0 || y < 0 || x >= width || y >= height)
    throw Error(ErrorKind::usage, "--pixel", std::to_string(x) + ',' + std::to_string(y) + " is not in the picture",
                "columns are 0 to " + std::to_string(width - 1) + ", rows 0 to " + std::to_string(height - 1) +
                    " from the top");
  PixelHistory out;
  out.pixel = {x, height - 1 - y};
  out.opaque = triangles_at(frame, out.pixel, Surfaces::opaque);
  find_visible(frame, out);
  const GBufferState planes = surface_planes(frame.pipeline);
  if (out.visible)
    out.surface =
        surface_of(frame, fragment_of(frame, out.opaque.covering[*out.visible], out.pixel), planes, out.pixel);
  if (frame.pipeline.strategy == Strategy::forward_multipass) find_tied(frame, planes, out);
  if (frame.transparency != TransparencyMode::none) {
    out.transparent = triangles_at(frame, out.pixel, Surfaces::transparent);
    find_glass(frame, out);
  }
  if (frame.transparency == TransparencyMode::into_albedo && out.visible) tint_albedo(frame, planes, out);
  out.lit = lit_surfaces(frame, surfaces_to_light(frame, out), geometry_at(frame, out.pixel));
  out.stored = drawn_target(frame, out.lit, {}, &out.draws);
  return out;
}

}  // namespace trueshade
