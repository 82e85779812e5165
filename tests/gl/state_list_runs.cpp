// state.json of `trueshade glsl` carried out: a renderer whose formats, clears, attachments, samplers and state are
// what that file says, on a context whose state was spoilt before each draw, makes the judge's own bytes.
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "gl/driver/read_back.h"
#include "gl/driver/scene_buffers.h"
#include "gl/driver/surface_uniforms.h"
#include "gl/emit/light_text.h"
#include "oracle/matrices.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/light_mesh.h"
#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"
#include "tests/gl/driver.h"
#include "tests/gl/gl_calls.h"
#include "tests/scratch_folder.h"
#include "tests/stated_presets.h"

using namespace trueshade;
using namespace trueshade::testing;
using namespace trueshade::oracle;
using nlohmann::json;

namespace {

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  REQUIRE(file.good());
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Of a draw's "geometry" or "of": the word before the colon.
std::string kind(const json& draw, const char* key) {
  const std::string text = draw[key];
  return text.substr(0, text.find(':'));
}

/// Draws from the files of one folder. The pipeline tells the size and the scene's matrices alone.
class ListedRenderer {
 public:
  ListedRenderer(const ScratchFolder& folder, const Scene& scene, const Pipeline& pipeline)
      : folder_(folder),
        scene_(scene),
        pipeline_(pipeline),
        list_(json::parse(contents(folder.path("state.json")))),
        buffers_(scene) {
    std::vector<GLuint> names;
    for (const json& entry : list_["geometry_attachments"]) {
      CHECK(entry["attachment"] == "GL_COLOR_ATTACHMENT" + std::to_string(planes_.size()));
      CHECK(entry["clear"] == 0);
      planes_.push_back({entry["plane"], entry["output"], entry["sampler"], format_of_gl_name(entry["format"])});
      textures_.push_back(make_texture(planes_.back().format, pipeline.width, pipeline.height));
      names.push_back(textures_.back());
    }
    depth_format_ = format_of_gl_name(list_["geometry_depth"]["format"]);
    target_format_ = format_of_gl_name(list_["light_target"]["format"]);
    depth_ = make_texture(depth_format_, pipeline.width, pipeline.height);
    own_depth_ = make_texture(depth_format_, pipeline.width, pipeline.height);
    color_ = make_texture(target_format_, pipeline.width, pipeline.height);
    geometry_ = make_target(names, depth_);
    const std::array<GLuint, 1> color{color_};
    light_ = make_target(color, 0), forward_ = make_target(color, own_depth_), over_ = make_target(color, depth_);
    buffers_.upload_instances(pipeline);
  }

  void draw() {
    clear_all();
    const json transparent = list_.contains("transparent_draws") ? list_["transparent_draws"] : json::array();
    const bool apart = !transparent.empty() && draws_transparent(scene_, pipeline_);
    solid_ = apart ? Surfaces::opaque : Surfaces::all;
    draw_geometry(solid_, list_["geometry_shaders"], list_["geometry_state"]);
    const bool into_albedo = apart && transparent[0]["shaders"][0] == "geometry.vert";
    if (into_albedo) draw_geometry(Surfaces::transparent, transparent[0]["shaders"], transparent[0]["state"]);
    draw_lights();
    if (apart && !into_albedo) draw_over(transparent[0]);
  }

  Image target() const { return read_texture(color_, target_format_, 0, 0, pipeline_.width, pipeline_.height); }
  Image plane(const std::string& name) const {
    for (size_t i = 0; i < planes_.size(); ++i)
      if (planes_[i].name == name)
        return read_texture(textures_[i], planes_[i].format, 0, 0, pipeline_.width, pipeline_.height);
    return {};
  }
  size_t planes() const { return planes_.size(); }

 private:
  static void set(const json& calls) {
    spoil_gl_state();
    for (const json& line : calls) run_gl_calls(line);
  }

  GLuint program(const json& shaders) {
    const std::string vertex = shaders[0], fragment = shaders[1];
    for (const auto& [name, made] : programs_)
      if (name == vertex + fragment) return made;
    programs_.emplace_back(vertex + fragment,
                           make_program(fragment, contents(folder_.path(vertex)), contents(folder_.path(fragment))));
    return programs_.back().second;
  }

  void clear_all() const {
    run_gl_calls(
        "glDepthMask(GL_TRUE); glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE); glDisable(GL_SCISSOR_TEST); "
        "glEnable(GL_FRAMEBUFFER_SRGB); glDisable(GL_DITHER)");
    const auto depth = list_["geometry_depth"]["clear"].get<float>();
    constexpr std::array<float, 4> kZero{};
    constexpr std::array<GLuint, 4> kNone{};
    glBindFramebuffer(GL_FRAMEBUFFER, geometry_.framebuffer);
    for (size_t i = 0; i < planes_.size(); ++i) {
      if (planes_[i].format == Format::r32ui)
        glClearBufferuiv(GL_COLOR, GLint(i), kNone.data());
      else
        glClearBufferfv(GL_COLOR, GLint(i), kZero.data());
    }
    glClearBufferfv(GL_DEPTH, 0, &depth);
    glBindFramebuffer(GL_FRAMEBUFFER, forward_.framebuffer);
    glClearBufferfv(GL_COLOR, 0, &scene_.clear.x);
    glClearBufferfv(GL_DEPTH, 0, &depth);
  }

  void draw_geometry(Surfaces which, const json& shaders, const json& state) {
    const GLuint p = program(shaders);
    for (size_t i = 0; i < planes_.size(); ++i) CHECK(glGetFragDataLocation(p, planes_[i].output.c_str()) == GLint(i));
    glUseProgram(p);
    if (reads_materials(pipeline_.light_model))
      bind_texture(p, "materials", 0, GL_TEXTURE_BUFFER, buffers_.material_texels(pipeline_));
    glBindFramebuffer(GL_FRAMEBUFFER, geometry_.framebuffer);
    set(state);
    buffers_.draw_instances(which);
  }

  GLuint use(const json& draw) {
    const GLuint p = program(draw["shaders"]);
    glUseProgram(p);
    const int unit = bind_surface(p, planes_, textures_, depth_, scene_, pipeline_, 0, 0);
    bind_texture(p, "lights", unit, GL_TEXTURE_BUFFER, buffers_.light_texels(pipeline_));
    set_uniform(p, "light_count", int(scene_.lights.size()));
    if (reads_materials(pipeline_.light_model))
      bind_texture(p, "materials", unit + 1, GL_TEXTURE_BUFFER, buffers_.material_texels(pipeline_));
    return p;
  }

  void draw_lights() {
    const json& draws = list_["light_draws"];
    const std::string first = kind(draws[0], "geometry");
    glBindFramebuffer(GL_FRAMEBUFFER, first == "scene" ? forward_.framebuffer : light_.framebuffer);
    if (first == "quad") return draw_volumes(draws);
    for (const json& draw : draws) {
      const GLuint p = use(draw);
      set(draw["state"]);
      if (first == "triangle") {
        const GlVertexArray none = make_vertex_array();
        glBindVertexArray(none);
        glDrawArrays(GL_TRIANGLES, 0, 3);
      } else if (kind(draw, "of") != "others") {
        set_uniform(p, kDrawnLight, 0);
        buffers_.draw_instances(solid_);
      } else {
        for (int light = 1; light < int(scene_.lights.size()); ++light) {
          set_uniform(p, kDrawnLight, light);
          buffers_.draw_instances(solid_);
        }
      }
    }
  }

  /// The draw before the lights, then each light by the entry of its kind.
  void draw_volumes(const json& draws) {
    const LightMeshes meshes(pipeline_.light_volumes);
    const GlVertexArray array = make_vertex_array();
    const auto entry = [&](const char* of) -> const json* {
      for (const json& draw : draws)
        if (kind(draw, "of") == of) return &draw;
      return nullptr;
    };
    if (const json* base = entry("none")) draw_corners(array, *base, use(*base), nullptr, nullptr);
    for (size_t i = 0; i < scene_.lights.size(); ++i) {
      const LightExtent extent = drawn_extent(scene_.lights[i], pipeline_.light_volumes);
      const json* draw = entry(is_mesh(extent) ? "meshes" : "quads");
      REQUIRE(draw != nullptr);
      const GLuint p = use(*draw);
      set_uniform(p, kDrawnLight, int(i));
      draw_corners(array, *draw, p, is_mesh(extent) ? &meshes[extent] : nullptr, &scene_.lights[i]);
    }
  }

  void draw_corners(GLuint array, const json& draw, GLuint p, const LightMesh* mesh, const Light* light) {
    constexpr std::array<glm::vec3, 4> kCorners{glm::vec3(-1, -1, 0), glm::vec3(1, -1, 0), glm::vec3(-1, 1, 0),
                                                glm::vec3(1, 1, 0)};
    std::vector<glm::vec3> corners(kCorners.begin(), kCorners.end());
    if (mesh != nullptr) corners.resize(mesh->unit.size()), light_vertices(*mesh, *light, corners);
    glBindVertexArray(array);
    const GlBuffer vertices = make_buffer(GL_ARRAY_BUFFER, std::span<const glm::vec3>(corners));
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    const Matrix4 clip = projection_of(scene_.camera, pipeline_.geometry, pipeline_.width, pipeline_.height);
    std::array<float, 16> rows{};
    for (size_t r = 0; r < 4; ++r)
      for (size_t c = 0; c < 4; ++c) rows[4 * r + c] = float(clip[4 * c + r]);
    glUniform4fv(glGetUniformLocation(p, "clip_from_world"), 4, rows.data());
    set_uniform(p, "mesh", mesh != nullptr ? 1 : 0);
    set(draw["state"]);
    if (mesh == nullptr) return glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    const GlBuffer indices = make_buffer(GL_ELEMENT_ARRAY_BUFFER, std::span<const uint32_t>(mesh->indices));
    glDrawElements(GL_TRIANGLES, GLsizei(mesh->indices.size()), GL_UNSIGNED_INT, nullptr);
  }

  void draw_over(const json& draw) {
    const bool forward = kind(list_["light_draws"][0], "geometry") == "scene";
    glBindFramebuffer(GL_FRAMEBUFFER, (forward ? forward_ : over_).framebuffer);
    use(draw);
    set(draw["state"]);
    buffers_.draw_instances(Surfaces::transparent);
  }

  const ScratchFolder& folder_;
  const Scene& scene_;
  const Pipeline& pipeline_;
  const json list_;
  SceneBuffers buffers_;
  std::vector<GlslPlane> planes_;
  std::vector<GlTexture> textures_;
  std::vector<std::pair<std::string, GlProgram>> programs_;
  Format depth_format_ = Format::d32f, target_format_ = Format::rgba8;
  GlTexture depth_, own_depth_, color_;
  GlTarget geometry_, light_, forward_, over_;
  Surfaces solid_ = Surfaces::all;
};

/// Writes the files of a pipeline, draws by them and by the judge, and compares all bytes.
void check_listed(const GlContext& context, const Scene& scene, const Preset& preset, Strategy strategy,
                  const std::string& changes) {
  const ScratchFolder folder;
  folder.write("p.json", R"({"width": 120, "height": 90)" + changes + "}");
  const std::string command = std::string("'") + TRUESHADE_COMMAND + "' glsl --preset " + std::string(preset.name) +
                              " --strategy " + std::string(name_of(strategy)) + " --pipeline '" +
                              folder.path("p.json") + "' -o '" + folder.path("") + "' > /dev/null";
  INFO(command);
  REQUIRE(std::system(command.c_str()) == 0);
  Pipeline asked = pipeline_from_json(contents(folder.path("p.json")), "p.json", preset.pipeline);
  asked.strategy = strategy;
  GlRenderer judge(context, scene);
  const Capture ours = judge.draw(asked).capture;
  const Pipeline pipeline = drawn_pipeline(asked);
  context.make_current();
  ListedRenderer listed(folder, scene, pipeline);
  listed.draw();
  CHECK(listed.target().texels == ours.color.texels);
  REQUIRE(listed.planes() + 1 == ours.planes.size());  // and depth
  for (const NamedImage& plane : ours.planes)
    if (plane.name != "depth") CHECK(listed.plane(plane.name).texels == plane.image.texels);
  run_gl_calls("glDisable(GL_SCISSOR_TEST); glDisable(GL_STENCIL_TEST); glDisable(GL_PRIMITIVE_RESTART)");
}

/// City, a third of whose materials are glass.
Scene part_of_glass() {
  Scene scene = builtin_scene("city,objects=60,lights=6");
  for (size_t i = 0; i < scene.materials.size(); i += 3) {
    scene.materials[i].base_color.a = 0.5f;
    scene.materials[i].transparent = true;
  }
  return scene;
}

}  // namespace

TEST_CASE("state.json carried out, call by call, draws the judge's own bytes under every formula and strategy") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const Scene scene = part_of_glass();
  for (const Preset& preset : stated_presets())
    for (size_t strategy = 0; strategy < std::size(kStrategyNames); ++strategy)
      check_listed(*context, scene, preset, Strategy(strategy), "");
}

TEST_CASE("state.json carried out follows every value of the pipeline that is state") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const Scene scene = part_of_glass();
  const Preset& preset = presets().front();
  const char* const changes[] = {
      R"(, "geometry": {"cull_face": "front", "front_face": "cw", "depth_func": "lequal", "depth_format": "d16", "depth_far": 0.75})",
      R"(, "geometry": {"depth_func": "greater", "clear_depth": 0, "clip_origin": "upper_left", "viewport": {"x": 8, "y": 4, "width": 100, "height": 80}})",
      R"(, "geometry": {"depth_clamp": true, "provoking": "first", "polygon_offset_factor": 1.5, "polygon_offset_units": 40},
         "gbuffer": {"normal": {"format": "rgba16f", "interpolation": "flat"}})",
      R"(, "target": "srgb8_a8", "transparency": {"mode": "after-lights"},
         "blend": {"rgb": {"equation": "max", "src": "one", "dst": "one"}, "mask": [true, false, true, true]})",
      R"(, "target": "rgba16f", "blend": {"rgb": {"equation": "add", "src": "constant_color", "dst": "one"}, "constant": [0.5, 0.25, 0.75, 1]},
         "light_volumes": {"point": "sphere", "cull_face": "front", "depth_clamp": true, "base": true})",
      R"(, "target": "rgb10_a2", "gbuffer": {"normal": {"format": "rgb10_a2"}, "albedo": {"format": "rgba16f"}})"};
  for (const char* change : changes)
    for (size_t strategy = 0; strategy < std::size(kStrategyNames); ++strategy) {
      CAPTURE(change, strategy);
      check_listed(*context, scene, preset, Strategy(strategy), change);
    }
}
