#pragma once
#include "scenes/pipeline/light_mesh.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"
#include "shading/frame.h"

namespace trueshade {

/// The frame's GlCounts, from stats.covered_pixels and, of deferred-volumes, stats.gl.light_pixels.
/// `meshes`: the pipeline's.
GlCounts counted_as_gl(const Scene& scene, const Pipeline& pipeline, const LightMeshes& meshes,
                       const FrameStats& stats);

}  // namespace trueshade
