#pragma once
#include "gl/driver/renderer.h"
#include "tests/gl/opened_driver.h"
#include "tests/raster/window_scene.h"

namespace trueshade::testing {

/// A frame's planes as window_scene.h has them, row 0 at the bottom.
Planes planes_of_capture(const oracle::Capture& capture);

/// drawn(), by OpenGL.
Planes drawn_by_gl(const oracle::GlContext& context, const Scene& scene, const Pipeline& pipeline,
                   const oracle::GlDraw& draw = {}, int rotation = 0);

}  // namespace trueshade::testing
