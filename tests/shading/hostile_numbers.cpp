// Every number a scene or a pipeline may hold, over the numbers that break programs: a frame without NaN (Inf only
// where a float target holds it), or a refusal. Through the C++ values, and through the text of a scene file. A new
// field is one row of kFields, and one of kTexts.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>

#include "core/error.h"
#include "scenes/presets.h"
#include "scenes/shapes.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/scenes/scratch_folder.h"

namespace trueshade {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kValues[] = {
    0.0f,    -0.0f, 1e-45f, 1.17549435e-38f, 1e-30f,        1.0f, 0.3f,  -1.0f,
    8192.0f, 1e18f, 1e30f,  -1e30f,          3.4028235e38f, kInf, -kInf, std::numeric_limits<float>::quiet_NaN()};

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
  return all;
}

/// What is wrong with a frame; empty: nothing. An infinity is none in a float target: light of 1e18 on a colour of
/// 1e18, or 1 - d / range at a range of 1e-45, is beyond float, and OpenGL stores it so.
std::string fault_of(const Image& image) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int channel = 0; channel < 4; ++channel) {
        const double value = image.value(x, y, channel);
        if (std::isnan(value))
          return std::to_string(value) + " at " + std::to_string(x) + "," + std::to_string(y) + " channel " +
                 std::to_string(channel);
      }
  return {};
}

/// Draws a frame, small.
std::string fault_of(const Scene& scene, Pipeline pipeline, Format target) {
  pipeline.width = 32, pipeline.height = 24;
  pipeline.target = target;
  Execution execution;
  execution.threads = 1;
  return fault_of(render_frame(scene, pipeline, execution).color);
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
          fault = fault_of(frame.scene, frame.pipeline, i % 2 == 0 ? Format::rgba32f : Format::rgba16f);
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

// --- Through a scene's text ------------------------------------------------------------------------------------------

struct Text {
  const char* where;  ///< camera, object, material, light or pipeline
  const char* text;   ///< keys and values; the number stands for @
};

constexpr Text kTexts[] = {
    {"camera", R"("eye": [@, 2, 4])"},
    {"camera", R"("eye": [0, 2, 4], "target": [0, @, 0])"},
    {"camera", R"("eye": [0, 2, 4], "up": [0, @, 0])"},
    {"camera", R"("eye": [0, 2, 4], "fov_deg": @)"},
    {"camera", R"("eye": [0, 2, 4], "fov_deg": @, "fov_axis": "x")"},
    {"camera", R"("eye": [0, 2, 4], "near": @)"},
    {"camera", R"("eye": [0, 2, 4], "far": @)"},
    {"camera", R"("eye": [0, 2, 4], "clip_from_world": [@,0,0,0, 0,@,0,0, 0,0,1,0, 0,0,0,1])"},
    {"camera", R"("steps": [{"time": 0, "eye": [0, 2, 4]}, {"time": @, "eye": [0, 2, 8]}])"},
    {"object", R"("position": [@, 0, 0])"},
    {"object", R"("scale": @)"},
    {"object", R"("scale": [1, @, 1])"},
    {"object", R"("rotation": [0, @, 0, 1])"},
    {"object", R"("rotation_deg": [@, 0, @])"},
    {"object", R"("color": [@, 0.5, 0.5])"},
    {"object", R"("color": [1, 1, 1, @])"},
    {"object", R"("grid": {"count": [2, 1, 2], "spacing": @})"},
    {"object", R"("grid": {"count": [2, 1, @], "spacing": 1})"},
    {"object", R"("grid": {"count": [2, 1, 2], "spacing": 1, "jitter": @})"},
    {"object", R"("grid": {"count": [2, 1, 2], "spacing": 1, "turn_deg": @})"},
    {"object", R"("grid": {"count": [2, 1, 2], "spacing": 1, "shrink": @, "seed": 1})"},
    {"object", R"("grid": {"count": [2, 1, 2], "spacing": 1, "seed": @})"},
    {"object", R"("steps": [{"time": 0, "position": [0, 0, 0]}, {"time": @, "position": [@, 0, 0]}], "repeat": true)"},
    {"material", R"("color": [1, @, 1])"},
    {"material", R"("color": [1, 1, 1], "specular_color": [@, 0, 0])"},
    {"material", R"("color": [1, 1, 1], "shininess": @)"},
    {"material", R"("color": [1, 1, 1], "emission": [@, 0, 0])"},
    {"material", R"("color": [1, 1, 1], "metallic": @)"},
    {"material", R"("color": [1, 1, 1], "roughness": @)"},
    {"material", R"("color": [1, 1, 1, @], "transparent": true)"},
    {"material", R"("color": [1, 1, 1, 0.5], "transparent": true, "alpha_cutoff": @)"},
    {"light", R"("type": "ambient", "color": [@, 1, 1])"},
    {"light", R"("type": "ambient", "intensity": @)"},
    {"light", R"("type": "directional", "direction": [@, -1, 0])"},
    {"light", R"("type": "directional", "direction": [@, @, @])"},
    {"light", R"("type": "point", "position": [0, @, 0], "range": 3)"},
    {"light", R"("type": "point", "position": [0, 2, 0], "range": @)"},
    {"light", R"("type": "point", "position": [0, 2, 0], "attenuation": [@, 0, 0])"},
    {"light", R"("type": "point", "position": [0, 2, 0], "attenuation": [1, @, @])"},
    {"light", R"("type": "point", "position": [0, 2, 0], "color": [@, @, @], "intensity": @)"},
    {"light", R"("type": "point", "position": [0, 2, 0], "ambient": [@, 0, 0])"},
    {"light", R"("type": "spot", "position": [0, 2, 0], "direction": [0, -1, 0], "cone_deg": @)"},
    {"light", R"("type": "spot", "position": [0, 2, 0], "direction": [0, -1, 0], "cone_deg": 20, "penumbra_deg": @)"},
    {"light", R"("type": "spot", "position": [0, 2, 0], "direction": [0, -1, 0], "cone_deg": 20, "spot_exponent": @)"},
    {"light", R"("type": "ring", "count": @, "radius": 1)"},
    {"light", R"("type": "ring", "count": 5, "radius": @, "range": 2)"},
    {"light", R"("type": "ring", "count": 5, "radius": 2, "height": @, "noise": 0.5)"},
    {"light", R"("type": "ring", "count": 5, "radius": 2, "noise": @, "turn_s": 3)"},
    {"light", R"("type": "ring", "count": 5, "radius": 2, "turn_s": @)"},
    {"light", R"("type": "box", "count": 5, "from": [@, 0, 0], "to": [1, 1, 1])"},
    {"light", R"("type": "box", "count": 5, "from": [0, 0, 0], "to": [1, @, 1], "drift": @)"},
    {"light", R"("type": "box", "count": 5, "from": [0, 0, 0], "to": [1, 1, 1], "drift": 1, "drift_s": @)"},
    {"light", R"("type": "buffers", "position": [[0, @, 0]], "color": [[1, @, 1]], "falloff": [[1, 0, @]])"},
    {"light", R"("type": "ambient", "steps": [{"time": 0, "intensity": 1}, {"time": @, "intensity": @}])"},
    {"pipeline", R"("width": @)"},
    {"pipeline", R"("geometry": {"depth_near": @})"},
    {"pipeline", R"("geometry": {"depth_far": @})"},
    {"pipeline", R"("geometry": {"clear_depth": @})"},
    {"pipeline", R"("geometry": {"viewport": [@, 0, 8, 8]})"},
    {"pipeline", R"("light_model": {"shininess": @})"},
    {"pipeline", R"("light_model": {"specular_color": [@, @, @]})"},
    {"pipeline", R"("light_model": {"global_ambient": [@, 0, 0]})"},
    {"pipeline", R"("light_model": {"damping": @})"},
    {"pipeline", R"("geometry": {"polygon_offset_factor": @, "polygon_offset_units": @})"},
    {"pipeline", R"("strategy": "forward-multipass", "light_model": {"damping": @})"},
    {"pipeline", R"("strategy": "deferred-volumes", "light_volumes": {"point": "sphere", "slices": @})"},
    {"pipeline", R"("strategy": "deferred-volumes", "light_volumes": {"point": "sphere", "stacks": @})"},
    {"pipeline",
     R"("strategy": "deferred-volumes", "blend": {"constant": [@, 0, 0, @], "rgb": {"src": "constant_color"}})"},
    {"pipeline", R"("transparency": {"blend": {"constant": [@, 0, 0, 0]}})"},
};

// As they may stand in a file: beyond float, beyond double, no JSON at all.
constexpr const char* kNumbers[] = {"0",    "-0",    "1e-310", "1e-45", "1.17549435e-38", "1e-30",
                                    "1",    "1.5",   "-1",     "1e18",  "1e30",           "-1e30",
                                    "3e38", "1e300", "1e999",  "NaN",   "Infinity",       "-Infinity"};

std::string scene_text(const Text& row, const std::string& number) {
  std::string text;
  for (const char* c = row.text; *c; ++c) text += *c == '@' ? number : std::string(1, *c);
  const auto part = [&](const char* name, const std::string& usual) {
    return std::string(name) == row.where ? text : usual;
  };
  return R"({"version": 1, "camera": {)" + part("camera", R"("eye": [0, 2, 4])") +
         R"(}, "materials": [{"name": "m", )" + part("material", R"("color": [1, 1, 1])") +
         R"(}], "objects": [{"mesh": "cube", )" + part("object", R"("material": "m")") +
         R"(}, {"mesh": "plane", "scale": 5}], "lights": [{)" +
         part("light", R"("type": "point", "position": [0, 2, 1])") + R"(}], "pipeline": {)" + part("pipeline", "") +
         "}}";
}

TEST_CASE("hostile numbers in a scene's text: a frame without NaN, or exit code 3 or 4 in one line") {
  const ScratchFolder scratch;
  size_t drawn = 0, refused = 0, case_number = 0;
  for (const Text& row : kTexts)
    for (const char* number : kNumbers) {
      const std::string text = scene_text(row, number);
      std::string fault;
      try {
        Scene scene = load_scene(scratch.write("s.json", text));
        Pipeline pipeline =
            pipeline_from_json(scene.pipeline_text, "s.json", presets()[case_number % presets().size()].pipeline);
        pipeline.width = 32, pipeline.height = 24;
        validate(pipeline);
        fault = fault_of(scene, pipeline, ++case_number % 2 == 0 ? Format::rgba32f : Format::rgba16f);
        set_time(scene, 0.7);
        if (fault.empty()) fault = fault_of(scene, pipeline, Format::rgba32f);
        ++drawn;
      } catch (const Error& error) {
        const bool in_kind = error.kind() == ErrorKind::bad_input || error.kind() == ErrorKind::limit ||
                             error.kind() == ErrorKind::usage;  // usage: validate(Pipeline) names no file
        if (!in_kind || std::string(error.what()).find('\n') != std::string::npos) fault = error.what();
        ++refused;
      }
      if (!fault.empty()) FAIL_CHECK(row.text << " with " << number << ": " << fault);
    }
  CHECK(drawn > 250);
  CHECK(refused > 400);
}

}  // namespace
}  // namespace trueshade
