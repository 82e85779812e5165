#include "gl/lists/frame_list.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <span>

#include "gl/emit/light_text.h"
#include "gl/emit/state_list.h"
#include "gl/lists/scene_records.h"
#include "scenes/pipeline/light_mesh.h"
#include "scenes/pipeline/transparency.h"

namespace trueshade::oracle {

namespace {

template <typename T>
std::vector<uint8_t> bytes_of(std::span<const T> values) {
  std::vector<uint8_t> bytes(values.size_bytes());
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

constexpr const char* kParameters = "parameters";  // the buffer of a light program's block
constexpr glm::vec3 kQuadCorners[] = {{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}};

/// A texture of one texel, so that a lookup gives it exactly.
Texture one_texel(const std::array<float, 4>& value) {
  Texture texture{"", TextureFormat::rgba32f, {{1, 1, {}}}};
  append_texel(texture.format, value, texture.levels[0].bytes);
  return texture;
}

struct NamedMap {
  const char* name;
  TextureSlot Material::*slot;
};
constexpr NamedMap kNamedMaps[] = {
    {"color", &Material::color_map},       {"specular", &Material::specular_map},
    {"normal", &Material::normal_map},     {"metallic_roughness", &Material::metallic_roughness_map},
    {"emission", &Material::emission_map}, {"occlusion", &Material::occlusion_map}};

class FrameLister {
 public:
  FrameLister(const Scene& scene, const Pipeline& asked, const GlslOptions& options)
      : scene_(scene),
        pipeline_(drawn_pipeline(asked)),
        options_(options),
        runs_(instance_runs(scene, options.maps)),
        values_(frame_values(scene, pipeline_)) {
    list_.width = pipeline_.width, list_.height = pipeline_.height;
    list_.shaders = gl_shader_files(asked, options);
    values_.push_back({"light_count", {double(scene.lights.size())}});
  }

  FrameList listed() {
    add_pictures();
    add_scene_buffers();
    const bool glass = draws_transparent(scene_, pipeline_);
    solid_ = glass ? Only::opaque : Only::all;
    const std::optional<PlannedDraw> over = glass ? glass_draw(pipeline_, options_) : std::nullopt;
    add_scene_passes("geometry", geometry_draw(pipeline_), solid_, planes_, "depth", true, {});
    if (over && over->lights == DrawnLights::none)
      add_scene_passes("glass", *over, Only::transparent, planes_, "depth", false, {});
    add_lights();
    if (over && over->lights == DrawnLights::all) {
      const bool forward = is_forward(pipeline_.strategy);
      add_scene_passes("glass", *over, Only::transparent, {"target"}, forward ? "light_depth" : "depth", false, {});
    }
    return std::move(list_);
  }

 private:
  enum class Only : uint8_t { all, opaque, transparent };

  void add_pictures() {
    const int w = pipeline_.width, h = pipeline_.height;
    GlslOptions all_formats = options_;
    all_formats.rgb16f = true;
    const std::vector<GlslPlane> planes = planes_of(pipeline_, options_), asked = planes_of(pipeline_, all_formats);
    for (size_t i = 0; i < planes.size(); ++i) {
      planes_.push_back(planes[i].name);
      samplers_.push_back({planes[i].sampler, planes[i].name});
      const int channels = info(asked[i].format).channels;
      list_.pictures.push_back({planes[i].name, planes[i].format, w, h, {}, planes[i].name, channels});
    }
    const float depth = pipeline_.geometry.clear_depth;
    samplers_.push_back({"depth_plane", "depth"});
    list_.pictures.push_back({"depth", pipeline_.geometry.depth_format, w, h, {depth}, "depth", 1});
    if (is_forward(pipeline_.strategy))
      list_.pictures.push_back({"light_depth", pipeline_.geometry.depth_format, w, h, {depth}, "", 1});
    const glm::vec4& clear = scene_.clear;
    list_.pictures.push_back({"target",
                              renderable(pipeline_.target, options_.rgb16f),
                              w,
                              h,
                              {clear.r, clear.g, clear.b, alpha_stands_in(pipeline_, options_) ? 1.0f : clear.a},
                              "color",
                              info(pipeline_.target).channels});
  }

  void add_texels(const std::string& name, const std::vector<float>& texels) {
    list_.buffers.push_back({name, bytes_of(std::span<const float>(texels)), true});
    if (list_.buffers.back().bytes.empty()) list_.buffers.back().bytes.resize(16);
  }

  void add_scene_buffers() {
    const std::string& vert = shader("geometry.vert");
    for (const ShaderVariable& v : interface_of(vert).inputs) {
      color_ = color_ || v.name == "vertex_color";
      uv_ = uv_ || v.name == "vertex_uv";
    }
    for (size_t i = 0; i < scene_.meshes.size(); ++i) add_mesh(i);
    const std::vector<InstanceRecord> records = instance_records(scene_, pipeline_);
    list_.buffers.push_back({"instances", bytes_of(std::span<const InstanceRecord>(records)), false});
    const bool program = pipeline_.light_program.used();
    add_texels("lights", light_records(scene_.lights, light_texels(pipeline_)));
    if (const std::vector<uint8_t> block = parameter_bytes(pipeline_); !block.empty())
      list_.buffers.push_back({kParameters, block, false});
    samplers_.push_back({"lights", "lights"});
    if (reads_materials(pipeline_.light_model) || (program && options_.unlit))
      add_texels("materials", material_records(scene_, pipeline_));
    samplers_.push_back({"materials", "materials"});
    if (options_.maps) add_textures();
  }

  void add_mesh(size_t index) {
    const Mesh own = options_.normal_maps ? unshared(scene_.meshes[index]) : Mesh{};
    const Mesh& mesh = options_.normal_maps ? own : scene_.meshes[index];
    const std::string number = std::to_string(index);
    const std::vector<float> vertices = interleaved(mesh, color_, uv_);
    list_.buffers.push_back({"vertices." + number, bytes_of(std::span<const float>(vertices)), false});
    list_.buffers.push_back({"indices." + number, bytes_of(std::span<const uint32_t>(mesh.indices)), false});
    if (options_.normal_maps) add_texels("tangents." + number, tangent_texels(mesh, options_.more_uv));
    if (options_.vertex_tangents) add_texels("vertex_tangents." + number, vertex_tangent_texels(mesh));
    if (options_.more_uv) add_texels("more_uv." + number, more_uv_texels(mesh));
  }

  void add_textures() {
    list_.textures.push_back({"white", one_texel({1, 1, 1, 1}), {}});
    list_.textures.push_back({"level", one_texel({0.5f, 0.5f, 1, 1}), {}});
    for (size_t m = 0; m < scene_.materials.size(); ++m)
      for (const NamedMap& map : kNamedMaps)
        if (const TextureSlot& slot = scene_.materials[m].*map.slot; slot.used())
          list_.textures.push_back({texture_name(map, m), scene_.textures[size_t(slot.texture)], slot.sampler});
  }
  static std::string texture_name(const NamedMap& map, size_t material) {
    return std::string(map.name) + "_map." + std::to_string(material);
  }

  const std::string& shader(const std::string& name) const {
    const auto found =
        std::find_if(list_.shaders.begin(), list_.shaders.end(), [&](const auto& file) { return file.first == name; });
    return found->second;
  }

  /// A pass of those shaders: with the attributes, uniforms and samplers that they read and that are the same for all
  /// of its draws.
  ListedPass pass_of(const std::string& name, const PlannedDraw& plan) const {
    ListedPass pass;
    pass.name = name, pass.vert = plan.vert, pass.frag = plan.frag, pass.state = plan.state;
    const ShaderInterface vert = interface_of(shader(plan.vert)), frag = interface_of(shader(plan.frag));
    for (const ShaderVariable& v : vert.inputs) add_attribute(v, pass.attributes);
    for (const std::vector<ShaderVariable>* uniforms : {&vert.uniforms, &frag.uniforms})
      for (const ShaderVariable& v : *uniforms) {
        for (const ListedBinding& sampler : samplers_)
          if (sampler.sampler == v.name) pass.bindings.push_back(sampler);
        for (const NamedValue& value : values_)
          if (value.name == v.name) pass.uniforms.push_back(value);
      }
    if (plan.frag != geometry_draw(pipeline_).frag && has_buffer(kParameters))
      pass.blocks.push_back({light_text_of(pipeline_)->outline.parameter_block, kParameters});
    return pass;
  }

  /// One for each location that the variable takes.
  void add_attribute(const ShaderVariable& v, std::vector<ListedAttribute>& out) const {
    constexpr int kInstanceStride = int(sizeof(InstanceRecord));
    struct Place {
      const char* name;
      int offset;
    };
    const int uv = color_ ? 40 : 24;
    const Place places[] = {{"object_position", 0},
                            {"object_normal", 12},
                            {"vertex_color", 24},
                            {"vertex_uv", uv},
                            {"corner", 0},
                            {"clip_from_object", 0},
                            {"world_from_object", 64},
                            {"normal_from_object", 112},
                            {"base_color", 148},
                            {"instance_ids", 4 * InstanceRecord::kFloats}};
    const auto place =
        std::find_if(std::begin(places), std::end(places), [&](const Place& p) { return v.name == p.name; });
    const bool instance = v.location >= kFirstInstanceLocation;
    const int stride = instance ? kInstanceStride : v.name == "corner" ? 12 : uv + (uv_ ? 8 : 0);
    const int components = components_of(v.type);
    for (int i = 0; i < std::max(v.elements, 1); ++i)
      out.push_back({v.name, v.location + i, components, is_integer(v.type), instance,
                     place->offset + 4 * components * i, stride});
  }

  bool among(const InstanceRun& run, Only only) const {
    return only == Only::all || run.transparent == (only == Only::transparent);
  }

  /// Draws of the scene's runs, in one pass with those of the same name before them where faces are culled alike.
  void add_scene_passes(const std::string& name, const PlannedDraw& plan, Only only,
                        const std::vector<std::string>& colors, const std::string& depth, bool clears,
                        const std::vector<NamedValue>& values) {
    bool clears_now = clears;
    for (const InstanceRun& run : runs_) {
      if (!among(run, only)) continue;
      const auto [culled, front] = faces_of(run, pipeline_.geometry);
      const auto fits = [&, culled = culled, front = front](const ListedPass& pass) {
        return pass.name == name && pass.state.geometry.cull_face == culled && pass.state.geometry.front_face == front;
      };
      if (clears_now || list_.passes.empty() || !fits(list_.passes.back())) {
        list_.passes.push_back(scene_pass(name, plan, colors, depth));
        list_.passes.back().state.geometry.cull_face = culled, list_.passes.back().state.geometry.front_face = front;
        if (clears_now) list_.passes.back().cleared = cleared(colors, depth);
        clears_now = false;
      }
      add_run(run, values, list_.passes.back());
    }
    if (!clears_now) return;
    list_.passes.push_back(scene_pass(name, plan, colors, depth));  // nothing is drawn, and all is cleared
    list_.passes.back().cleared = cleared(colors, depth);
  }

  ListedPass scene_pass(const std::string& name, const PlannedDraw& plan, const std::vector<std::string>& colors,
                        const std::string& depth) const {
    ListedPass pass = pass_of(name, plan);
    pass.colors = colors, pass.depth = depth;
    return pass;
  }

  static std::vector<std::string> cleared(std::vector<std::string> colors, const std::string& depth) {
    if (!depth.empty()) colors.push_back(depth);
    return colors;
  }

  /// A draw of a run; transparent instances are drawn one by one, as their blending is watched.
  void add_run(const InstanceRun& run, const std::vector<NamedValue>& values, ListedPass& pass) const {
    const uint32_t step = run.transparent ? 1 : run.count;
    for (uint32_t i = 0; i < run.count; i += step) {
      ListedDraw draw;
      const std::string mesh = std::to_string(run.mesh);
      draw.vertices = "vertices." + mesh, draw.indices = "indices." + mesh, draw.instances = "instances";
      draw.instances_offset = (run.first + i) * sizeof(InstanceRecord);
      draw.count = int(scene_.meshes[run.mesh].indices.size());
      draw.instance_count = int(step);
      draw.uniforms = values;
      if (run.transparent) draw.object = int(run.first + i);
      add_material(run, mesh, draw);
      pass.draws.push_back(std::move(draw));
    }
  }

  void add_material(const InstanceRun& run, const std::string& mesh, ListedDraw& draw) const {
    const Material& m = scene_.materials[run.material];
    if (options_.double_sided) draw.uniforms.push_back({"double_sided", {run.double_sided ? 1.0 : 0.0}});
    if (!options_.maps) return;
    draw.uniforms.push_back({"alpha_cutoff", {double(m.alpha_cutoff)}});
    if (options_.normal_maps) draw.uniforms.push_back({"normal_scale", {double(m.normal_scale)}});
    if (options_.normal_maps) draw.bindings.push_back({"tangents", "tangents." + mesh});
    if (options_.vertex_tangents) draw.bindings.push_back({"vertex_tangents", "vertex_tangents." + mesh});
    if (options_.more_uv) draw.bindings.push_back({"more_uv", "more_uv." + mesh});
    for (const NamedMap& map : kNamedMaps) {
      const TextureSlot& slot = m.*map.slot;
      const std::string name = map.name, none = name == "normal" ? "level" : "white";
      draw.bindings.push_back({name + "_map", slot.used() ? texture_name(map, run.material) : none});
      if (options_.more_uv) draw.uniforms.push_back({name + "_uv_set", {double(slot.uv_set)}});
    }
  }

  void add_lights() {
    const std::vector<PlannedDraw> plans = light_draws(pipeline_, options_);
    if (plans[0].geometry == DrawnGeometry::triangle) return add_triangle(plans[0]);
    if (plans[0].geometry != DrawnGeometry::scene) return add_volumes(plans);
    const int lights = int(scene_.lights.size());
    if (plans[0].lights == DrawnLights::all)
      return add_scene_passes("lights", plans[0], solid_, {"target"}, "light_depth", true, {});
    for (int light = lights == 0 ? -1 : 0; light < lights; ++light) {
      add_scene_passes(light <= 0 ? "first light" : "other lights", plans[light <= 0 ? 0 : 1], solid_, {"target"},
                       "light_depth", light <= 0, {{kDrawnLight, {double(light)}}});
      if (!list_.passes.back().draws.empty()) list_.passes.back().draws.back().light = light;
    }
  }

  void add_triangle(const PlannedDraw& plan) {
    ListedPass pass = pass_of("lights", plan);
    pass.colors = pass.cleared = {"target"};
    pass.draws.emplace_back();
    pass.draws.back().count = 3;
    list_.passes.push_back(std::move(pass));
  }

  /// The quad over the image, and the mesh of each light that has one, one after the other in one buffer.
  void add_volumes(const std::vector<PlannedDraw>& plans) {
    const LightMeshes meshes(pipeline_.light_volumes);
    list_.buffers.push_back({"quad", bytes_of(std::span<const glm::vec3>(kQuadCorners)), false});
    std::vector<glm::vec3> all, corners;
    bool first = true;
    const auto start = [&](const PlannedDraw& plan, const char* name) {
      list_.passes.push_back(pass_of(name, plan));
      ListedPass& pass = list_.passes.back();
      pass.colors = {"target"};
      if (first) pass.cleared = {"target"};
      pass.strip = plan.geometry != DrawnGeometry::meshes;
      first = false;
    };
    if (plans[0].geometry == DrawnGeometry::quad) {
      start(plans[0], "base");
      list_.passes.back().draws.push_back(quad_draw(-1));
    }
    const PlannedDraw& quads = plans[plans[0].geometry == DrawnGeometry::quad ? 1 : 0];
    bool in_meshes = false, in_quads = false;
    for (size_t i = 0; i < scene_.lights.size(); ++i) {
      const LightExtent extent = drawn_extent(scene_.lights[i], pipeline_.light_volumes);
      const bool mesh = is_mesh(extent);
      if (mesh ? !in_meshes : !in_quads) start(mesh ? plans.back() : quads, mesh ? "light meshes" : "light quads");
      in_meshes = mesh, in_quads = !mesh;
      ListedDraw draw = quad_draw(int(i));
      if (mesh) {
        const LightMesh& shape = meshes[extent];
        corners.resize(shape.unit.size());
        light_vertices(shape, scene_.lights[i], corners);
        draw.vertices = "light_vertices", draw.vertices_offset = all.size() * sizeof(glm::vec3);
        draw.indices = index_buffer(extent, shape), draw.count = int(shape.indices.size());
        draw.uniforms[0].numbers[0] = 1;
        all.insert(all.end(), corners.begin(), corners.end());
      }
      list_.passes.back().draws.push_back(std::move(draw));
    }
    if (first) start(quads, "light quads");  // no light: the target is cleared all the same
    if (!all.empty()) list_.buffers.push_back({"light_vertices", bytes_of(std::span<const glm::vec3>(all)), false});
  }

  ListedDraw quad_draw(int light) const {
    ListedDraw draw;
    draw.vertices = "quad", draw.count = 4;
    draw.uniforms.push_back({"mesh", {0}});
    if (light >= 0) draw.uniforms.push_back({kDrawnLight, {double(light)}});
    draw.light = light;
    return draw;
  }

  /// The name of the buffer with the indices of a shape, made when it is first drawn.
  std::string index_buffer(LightExtent extent, const LightMesh& shape) {
    const std::string name = "indices." + std::string(name_of(extent));
    if (!has_buffer(name)) list_.buffers.push_back({name, bytes_of(std::span<const uint32_t>(shape.indices)), false});
    return name;
  }

  bool has_buffer(const std::string& name) const {
    return std::any_of(list_.buffers.begin(), list_.buffers.end(),
                       [&](const ListedBuffer& b) { return b.name == name; });
  }

  const Scene& scene_;
  const Pipeline pipeline_;
  const GlslOptions options_;
  const std::vector<InstanceRun> runs_;
  std::vector<NamedValue> values_;
  std::vector<ListedBinding> samplers_;  ///< of what is the same for a whole frame
  std::vector<std::string> planes_;
  bool color_ = false, uv_ = false;  ///< whether vertices have these
  Only solid_ = Only::all;
  FrameList list_;
};

}  // namespace

FrameList frame_list(const Scene& scene, const Pipeline& pipeline, const GlslOptions& options) {
  return FrameLister(scene, pipeline, options).listed();
}

}  // namespace trueshade::oracle
