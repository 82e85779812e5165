#include "gl/driver/blend_state.h"

#include <epoxy/gl.h>

namespace trueshade::oracle {

namespace {

GLenum gl_enum(BlendFactor factor) {
  switch (factor) {
    case BlendFactor::zero:
      return GL_ZERO;
    case BlendFactor::one:
      return GL_ONE;
    case BlendFactor::src_color:
      return GL_SRC_COLOR;
    case BlendFactor::one_minus_src_color:
      return GL_ONE_MINUS_SRC_COLOR;
    case BlendFactor::dst_color:
      return GL_DST_COLOR;
    case BlendFactor::one_minus_dst_color:
      return GL_ONE_MINUS_DST_COLOR;
    case BlendFactor::src_alpha:
      return GL_SRC_ALPHA;
    case BlendFactor::one_minus_src_alpha:
      return GL_ONE_MINUS_SRC_ALPHA;
    case BlendFactor::dst_alpha:
      return GL_DST_ALPHA;
    case BlendFactor::one_minus_dst_alpha:
      return GL_ONE_MINUS_DST_ALPHA;
    case BlendFactor::constant_color:
      return GL_CONSTANT_COLOR;
    case BlendFactor::one_minus_constant_color:
      return GL_ONE_MINUS_CONSTANT_COLOR;
    case BlendFactor::constant_alpha:
      return GL_CONSTANT_ALPHA;
    case BlendFactor::one_minus_constant_alpha:
      return GL_ONE_MINUS_CONSTANT_ALPHA;
    case BlendFactor::src_alpha_saturate:
      return GL_SRC_ALPHA_SATURATE;
  }
  return GL_ONE;
}

GLenum gl_enum(BlendEquation equation) {
  switch (equation) {
    case BlendEquation::add:
      return GL_FUNC_ADD;
    case BlendEquation::subtract:
      return GL_FUNC_SUBTRACT;
    case BlendEquation::reverse_subtract:
      return GL_FUNC_REVERSE_SUBTRACT;
    case BlendEquation::min:
      return GL_MIN;
    case BlendEquation::max:
      return GL_MAX;
  }
  return GL_FUNC_ADD;
}

GLboolean gl_bool(bool value) { return value ? GL_TRUE : GL_FALSE; }

}  // namespace

void set_blend_state(const BlendState& state) {
  if (state.enabled)
    glEnable(GL_BLEND);
  else
    glDisable(GL_BLEND);
  glBlendEquationSeparate(gl_enum(state.rgb.equation), gl_enum(state.alpha.equation));
  glBlendFuncSeparate(gl_enum(state.rgb.src), gl_enum(state.rgb.dst), gl_enum(state.alpha.src),
                      gl_enum(state.alpha.dst));
  glBlendColor(state.constant[0], state.constant[1], state.constant[2], state.constant[3]);
  glColorMask(gl_bool(state.mask[0]), gl_bool(state.mask[1]), gl_bool(state.mask[2]), gl_bool(state.mask[3]));
}

}  // namespace trueshade::oracle
