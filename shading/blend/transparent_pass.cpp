#include "shading/blend/transparent_pass.h"

#include "raster/visibility/fragment_layers.h"
#include "shading/blend/transparent_blend.h"
#include "shading/program/program_frame.h"

namespace trueshade {
namespace {

GBufferState float_planes(const Pipeline& pipeline) {
  Pipeline forward = pipeline;
  forward.strategy = Strategy::forward_loop;
  return surface_planes(forward);
}

TileDraws with_list(const TileDraws& draws, std::span<const uint32_t> list) {
  return {draws.clusters, draws.scene, draws.view, draws.state, draws.draws, list};
}

}  // namespace

TransparentPass::TransparentPass(const Scene& scene, const Pipeline& pipeline, const ProgramFrame* program,
                                 const Execution& execution)
    : scene_(scene),
      mode_(draws_transparent(scene, pipeline) ? pipeline.transparency.mode : TransparencyMode::none),
      blend_(pipeline.transparency.blend),
      planes_(float_planes(pipeline)),
      model_(pipeline.light_model),
      target_{into_albedo() ? pipeline.gbuffer.albedo.format : pipeline.target, pipeline.profile,
              pipeline.gbuffer.half_round} {
  model_.alpha_from_albedo = true;
  if (program != nullptr && program->reads().uv) uv_planes_ = UvPlanes::filled;
  if (!after_lights()) return;
  lights_ = make_light_table(scene.lights, model_, scene.camera, execution.threads);
  bound_by_extents(lights_, scene.lights, pipeline.light_volumes, false);
  lights_.program = program;
  if (execution.light_culling) clusters_ = make_light_clusters(lights_, execution.threads);
}

TileDraws TransparentPass::opaque_draws(const TileDraws& all, TransparentWork& work) const {
  work.opaque.clear();
  work.transparent.clear();
  for (const uint32_t i : all.list) {
    const Material& material = scene_.materials[scene_.instances[all.draws[i].instance].material];
    (material.transparent ? work.transparent : work.opaque).push_back(i);
  }
  return with_list(all, work.opaque);
}

size_t TransparentPass::find_fragments(const TileDraws& all, const TileRect& rect, bool culling,
                                       VisibilityTile& visible, TransparentWork& work) const {
  passing_fragments(with_list(all, work.transparent), rect, culling, visible, work.fragments);
  return work.fragments.size();
}

void TransparentPass::blend_into_albedo(const TileDraws& all, const TileRect& rect, VisibleVertices& vertices,
                                        TransparentWork& work, SurfaceTile& surface) const {
  const TileDraws draws = with_list(all, work.transparent);
  for (FragmentLayers layers(work.fragments); layers.next(work.layer);) {
    resolve_surfaces(draws, rect, planes_, model_, work.layer, UvPlanes::omitted, vertices, work.surface);
    blend_albedo(blend_, target_, work.surface, rect.size * rect.size, surface);
  }
}

void TransparentPass::blend_after_lights(const TileDraws& all, const TileRect& rect, const Execution& execution,
                                         VisibleVertices& vertices, LightLists& lists, TransparentWork& work,
                                         ColorTile& stored) const {
  constexpr float kNothing[4] = {0.0f, 0.0f, 0.0f, 0.0f};
  const TileDraws draws = with_list(all, work.transparent);
  LightCounts uncounted;
  for (FragmentLayers layers(work.fragments); layers.next(work.layer);) {
    resolve_surfaces(draws, rect, planes_, model_, work.layer, uv_planes_, vertices, work.surface);
    light_tile(work.surface, rect.size, lights_, clusters_, model_, kNothing,
               {.culling = execution.light_culling, .compiled = execution.compiled_models}, lists, work.color,
               uncounted);
    blend_layer(blend_, target_, work.surface, work.color, rect.size * rect.size, stored);
  }
}

}  // namespace trueshade
