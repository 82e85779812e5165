#pragma once
#include <epoxy/gl.h>

#include <span>

#include "gl/driver/blend_state.h"
#include "gl/emit/glsl.h"

namespace trueshade::oracle {

/// Blends what `draw` draws into the albedo plane of the G-buffer that is bound. The other planes are not written;
/// depth is tested, but not written either.
template <typename Draw>
void blend_into_albedo(std::span<const GlslPlane> planes, const BlendState& blend, const Draw& draw) {
  glDepthMask(GL_FALSE);
  set_blend_state(blend);
  for (size_t i = 0; i < planes.size(); ++i) {
    if (planes[i].name == "albedo") continue;
    glDisablei(GL_BLEND, GLuint(i));
    glColorMaski(GLuint(i), GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  }
  draw();
  set_blend_state({});
  glDepthMask(GL_TRUE);
}

}  // namespace trueshade::oracle
