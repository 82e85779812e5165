#include "explain/explained_frame.h"

#include "core/fp_env.h"
#include "raster/light_geometry/light_outlines.h"
#include "scenes/light_models/stated_model.h"
#include "scenes/pipeline/program_inputs.h"
#include "scenes/pipeline/transparency.h"

namespace trueshade {
namespace {

/// The pipeline without post chain and view, with the planes that its light program reads.
Pipeline of_target(Pipeline pipeline) {
  pipeline.post = {};
  pipeline.view = ImageView::lit;
  return with_planes_of_program(pipeline);
}

/// The lights' rows, bounded by the extents that light geometry is drawn with.
LightTable bounded_table(const Scene& scene, const Pipeline& pipeline, bool draws_meshes) {
  LightTable table = make_light_table(scene.lights, pipeline.light_model, scene.camera);
  bound_by_extents(table, scene.lights, pipeline.light_volumes, draws_meshes);
  return table;
}

/// The pipeline's light program; where it has none, its light model as one. On glass, alpha is the albedo's.
LightProgram light_program_of(const Pipeline& pipeline, bool of_glass) {
  if (pipeline.light_program.used()) return pipeline.light_program;
  LightModel model = pipeline.light_model;
  model.alpha_from_albedo = model.alpha_from_albedo || of_glass;
  return program_of(model, pipeline.preset);
}

FrameLights frame_lights(const Scene& scene, Pipeline pipeline, bool draws_meshes, bool of_glass) {
  const bool is_stated = !pipeline.light_program.used();
  FrameLights out{bounded_table(scene, pipeline, draws_meshes), nullptr,
                  pipeline.light_model.alpha_from_albedo || of_glass};
  pipeline.light_program = light_program_of(pipeline, of_glass);
  out.program = std::make_shared<ProgramFrame>(scene, pipeline, is_stated ? Unlit::by_planes : Unlit::shows_albedo);
  return out;
}

}  // namespace

ExplainedFrame::ExplainedFrame(const Scene& of_scene, const Pipeline& of_pipeline)
    : scene(of_scene),
      pipeline(of_target(of_pipeline)),
      view(make_view(scene, pipeline)),
      light_program(light_program_of(pipeline, false)),
      lights(frame_lights(scene, pipeline, pipeline.strategy == Strategy::deferred_volumes, false)),
      glass_lights(frame_lights(scene, pipeline, false, true)),
      meshes(pipeline.light_volumes),
      volume_state(light_geometry_state(pipeline)),
      volume_window(window_transform(volume_state, pipeline.width, pipeline.height, pipeline.profile)),
      target{pipeline.target, pipeline.profile, pipeline.gbuffer.half_round},
      transparency(draws_transparent(scene, pipeline) ? pipeline.transparency.mode : TransparencyMode::none) {
}

}  // namespace trueshade
