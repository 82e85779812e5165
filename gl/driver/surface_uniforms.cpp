#include "gl/driver/surface_uniforms.h"

#include "gl/lists/frame_values.h"

namespace trueshade::oracle {

namespace {

/// Sets a uniform of floats where the program has one of that name: a vector or a matrix.
void set_value(GLuint program, const NamedValue& value) {
  const std::vector<float> floats(value.numbers.begin(), value.numbers.end());
  if (value.name == "world_from_clip")
    glUniformMatrix4fv(glGetUniformLocation(program, value.name.c_str()), 1, GL_FALSE, floats.data());
  else
    set_uniform(program, value.name.c_str(), floats);
}

}  // namespace

int bind_surface(GLuint program, std::span<const GlslPlane> planes, std::span<const GlTexture> textures, GLuint depth,
                 const Scene& scene, const Pipeline& pipeline, int shift_x, int shift_y) {
  int unit = 0;
  for (size_t i = 0; i < planes.size(); ++i)
    bind_texture(program, planes[i].sampler.c_str(), unit++, GL_TEXTURE_2D, textures[i]);
  if (pipeline.gbuffer.position_from_depth) bind_texture(program, "depth_plane", unit++, GL_TEXTURE_2D, depth);
  for (const NamedValue& value : frame_values(scene, pipeline, shift_x, shift_y))
    if (value.name != "clip_from_world") set_value(program, value);
  return unit;
}

void set_clip_rows(GLuint program, const Scene& scene, const Pipeline& pipeline) {
  for (const NamedValue& value : frame_values(scene, pipeline))
    if (value.name == "clip_from_world") set_value(program, value);
}

}  // namespace trueshade::oracle
