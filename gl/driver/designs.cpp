#include "gl/driver/designs.h"

#include <algorithm>
#include <stdexcept>

#include "gl/driver/albedo_blend.h"
#include "gl/driver/geometry_state.h"
#include "gl/driver/light_tiles.h"
#include "gl/driver/objects.h"
#include "gl/driver/pass_timer.h"
#include "gl/driver/read_back.h"
#include "gl/driver/scene_buffers.h"
#include "gl/driver/surface_uniforms.h"
#include "gl/driver/volume_batches.h"
#include "gl/emit/designs_glsl.h"
#include "gl/emit/light_text.h"
#include "oracle/exact_coverage.h"
#include "oracle/matrices.h"

namespace trueshade::oracle {

struct GlPeer::Work {
  GlRenderer& renderer;
  const Pipeline pipeline;
  const GlDesign design;
  const int tile;
  const GlslOptions options;
  const std::vector<GlslPlane> planes;  ///< of the G-buffer; none in forward designs
  Viewport viewport{};
  GlProgram geometry, lighting, base, depth_only, over;  ///< over: of transparent surfaces after the lights
  std::vector<GlTexture> textures;
  GlTexture depth, color;
  GlTarget geometry_target, light_target, forward_target;
  GlVertexArray none;
  VolumeBatches volumes;  ///< of deferred_volumes
  GlTexelBuffer tile_ranges, tile_records;
  GlBuffer parameters;            ///< a light program's block; none where it has none
  std::vector<float> depths;      ///< read back, row 0 at the bottom
  std::vector<uint16_t> normals;  ///< and RGBA halves

  Work(GlRenderer& r, const Pipeline& p, GlDesign d, int tile_size);
  const Scene& scene() { return renderer.buffers().scene(); }
  GlFrame draw(bool read_back);

 private:
  bool glass() { return draws_transparent(scene(), pipeline); }
  Surfaces solid() { return glass() ? Surfaces::opaque : Surfaces::all; }
  void draw_surfaces(GLuint program, Surfaces which);
  void draw_scene(GLuint program) { draw_surfaces(program, solid()); }
  void draw_gbuffer();
  void draw_depth();
  void read_normals();
  void bin_lights();
  void begin_forward();
  void use_lighting();
  void use_light_program(GLuint program);
  void light_deferred();
  void draw_volumes();
  void draw_multipass();
  void draw_over();
};

namespace {

constexpr int kLightUnit = 11, kMaterialUnit = 12;  // those below belong to planes and lights, those above to maps

/// With the planes that a light program reads.
Pipeline with_planes(const Pipeline& p) {
  const std::shared_ptr<const LightText> text = light_text_of(p);
  return text == nullptr ? p : with_planes_of(p, text->reads);
}

GlslOptions lean_options(GlRenderer& renderer) {
  GlDraw draw;
  draw.planes = false;
  GlslOptions options = renderer.shader_options(draw);
  options.products = true;
  options.instance_uniforms = renderer.buffers().has_large_meshes() && !options.maps;
  options.vertex_color = renderer.buffers().has_vertex_colors();
  return options;
}

}  // namespace

GlPeer::Work::Work(GlRenderer& r, const Pipeline& p, GlDesign d, int tile_size)
    : renderer(r),
      pipeline(with_planes(design_pipeline(p, d))),
      design(d),
      tile(tile_size > 0                 ? tile_size
           : d == GlDesign::forward_plus ? 16
                                         : 32),
      options(lean_options(r)),
      planes(is_forward(d) ? std::vector<GlslPlane>{} : planes_of(pipeline, options)) {
  renderer.context().make_current();
  check_limits(renderer.context(), pipeline, pipeline.width, pipeline.height);
  viewport = resolved_viewport(pipeline.geometry, pipeline.width, pipeline.height);
  const DesignShaders text = lighting_shaders(pipeline, options, design);
  lighting = make_program(name_of(design), text.vert, text.frag);
  const GlslShaders judge = shaders_of(pipeline, options);
  if (!is_forward(design)) geometry = make_program("geometry", judge.geometry_vert, judge.geometry_frag);
  if (glass() && !judge.transparent_frag.empty())
    over = make_program("transparent", judge.transparent_vert, judge.transparent_frag);
  if (design == GlDesign::forward_plus)
    depth_only = make_program("depth", judge.geometry_vert, empty_fragment_text(options.version));
  if (design == GlDesign::deferred_volumes) {
    if (pipeline.light_volumes.base)
      base = make_program("base", fullscreen_vertex_text(options.version), base_fragment_text(pipeline, options));
    volumes = make_volume_batches(scene().lights, pipeline.light_volumes);
  }

  std::vector<GLuint> names;
  for (const GlslPlane& plane : planes) {
    textures.push_back(make_texture(plane.format, pipeline.width, pipeline.height));
    names.push_back(textures.back());
  }
  depth = make_texture(Format::d32f, pipeline.width, pipeline.height);
  color = make_texture(renderable(pipeline.target, options.rgb16f), pipeline.width, pipeline.height);
  const std::array<GLuint, 1> target{color};
  geometry_target = make_target(names, depth);
  light_target = make_target(target, 0);
  forward_target = make_target(target, depth);
  if (!geometry_target.complete || !forward_target.complete)
    throw std::runtime_error("the driver cannot render to the planes of this design");
  none = make_vertex_array();
  if (const std::vector<uint8_t> block = parameter_bytes(pipeline); !block.empty())
    parameters = make_buffer(GL_UNIFORM_BUFFER, std::span<const uint8_t>(block));
  renderer.buffers().upload_instances(pipeline);
}

void GlPeer::Work::draw_surfaces(GLuint program, Surfaces which) {
  glUseProgram(program);
  if (reads_materials(pipeline.light_model))
    bind_texture(program, "materials", kMaterialUnit, GL_TEXTURE_BUFFER, renderer.buffers().material_texels(pipeline));
  if (options.instance_uniforms)
    renderer.buffers().draw_each_instance(program, which);
  else
    renderer.buffers().draw_instances(which);
}

void GlPeer::Work::draw_gbuffer() {
  glBindFramebuffer(GL_FRAMEBUFFER, geometry_target.framebuffer);
  glDepthMask(GL_TRUE);
  constexpr std::array<float, 4> kZero{};
  constexpr std::array<GLuint, 4> kNone{};
  for (size_t i = 0; i < planes.size(); ++i) {
    if (planes[i].format == Format::r32ui)
      glClearBufferuiv(GL_COLOR, GLint(i), kNone.data());
    else
      glClearBufferfv(GL_COLOR, GLint(i), kZero.data());
  }
  glClearBufferfv(GL_DEPTH, 0, &pipeline.geometry.clear_depth);
  set_geometry_state(pipeline.geometry, viewport, 0, 0);
  draw_scene(geometry);
  if (glass() && pipeline.transparency.mode == TransparencyMode::into_albedo)
    blend_into_albedo(planes, pipeline.transparency.blend, [this] { draw_surfaces(geometry, Surfaces::transparent); });
}

void GlPeer::Work::draw_depth() {
  glBindFramebuffer(GL_FRAMEBUFFER, geometry_target.framebuffer);
  glDepthMask(GL_TRUE);
  glClearBufferfv(GL_DEPTH, 0, &pipeline.geometry.clear_depth);
  set_geometry_state(pipeline.geometry, viewport, 0, 0);
  draw_scene(depth_only);
}

/// The thin G-buffer's halves as they are: on llvmpipe a copy.
void GlPeer::Work::read_normals() {
  for (size_t i = 0; i < planes.size(); ++i) {
    if (planes[i].name != "normal" || planes[i].format != Format::rgba16f) continue;
    normals.resize(4 * depths.size());
    glReadBuffer(GLenum(GL_COLOR_ATTACHMENT0 + i));
    glReadPixels(0, 0, pipeline.width, pipeline.height, GL_RGBA, GL_HALF_FLOAT, normals.data());
  }
}

void GlPeer::Work::bin_lights() {
  depths.resize(size_t(pipeline.width) * size_t(pipeline.height));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, geometry_target.framebuffer);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, pipeline.width, pipeline.height, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
  if (design == GlDesign::tiled) read_normals();
  const LightTiles tiles = light_tiles(scene(), pipeline, depths, normals, tile);
  std::vector<uint32_t> ranges;
  ranges.reserve(2 * tiles.first.size());
  for (size_t i = 0; i < tiles.first.size(); ++i) ranges.insert(ranges.end(), {tiles.first[i], tiles.count[i]});
  tile_ranges = make_index_buffer(ranges);
  tile_records = make_texel_buffer(tiles.records);
}

/// Binds what the pipeline's own light program reads beside surfaces and lights; under a light model nothing.
void GlPeer::Work::use_light_program(GLuint program) {
  if (!pipeline.light_program.used()) return;
  bind_texture(program, "materials", kMaterialUnit, GL_TEXTURE_BUFFER, renderer.buffers().material_texels(pipeline));
  if (parameters != 0) bind_block(program, light_text_of(pipeline)->outline.parameter_block.c_str(), parameters);
}

/// Binds whatever the lighting program reads; samplers it does not have are no harm.
void GlPeer::Work::use_lighting() {
  glUseProgram(lighting);
  int unit = bind_surface(lighting, planes, textures, depth, scene(), pipeline, 0, 0);
  if (is_binned(design)) {
    bind_texture(lighting, "tiles", unit++, GL_TEXTURE_BUFFER, tile_ranges.texture);
    bind_texture(lighting, "lights", unit, GL_TEXTURE_BUFFER, tile_records.texture);
    set_uniform(lighting, "tile_size", tile);
    set_uniform(lighting, "columns", (pipeline.width + tile - 1) / tile);
    set_uniform(lighting, "image_size", std::array<float, 2>{float(pipeline.width), float(pipeline.height)});
  } else {
    bind_texture(lighting, "lights", unit, GL_TEXTURE_BUFFER, renderer.buffers().light_texels(pipeline));
    set_uniform(lighting, "light_count", int(scene().lights.size()));
  }
  use_light_program(lighting);
}

void GlPeer::Work::light_deferred() {
  set_image_state(pipeline.width, pipeline.height);
  glBindFramebuffer(GL_FRAMEBUFFER, light_target.framebuffer);
  const glm::vec4& clear = scene().clear;
  glClearBufferfv(GL_COLOR, 0, std::array<float, 4>{clear.r, clear.g, clear.b, clear.a}.data());
  if (design == GlDesign::deferred_volumes) return draw_volumes();
  use_lighting();
  glBindVertexArray(none);
  const int columns = (pipeline.width + tile - 1) / tile, rows = (pipeline.height + tile - 1) / tile;
  if (is_tiled(design))
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, columns * rows);
  else
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void GlPeer::Work::draw_volumes() {
  if (pipeline.light_volumes.base) {
    glUseProgram(base);
    bind_surface(base, planes, textures, depth, scene(), pipeline, 0, 0);
    bind_texture(base, "lights", kLightUnit, GL_TEXTURE_BUFFER, renderer.buffers().light_texels(pipeline));
    use_light_program(base);
    glBindVertexArray(none);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  use_lighting();
  const Matrix4 clip = projection_of(scene().camera, pipeline.geometry, pipeline.width, pipeline.height);
  std::array<float, 16> columns{};
  for (size_t i = 0; i < 16; ++i) columns[i] = float(clip[i]);
  glUniformMatrix4fv(glGetUniformLocation(lighting, "clip_columns"), 1, GL_FALSE, columns.data());
  glBindVertexArray(volumes.array);
  for (const VolumeBatches::Run& run : volumes.runs) {
    set_volume_state(pipeline, run.mesh, 0, 0);
    set_blend_state(pipeline.blend);
    set_uniform(lighting, "mesh", int(run.mesh));
    glDrawElements(GL_TRIANGLES, run.count, GL_UNSIGNED_INT, reinterpret_cast<const void*>(4 * run.first));
  }
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void GlPeer::Work::begin_forward() {
  glBindFramebuffer(GL_FRAMEBUFFER, forward_target.framebuffer);
  set_geometry_state(pipeline.geometry, viewport, 0, 0);
  const glm::vec4& clear = scene().clear;
  glClearBufferfv(GL_COLOR, 0, std::array<float, 4>{clear.r, clear.g, clear.b, clear.a}.data());
  if (design != GlDesign::forward_plus) glClearBufferfv(GL_DEPTH, 0, &pipeline.geometry.clear_depth);
  use_lighting();
  if (design == GlDesign::forward_plus) {
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_EQUAL);
  }
}

/// The first light stores depth and colour, the others add where the depth is the one stored.
void GlPeer::Work::draw_multipass() {
  const int lights = int(scene().lights.size());
  for (int i = lights == 0 ? -1 : 0; i < std::max(lights, 0); ++i) {
    set_uniform(lighting, kDrawnLight, i);
    draw_scene(lighting);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_EQUAL);
    set_blend_state(kAddLight);
  }
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

/// Transparent surfaces after the lights, in every design lit by all of them: tiles' lists end at what lies behind.
void GlPeer::Work::draw_over() {
  glBindFramebuffer(GL_FRAMEBUFFER, forward_target.framebuffer);
  set_geometry_state(pipeline.geometry, viewport, 0, 0);
  glUseProgram(over);
  const int unit = bind_surface(over, planes, textures, depth, scene(), pipeline, 0, 0);
  bind_texture(over, "lights", unit, GL_TEXTURE_BUFFER, renderer.buffers().light_texels(pipeline));
  set_uniform(over, "light_count", int(scene().lights.size()));
  use_light_program(over);
  glDepthMask(GL_FALSE);
  set_blend_state(pipeline.transparency.blend);
  draw_surfaces(over, Surfaces::transparent);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

GlFrame GlPeer::Work::draw(bool read_back) {
  renderer.context().make_current();
  renderer.buffers().light_texels(pipeline);  // made before any is bound: making one binds it to whichever unit is active
  if (pipeline.light_program.used()) renderer.buffers().material_texels(pipeline);
  GlFrame frame;
  frame.capture.driver = renderer.context().info().line();
  PassTimer timer(frame.passes);
  if (!is_forward(design)) {
    draw_gbuffer();
    timer.end("geometry");
  }
  if (design == GlDesign::forward_plus) {
    draw_depth();
    timer.end("depth");
  }
  if (is_binned(design)) {
    bin_lights();
    timer.end("binning");
  }
  if (is_forward(design)) {
    begin_forward();
    if (design == GlDesign::forward_multipass)
      draw_multipass();
    else
      draw_scene(lighting);
    timer.end("forward");
  } else {
    light_deferred();
    timer.end("lights");
  }
  if (glass() && pipeline.transparency.mode == TransparencyMode::after_lights) {
    draw_over();
    timer.end("transparent");
  }
  if (read_back) frame.capture.color = read_texture(color, pipeline.target, 0, 0, pipeline.width, pipeline.height);
  check_gl(name_of(design));
  return frame;
}

GlPeer::GlPeer(GlRenderer& renderer, const Pipeline& pipeline, GlDesign design, int tile)
    : work_(std::make_unique<Work>(renderer, pipeline, design, tile)) {}
GlPeer::~GlPeer() = default;

GlFrame GlPeer::draw(bool read_back) { return work_->draw(read_back); }

}  // namespace trueshade::oracle
