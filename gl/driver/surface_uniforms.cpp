#include "gl/driver/surface_uniforms.h"

#include <array>

#include "oracle/exact_coverage.h"
#include "oracle/matrices.h"

namespace trueshade::oracle {

namespace {

/// Uniforms of a position rebuilt from depth (docs/arithmetic.md section 7).
void set_depth_uniforms(GLuint program, const Scene& scene, const Pipeline& pipeline, int shift_x, int shift_y) {
  const GeometryState& g = pipeline.geometry;
  const Matrix4 inverse = inverse_of(projection_of(scene.camera, g, pipeline.width, pipeline.height));
  std::array<float, 16> columns{};
  for (size_t i = 0; i < 16; ++i) columns[i] = float(inverse[i]);
  glUniformMatrix4fv(glGetUniformLocation(program, "world_from_clip"), 1, GL_FALSE, columns.data());
  const Viewport v = resolved_viewport(g, pipeline.width, pipeline.height);
  const float up = g.clip_origin == ClipOrigin::upper_left ? -1.0f : 1.0f;
  const std::array<float, 4> window{float(v.x + shift_x), float(v.y + shift_y), float(2.0 / v.width),
                                    up * float(2.0 / v.height)};
  set_uniform(program, "ndc_from_window", window);
  set_uniform(program, "ndc_origin", std::array<float, 2>{1.0f, up});
  const bool zero_to_one = g.clip_depth == ClipDepth::zero_to_one;
  const double near = double(g.depth_near), far = double(g.depth_far);
  const double scale = zero_to_one ? far - near : (far - near) * 0.5, offset = zero_to_one ? near : (near + far) * 0.5;
  set_uniform(program, "depth_to_ndc", std::array<float, 2>{float(offset), float(1.0 / scale)});
}

}  // namespace

int bind_surface(GLuint program, std::span<const GlslPlane> planes, std::span<const GlTexture> textures, GLuint depth,
                 const Scene& scene, const Pipeline& pipeline, int shift_x, int shift_y) {
  int unit = 0;
  for (size_t i = 0; i < planes.size(); ++i)
    bind_texture(program, planes[i].sampler.c_str(), unit++, GL_TEXTURE_2D, textures[i]);
  if (pipeline.gbuffer.position_from_depth) {
    bind_texture(program, "depth_plane", unit++, GL_TEXTURE_2D, depth);
    set_depth_uniforms(program, scene, pipeline, shift_x, shift_y);
  }
  set_uniform(program, "eye", std::array<float, 3>{scene.camera.eye.x, scene.camera.eye.y, scene.camera.eye.z});
  const auto axis = view_axis(projection_of(scene.camera, pipeline.geometry, pipeline.width, pipeline.height));
  set_uniform(program, "view_axis", std::array<float, 3>{float(axis[0]), float(axis[1]), float(axis[2])});
  return unit;
}

}  // namespace trueshade::oracle
