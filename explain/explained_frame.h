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

/// The lights of a frame, and what they add.
struct FrameLights {
  LightTable table;
  std::shared_ptr<const ProgramFrame> program;
  bool takes_albedo_alpha;  ///< where the program does not say what alpha is
};

/// What every pixel's explanation reads of a frame, made once. `pipeline` is without post chain and
/// view: what is explained is the target.
struct ExplainedFrame {
  const Scene& scene;
  Pipeline pipeline;
  View view;
  LightProgram light_program;  ///< the pipeline's, or its light model as a program
  FrameLights lights;          ///< bounded as the strategy draws them
  FrameLights glass_lights;    ///< bounded by their analytic extents, as transparent fragments are lit
  LightMeshes meshes;
  GeometryState volume_state;     ///< that light geometry is drawn with
  WindowTransform volume_window;  ///< of it
  BlendTarget target;
  TransparencyMode transparency;  ///< none too where the scene has no transparent surface

  /// Borrows the scene. Makes the view of all instances and both tables of the lights.
  ExplainedFrame(const Scene& of_scene, const Pipeline& of_pipeline);
};

}  // namespace trueshade
