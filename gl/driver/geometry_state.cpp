#include "gl/driver/geometry_state.h"

#include <epoxy/gl.h>

#include <string>

#include "core/error.h"
#include "gl/driver/context.h"
#include "oracle/exact_coverage.h"

namespace trueshade::oracle {

namespace {

GLenum gl_enum(DepthFunc func) {
  switch (func) {
    case DepthFunc::never:
      return GL_NEVER;
    case DepthFunc::less:
      return GL_LESS;
    case DepthFunc::equal:
      return GL_EQUAL;
    case DepthFunc::lequal:
      return GL_LEQUAL;
    case DepthFunc::greater:
      return GL_GREATER;
    case DepthFunc::notequal:
      return GL_NOTEQUAL;
    case DepthFunc::gequal:
      return GL_GEQUAL;
    case DepthFunc::always:
      return GL_ALWAYS;
  }
  return GL_LESS;
}

void set_enabled(GLenum capability, bool enabled) {
  if (enabled)
    glEnable(capability);
  else
    glDisable(capability);
}

void set_culling(CullFace face) {
  set_enabled(GL_CULL_FACE, face != CullFace::none);
  if (face == CullFace::front) glCullFace(GL_FRONT);
  if (face == CullFace::back) glCullFace(GL_BACK);
  if (face == CullFace::front_and_back) glCullFace(GL_FRONT_AND_BACK);
}

/// Left alone where it is as GL starts with, so that a driver without ARB_clip_control draws what it can.
void set_clip_control(ClipOrigin origin, ClipDepth depth) {
  if (!epoxy_has_gl_extension("GL_ARB_clip_control") && epoxy_gl_version() < 45) return;
  glClipControl(origin == ClipOrigin::upper_left ? GL_UPPER_LEFT : GL_LOWER_LEFT,
                depth == ClipDepth::zero_to_one ? GL_ZERO_TO_ONE : GL_NEGATIVE_ONE_TO_ONE);
}

/// What no pipeline asks for, and a context may start with: dithering is on initially (GL 4.6 core, 17.3.8). sRGB
/// targets are encoded, and blended in linear values (17.3.6); of others FRAMEBUFFER_SRGB says nothing.
void set_common_state() {
  constexpr GLenum kOff[] = {GL_DITHER,           GL_MULTISAMPLE,  GL_BLEND,
                             GL_SCISSOR_TEST,     GL_STENCIL_TEST, GL_POLYGON_OFFSET_FILL,
                             GL_PRIMITIVE_RESTART};
  for (const GLenum capability : kOff) glDisable(capability);
  glEnable(GL_FRAMEBUFFER_SRGB);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

}  // namespace

void check_limits(const GlContext& context, const Pipeline& pipeline, int width, int height) {
  const int side = context.info().max_texture_size;
  if (width > side || height > side)
    throw Error(ErrorKind::limit, "OpenGL",
                "an image of " + std::to_string(width) + " x " + std::to_string(height) + " is more than " +
                    context.info().renderer + " can draw",
                "at most " + std::to_string(side) + " pixels a side");
  const GeometryState& g = pipeline.geometry;
  const bool initial = g.clip_origin == ClipOrigin::lower_left && g.clip_depth == ClipDepth::negative_one_to_one;
  if (!initial && epoxy_gl_version() < 45 && !context.has("GL_ARB_clip_control"))
    throw Error(ErrorKind::no_gl_driver, "OpenGL", context.info().renderer + " has no glClipControl",
                "use lower_left and negative_one_to_one, or a driver of OpenGL 4.5");
  GLint most[2] = {0, 0};
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, most);
  if (g.viewport.width > most[0] || g.viewport.height > most[1])
    throw Error(ErrorKind::limit, "OpenGL", "the viewport is larger than the driver's",
                "at most " + std::to_string(most[0]));
}

void set_faces(CullFace culled, FrontFace front) {
  set_culling(culled);
  glFrontFace(front == FrontFace::ccw ? GL_CCW : GL_CW);
}

void set_geometry_state(const GeometryState& state, const Viewport& viewport, int shift_x, int shift_y) {
  set_common_state();
  glViewport(viewport.x + shift_x, viewport.y + shift_y, viewport.width, viewport.height);
  glDepthRange(double(state.depth_near), double(state.depth_far));
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(gl_enum(state.depth_func));
  glDepthMask(GL_TRUE);
  set_enabled(GL_DEPTH_CLAMP, state.depth_clamp);
  set_faces(state.cull_face, state.front_face);
  set_clip_control(state.clip_origin, state.clip_depth);
  set_enabled(GL_POLYGON_OFFSET_FILL, state.polygon_offset_factor != 0 || state.polygon_offset_units != 0);
  glPolygonOffset(state.polygon_offset_factor, state.polygon_offset_units);
  glProvokingVertex(state.provoking == Provoking::last ? GL_LAST_VERTEX_CONVENTION : GL_FIRST_VERTEX_CONVENTION);
}

void set_volume_state(const Pipeline& pipeline, bool mesh, int shift_x, int shift_y) {
  GeometryState state = pipeline.geometry;
  state.cull_face = mesh ? pipeline.light_volumes.cull_face : CullFace::none;
  state.front_face = FrontFace::ccw;
  state.depth_clamp = pipeline.light_volumes.depth_clamp;
  set_geometry_state(state, resolved_viewport(state, pipeline.width, pipeline.height), shift_x, shift_y);
  glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
}

void set_image_state(int width, int height) {
  set_common_state();
  glViewport(0, 0, width, height);
  glDepthRange(0.0, 1.0);
  glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glDisable(GL_DEPTH_CLAMP);
  glDisable(GL_CULL_FACE);
  glFrontFace(GL_CCW);
  set_clip_control(ClipOrigin::lower_left, ClipDepth::negative_one_to_one);
}

}  // namespace trueshade::oracle
