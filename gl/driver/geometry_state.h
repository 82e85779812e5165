#pragma once
#include "scenes/pipeline/pipeline.h"

namespace trueshade::oracle {

class GlContext;

/// Throws Error where the driver cannot draw the pipeline's geometry at this size in pixels.
void check_limits(const GlContext& context, const Pipeline& pipeline, int width, int height);

/// Sets all GL state of the geometry pass, whatever was set before, with the viewport moved by (shift_x, shift_y)
/// pixels.
void set_geometry_state(const GeometryState& state, const Viewport& viewport, int shift_x, int shift_y);

/// Sets culling and the front face, and no other state.
void set_faces(CullFace culled, FrontFace front);

/// Sets the state in which lights' geometry is drawn, except blending: no depth test, and none of the scene's culling.
///   mesh: the geometry is meshes; false: quads
void set_volume_state(const Pipeline& pipeline, bool mesh, int shift_x, int shift_y);

/// Sets the state of a pass over the whole image: no depth test, blending or culling; clip control as in a new context.
void set_image_state(int width, int height);

}  // namespace trueshade::oracle
