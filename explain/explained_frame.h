#pragma once
#include <memory>

#include "raster/view.h"
#include "scenes/pipeline/light_mesh.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"
#include "shading/blend/blend.h"
#include "shading/light/light_table.h"
#include "shading/program/program_frame.h"

namespace trueshade {

/// The lights of a frame in the form in which a surface is lit.
struct FrameLights {
  LightTable table;
  std::shared_ptr<const ProgramFrame> program;
  bool takes_albedo_alpha;  ///< alpha is the albedo's, as the program does not set it
};

/// What the explanation of any pixel needs of a frame, computed once. Its pipeline has neither post chain nor view, as
/// the target is explained, not the finished picture.
struct ExplainedFrame {
  const Scene& scene;
  Pipeline pipeline;
  View view;
  LightProgram light_program;  ///< the pipeline's, or its light model as a program
  FrameLights lights;          ///< bounded as the strategy draws them
  FrameLights glass_lights;    ///< ended by their analytic extents, as transparent fragments are lit
  LightMeshes meshes;
  GeometryState volume_state;     ///< the state that lights' meshes are drawn with
  WindowTransform volume_window;  ///< the window transform of lights' meshes
  BlendTarget target;
  TransparencyMode transparency;  ///< none also where the scene has no transparent surface

  /// Borrows the scene. Transforms all instances, and makes both tables of lights.
  ExplainedFrame(const Scene& of_scene, const Pipeline& of_pipeline);
};

}  // namespace trueshade
