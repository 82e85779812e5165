#include "gl/emit/draw_plan.h"

#include "scenes/pipeline/light_mesh.h"

namespace trueshade::oracle {

namespace {

constexpr const char *kGeometryVert = "geometry.vert", *kGeometryFrag = "geometry.frag", *kLightVert = "light.vert",
                     *kLightFrag = "light.frag";

std::vector<PlannedDraw> volume_draws(const Pipeline& pipeline, const BlendState& base, const BlendState& blend) {
  const LightVolumes& v = pipeline.light_volumes;
  std::vector<PlannedDraw> draws;
  if (v.base)
    draws.push_back({kLightVert, "base.frag", DrawnGeometry::quad, DrawnLights::none,
                     volume_state(pipeline, CullFace::none, base)});
  draws.push_back(
      {kLightVert, kLightFrag, DrawnGeometry::quads, DrawnLights::each, volume_state(pipeline, CullFace::none, blend)});
  if (is_mesh(v.point) || is_mesh(v.spot))
    draws.push_back(
        {kLightVert, kLightFrag, DrawnGeometry::meshes, DrawnLights::each, volume_state(pipeline, v.cull_face, blend)});
  return draws;
}

/// Of the target: its alpha is masked where it stands in for none.
BlendState of_target(BlendState blend, const Pipeline& pipeline, const GlslOptions& options) {
  if (alpha_stands_in(pipeline, options)) blend.mask[3] = false;
  return blend;
}

}  // namespace

PlannedDraw geometry_draw(const Pipeline& pipeline) {
  return {kGeometryVert, kGeometryFrag, DrawnGeometry::scene, DrawnLights::none,
          scene_state(pipeline, pipeline.geometry.depth_func, true, {})};
}

std::vector<PlannedDraw> light_draws(const Pipeline& pipeline, const GlslOptions& options) {
  const DepthFunc func = pipeline.geometry.depth_func;
  const BlendState stored = of_target({}, pipeline, options);
  switch (pipeline.strategy) {
    case Strategy::forward_multipass:
      return {
          {kLightVert, kLightFrag, DrawnGeometry::scene, DrawnLights::first, scene_state(pipeline, func, true, stored)},
          {kLightVert, kLightFrag, DrawnGeometry::scene, DrawnLights::others,
           scene_state(pipeline, DepthFunc::equal, false, of_target(kAddLight, pipeline, options))}};
    case Strategy::forward_loop:
      return {
          {kLightVert, kLightFrag, DrawnGeometry::scene, DrawnLights::all, scene_state(pipeline, func, true, stored)}};
    case Strategy::deferred_volumes:
      return volume_draws(pipeline, stored, of_target(pipeline.blend, pipeline, options));
    case Strategy::deferred_loop:
      break;
  }
  PlannedDraw draw{kLightVert, kLightFrag, DrawnGeometry::triangle, DrawnLights::all,
                   image_state(pipeline.width, pipeline.height)};
  draw.state.blend = stored;
  return {draw};
}

std::optional<PlannedDraw> glass_draw(const Pipeline& pipeline, const GlslOptions& options) {
  switch (pipeline.transparency.mode) {
    case TransparencyMode::none:
      return std::nullopt;
    case TransparencyMode::into_albedo: {
      const std::vector<GlslPlane> planes = planes_of(pipeline, options);
      int albedo = 0;
      while (planes[size_t(albedo)].name != "albedo") ++albedo;
      return PlannedDraw{kGeometryVert, kGeometryFrag, DrawnGeometry::glass, DrawnLights::none,
                         albedo_state(pipeline, albedo)};
    }
    case TransparencyMode::after_lights:
      break;
  }
  return PlannedDraw{"transparent.vert", "transparent.frag", DrawnGeometry::glass, DrawnLights::all,
                     scene_state(pipeline, pipeline.geometry.depth_func, false,
                                 of_target(pipeline.transparency.blend, pipeline, options))};
}

}  // namespace trueshade::oracle
