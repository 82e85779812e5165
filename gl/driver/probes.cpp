#include "gl/driver/probes.h"

#include <array>

#include "gl/driver/geometry_state.h"
#include "gl/emit/glsl.h"
#include "gl/driver/objects.h"
#include "gl/driver/read_back.h"

namespace trueshade::oracle {

bool renders_to(Format format) {
  const GlTexture texture = make_texture(format, 4, 4);
  const std::array<GLuint, 1> names{texture};
  return make_target(names, 0).complete;
}

bool counts_primitives() {
  const std::string fragment = glsl_header(330, "gl_PrimitiveID") +
                               "layout(location = 0) out uint id;\nvoid main() { id = uint(gl_PrimitiveID) + 1u; }\n";
  const GlProgram program = make_program("probe", fullscreen_vertex_text(330), fragment);
  const GlTexture texture = make_texture(Format::r32ui, 4, 4);
  const std::array<GLuint, 1> names{texture};
  const GlTarget target = make_target(names, 0);
  const GlVertexArray none = make_vertex_array();
  constexpr std::array<GLuint, 4> kNothing{};
  set_image_state(4, 4);
  glClearBufferuiv(GL_COLOR, 0, kNothing.data());
  glUseProgram(program);
  glBindVertexArray(none);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  return read_texture(texture, Format::r32ui, 0, 0, 4, 4).value(1, 1, 0) == 1;
}

}  // namespace trueshade::oracle
