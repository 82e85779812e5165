#include "oracle/gl/renderer.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "oracle/exact_coverage.h"
#include "oracle/gl/geometry_state.h"
#include "oracle/gl/objects.h"
#include "oracle/gl/pass_timer.h"
#include "oracle/gl/probes.h"
#include "oracle/gl/read_back.h"
#include "oracle/gl/scene_buffers.h"
#include "oracle/gl/surface_uniforms.h"

namespace trueshade::oracle {

/// Textures of one frame and where the picture lies in them.
struct Targets {
  int width = 0, height = 0;  ///< of the textures: the image and its shift
  Format color_format = Format::rgba8, depth_format = Format::d32f;
  std::vector<GlslPlane> planes;
  std::vector<GlTexture> textures;  ///< one a plane
  GlTexture depth, color;
  GlTarget geometry, light;
};

struct Programs {
  GlslShaders text;
  GlProgram geometry, light;
};

namespace {

std::unique_ptr<Targets> make_targets(int width, int height, Format color_format, Format depth_format,
                                      const std::vector<GlslPlane>& planes) {
  auto t = std::make_unique<Targets>();
  t->width = width;
  t->height = height;
  t->color_format = color_format;
  t->depth_format = depth_format;
  t->planes = planes;
  std::vector<GLuint> names;
  for (const GlslPlane& plane : planes) {
    t->textures.push_back(make_texture(plane.format, width, height));
    names.push_back(t->textures.back());
  }
  t->depth = make_texture(depth_format, width, height);
  t->color = make_texture(color_format, width, height);
  t->geometry = make_target(names, t->depth);
  const std::array<GLuint, 1> color{t->color};
  t->light = make_target(color, 0);
  if (!t->geometry.complete || !t->light.complete)
    throw std::runtime_error("the driver cannot render to the planes of this pipeline");
  return t;
}

void clear_geometry(const Targets& t, float clear_depth) {
  glBindFramebuffer(GL_FRAMEBUFFER, t.geometry.framebuffer);
  glDepthMask(GL_TRUE);
  constexpr std::array<float, 4> kZero{};
  constexpr std::array<GLuint, 4> kNone{};
  for (size_t i = 0; i < t.planes.size(); ++i) {
    if (t.planes[i].format == Format::r32ui)
      glClearBufferuiv(GL_COLOR, GLint(i), kNone.data());
    else
      glClearBufferfv(GL_COLOR, GLint(i), kZero.data());
  }
  glClearBufferfv(GL_DEPTH, 0, &clear_depth);
}

void draw_lights(const Targets& t, const GlProgram& program, SceneBuffers& buffers, const Pipeline& pipeline,
                 const GlDraw& draw) {
  const Scene& scene = buffers.scene();
  set_image_state(t.width, t.height);
  glBindFramebuffer(GL_FRAMEBUFFER, t.light.framebuffer);
  const std::array<float, 4> clear{scene.clear.r, scene.clear.g, scene.clear.b, scene.clear.a};
  glClearBufferfv(GL_COLOR, 0, clear.data());
  glUseProgram(program);
  const int unit = bind_surface(program, t.planes, t.textures, t.depth, scene, pipeline, draw.shift_x, draw.shift_y);
  bind_texture(program, "lights", unit, GL_TEXTURE_BUFFER, buffers.light_texels(pipeline.light_model));
  const int all = int(scene.lights.size());
  set_uniform(program, "light_count", draw.lights < 0 ? all : std::min(draw.lights, all));
  const GlVertexArray none = make_vertex_array();
  glBindVertexArray(none);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void read_all(const Targets& t, const Pipeline& pipeline, const GlDraw& draw, Capture& out) {
  const auto read = [&](GLuint texture, Format format) {
    return read_texture(texture, format, draw.shift_x, draw.shift_y, pipeline.width, pipeline.height);
  };
  out.color = read(t.color, pipeline.target);
  if (!draw.planes) return;
  out.planes.push_back({"depth", read(t.depth, Format::d32f)});  // as floats, whatever they are stored as
  for (size_t i = 0; i < t.planes.size(); ++i)
    out.planes.push_back({t.planes[i].name, read(t.textures[i], t.planes[i].format)});
}

bool wants_rgb16f(const GBufferState& g) {
  return g.position.format == Format::rgb16f || g.normal.format == Format::rgb16f ||
         g.albedo.format == Format::rgb16f || g.uv.format == Format::rgb16f;
}

}  // namespace

GlRenderer::GlRenderer(const GlContext& context, const Scene& scene, int rotation) : context_(&context) {
  context.make_current();
  buffers_ = std::make_unique<SceneBuffers>(scene, rotation);
  rgb16f_ = renders_to(Format::rgb16f);
  primitive_ids_ = counts_primitives();
}

GlRenderer::~GlRenderer() { context_->make_current(); }  // what it owns is freed in that context

GlslOptions GlRenderer::shader_options(const GlDraw& draw) const {
  GlslOptions options;
  options.version = context_->info().major * 10 + context_->info().minor >= 45 ? 450 : 330;
  options.ids = options.uv = draw.planes;
  options.primitive = primitive_ids_;
  options.rgb16f = rgb16f_;
  options.maps = buffers_->has_maps();
  options.ambient = draw.planes || buffers_->has_type(LightType::ambient);
  options.directional = draw.planes || buffers_->has_type(LightType::directional);
  return options;
}

const Programs& GlRenderer::programs(const GlslShaders& text) {
  if (programs_ == nullptr || programs_->text != text)
    programs_ =
        std::make_unique<Programs>(Programs{text, make_program("geometry", text.geometry_vert, text.geometry_frag),
                                            make_program("light", text.light_vert, text.light_frag)});
  return *programs_;
}

const Targets& GlRenderer::targets(const Pipeline& pipeline, const GlslOptions& options, const GlDraw& draw) {
  const int width = pipeline.width + draw.shift_x, height = pipeline.height + draw.shift_y;
  const std::vector<GlslPlane> planes = planes_of(pipeline, options);
  const Targets* t = targets_.get();
  if (t == nullptr || t->width != width || t->height != height || t->color_format != pipeline.target ||
      t->depth_format != pipeline.geometry.depth_format || t->planes != planes)
    targets_ = make_targets(width, height, pipeline.target, pipeline.geometry.depth_format, planes);
  return *targets_;
}

GlFrame GlRenderer::draw(const Pipeline& pipeline, const GlDraw& draw) {
  context_->make_current();
  check_limits(*context_, pipeline, pipeline.width + draw.shift_x, pipeline.height + draw.shift_y);
  const GlslOptions options = draw.shaders != nullptr ? draw.shader_options : shader_options(draw);
  const GlslShaders text = draw.shaders != nullptr ? *draw.shaders : shaders_of(pipeline, options);
  const Programs& program = programs(text);
  const Targets& target = targets(pipeline, options, draw);

  GlFrame frame;
  frame.capture.driver = context_->info().line();
  frame.capture.drawn_at = {draw.shift_x, draw.shift_y};
  if (!options.rgb16f && wants_rgb16f(pipeline.gbuffer))
    frame.notes.push_back("rgb16f is not renderable on this driver: its planes are rgba16f");
  if (options.ids && !options.primitive)
    frame.notes.push_back("gl_PrimitiveID draws nothing on this driver: there is no plane id.primitive");
  PassTimer timer(frame.passes);
  buffers_->upload_instances(pipeline);
  clear_geometry(target, pipeline.geometry.clear_depth);
  timer.end("upload and clear");
  set_geometry_state(pipeline.geometry, resolved_viewport(pipeline.geometry, pipeline.width, pipeline.height),
                     draw.shift_x, draw.shift_y);
  glUseProgram(program.geometry);
  buffers_->draw_instances(program.geometry);
  timer.end("geometry");
  draw_lights(target, program.light, *buffers_, pipeline, draw);
  timer.end("lights");
  read_all(target, pipeline, draw, frame.capture);
  timer.end("read back");
  check_gl("drawing");
  return frame;
}

}  // namespace trueshade::oracle
