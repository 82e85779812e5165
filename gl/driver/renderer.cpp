#include "gl/driver/renderer.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "gl/driver/albedo_blend.h"
#include "gl/driver/geometry_state.h"
#include "gl/driver/objects.h"
#include "gl/driver/pass_timer.h"
#include "gl/driver/post_frame.h"
#include "gl/driver/probes.h"
#include "gl/driver/read_back.h"
#include "gl/driver/scene_buffers.h"
#include "gl/driver/surface_uniforms.h"
#include "gl/emit/light_text.h"
#include "gl/emit/post_glsl.h"
#include "oracle/exact_coverage.h"
#include "scenes/pipeline/light_mesh.h"

namespace trueshade::oracle {

/// Textures of one frame and where the picture lies in them.
struct Targets {
  int width = 0, height = 0;  ///< of the textures: the image and its shift
  Format color_format = Format::rgba8, depth_format = Format::d32f;
  std::vector<GlslPlane> planes;
  std::vector<GlTexture> textures;  ///< one a plane
  GlTexture depth, color, forward_depth;
  GlTarget geometry, light, forward;  ///< forward: the target with a depth of its own
  GlTarget over;                      ///< the target with the geometry pass's depth
};

struct Programs {
  GlslShaders text;
  GlProgram geometry, light, base, transparent;
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
  t->forward_depth = make_texture(depth_format, width, height);
  t->forward = make_target(color, t->forward_depth);
  t->over = make_target(color, t->depth);
  if (!t->geometry.complete || !t->light.complete)
    throw std::runtime_error("the driver cannot render to the planes of this pipeline");
  return t;
}

void clear_geometry(const Targets& t, float clear_depth) {
  glBindFramebuffer(GL_FRAMEBUFFER, t.geometry.framebuffer);
  glDepthMask(GL_TRUE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);  // clears are masked too, and the frame before may have left one
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

/// The light pass of one frame, by strategy.
class LightPass {
 public:
  LightPass(const Targets& t, const Programs& programs, SceneBuffers& buffers, const Pipeline& pipeline,
            const GlDraw& draw)
      : t_(t), programs_(programs), buffers_(buffers), pipeline_(pipeline), draw_(draw), scene_(buffers.scene()) {
    const int all = int(scene_.lights.size());
    lights_ = draw.lights < 0 ? all : std::min(draw.lights, all);
    stands_in_ = t.color_format != pipeline.target;
    if (const std::vector<uint8_t> block = parameter_bytes(pipeline); !block.empty())
      parameters_ = make_buffer(GL_UNIFORM_BUFFER, std::span<const uint8_t>(block));
  }

  void run() {
    draw_lights();
    if (transparent() && pipeline_.transparency.mode == TransparencyMode::after_lights) draw_over();
  }

 private:
  void draw_lights() {
    switch (pipeline_.strategy) {
      case Strategy::forward_multipass:
        return multipass();
      case Strategy::forward_loop:
        return forward_loop();
      case Strategy::deferred_volumes:
        return volumes();
      case Strategy::deferred_loop:
        return deferred_loop();
    }
  }

  bool transparent() const { return draws_transparent(scene_, pipeline_); }
  Surfaces solid() const { return transparent() ? Surfaces::opaque : Surfaces::all; }

  /// Transparent surfaces lit one by one, blended into the target.
  void draw_over() const {
    set_scene_state();
    glBindFramebuffer(GL_FRAMEBUFFER, (is_forward(pipeline_.strategy) ? t_.forward : t_.over).framebuffer);
    use(programs_.transparent);
    glDepthMask(GL_FALSE);
    set_blend_state(of_target(pipeline_.transparency.blend));
    if (draw_.after_object)
      draw_over_one_by_one();
    else
      buffers_.draw_instances(Surfaces::transparent);
    write_alpha();
  }

  void draw_over_one_by_one() const {
    constexpr size_t kMostSteps = 64;
    std::vector<uint32_t> objects;
    for (uint32_t i = 0; i < scene_.instances.size(); ++i)
      if (scene_.materials[scene_.instances[i].material].transparent) objects.push_back(i);
    const size_t stride = (objects.size() + kMostSteps - 1) / kMostSteps;
    const GLuint framebuffer = (is_forward(pipeline_.strategy) ? t_.forward : t_.over).framebuffer;
    show(draw_.after_object, -1, framebuffer);
    for (size_t k = 0; k < objects.size(); ++k) {
      buffers_.draw_transparent(objects[k]);
      if ((k + 1) % stride == 0 || k + 1 == objects.size()) show(draw_.after_object, int(objects[k]), framebuffer);
    }
  }

  /// An alpha that stands in for none stays 1 from the clear on.
  BlendState of_target(BlendState blend) const {
    if (stands_in_) blend.mask[3] = false;
    return blend;
  }
  void hold_alpha() const { glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, stands_in_ ? GL_FALSE : GL_TRUE); }
  static void write_alpha() { glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE); }

  void clear(GLuint framebuffer) const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    const std::array<float, 4> color{scene_.clear.r, scene_.clear.g, scene_.clear.b,
                                     stands_in_ ? 1.0f : scene_.clear.a};
    glClearBufferfv(GL_COLOR, 0, color.data());
  }

  void show(int light, GLuint framebuffer) const { show(draw_.after_light, light, framebuffer); }
  void show(const StepSink& sink, int step, GLuint framebuffer) const {
    if (!sink) return;
    sink(step,
         read_texture(t_.color, pipeline_.target, draw_.shift_x, draw_.shift_y, pipeline_.width, pipeline_.height));
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  }

  void use(GLuint program) const {
    const bool materials = reads_materials(pipeline_.light_model) || pipeline_.light_program.used();
    // Made before any is bound: making one binds it to whichever unit is active.
    const GLuint light_texels = buffers_.light_texels(pipeline_);
    const GLuint material_texels = materials ? buffers_.material_texels(pipeline_) : 0;
    glUseProgram(program);
    const int unit =
        bind_surface(program, t_.planes, t_.textures, t_.depth, scene_, pipeline_, draw_.shift_x, draw_.shift_y);
    bind_texture(program, "lights", unit, GL_TEXTURE_BUFFER, light_texels);
    set_uniform(program, "light_count", lights_);
    if (materials) bind_texture(program, "materials", unit + 1, GL_TEXTURE_BUFFER, material_texels);
    if (parameters_ != 0) bind_block(program, light_text_of(pipeline_)->outline.parameter_block.c_str(), parameters_);
  }

  void set_scene_state() const {
    set_geometry_state(pipeline_.geometry, resolved_viewport(pipeline_.geometry, pipeline_.width, pipeline_.height),
                       draw_.shift_x, draw_.shift_y);
  }

  void begin_forward() const {
    set_scene_state();
    clear(t_.forward.framebuffer);
    glClearBufferfv(GL_DEPTH, 0, &pipeline_.geometry.clear_depth);
    use(programs_.light);
    hold_alpha();
  }

  void forward_loop() const {
    begin_forward();
    buffers_.draw_instances(solid());
    write_alpha();
  }

  /// The first light stores depth and colour, the others add where the depth is the one stored.
  void multipass() const {
    begin_forward();
    if (lights_ > 0) show(-1, t_.forward.framebuffer);
    for (int light = lights_ == 0 ? -1 : 0; light < lights_; ++light) {
      set_uniform(programs_.light, kDrawnLight, light);
      buffers_.draw_instances(solid());
      show(light, t_.forward.framebuffer);
      glDepthMask(GL_FALSE);
      glDepthFunc(GL_EQUAL);
      set_blend_state(of_target(kAddLight));
    }
    write_alpha();
  }

  void deferred_loop() const {
    set_image_state(t_.width, t_.height);
    clear(t_.light.framebuffer);
    use(programs_.light);
    const GlVertexArray none = make_vertex_array();
    glBindVertexArray(none);
    hold_alpha();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    write_alpha();
  }

  void draw_quad(GLuint program) const {
    constexpr std::array<float, 12> kCorners{-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0};
    const GlBuffer corners = make_buffer(GL_ARRAY_BUFFER, std::span<const float>(kCorners));
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    set_uniform(program, "mesh", 0);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }

  void draw_mesh(const LightMesh& mesh, const Light& light) const {
    std::vector<glm::vec3> vertices(mesh.unit.size());
    light_vertices(mesh, light, vertices);
    const GlBuffer corners = make_buffer(GL_ARRAY_BUFFER, std::span<const glm::vec3>(vertices));
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    const GlBuffer indices = make_buffer(GL_ELEMENT_ARRAY_BUFFER, std::span<const uint32_t>(mesh.indices));
    set_uniform(programs_.light, "mesh", 1);
    glDrawElements(GL_TRIANGLES, GLsizei(mesh.indices.size()), GL_UNSIGNED_INT, nullptr);
  }

  void volumes() const {
    clear(t_.light.framebuffer);
    const GlVertexArray array = make_vertex_array();
    glBindVertexArray(array);
    glEnableVertexAttribArray(0);
    if (pipeline_.light_volumes.base) {
      set_volume_state(pipeline_, false, draw_.shift_x, draw_.shift_y);
      hold_alpha();
      use(programs_.base);
      draw_quad(programs_.base);
    }
    show(-1, t_.light.framebuffer);
    use(programs_.light);
    set_clip_rows(programs_.light, scene_, pipeline_);
    const BlendState blend = of_target(pipeline_.blend);
    const LightMeshes meshes(pipeline_.light_volumes);
    for (int i = 0; i < lights_; ++i) {
      const Light& light = scene_.lights[size_t(i)];
      const LightExtent extent = drawn_extent(light, pipeline_.light_volumes);
      set_volume_state(pipeline_, is_mesh(extent), draw_.shift_x, draw_.shift_y);
      set_blend_state(blend);
      set_uniform(programs_.light, kDrawnLight, i);
      if (is_mesh(extent))
        draw_mesh(meshes[extent], light);
      else
        draw_quad(programs_.light);
      show(i, t_.light.framebuffer);
    }
    write_alpha();
  }

  const Targets& t_;
  const Programs& programs_;
  SceneBuffers& buffers_;
  const Pipeline& pipeline_;
  const GlDraw& draw_;
  const Scene& scene_;
  int lights_ = 0;
  GlBuffer parameters_;     ///< a light program's block; none where it has none
  bool stands_in_ = false;  ///< the target has an alpha that its format has not: it stays 1, as blending reads it
};

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
         g.albedo.format == Format::rgb16f || g.uv.format == Format::rgb16f || g.emission == Format::rgb16f;
}

}  // namespace

KeptPrograms::KeptPrograms() = default;
KeptPrograms::~KeptPrograms() = default;

GlRenderer::GlRenderer(const GlContext& context, const Scene& scene, int rotation, KeptPrograms* kept)
    : context_(&context), kept_(kept) {
  context.make_current();
  buffers_ = std::make_unique<SceneBuffers>(scene, rotation);
  rgb16f_ = renders_to(Format::rgb16f);
  primitive_ids_ = counts_primitives();
}

GlRenderer::~GlRenderer() { context_->make_current(); }  // what it owns is freed in that context

GlslOptions GlRenderer::shader_options(const GlDraw& draw) const {
  GlslOptions options = scene_options(buffers_->scene());
  options.version = context_->info().major * 10 + context_->info().minor >= 45 ? 450 : 330;
  options.ids = options.uv = draw.planes;
  options.primitive = primitive_ids_;
  options.rgb16f = rgb16f_;
  if (!draw.planes) options.light_types = buffers_->light_types();
  return options;
}

const Programs& GlRenderer::programs(const GlslShaders& text) {
  std::vector<std::unique_ptr<Programs>>& all = kept_ != nullptr ? kept_->all_ : own_.all_;
  for (const std::unique_ptr<Programs>& p : all)
    if (p->text == text) return *p;
  if (kept_ == nullptr) all.clear();
  all.push_back(std::make_unique<Programs>(Programs{
      text, make_program("geometry", text.geometry_vert, text.geometry_frag),
      make_program("light", text.light_vert, text.light_frag),
      text.base_frag.empty() ? GlProgram{} : make_program("base", text.light_vert, text.base_frag),
      text.transparent_frag.empty() ? GlProgram{}
                                    : make_program("transparent", text.transparent_vert, text.transparent_frag)}));
  return *all.back();
}

const Targets& GlRenderer::targets(const Pipeline& pipeline, const GlslOptions& options, const GlDraw& draw) {
  const int width = pipeline.width + draw.shift_x, height = pipeline.height + draw.shift_y;
  const Format color_format = renderable(pipeline.target, options.rgb16f);
  const std::vector<GlslPlane> planes = planes_of(pipeline, options);
  const Targets* t = targets_.get();
  if (t == nullptr || t->width != width || t->height != height || t->color_format != color_format ||
      t->depth_format != pipeline.geometry.depth_format || t->planes != planes)
    targets_ = make_targets(width, height, color_format, pipeline.geometry.depth_format, planes);
  return *targets_;
}

GlFrame GlRenderer::draw(const Pipeline& asked, const GlDraw& draw) {
  const bool post = draw.post && asked.post.active();
  const Pipeline pipeline = drawn_pipeline(post ? pipeline_without_post(asked) : asked);
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
  if (!options.rgb16f && pipeline.target == Format::rgb16f)
    frame.notes.push_back("rgb16f is not renderable on this driver: the target is rgba16f whose alpha stays 1");
  if (options.ids && !options.primitive)
    frame.notes.push_back("gl_PrimitiveID draws nothing on this driver: there is no plane id.primitive");
  PassTimer timer(frame.passes);
  buffers_->upload_instances(pipeline);
  clear_geometry(target, pipeline.geometry.clear_depth);
  timer.end("upload and clear");
  set_geometry_state(pipeline.geometry, resolved_viewport(pipeline.geometry, pipeline.width, pipeline.height),
                     draw.shift_x, draw.shift_y);
  glUseProgram(program.geometry);
  if (reads_materials(pipeline.light_model))
    bind_texture(program.geometry, "materials", 0, GL_TEXTURE_BUFFER, buffers_->material_texels(pipeline));
  const bool apart = draws_transparent(buffers_->scene(), pipeline);
  buffers_->draw_instances(apart ? Surfaces::opaque : Surfaces::all);
  if (apart && pipeline.transparency.mode == TransparencyMode::into_albedo)
    blend_into_albedo(target.planes, pipeline.transparency.blend,
                      [this] { buffers_->draw_instances(Surfaces::transparent); });
  timer.end("geometry");
  LightPass(target, program, *buffers_, pipeline, draw).run();
  timer.end("lights");
  read_all(target, pipeline, draw, frame.capture);
  timer.end("read back");
  if (post) {
    frame.finished = finished_by_gl(buffers_->scene(), asked, options.version, target.color, target.depth);
    timer.end("post");
  }
  check_gl("drawing");
  return frame;
}

}  // namespace trueshade::oracle
