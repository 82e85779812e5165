// Every number a scene or a pipeline may hold, over the numbers that break programs: a frame without NaN (Inf only
// where a float target holds it), or a refusal. Through the C++ values, and through the text of a scene file. A new
// field is one row of kFields, and one of kTexts (hostile_texts.cpp).
#include <cstring>
#include <limits>

#include "core/error.h"
#include "scenes/pipeline/presets.h"
#include "scenes/shapes.h"
#include "tests/catch.hpp"
#include "tests/shading/nan_search.h"

namespace trueshade {
namespace {

using testing::fault_of;

constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr float kValues[] = {0.0f,          -0.0f,     1e-45f,     1.17549435e-38f,
                             1e-30f,        1.0f,      0.3f,       -1.0f,
                             8192.0f,       1e18f,     1e30f,      -1e30f,
                             3.4028235e38f, kInfinite, -kInfinite, std::numeric_limits<float>::quiet_NaN()};

/// A cube on a floor, seen from above, under one light of each type.
Scene small_scene() {
  Scene scene;
  scene.spec = "small";
  scene.meshes = {cube_mesh(), plane_mesh(2)};
  scene.materials.resize(2);
  scene.materials[0].base_color = {0.8f, 0.5f, 0.3f, 1.0f};
  scene.instances = {{0, 0, placed({0.0, 0.5, 0.0}, glm::dvec3(1.0), 0.4)}, {1, 1, placed({}, glm::dvec3(6.0))}};
  scene.lights.resize(4);
  for (size_t i = 0; i < 4; ++i) {
    Light& light = scene.lights[i];
    light.type = LightType(i);
    light.position = {0.5f, 2.0f, 1.0f};
    light.direction = {0.0f, -1.0f, 0.0f};
    light.range = 5.0f;
    light.attenuation = {1.0f, 0.1f, 0.1f};
    light.cone_rad = 0.5f;
    light.penumbra_rad = 0.2f;
  }
  scene.camera.eye = {1.0f, 2.5f, 4.0f};
  return scene;
}

struct Frame32 {
  Scene scene = small_scene();
  Pipeline pipeline;
};

struct Field {
  const char* name;
  void (*set)(Frame32&, float);
};

template <float Light::*field>
void set_lights(Frame32& f, float x) {
  for (Light& light : f.scene.lights) light.*field = x;
}
template <glm::vec3 Light::*field, int k>
void set_lights(Frame32& f, float x) {
  for (Light& light : f.scene.lights) (light.*field)[k] = x;
}
template <glm::vec3 Camera::*field, int k>
void set_camera(Frame32& f, float x) {
  (f.scene.camera.*field)[k] = x;
}

/// The floor's sampler, of a colour map that its border and its levels are seen of.
Sampler& map_floor(Frame32& f) {
  Texture texture{"", TextureFormat::rgba32f, {{4, 4, {}}}};
  for (int i = 0; i < 16; ++i)
    append_texel(texture.format, {float(i) / 16.0f, 0.5f, 1.0f, 1.0f}, texture.levels[0].bytes);
  build_mip_chain(texture);
  f.scene.textures = {texture};
  Mesh& floor = f.scene.meshes[1];
  for (size_t k = 0; k < 2; ++k) {
    floor.uv[k].clear();
    for (const float x : floor.position[2 * k]) floor.uv[k].push_back(3.0f * x);
  }
  TextureSlot& slot = f.scene.materials[1].color_map;
  slot.texture = 0;
  slot.sampler.wrap = {Wrap::clamp_to_border, Wrap::mirrored_repeat};
  return slot.sampler;
}

/// The whole post chain, whose last picture is of floats.
PostChain& post_chain(Frame32& f) {
  PostChain& post = f.pipeline.post;
  post.samples = 2;
  post.marker_radius = 0.1f;
  post.bloom = {0.5f, 0.25f, 2, 2};
  post.tone_map = PostChain::ToneMap::reinhard;
  post.edge_filter = true;
  post.output = Format::rgba32f;
  return post;
}

constexpr Field kFields[] = {
    {"light.position.x", set_lights<&Light::position, 0>},
    {"light.position.y", set_lights<&Light::position, 1>},
    {"light.direction.x", set_lights<&Light::direction, 0>},
    {"light.direction.y", set_lights<&Light::direction, 1>},
    {"light.color.r", set_lights<&Light::color, 0>},
    {"light.color",
     [](Frame32& f, float x) {
       for (Light& light : f.scene.lights) light.color = glm::vec3(x);
     }},
    {"light.ambient.g", set_lights<&Light::ambient, 1>},
    {"light.range", set_lights<&Light::range>},
    {"light.attenuation.k0", set_lights<&Light::attenuation, 0>},
    {"light.attenuation.k1", set_lights<&Light::attenuation, 1>},
    {"light.attenuation.k2", set_lights<&Light::attenuation, 2>},
    {"light.attenuation",
     [](Frame32& f, float x) {
       for (Light& light : f.scene.lights) light.attenuation = glm::vec3(x);
     }},
    {"light.cone_rad", set_lights<&Light::cone_rad>},
    {"light.penumbra_rad", set_lights<&Light::penumbra_rad>},
    {"light.spot_exponent", set_lights<&Light::spot_exponent>},
    {"light.range and color",
     [](Frame32& f, float x) {
       for (Light& light : f.scene.lights) light.range = x, light.color = glm::vec3(1e18f);
     }},
    {"camera.eye.x", set_camera<&Camera::eye, 0>},
    {"camera.eye.z", set_camera<&Camera::eye, 2>},
    {"camera.target.y", set_camera<&Camera::target, 1>},
    {"camera.up.x", set_camera<&Camera::up, 0>},
    {"camera.up.y", set_camera<&Camera::up, 1>},
    {"camera.fov_y", [](Frame32& f, float x) { f.scene.camera.fov_y_rad = x; }},
    {"camera.fov_x", [](Frame32& f, float x) { f.scene.camera.fov_x_rad = x; }},
    {"camera.near", [](Frame32& f, float x) { f.scene.camera.near = x; }},
    {"camera.far", [](Frame32& f, float x) { f.scene.camera.far = x; }},
    {"camera.clip_from_world",
     [](Frame32& f, float x) { f.scene.camera.clip_from_world = {x, 0, 0, 0, 0, x, 0, 0, 0, 0, -1, -1, 0, 0, x, x}; }},
    {"camera.clip_from_world.w",
     [](Frame32& f, float x) { f.scene.camera.clip_from_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, 2, x}; }},
    {"clear.r", [](Frame32& f, float x) { f.scene.clear.r = x; }},
    {"clear.a", [](Frame32& f, float x) { f.scene.clear.a = x; }},
    {"material.base_color.r", [](Frame32& f, float x) { f.scene.materials[0].base_color.r = x; }},
    {"material.base_color.a", [](Frame32& f, float x) { f.scene.materials[0].base_color.a = x; }},
    {"material.specular_color", [](Frame32& f, float x) { f.scene.materials[0].specular_color = glm::vec3(x); }},
    {"material.shininess", [](Frame32& f, float x) { f.scene.materials[0].shininess = x; }},
    {"material.emission", [](Frame32& f, float x) { f.scene.materials[0].emission = glm::vec3(x); }},
    {"material.metallic", [](Frame32& f, float x) { f.scene.materials[0].metallic = x; }},
    {"material.roughness", [](Frame32& f, float x) { f.scene.materials[0].roughness = x; }},
    {"material.alpha_cutoff", [](Frame32& f, float x) { f.scene.materials[0].alpha_cutoff = x; }},
    {"material.base_color.a of glass",
     [](Frame32& f, float x) { f.scene.materials[0].transparent = true, f.scene.materials[0].base_color.a = x; }},
    {"material.base_color of glass",
     [](Frame32& f, float x) {
       f.scene.materials[0].transparent = true;
       f.scene.materials[0].base_color = {x, x, x, 0.5f};
     }},
    {"instance.position.x", [](Frame32& f, float x) { f.scene.instances[0].world_from_object[3].x = x; }},
    {"instance.scale",
     [](Frame32& f, float x) {
       for (int k = 0; k < 3; ++k)
         f.scene.instances[0].world_from_object[k] = glm::vec3(0.0f), f.scene.instances[0].world_from_object[k][k] = x;
     }},
    {"instance.shear", [](Frame32& f, float x) { f.scene.instances[0].world_from_object[1].x = x; }},
    {"mesh.position", [](Frame32& f, float x) { f.scene.meshes[0].position[1][2] = x; }},
    {"mesh.normal",
     [](Frame32& f, float x) {
       for (auto& stream : f.scene.meshes[0].normal) stream.assign(stream.size(), x);
     }},
    {"geometry.depth_near", [](Frame32& f, float x) { f.pipeline.geometry.depth_near = x; }},
    {"geometry.depth_far", [](Frame32& f, float x) { f.pipeline.geometry.depth_far = x; }},
    {"geometry.clear_depth", [](Frame32& f, float x) { f.pipeline.geometry.clear_depth = x; }},
    {"geometry.polygon_offset_factor", [](Frame32& f, float x) { f.pipeline.geometry.polygon_offset_factor = x; }},
    {"geometry.polygon_offset_units", [](Frame32& f, float x) { f.pipeline.geometry.polygon_offset_units = x; }},
    {"blend.constant",
     [](Frame32& f, float x) {
       f.pipeline.blend.constant = {x, x, x, x};
     }},
    {"transparency.blend.constant",
     [](Frame32& f, float x) {
       f.scene.materials[0].transparent = true;
       f.pipeline.transparency.blend.constant = {x, x, x, x};
       f.pipeline.transparency.blend.rgb = {BlendEquation::add, BlendFactor::constant_alpha, BlendFactor::one};
     }},
    {"light_model.shininess", [](Frame32& f, float x) { f.pipeline.light_model.shininess = x; }},
    {"light_model.specular_color", [](Frame32& f, float x) { f.pipeline.light_model.specular_color = glm::vec3(x); }},
    {"light_model.global_ambient", [](Frame32& f, float x) { f.pipeline.light_model.global_ambient = glm::vec3(x); }},
    {"light_model.damping", [](Frame32& f, float x) { f.pipeline.light_model.damping = x; }},
    {"sampler.lod_bias", [](Frame32& f, float x) { map_floor(f).lod_bias = x; }},
    {"sampler.lod_min", [](Frame32& f, float x) { map_floor(f).lod_min = x; }},
    {"sampler.lod_max", [](Frame32& f, float x) { map_floor(f).lod_max = x; }},
    {"sampler.border", [](Frame32& f, float x) { map_floor(f).border = glm::vec4(x, x, 0.0f, 1.0f); }},
    {"sampler.border.a", [](Frame32& f, float x) { map_floor(f).border.a = x; }},
    {"mesh.uv", [](Frame32& f, float x) { map_floor(f), f.scene.meshes[1].uv[0][0] = x; }},
    {"mesh.more_uv",
     [](Frame32& f, float x) {
       map_floor(f);
       Mesh& floor = f.scene.meshes[1];
       floor.more_uv = {floor.uv, floor.uv};
       floor.more_uv[1][1][0] = x;
       Material& m = f.scene.materials[1];
       m.normal_map = m.color_map;
       m.color_map.uv_set = 1, m.normal_map.uv_set = 2;
       m.double_sided = true;
     }},
    {"mesh.tangent",
     [](Frame32& f, float x) {
       map_floor(f);
       Mesh& floor = f.scene.meshes[1];
       for (size_t c = 0; c < 4; ++c) floor.tangent[c].assign(floor.vertex_count(), 1.0f);
       floor.tangent[0][0] = floor.tangent[2][1] = x;
       f.scene.materials[1].normal_map = f.scene.materials[1].color_map;
     }},
    {"mesh.tangent.w",
     [](Frame32& f, float x) {
       map_floor(f);
       Mesh& floor = f.scene.meshes[1];
       for (size_t c = 0; c < 4; ++c) floor.tangent[c].assign(floor.vertex_count(), c == 3 ? x : 1.0f);
       f.scene.materials[1].normal_map = f.scene.materials[1].color_map;
     }},
    {"texel",
     [](Frame32& f, float x) {
       map_floor(f);
       std::memcpy(f.scene.textures[0].levels[0].bytes.data(), &x, sizeof x);
     }},
    {"material.normal_scale",
     [](Frame32& f, float x) {
       map_floor(f);
       f.scene.materials[1].normal_map = f.scene.materials[1].color_map;
       f.scene.materials[1].normal_scale = x;
     }},
    {"post.marker_radius", [](Frame32& f, float x) { post_chain(f).marker_radius = x; }},
    {"post.bloom.strength", [](Frame32& f, float x) { post_chain(f).bloom.strength = x; }},
    {"post.bloom.threshold", [](Frame32& f, float x) { post_chain(f).bloom.threshold = x; }},
    {"post.key", [](Frame32& f, float x) { post_chain(f).key = x; }},
    {"post.white", [](Frame32& f, float x) { post_chain(f).white = x; }},
    {"post.log_offset", [](Frame32& f, float x) { post_chain(f).log_offset = x; }},
    {"light.color under the post chain",
     [](Frame32& f, float x) {
       post_chain(f);
       for (Light& light : f.scene.lights) light.color = glm::vec3(x);
     }},
};

/// The first preset with lights blended one by one: as draws of the scene, as each kind of geometry, with factors that
/// read every number of the state; and glass in the colour plane.
void add_blending(std::vector<Pipeline>& all) {
  for (uint8_t i = 0; i < 5; ++i) {
    Pipeline p = presets().front().pipeline;
    p.strategy = i == 0 ? Strategy::forward_multipass : Strategy::deferred_volumes;
    p.light_volumes.point = p.light_volumes.spot = LightExtent(i);
    p.light_volumes.cull_face = CullFace(i % 3);
    p.light_volumes.base = i % 2 == 0;
    if (i >= 2) p.blend.rgb = {BlendEquation(i % 3), BlendFactor::constant_color, BlendFactor::one};
    if (i == 4) p.blend.rgb.dst = BlendFactor::constant_alpha;
    p.blend.constant = {0.5f, 1.0f, 2.0f, 0.5f};
    p.transparency.mode = TransparencyMode(i == 0 ? 2 : i % 3);
    all.push_back(p);
  }
}

/// The presets; the first one with each falloff, cone, specular term and order in turn, whatever presets there are; and
/// with lights blended.
std::vector<Pipeline> pipelines() {
  std::vector<Pipeline> all;
  for (const Preset& preset : presets()) all.push_back(preset.pipeline);
  for (uint8_t i = 0; i < 6; ++i) {
    Pipeline p = presets().front().pipeline;
    p.light_model.falloff = Falloff(i);
    p.light_model.cone = Cone(i % 5);
    p.light_model.specular = Specular(i % 3);
    p.light_model.order = TermOrder(i % 4);
    p.light_model.diffuse = Diffuse(i == 3);
    p.light_model.specular_source = SpecularSource(i % 4);
    p.light_model.viewer = Viewer(i % 2);
    p.light_model.emission = i % 2 == 1;
    p.light_model.renormalize = i % 3 != 2;
    p.gbuffer.position_from_depth = i == 4;
    all.push_back(p);
  }
  add_blending(all);
  for (uint8_t i = 0; i < 4; ++i) {  // the targets that llvmpipe stores in its own way
    Pipeline p = presets().front().pipeline;
    p.strategy = Strategy(i);
    p.profile = NumericProfile::mesa_llvmpipe_22_3;
    constexpr Format kOwn[] = {Format::rgb10_a2, Format::srgb8_a8, Format::r11g11b10f, Format::rgb16f};
    p.target = kOwn[i];
    all.push_back(p);
  }
  return all;
}

TEST_CASE("hostile numbers in C++ values: a frame without NaN, or a refusal") {
  const std::vector<Pipeline> bases = pipelines();
  size_t drawn = 0, refused = 0;
  for (const Field& field : kFields)
    for (const float value : kValues)
      for (size_t i = 0; i < bases.size(); ++i) {
        Frame32 frame;
        frame.pipeline = bases[i];
        field.set(frame, value);
        std::string fault;
        try {
          validate(frame.scene);
          const bool own_target = frame.pipeline.profile != NumericProfile::ideal;
          fault = fault_of(frame.scene, frame.pipeline,
                           own_target   ? frame.pipeline.target
                           : i % 2 == 0 ? Format::rgba32f
                                        : Format::rgba16f);
          ++drawn;
        } catch (const Error& error) {
          const bool in_kind = error.kind() == ErrorKind::bad_input || error.kind() == ErrorKind::usage;
          if (!in_kind) fault = error.what();
          ++refused;
        }
        if (fault.empty()) continue;
        FAIL_CHECK(field.name << " = " << value << " with pipeline " << i << " (" << bases[i].preset << "): " << fault);
      }
  CHECK(drawn > 2000);
  CHECK(refused > 2000);
}

}  // namespace
}  // namespace trueshade
