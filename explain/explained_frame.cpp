#include "explain/explained_frame.h"

#include "core/fp_env.h"
#include "raster/light_geometry/light_outlines.h"
#include "scenes/pipeline/program_inputs.h"
#include "scenes/pipeline/transparency.h"

namespace trueshade {
namespace {

Pipeline of_target(Pipeline pipeline) {
  pipeline.post = {};
  pipeline.view = ImageView::lit;
  return with_planes_of_program(pipeline);
}

LightTable bounded_table(const Scene& scene, const Pipeline& pipeline, bool draws_meshes) {
  LightTable table = make_light_table(scene.lights, pipeline.light_model, scene.camera);
  bound_by_extents(table, scene.lights, pipeline.light_volumes, draws_meshes);
  return table;
}

}  // namespace

ExplainedFrame::ExplainedFrame(const Scene& of_scene, const Pipeline& of_pipeline)
    : scene(of_scene),
      pipeline(of_target(of_pipeline)),
      view(make_view(scene, pipeline)),
      lights(bounded_table(scene, pipeline, pipeline.strategy == Strategy::deferred_volumes)),
      glass_lights(bounded_table(scene, pipeline, false)),
      meshes(pipeline.light_volumes),
      volume_state(light_geometry_state(pipeline)),
      volume_window(window_transform(volume_state, pipeline.width, pipeline.height, pipeline.profile)),
      target{pipeline.target, pipeline.profile, pipeline.gbuffer.half_round},
      transparency(draws_transparent(scene, pipeline) ? pipeline.transparency.mode : TransparencyMode::none) {
  if (pipeline.light_program.used()) program = std::make_shared<ProgramFrame>(scene, pipeline);
}

}  // namespace trueshade
