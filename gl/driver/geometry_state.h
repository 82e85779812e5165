#pragma once
#include "scenes/pipeline/pipeline.h"

namespace trueshade::oracle {

class GlContext;

/// Throws Error where the driver cannot do what the pipeline says at this size.
void check_limits(const GlContext& context, const Pipeline& pipeline, int width, int height);

/// Sets all state of the geometry pass, the viewport moved by (shift_x, shift_y); whatever was set before is
/// overridden.
void set_geometry_state(const GeometryState& state, const Viewport& viewport, int shift_x, int shift_y);

/// Of this state, culling and the front face alone.
void set_faces(CullFace culled, FrontFace front);

/// State of the draws of light geometry (meshes, or quads) but for blending: no depth test, nothing of the scene's
/// culling.
void set_volume_state(const Pipeline& pipeline, bool mesh, int shift_x, int shift_y);

/// State of a pass over the whole image: no test, no blending, no culling, clip control as GL starts with.
void set_image_state(int width, int height);

}  // namespace trueshade::oracle
