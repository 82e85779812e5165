#include "shading/frame_tile.h"

#include <algorithm>
#include <memory>

#include "core/threads/clock.h"
#include "raster/surfaces/surfaces.h"
#include "raster/visibility/overdraw.h"
#include "shading/blend/blend_pass.h"
#include "shading/blend/tied_fragments.h"
#include "shading/blend/transparent_blend.h"
#include "shading/output/target.h"
#include "shading/output/texels.h"
#include "shading/sum/light_pass.h"

namespace trueshade {
namespace {

// Scratch of one thread: about 0.8 MB, kept for the thread's life so that no frame allocates it.
struct TileScratch {
  VisibilityTile visible;
  SurfaceTile surface;
  ColorTile color, extra;  // extra: of planes beside the picture
  VisibleVertices vertices;
  LightLists lights;
  BlendWork blend;
  TiedFragments tied;
  std::unique_ptr<TransparentWork> transparent;  // made by the first tile that needs it
};

TileScratch& thread_scratch() {
  thread_local std::unique_ptr<TileScratch> scratch = std::make_unique<TileScratch>();
  return *scratch;
}

/// The stages of one tile, in the order in which draw_tile() runs them.
struct TileStages {
  const FrameWork& frame;
  const FramePlan& plan;
  TileScratch& s;
  TileCounts& counts;
  const TileRect rect;
  const TileDraws all;                  // of the tile's list
  TransparentWork* const glass;         // null where the scene has no transparent surface
  const TileDraws draws;                // `all` but for transparent surfaces
  const TiedFragments* tied = nullptr;  // null where no pixel of the tile has any

  TileStages(const FrameWork& of_frame, int tile, TileScratch& scratch, TileCounts& tile_counts)
      : frame(of_frame),
        plan(of_frame.plan),
        s(scratch),
        counts(tile_counts),
        rect(tile_rect(of_frame.view.window, of_frame.plan.execution.tile, of_frame.tables.bins.tiles_x, tile)),
        all{frame.prepared.clusters(),   frame.prepared.scene(),  frame.view,
            frame.pipeline.geometry,     frame.tables.bins.draws, frame.tables.bins.tile_list(tile),
            plan.execution.fast_geometry},
        glass(transparent_work()),
        draws(glass != nullptr ? frame.transparent.opaque_draws(all, *glass) : all) {}

  TransparentWork* transparent_work() const {
    if (plan.transparency == TransparencyMode::none) return nullptr;
    if (s.transparent == nullptr) s.transparent = std::make_unique<TransparentWork>();
    return s.transparent.get();
  }

  void find_visible() { draw_visibility(draws, rect, plan.execution.geometry_culling, s.visible, counts.raster); }

  void find_surfaces() {
    const LightModel& model = frame.pipeline.light_model;
    const bool culling = plan.execution.geometry_culling;
    resolve_surfaces(draws, rect, plan.surface_planes, model, s.visible, plan.uv_planes, s.vertices, s.surface);
    if (plan.tied_fragments &&
        resolve_tied(draws, rect, plan.surface_planes, model, plan.uv_planes, culling, s.visible, s.vertices, s.tied))
      tied = &s.tied;
    counts.covered += uint64_t(s.surface.covered_pixels);
    if (glass == nullptr) return;
    counts.transparent += frame.transparent.find_fragments(all, rect, culling, s.visible, *glass);
    if (plan.transparency == TransparencyMode::into_albedo)
      frame.transparent.blend_into_albedo(all, rect, s.vertices, *glass, s.surface);
  }

  void take_surfaces() {
    const ProgramReads* const reads = plan.program != nullptr ? &plan.program->reads() : nullptr;
    load_surfaces(*frame.given, reads, frame.view, rect, s.visible, s.surface);
    counts.covered += uint64_t(s.surface.covered_pixels);
  }

  // Leaves the lit tile in s.color; in the target's stored form where the plan encodes.
  void add_lights() {
    fetch_texels(rect, frame.out.color);
    const float* const clear = &plan.clear[0];
    if (plan.blends()) {
      blend_tile(frame.light_volume_draws, s.surface, tied, rect, clear, s.blend, s.color, counts.light);
    } else {
      light_tile(s.surface, rect.size, frame.tables.lights, frame.tables.clusters, frame.pipeline.light_model, clear,
                 plan.shortcuts, s.lights, s.color, counts.light);
      if (plan.encodes) encode_colors(plan.target, rect.size * rect.size, s.color);
    }
    if (plan.transparency == TransparencyMode::after_lights)
      frame.transparent.blend_after_lights(all, rect, plan.execution, s.vertices, s.lights, *glass, s.color);
  }

  void store_lights() {
    if (plan.encodes)
      write_stored(s.color, rect, frame.out.color);
    else
      store_target(s.color, rect, plan.target.half_round, frame.out.color);
    if (plan.blends())
      frame.light_planes.blend(frame.light_volume_draws, s.surface, tied, rect, s.blend, s.extra, frame.out.aovs);
    else
      frame.light_planes.sum(s.surface, rect, plan.shortcuts, s.lights, s.extra, frame.out.aovs);
  }

  // Planes but for light.<i>.
  void store_planes() {
    const HalfRound half_round = plan.surface_planes.half_round;
    for (size_t i = 0; i < plan.planes.size(); ++i) {
      NamedImage& plane = frame.out.aovs[i];
      const PlaneSource source = plan.planes[i];
      if (source == PlaneSource::one_light) continue;
      if (source == PlaneSource::material) {
        store_material_plane(plane.name, s.surface, frame.pipeline.light_model, rect, half_round, plane.image);
        continue;
      }
      if (source == PlaneSource::fragment_counts) count_fragments(all, rect, s.extra.light_count);
      if (source == PlaneSource::view_distance)
        frame.view_distance.measure(s.surface, rect.size * rect.size, s.extra.plane[0]);
      const ColorTile& color = source == PlaneSource::tile ? s.color : s.extra;
      store_aov(plane.name, s.visible, s.surface, color, rect, half_round, plane.image);
    }
  }
};

}  // namespace

void draw_tile(const FrameWork& frame, int tile, TileCounts& counts) {
  const bool lit = frame.plan.lit();
  const double start = now_ms();
  TileStages stages(frame, tile, thread_scratch(), counts);
  if (frame.given == nullptr) stages.find_visible();
  const double seen = now_ms();
  if (frame.given == nullptr)
    stages.find_surfaces();
  else
    stages.take_surfaces();
  const double resolved = now_ms();
  if (lit) stages.add_lights();
  const double lighted = now_ms();
  if (lit) stages.store_lights();
  stages.store_planes();
  counts.ms = {seen - start, resolved - seen, lighted - resolved, now_ms() - lighted};
  // Counted after the clock has stopped: the frame's time is that of drawing alone.
  if (frame.plan.light_geometry)
    counts.lit_geometry += count_lit_geometry(frame.light_volume_draws, stages.s.surface, stages.rect,
                                              stages.s.blend.counts, stages.s.blend.lights);
}

}  // namespace trueshade
