// scenes/: what is read, moved, checked and hashed.
#include "core/error.h"
#include "scenes/builtin/builtin.h"
#include "scenes/light_fields.h"
#include "scenes/pipeline/pipeline.h"
#include "tests/fp_modes/rows.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

constexpr const char* kText = R"({"version": 1, "fps": 29.97,
  "camera": {"target": [0.1, 1, 0], "fov_deg": 41.3,
             "steps": [{"time": 0, "eye": [0, 3, 9.1]}, {"time": 7, "eye": [6.3, 3, 6]}]},
  "clear": [0.1, 1e-40, 0.3, 0.7],
  "textures": [{"name": "tiles", "pattern": {"type": "noise", "size": [13, 9], "cells": [3, 3], "format": "rgba32f"}}],
  "materials": [{"name": "tiled", "color": [0.9, 0.7, 1e-40], "roughness": 0.3, "alpha_cutoff": 1e-40,
                 "color_map": {"texture": "tiles", "lod_bias": 0.1}}],
  "objects": [{"mesh": "sphere", "material": "tiled", "scale": 0.7, "rotation_deg": [10, 20, 33.3],
               "grid": {"count": [2, 1, 2], "spacing": 1.3, "jitter": 0.4, "shrink": 0.3, "turn_deg": 77, "seed": 3}},
              {"mesh": "cube", "color": [0.1, 0.2, 0.3],
               "steps": [{"time": 0, "position": [0.1, 0, 0], "rotation_deg": [0, 0, 0]},
                         {"time": 3, "position": [1.7, 1e-40, 0], "rotation_deg": [0, 0, 100]}]}],
  "lights": [{"type": "spot", "position": [2, 4, 3], "cone_deg": 20.1, "penumbra_deg": 8, "range": 12.1,
              "color": [0.1, 1e-40, 3],
              "steps": [{"time": 0, "direction": [-1, -2, 0], "intensity": 0.3},
                        {"time": 3, "direction": [1, -2, 0], "intensity": 2}]},
             {"type": "ring", "count": 5, "radius": 1.7, "range": 4.1, "turn_s": 20.3, "noise": 0.3, "seed": 4,
              "colors": [[0.4, 0.1, 0], [0, 0.1, 0.4]]}],
  "pipeline": {"light_model": {"damping": 0.1}}})";

constexpr const char* kPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property double z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0.1 0.2 0.3 1 2 3\n1.1 0.7 0 4 5 6\n1 1.3 1e-40 200 8 9\n0 1 0.1 10 11 12\n4 0 1 2 3\n";

const ScratchFolder& folder() {
  static const ScratchFolder scratch;
  return scratch;
}

/// Both are written under the default mode, as scene_of_all() is made there first.
const std::string& scene_path() {
  static const std::string path = folder().write("scene.json", kText);
  return path;
}
const std::string& mesh_path() {
  static const std::string path = folder().write("mesh.ply", kPly);
  return path;
}

const Orbit kOrbit{0, {0.1f, 0.2f, 0.3f}, {1.3f, 0.0f, 1e-40f}, {0.0f, 1.7f, 0.0f}, 3.3f, 0.21f};
const Track kTrack{{0.1, 0.7}, {{0.1, 0.2, 0.3, 0.4}, {1.0, 1e-310, 3.0, 0.7}}, Between::linear, true, 0.1, 0.9};
const Placement kPlacement{{0.1, 0.2, 1e-310}, {0.1, 0.2, 0.3, 0.9273618495495704}, {0.7, 1.1, 3.0}};

/// A triangle that turns, bends and blends, under a camera and a light that hang on a node.
constexpr const char* kGltf = R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 236, "uri":
  "data:application/octet-stream;base64,)"
                              "zczMPWZmZj8AAAAAAAAAAAAAAAAAAIA/zczMPc3MTD6amZk+lmdtP83MzD3NzEw+mpmZPs3MjD8zMzM/whYB"
                              "AAAAgD9mZqY/zczMPZqZmT4AAAAAAAAAAAAAAADNzMw9AAAAAAAAAAAAAAAAMzMzPwAAAAAAAAAAAAAAADMz"
                              "Mz/NzMw9zczMPc3MzD0zMzM/zczMPc3MzD3NzMw9MzMzP83MzD3NzMw9zczMPc3MjD/NzMw9AAAAAAAAAAAA"
                              "AAAAZmZmPwAAAAAAAAAAAAAAAAAAAAAzMzM/AAAAAM3MzD3NzEw+mpmZPgAAgD8="
                              R"("}],
  "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 32},
                  {"buffer": 0, "byteOffset": 40, "byteLength": 36}, {"buffer": 0, "byteOffset": 76, "byteLength": 36},
                  {"buffer": 0, "byteOffset": 112, "byteLength": 12}, {"buffer": 0, "byteOffset": 124, "byteLength": 48},
                  {"buffer": 0, "byteOffset": 172, "byteLength": 64}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR"},
                {"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC4"},
                {"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC3"},
                {"bufferView": 3, "componentType": 5126, "count": 3, "type": "VEC3"},
                {"bufferView": 4, "componentType": 5121, "count": 3, "type": "VEC4"},
                {"bufferView": 5, "componentType": 5126, "count": 3, "type": "VEC4"},
                {"bufferView": 6, "componentType": 5126, "count": 1, "type": "MAT4"}],
  "cameras": [{"type": "orthographic", "orthographic": {"xmag": 0.7, "ymag": 1.3, "znear": 0.1, "zfar": 7.7}}],
  "extensionsUsed": ["KHR_lights_punctual"],
  "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "color": [0.1, 0.7, 1e-40], "spot": {}}]}},
  "meshes": [{"weights": [0.3], "primitives": [{"attributes": {"POSITION": 2, "JOINTS_0": 4, "WEIGHTS_0": 5},
                                                "targets": [{"POSITION": 3}]}]}],
  "skins": [{"joints": [1], "inverseBindMatrices": 6}],
  "nodes": [{"mesh": 0, "skin": 0}, {"translation": [0.1, 0.2, 0.3], "scale": [0.7, 1.1, 3], "camera": 0,
             "extensions": {"KHR_lights_punctual": {"light": 0}}}],
  "animations": [{"samplers": [{"input": 0, "output": 1}], "channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}]}]})";

const std::string& gltf_path() {
  static const std::string path = folder().write("model.gltf", kGltf);
  return path;
}

void call_load(Bytes& out) {
  out.put(load_scene(scene_path()));
  out.put(load_scene(gltf_path()));
  out.put(load_scene(mesh_path()));
  out.put(load_scene("builtin:cornell"));
  out.put_error([] { load_scene("builtin:city,lights=0.1"); });
  out.put_error([] { load_scene(scratch_path("absent.json")); });
}

void call_hash(Bytes& out) {
  out.put(scene_hash(scene_of_all()));
  Scene digested = scene_of_all();
  digested.digests = std::make_shared<SceneDigests>(digests_of(digested));
  out.put(scene_hash(digested));
  out.put(scene_of_all().triangle_count());
  for (const Material& material : scene_of_all().materials) {
    out.put(material.masked());
    out.put(material.textured());
  }
}

void call_validate(Bytes& out) {
  validate(scene_of_all());
  validate_moving(scene_of_all(), 0.1);
  for (const Mesh& mesh : scene_of_all().meshes) out.put(reach_of(mesh));
  out.put_error([] {
    Scene scene = scene_of_all();
    scene.lights[0].range = -1e-40f;
    validate(scene);
  });
  out.put_error([] {
    Scene scene = scene_of_all();
    scene.camera.near = 0.0f;
    validate_moving(scene, 0.1);  // the error prints the time
  });
}

void call_parts(Bytes& out) {
  out.put(camera_named("Side", {{"Main", "", 0.7}, {"", "Side", 1e-310}}, "file"));
  out.put(animation_named("1", {{"Walk", 0.1}, {"Run", 1e-310}}, "file"));
  out.put_error([] { animation_named("2", {{"Walk", 0.1}, {"Run", 1e-310}}, "file"); });
  validate_camera(scene_of_all().camera, "camera", ErrorKind::usage);
  out.put_error([] {
    Camera camera = scene_of_all().camera;
    camera.fov_y_rad = 3.1415926f;
    validate_camera(camera, "camera", ErrorKind::usage);
  });
}

void call_set_time(Bytes& out) {
  Scene scene = scene_of_all();
  for (const double time : {0.0, 0.1, 2.7, -1e5}) {
    set_time(scene, time);
    out.put(scene);
  }
  Scene hierarchy = load_scene(gltf_path());
  for (const double time : {0.3, 0.65}) {
    set_time(hierarchy, time);
    out.put(hierarchy);
    for (const Light& light : hierarchy.lights) out.put_light(light);
    out.put(hierarchy.camera.clip_from_world.value());
  }
  out.put(frame_at(scene));
  out.put_error([&] { set_time(scene, 1e7); });
  out.put_error([&] { set_time(scene, std::numeric_limits<double>::quiet_NaN()); });
}

void call_tracks(Bytes& out) {
  for (const double time : {0.3, 0.65, 17.3}) {
    out.put(value_at(kTrack, time));
    out.put(direction_at(kTrack, time));
    out.put(rotation_at(kTrack, time));
    out.put(position_at(kOrbit, time));
  }
  Light light;
  Camera camera;
  set_property(light, LightProperty::color, {0.1, 1e-40, 0.7, 0.0});
  set_property(light, LightProperty::intensity, {0.3, 0.0, 0.0, 0.0});
  set_property(camera, CameraProperty::fov_y, {0.7, 0.0, 0.0, 0.0});
  out.put_light(light);
  out.put(camera.fov_y_rad);
  out.put(scene_of_all().timeline.empty());
}

void call_placements(Bytes& out) {
  out.put(world_from_object(kPlacement));
  out.put(copied(kPlacement, kPlacement));
  out.put(turned(kPlacement.rotation, {0.5, 0.5, 0.1, 0.7}));
  out.put(turn_about(1, 0.7));
  out.put(unit(glm::dvec4(0.1, 0.2, 0.3, 0.4)));
  for (const float z : {-1e-30f, 1e-30f})  // a determinant that is no normal float
    out.put(mirrors(glm::mat4x3(glm::vec3(1e-10f, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, z), glm::vec3(0))));
}

void call_camera(Bytes& out) {
  Camera camera = scene_of_all().camera;
  const Matrix4 clip = clip_from_world(camera, 1.7), other = clip_from_world(camera, 0.3, ClipRange::zero_to_one);
  out.put(clip);
  out.put(other);
  out.put(product(clip, other));
  out.put(view_axis(camera));
  out.put(clip_from_view(camera, 1.7, ClipRange::zero_to_one));
  out.put(view_from_world(camera));
  camera.clip_from_world.emplace();
  camera.clip_from_world->fill(0.1f);
  out.put(clip_from_world(camera, 1.7));
  out.put(view_axis(camera));
}

void call_textures(Bytes& out) {
  for (const TextureFormat format :
       {TextureFormat::rgba8, TextureFormat::srgb8_a8, TextureFormat::rgba16f, TextureFormat::rgba32f}) {
    Texture texture{"t", format, {{3, 2, {}}}};
    for (const float x : {0.1f, 0.5f, 1e-40f, 0.3f, 3e-8f, 0.999f})
      append_texel(format, {x, 0.7f, x, 0.25f}, texture.levels[0].bytes);
    build_mip_chain(texture);
    for (const TextureLevel& level : texture.levels) out.put(level.bytes);
    for (int x = 0; x < 3; ++x) out.put(texel_value(texture, 0, x, 1));
    out.put(bytes_per_texel(format));
  }
  out.put(scene_of_all().materials[0].color_map.used());
  out.put(reads_border(scene_of_all().materials[0].color_map.sampler));
  out.put(texture_bytes(13, 7, TextureFormat::rgba16f, MipChain::whole));
  const std::vector<uint8_t> codes = {1, 0, 0x55, 0x7f, 0xff, 0xff, 9, 0x80};
  for (const CodeEncoding encoding : {CodeEncoding::linear, CodeEncoding::srgb})
    out.put(float_texels_of_16_bits(codes, encoding));
}

void call_shininess(Bytes& out) {
  for (const float roughness : {1e-40f, 0.1f, 0.3f, 0.77f, 1.0f}) out.put(shininess_of_roughness(roughness));
  for (const TextureSlot* map : maps_of(scene_of_all().materials[0])) out.put(map->used());
}

void call_light_types(Bytes& out) {
  for (size_t i = 0; i < std::size(kLightTypes); ++i) {
    const auto type = LightType(i);
    out.put(name_of(type));
    out.put(row_of(type).is_aimed);
    out.put(is_placed(type) && has_area(type));
    out.put(is_ambient(type) || is_directional(type) || is_spot(type));
    out.put(stated_extent(type, LightVolumes{}));
  }
  Light light;
  light.type = LightType::rectangle, light.right = {0.1f, 0.2f, 1e-40f}, light.up = {0.2f, -0.1f, 0.7f};
  aim(light);
  out.put_light(light);
  out.put_light(ambient_light({0.1f, 1e-40f, 0.7f}));
}

void call_builtin(Bytes& out) {
  for (const BuiltinInfo& scene : builtin_scenes()) out.put(scene.name);
  out.put(builtin_scene("circle,lights=7,objects=5"));
  out.put_error([] { builtin_scene("nowhere"); });
}

void call_mesh(Bytes& out) {
  const Mesh& mesh = scene_of_all().meshes[0];
  out.put(mesh.vertex_count());
  out.put(mesh.triangle_count());
  out.put(mesh.has_uv());
  out.put(mesh.has_color());
  out.put(mesh.has_tangents());
  for (size_t set = 0; set < kMaxUvSets; ++set)
    for (const auto& stream : mesh.uv_set(set)) out.put(stream);
}

constexpr Row kSceneRows[] = {
    {"scenes/builtin/builtin.h", "builtin_scene builtin_scenes", call_builtin},
    {"scenes/camera.h", "clip_from_world clip_from_view view_from_world product view_axis", call_camera},
    {"scenes/light.h", "row_of name_of is_placed has_area is_ambient is_directional is_spot ambient_light",
     call_light_types},
    {"scenes/pipeline/pipeline.h", "stated_extent", call_light_types},
    {"scenes/mesh.h", "vertex_count triangle_count has_uv has_color has_tangents uv_set", call_mesh},
    {"scenes/placement.h", "world_from_object copied turned turn_about unit mirrors", call_placements},
    {"scenes/texture.h",
     "append_texel build_mip_chain texel_value bytes_per_texel used texture_bytes float_texels_of_16_bits "
     "reads_border",
     call_textures},
    {"scenes/timeline.h", "value_at direction_at rotation_at position_at set_property aim empty", call_tracks},
    {"scenes/pipeline/transparency.h", "draws_transparent",
     [](Bytes& out) { out.put(draws_transparent(scene_of_all(), Pipeline{})); }},
    {"scenes/scene.h", "load_scene Image", call_load},
    {"scenes/scene.h", "scene_hash digests_of triangle_count masked textured", call_hash},
    {"scenes/scene.h", "validate validate_moving reach_of", call_validate},
    {"scenes/scene.h", "validate_camera", call_parts},
    {"scenes/scene_parts.h", "camera_named animation_named", call_parts},
    {"scenes/scene.h", "set_time frame_at", call_set_time},
    {"scenes/scene.h", "shininess_of_roughness maps_of map_name", call_shininess},
};

}  // namespace

void Bytes::put_light(const Light& light) {
  put(light.type);
  for (const glm::vec3& three : {light.position, light.direction, light.color, light.attenuation, light.ambient})
    put(three);
  for (const glm::vec3& extent : {light.right, light.up}) put(extent);
  for (const float number : {light.range, light.cone_rad, light.penumbra_rad, light.spot_exponent}) put(number);
}

void Bytes::put(const Scene& scene) {
  for (const Mesh& mesh : scene.meshes) {
    for (const auto& stream : mesh.position) put(stream);
    for (const auto& stream : mesh.normal) put(stream);
    for (const auto& stream : mesh.uv) put(stream);
    for (const UvStreams& set : mesh.more_uv)
      for (const auto& stream : set) put(stream);
    for (const auto& stream : mesh.color) put(stream);
    for (const auto& stream : mesh.tangent) put(stream);
    put(mesh.indices);
  }
  for (const Material& material : scene.materials) {
    put(material.base_color);
    put(material.shininess);
  }
  for (const Texture& texture : scene.textures)
    for (const TextureLevel& level : texture.levels) put(level.bytes);
  for (const Instance& instance : scene.instances) {  // field by field, as lights
    put(instance.mesh);
    put(instance.material);
    put(instance.world_from_object);
    put(instance.mirrored);
  }
  for (const Light& light : scene.lights) put_light(light);
  put(scene.clear);
  put(scene.camera.eye);
  put(scene.camera.target);
  put(scene.camera.fov_y_rad);
  put(scene.camera.near);
  put(scene.camera.far);
  put(scene.timeline.fps);
  put(scene.pipeline_text);
}

const Scene& scene_of_all() {
  static const Scene scene = load_scene(scene_path());
  return scene;
}

/// Joined as text: paths of the standard library grow by floating-point arithmetic, which a mode may trap.
std::string scratch_path(std::string_view name) {
  static const std::string root = folder().path("");
  return root + std::string(name);
}

std::span<const Row> rows_of_scenes() { return kSceneRows; }

}  // namespace trueshade
