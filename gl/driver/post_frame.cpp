#include "gl/driver/post_frame.h"

#include <array>
#include <map>
#include <string>

#include "oracle/exact_coverage.h"
#include "gl/driver/geometry_state.h"
#include "gl/emit/glsl.h"
#include "gl/emit/post_glsl.h"
#include "gl/driver/read_back.h"
#include "gl/driver/scene_buffers.h"
#include "scenes/light_shapes.h"

namespace trueshade::oracle {

namespace {

/// Front faces of a sphere a light, by the frame's own state, where they pass its depth test.
void draw_markers(const Scene& scene, const Pipeline& pipeline, int version, GLuint picture, const GlTexture& depth) {
  Pipeline large = pipeline_without_post(pipeline);
  large.geometry.cull_face = CullFace::back;
  const GlProgram program =
      make_program("markers", marker_vertex_text(large, version), marker_fragment_text(large, version));
  const Scene markers = light_markers(scene, pipeline.post.marker_radius);
  SceneBuffers buffers(markers);
  buffers.upload_instances(large);
  const std::array<GLuint, 1> color{picture};
  const GlTarget target = make_target(color, depth);
  set_geometry_state(large.geometry, resolved_viewport(large.geometry, large.width, large.height), 0, 0);
  glUseProgram(program);
  buffers.draw_instances();
}

void run(const PostPass& pass, GLuint program, const std::map<std::string, GlTexture>& pictures, GLuint target,
         GLuint written) {
  const std::array<GLuint, 1> color{written};
  const GlTarget frame = make_target(color, 0);
  set_image_state(pass.width, pass.height);
  glUseProgram(program);
  int unit = 0;
  for (const auto& [sampler, picture] : pass.reads)
    bind_texture(program, sampler.c_str(), unit++, GL_TEXTURE_2D, picture == "target" ? target : pictures.at(picture));
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace

Image finished_by_gl(const Scene& scene, const Pipeline& pipeline, int version, const GlTexture& target,
                     const GlTexture& depth) {
  const std::vector<PostPass> passes = post_passes(pipeline, version);
  const GlVertexArray none = make_vertex_array();
  std::map<std::string, GlProgram> programs;
  std::map<std::string, GlTexture> pictures;
  for (const PostPass& pass : passes) {
    GlProgram& program = programs[pass.name];
    if (program == 0) program = make_program("post_" + pass.name, fullscreen_vertex_text(version), pass.frag);
    GlTexture& picture = pictures[pass.writes];
    if (picture == 0) picture = make_texture(pass.format, pass.width, pass.height);
    glBindVertexArray(none);
    run(pass, program, pictures, target, picture);
    if (pass.name == "load" && pipeline.post.marker_radius > 0.0f)
      draw_markers(scene, pipeline, version, picture, depth);
  }
  const PostPass& last = passes.back();
  return read_texture(pictures.at(last.writes), last.format, 0, 0, last.width, last.height);
}

}  // namespace trueshade::oracle
