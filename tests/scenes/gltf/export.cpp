#include <algorithm>

#include "../expect_error.h"
#include "asset.h"
#include "round_trip.h"
#include "scenes/builtin/builtin.h"
#include "scenes/builtin/pcg32.h"
#include "scenes/files/gltf/glb.h"
#include "scenes/files/scene_json.h"
#include "scenes/light_fields.h"
#include "scenes/trig.h"
#include "tests/scratch_folder.h"

// A scene written as GLB and loaded again is the same scene.
namespace trueshade {
namespace {

void check_same_at(Scene& scene, Scene& loaded, double time) {
  CAPTURE(time);
  set_time(scene, time);
  set_time(loaded, time);
  CHECK(scene_hash(loaded) == scene_hash(scene));
}

void check_round_trip(Scene scene) {
  Scene loaded = written_and_loaded(scene);
  CHECK(scene_hash(loaded) == scene_hash(scene));
  CHECK(loaded.meshes.size() == scene.meshes.size());
  CHECK(loaded.pipeline_text == scene.pipeline_text);
  CHECK(loaded.photometric == scene.photometric);
  CHECK(loaded.timeline.fps == scene.timeline.fps);
  for (const double time : {0.0, 0.37, 2.5}) check_same_at(scene, loaded, time);
}

TEST_CASE("export: a built-in scene loads as the same scene, at all times") {
  for (const char* spec : {"city", "rabbits", "sphere", "cornell", "circle", "lecture", "atrium,glass=1",
                           "city,lights=5000,seed=9", "circle,objects=3,lights=2"}) {
    CAPTURE(spec);
    check_round_trip(builtin_scene(spec));
  }
}

TEST_CASE("export: the largest built-in scene loads as the same scene") {
  const Scene scene = builtin_scene("red");
  CHECK(scene_hash(written_and_loaded(scene)) == scene_hash(scene));
}

/// A scene of all that a scene may have, by random numbers.
class RandomScene {
 public:
  explicit RandomScene(uint64_t seed) : random_(seed, 5) {}

  Scene make() {
    scene_.spec = "random";
    for (int i = 0; i < 4; ++i) scene_.textures.push_back(texture());
    for (int i = 0; i < 4; ++i) scene_.materials.push_back(material());
    for (int i = 0; i < 4; ++i) scene_.meshes.push_back(mesh(i));
    for (int i = 0; i < 9; ++i) scene_.instances.push_back(instance());
    for (int i = 0; i < 12; ++i) scene_.lights.push_back(light());
    scene_.clear = {number(0, 1), 0.0f, number(0, 5), 0.5f};
    camera();
    moves();
    scene_.photometric = below(2) == 0;
    if (below(2) == 0) scene_.pipeline_text = R"({"width":320,"light_model":{"shininess":12.5}})";
    set_time(scene_, 0.0);
    validate(scene_);
    return std::move(scene_);
  }

 private:
  uint32_t below(uint32_t count) { return random_.below(count); }
  float number(double from, double to) { return float(from + (to - from) * random_.real()); }
  glm::vec3 three(double from, double to) { return {number(from, to), number(from, to), number(from, to)}; }

  Texture texture() {
    Texture t;
    t.name = "t \"" + std::to_string(below(100));
    t.format = TextureFormat(below(4));
    TextureLevel level{int(1 + below(9)), int(1 + below(9)), {}};
    for (int i = 0; i < level.width * level.height; ++i)
      append_texel(t.format, {number(0, 0.9), number(0, 0.9), number(0, 0.9), number(0, 0.9)}, level.bytes);
    t.levels.push_back(std::move(level));
    if (below(3) > 0) build_mip_chain(t);
    if (below(3) == 0 && t.levels.size() > 1) t.levels.back().bytes[0] ^= 1;  // levels of one's own
    return t;
  }

  TextureSlot slot() {
    TextureSlot s;
    if (below(3) == 0) return s;
    s.texture = int32_t(below(4));
    for (Wrap& wrap : s.sampler.wrap) wrap = Wrap(below(5));
    s.sampler.mag_filter = Filter(below(2));
    s.sampler.min_filter = Filter(below(2));
    s.sampler.mip_filter = scene_.textures[size_t(s.texture)].levels.size() > 1 ? MipFilter(below(3)) : MipFilter::none;
    if (below(2) == 0) s.sampler.lod_bias = number(-3, 3), s.sampler.lod_min = -1.5f, s.sampler.lod_max = number(2, 9);
    if (below(2) == 0) s.sampler.border = {number(0, 1), 0.0f, number(0, 1), number(0, 1)};
    s.uv_set = uint8_t(below(kMaxUvSets));
    return s;
  }

  Material material() {
    Material m;
    m.name = "m" + std::to_string(below(50));
    m.base_color = {number(0, 1), number(0, 3), number(0, 1), number(0, 1)};
    m.specular_color = three(0, 1);
    m.shininess = float(below(8193));
    m.emission = three(0, below(2) == 0 ? 1 : 40);
    m.metallic = number(0, 1);
    m.roughness = number(0, 1);
    for (TextureSlot* map :
         {&m.color_map, &m.specular_map, &m.normal_map, &m.metallic_roughness_map, &m.emission_map, &m.occlusion_map})
      *map = slot();
    m.normal_scale = number(-2, 2);
    m.alpha_cutoff = below(2) == 0 ? number(0, 1) : 0.0f;
    m.transparent = below(2) == 0;
    m.occlusion_strength = number(0, 1);
    m.unlit = below(4) == 0;
    m.double_sided = below(2) == 0;
    return m;
  }

  /// One mesh without vertices, one without triangles, others with random streams.
  Mesh mesh(int kind) {
    Mesh m;
    m.name = "mesh" + std::to_string(kind);
    const uint32_t vertices = kind == 0 ? 0 : 3 + below(20);
    const auto fill = [&](auto& streams, double from, double to) {
      for (auto& stream : streams)
        for (uint32_t i = 0; i < vertices; ++i) stream.push_back(number(from, to));
    };
    fill(m.position, -3, 3);
    fill(m.normal, -1, 1);
    if (below(2) == 0) fill(m.uv, -2, 2);
    m.more_uv.resize(below(kMaxUvSets));
    for (UvStreams& set : m.more_uv)
      if (below(2) == 0) fill(set, -2, 2);
    if (below(2) == 0) fill(m.color, 0, below(2) == 0 ? 1 : 7);
    for (float& alpha : m.color[3]) alpha = std::min(alpha, 1.0f);
    if (below(2) == 0) fill(m.tangent, -1, 1);
    for (float& side : m.tangent[3]) side = side < 0.0f ? -1.0f : 1.0f;
    for (uint32_t i = 0; kind > 1 && i < 3 * (1 + below(9)); ++i) m.indices.push_back(below(vertices));
    m.indices.resize(m.indices.size() / 3 * 3);
    return m;
  }

  Instance instance() {
    Instance i{below(4), below(4), glm::mat4x3(1.0f)};
    if (below(4) > 0)
      for (int c = 0; c < 4; ++c) i.world_from_object[c] = three(-2, 2);
    i.mirrored = below(3) == 0;
    return i;
  }

  Light light() {
    Light l;
    l.type = LightType(below(4));
    l.position = three(-5, 5);
    l.direction = glm::vec3(unit(glm::dvec3(three(-1, 1))));
    l.color = three(0, 4);
    if (below(2) == 0) l.range = number(0.1, 30);
    if (below(2) == 0) l.attenuation = three(0, 2);
    l.cone_rad = number(0, 1.5);
    l.penumbra_rad = number(0, 1.5);
    l.ambient = three(0, 0.2);
    l.spot_exponent = float(below(100));
    return l;
  }

  void camera() {
    Camera& c = scene_.camera;
    c.eye = three(4, 6);
    c.target = three(-1, 1);
    c.near = number(0.01, 0.2);
    c.far = number(20, 1e6);
    const uint32_t kind = below(3);
    if (kind == 0) c.fov_y_rad = number(0.3, 2);
    if (kind == 1) c.fov_x_rad = number(0.3, 2);
    if (kind < 2) return;
    c.clip_from_world.emplace();
    for (float& element : *c.clip_from_world) element = number(-2, 2);
    c.matrix_has_gl_range = below(2) == 0;
  }

  Track track(int components, double from, double to) {
    Track t;
    const uint32_t steps = 2 + below(4);
    for (uint32_t i = 0; i < steps; ++i) {
      t.times.push_back(double(i) * 0.7 + 0.3 * random_.real());
      glm::dvec4 value(0.0);
      for (int k = 0; k < components; ++k) value[k] = from + (to - from) * random_.real();
      t.values.push_back(value);
    }
    t.between = Between(below(2));
    t.start = t.times.front();
    t.end = t.times.back();
    t.repeats = below(2) == 0;
    return t;
  }

  void moves() {
    Timeline& t = scene_.timeline;
    t.fps = 30.0;
    ObjectMotion motion;
    motion.rest.position = glm::dvec3(three(-1, 1));
    motion.rest.rotation = unit(glm::dvec4(number(-1, 1), number(-1, 1), number(-1, 1), 1.0));
    motion.position = track(3, -2, 2);
    motion.scale = track(3, 0.5, 2);
    motion.rotation = track(4, 0.1, 1);
    for (glm::dvec4& q : motion.rotation->values) q = unit(q);
    t.motions.push_back(motion);
    for (const uint32_t i : {2u, 5u}) {
      Placement copy;
      copy.position = glm::dvec3(three(-3, 3));
      t.instances.push_back({i, 0, copy, reach_of(scene_.meshes[scene_.instances[i].mesh])});
    }
    for (uint32_t i = 0; i < scene_.materials.size(); ++i)
      if (!scene_.materials[i].textured()) t.materials.push_back({i, track(4, 0, 1)});
    t.lights.push_back({1, LightProperty::color, track(3, 0, 2)});
    t.lights.push_back({1, LightProperty::intensity, track(1, 0, 2)});
    t.lights.push_back({1, LightProperty::position, track(3, -2, 2)});
    t.orbits.push_back({3, scene_.lights[3].position, three(-1, 1), three(-1, 1), number(1, 9), number(0, 1)});
    if (!scene_.camera.clip_from_world) t.camera.push_back({CameraProperty::eye, track(3, 4, 6)});
  }

  Pcg32 random_;
  Scene scene_;
};

TEST_CASE("export: random scenes of all that a scene may have load as the same scenes") {
  for (uint64_t seed = 0; seed < 150; ++seed) {
    CAPTURE(seed);
    check_round_trip(RandomScene(seed).make());
  }
}

TEST_CASE("export: geometry that instances share is written once") {
  const Scene scene = builtin_scene("rabbits");
  size_t bytes = 0;
  for (const Mesh& mesh : scene.meshes) bytes += mesh.vertex_count() * 24 + mesh.indices.size() * 4;
  CHECK(glb_of_scene(scene, stored_picture).bytes.size() < bytes + 1000 * scene.instances.size() + 100000);
}

TEST_CASE("export: what glTF cannot say is told") {
  Scene scene = builtin_scene("red");
  scene.meshes.clear(), scene.instances.clear();
  scene.camera.clip_from_world.emplace();
  const std::vector<std::string> notes = glb_of_scene(scene, stored_picture).notes;
  REQUIRE(notes.size() == 3);
  CHECK(notes[0].find("for trueshade alone, because glTF has no ambient lights") != std::string::npos);
  CHECK_STARTS_WITH(notes[1], "The camera is for trueshade alone");
  CHECK_STARTS_WITH(notes[2], "What moves is for trueshade alone");
}

TEST_CASE("export: an empty scene is a file, and loads") {
  Scene scene;
  scene.spec = "nothing";
  CHECK(scene_hash(written_and_loaded(scene)) == scene_hash(scene));
}

// --- What is read back ---------------------------------------------------------------------------------------------

std::string json_of(const std::vector<uint8_t>& glb) { return std::string(gltf::container_of(glb, "a.glb").json); }

/// The document of a small scene, its buffer aside, with a text replaced.
std::string altered_document(std::string_view from, std::string_view to) {
  Scene scene = builtin_scene("cornell");
  std::string text = json_of(glb_of_scene(scene, stored_picture).bytes);
  const size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

/// A GLB file of a document, whose buffer is all zeros.
std::vector<uint8_t> glb_of_json(std::string text) {
  const size_t at = text.find("\"buffers\":[{\"byteLength\":") + 25;
  const size_t bytes = at < 25 ? 0 : std::stoul(text.substr(at));
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::vector<uint8_t> out;
  const auto word = [&](uint32_t w) {
    for (int shift = 0; shift < 32; shift += 8) out.push_back(uint8_t(w >> shift));
  };
  for (const uint32_t w : {0x46546C67u, 2u, uint32_t(28 + text.size() + bytes), uint32_t(text.size()), 0x4E4F534Au})
    word(w);
  out.insert(out.end(), text.begin(), text.end());
  word(uint32_t(bytes));
  word(0x004E4942u);
  out.resize(out.size() + bytes);
  return out;
}

std::string altered_glb_refusal(std::string_view from, std::string_view to) {
  return error_of(ErrorKind::bad_input,
                  [&] { scene_from_gltf(glb_of_json(altered_document(from, to)), "a.glb", {}, loaded_picture); });
}

TEST_CASE("export: extras.trueshade is read strictly") {
  CHECK_NOTHROW(
      scene_from_gltf(glb_of_json(altered_document("\"version\":1,", "\"version\":1,")), "a.glb", {}, loaded_picture));
  CHECK_STARTS_WITH(altered_glb_refusal("\"version\":1,", "\"version\":1,\"new\":1,"),
                    "a.glb: /extras/trueshade/new: this key is unknown");
  CHECK_STARTS_WITH(altered_glb_refusal("\"version\":1,", "\"version\":2,"),
                    "a.glb: /extras/trueshade/version: the version is 2");
  CHECK_STARTS_WITH(altered_glb_refusal("\"version\":1,", ""), "a.glb: /extras/trueshade/version: the version is 0");
  CHECK_STARTS_WITH(altered_glb_refusal("\"camera\":{\"eye\"", "\"camera\":{\"lens\":1,\"eye\""),
                    "a.glb: /extras/trueshade/camera/lens: this key is unknown");
  CHECK_STARTS_WITH(altered_glb_refusal("\"camera\":{\"eye\":[", "\"camera\":{\"eye\":[0,"),
                    "a.glb: /extras/trueshade/camera/eye: ");
  CHECK_STARTS_WITH(altered_glb_refusal("\"mesh_count\":", "\"mesh_count\":9"),
                    "a.glb: /extras/trueshade/meshes: there are ");
  CHECK_STARTS_WITH(altered_glb_refusal("\"instances\":[", "\"instances\":[77,"),
                    "a.glb: /extras/trueshade/instances: the number of indices is odd");
  CHECK_STARTS_WITH(altered_glb_refusal("\"instances\":[0,0", "\"instances\":[77,0"),
                    "a.glb: /extras/trueshade/instances: there is no mesh 77");
  CHECK_STARTS_WITH(altered_glb_refusal("\"meshes\":[0", "\"meshes\":[99"),
                    "a.glb: /extras/trueshade/meshes: there is no mesh 99");
  CHECK_STARTS_WITH(
      altered_glb_refusal("\"hierarchy\":{}", "\"hierarchy\":{\"node_lights\":[{\"light\":0,\"node\":3}]}"),
      "a.glb: /extras/trueshade: there is no node 3");
  CHECK_STARTS_WITH(altered_glb_refusal("\"hierarchy\":{}", "\"hierarchy\":{},\"pipeline\":{\"widht\":3}"),
                    "a.glb: /extras/trueshade/pipeline: ");
}

TEST_CASE("export: lists of extras.trueshade take no memory beyond the limit") {
  std::string many = "\"materials\":[{}";
  for (int i = 0; i < 20000; ++i) many += ",{}";
  SceneLimits limits;
  limits.geometry_bytes = 1 << 20;
  CHECK_STARTS_WITH(error_of(ErrorKind::limit,
                             [&] {
                               const std::string json = altered_document(
                                   "\"hierarchy\":{}", "\"hierarchy\":{\"nodes\":[" + many.substr(13) + "]}");
                               scene_from_gltf(glb_of_json(json), "a.glb", limits, loaded_picture);
                             }),
                    "a.glb: /extras/trueshade/hierarchy/nodes: the list is over the limit of memory");
}

TEST_CASE("export: extras of others are passed over") {
  for (const char* extras :
       {"\"extras\":{\"other\"", "\"extras\":[1,2],\"was\":{\"other\"", "\"extras\":3,\"was\":{\"other\""})
    CHECK(
        scene_from_gltf(glb_of_json(altered_document("\"extras\":{\"trueshade\"", extras)), "a.glb", {}, loaded_picture)
            .photometric);
}

TEST_CASE("export: lights that were changed for other programs, and not in extras.trueshade, are told of") {
  const auto notes = [](std::string_view from, std::string_view to) {
    return scene_from_gltf(glb_of_json(altered_document(from, to)), "a.glb", {}, loaded_picture).notes;
  };
  CHECK(notes("\"version\":1,", "\"version\":1,").empty());
  const std::vector<std::string> brighter = notes("\"intensity\":", "\"intensity\":9");
  REQUIRE(brighter.size() == 1);
  CHECK(brighter[0].find("of KHR_lights_punctual differ") != std::string::npos);
}

TEST_CASE("export: the lights of built-in scenes and of random ones are what extras.trueshade says") {
  for (const char* spec : {"city", "cornell", "circle", "lecture", "red,lights=9"}) {
    CAPTURE(spec);
    CHECK(written_and_loaded(builtin_scene(spec)).notes.empty());
  }
  for (uint64_t seed = 0; seed < 20; ++seed) CHECK(written_and_loaded(RandomScene(seed).make()).notes.empty());
}

TEST_CASE("export: a scene file loads as the same scene") {
  const ScratchFolder folder;
  const std::string text = R"({"version": 1, "fps": 12, "camera": {"fov_axis": "x", "fov_deg": 50,
      "steps": [{"time": 0, "eye": [0, 2, 6]}, {"time": 3, "eye": [1, 2, 5]}]},
    "textures": [{"name": "a", "pattern": {"type": "brick", "size": [32, 16], "format": "rgba16f"}}],
    "materials": [{"name": "m", "color": [1, 1, 1], "color_map": {"texture": "a", "wrap": "clamp_to_border"}}],
    "objects": [{"mesh": "plane", "material": "m", "scale": 5},
      {"mesh": "cube", "grid": {"count": [2, 1, 2], "spacing": 2},
       "steps": [{"time": 0, "color": [1, 0, 0], "rotation_deg": [0, 0, 0]},
       {"time": 1, "color": [0, 0, 1], "rotation_deg": [0, 90, 0]}]}],
    "lights": [{"type": "ring", "count": 5, "radius": 2, "range": 4, "turn_s": 3},
      {"type": "spot", "cone_deg": 20, "position": [0, 4, 0],
       "steps": [{"time": 0, "direction": [0, -1, 0]}, {"time": 2, "direction": [1, -1, 0]}]}],
    "pipeline": {"target": "rgba16f"}})";
  const std::string path = folder.write("scene.json", text);
  check_round_trip(scene_from_json(text, path, {}, {}));
}

/// A triangle, a light and a camera on nodes that move and turn.
std::string animated() {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  asset.accessor(std::vector<float>{0, 1, 3}, "SCALAR", R"("min": [0], "max": [3])");
  asset.accessor(std::vector<float>{0, 0, 0, 1, 2, 3, -1, 0, 1}, "VEC3");
  asset.accessor(std::vector<float>{0, 0, 0, 1, 0, 0.6f, 0, 0.8f, 0.8f, 0, 0, 0.6f}, "VEC4");
  return asset.gltf(R"("scene": 0, "scenes": [{"nodes": [0]}], "extensionsUsed": ["KHR_lights_punctual"],
    "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {}}]}},
    "cameras": [{"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 3, "znear": 0, "zfar": 20}}],
    "nodes": [{"children": [1, 2, 3], "translation": [0.1, 0.2, 0.3]}, {"mesh": 0, "scale": [1, 2, 3]},
              {"extensions": {"KHR_lights_punctual": {"light": 0}}}, {"camera": 0, "translation": [0, 0, 5]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "animations": [{"samplers": [{"input": 1, "output": 2}, {"input": 1, "output": 3}, {"input": 1, "output": 2}],
      "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}},
                   {"sampler": 1, "target": {"node": 1, "path": "rotation"}},
                   {"sampler": 2, "target": {"node": 3, "path": "translation"}}]}])");
}

TEST_CASE("export: an animated glTF file loads as the same scene, and skins are said to stand still") {
  Scene scene = load_gltf(animated());
  REQUIRE(scene.timeline.node_motions.size() == 3);
  REQUIRE(scene.timeline.node_camera);
  check_round_trip(scene);
  scene.timeline.posed.emplace_back();
  const GlbFile file = glb_of_scene(scene, stored_picture);
  CHECK(scene_from_gltf(file.bytes, "a.glb", {}, loaded_picture).timeline.empty());
  CHECK_STARTS_WITH(file.notes.back(), "The scene stands still");
}

}  // namespace
}  // namespace trueshade
