#include "shading/frame_plan.h"

#include <algorithm>
#include <bit>

#include "scenes/pipeline/transparency.h"
#include "shading/blend/clear_color.h"
#include "shading/frame.h"
#include "shading/output/light_planes.h"

namespace trueshade {
namespace {

PlaneSource plane_source(const std::string& name) {
  if (name == "specular" || name == "emission") return PlaneSource::material;
  if (name == "overdraw") return PlaneSource::fragment_counts;
  if (name == "Z") return PlaneSource::view_distance;
  return light_of_plane(name) ? PlaneSource::one_light : PlaneSource::tile;
}

}  // namespace

Pipeline without_idle_emission(const Scene& scene, const Pipeline& pipeline) {
  // By bits: a sum that starts from -0 may end as -0.
  const auto is_zero = [](float x) { return std::bit_cast<uint32_t>(x) == 0; };
  const auto fills = [&](const Material& m) {
    return m.unlit || m.occlusion_map.used() || !is_zero(m.emission.r) || !is_zero(m.emission.g) ||
           !is_zero(m.emission.b);
  };
  Pipeline drawn = pipeline;
  if (pipeline.light_model.global_ambient == glm::vec3(0.0f) &&
      std::none_of(scene.materials.begin(), scene.materials.end(), fills))
    drawn.light_model.emission = false;
  return drawn;
}

FramePlan plan_frame(const Scene& scene, const Pipeline& pipeline, const Execution& execution,
                     std::span<const std::string> planes, bool lit, const CapturedFields& there) {
  FramePlan plan{};
  plan.execution = execution;
  const PictureRegion drawn = drawn_region(pipeline, execution.region);
  if (execution.tile == 0) plan.execution.tile = tile_for(drawn.width, drawn.height, execution.threads);
  const LightPass of_strategy = blends_lights(pipeline.strategy) ? LightPass::blends : LightPass::sums;
  plan.light_pass = lit ? of_strategy : LightPass::none;
  plan.transparency = draws_transparent(scene, pipeline) ? pipeline.transparency.mode : TransparencyMode::none;
  plan.tied_fragments = pipeline.strategy == Strategy::forward_multipass;
  const bool shows_uv = std::find(planes.begin(), planes.end(), "uv") != planes.end();
  if (lit && pipeline.light_program.used())
    plan.program = std::make_shared<ProgramFrame>(scene, pipeline, Unlit::shows_albedo, there);
  const bool reads_uv = plan.program != nullptr && plan.program->reads().uv;
  plan.uv_planes = shows_uv || reads_uv ? UvPlanes::filled : UvPlanes::omitted;
  plan.light_geometry = plan.blends() && execution.count_as_gl;
  plan.surface_planes = surface_planes(pipeline);
  plan.target = {pipeline.target, pipeline.profile, pipeline.gbuffer.half_round};
  plan.clear = drawn_clear(scene.clear, plan.target);
  const bool draws_unlike = draws_unlike_clears(plan.target);
  plan.encodes = plan.blends() || draws_unlike || plan.transparency == TransparencyMode::after_lights;
  // Sums that are stored as they are in fixed point need only have the right codes.
  const bool codes = info(pipeline.target).number_class == NumberClass::unorm && !draws_unlike;
  plan.shortcuts = {.culling = execution.light_culling, .compiled = execution.compiled_models};
  if (codes && execution.bounded_codes) plan.shortcuts.codes = pipeline.target;
  for (const std::string& name : planes) plan.planes.push_back(plane_source(name));
  return plan;
}

}  // namespace trueshade
