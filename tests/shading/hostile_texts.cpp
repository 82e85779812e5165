// Every number a scene file may hold, over the numbers that break programs, as they stand in a text: a frame without
// NaN, or a refusal in one line. A new field is one row of kTexts.
#include <string>

#include "core/error.h"
#include "scenes/pipeline/presets.h"
#include "scenes/scene.h"
#include "tests/catch.hpp"
#include "tests/scratch_folder.h"
#include "tests/shading/nan_search.h"
#include "tests/stated_presets.h"

namespace trueshade {
namespace {

using testing::fault_of;

struct Text {
  const char* where;  ///< camera, object, material, texture, light or pipeline
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
    {"material", R"("color": [1, 1, 1], "color_map": {"texture": "t", "lod_bias": @})"},
    {"material", R"("color": [1, 1, 1], "color_map": {"texture": "t", "lod_min": @, "lod_max": @})"},
    {"material",
     R"("color": [1, 1, 1], "color_map": {"texture": "t", "wrap": ["clamp_to_border", "repeat"], "border": [@, 0, 0, @]})"},
    {"material", R"("color": [@, 1, 1], "specular_color": [@, 1, 1], "specular_map": {"texture": "t"})"},
    {"material", R"("color": [1, 1, 1], "normal_map": {"texture": "t"}, "normal_scale": @)"},
    {"texture", R"("pattern": {"type": "checker", "cells": [@, 8]})"},
    {"texture", R"("pattern": {"type": "checker", "size": [@, 8], "seed": @})"},
    {"texture", R"("pattern": {"type": "checker", "colors": [[@, 0, 0], [1, 1, 1, @]]})"},
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
    {"pipeline", R"("geometry": {"viewport": {"x": @, "y": 0, "width": 8, "height": @}})"},
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
    {"pipeline", R"("profile": "mesa-llvmpipe-22.3", "blend": {"constant": [@, 0, 0, @]})"},
    {"pipeline", R"("post": {"marker_radius": @})"},
    {"pipeline", R"("post": {"samples": @})"},
    {"pipeline", R"("post": {"bloom": {"strength": @, "threshold": 0.5}})"},
    {"pipeline", R"("post": {"bloom": {"strength": 0.5, "threshold": @}})"},
    {"pipeline", R"("post": {"bloom": {"strength": 0.5, "radius": @, "passes": @}})"},
    {"pipeline", R"("post": {"tone_map": "reinhard", "key": @, "white": @})"},
    {"pipeline", R"("post": {"tone_map": "reinhard", "log_offset": @})"},
};

// As they may stand in a file: beyond float, beyond double, no JSON at all.
constexpr const char* kNumbers[] = {"0",     "-0",    "1e-310", "1e-45",    "1.17549435e-38", "1e-30", "1",
                                    "3",     "1.5",   "-1",     "1e18",     "1e30",           "-1e30", "3e38",
                                    "1e300", "1e999", "NaN",    "Infinity", "-Infinity"};

std::string scene_text(const Text& row, const std::string& number) {
  std::string text;
  for (const char* c = row.text; *c; ++c) text += *c == '@' ? number : std::string(1, *c);
  const auto part = [&](const char* name, const std::string& usual) {
    return std::string(name) == row.where ? text : usual;
  };
  return R"({"version": 1, "camera": {)" + part("camera", R"("eye": [0, 2, 4])") + R"(}, "textures": [{"name": "t", )" +
         part("texture", R"("pattern": {"type": "checker"})") + R"(}], "materials": [{"name": "m", )" +
         part("material", R"("color": [1, 1, 1])") + R"(}], "objects": [{"mesh": "cube", )" +
         part("object", R"("material": "m")") + R"(}, {"mesh": "plane", "scale": 5}], "lights": [{)" +
         part("light", R"("type": "point", "position": [0, 2, 1])") + R"(}], "pipeline": {)" + part("pipeline", "") +
         "}}";
}

/// What README promises of a bad file: `FILE: WHERE: REASON (REMEDY)` in one line, and exit code 3, or 4 for a limit.
bool names_the_file(const Error& error) {
  const std::string line = error.what();
  return (error.kind() == ErrorKind::bad_input || error.kind() == ErrorKind::limit) &&
         line.find("s.json: ") != std::string::npos && line.find('\n') == std::string::npos;
}

TEST_CASE("hostile numbers in a scene's text: a frame without NaN, or exit code 3 or 4 in one line") {
  const ScratchFolder scratch;
  const std::vector<Preset> rows = stated_presets();
  size_t drawn = 0, refused = 0, case_number = 0;
  for (const Text& row : kTexts) {
    const size_t drawn_before = drawn, refused_before = refused;
    for (const char* number : kNumbers) {
      const std::string text = scene_text(row, number);
      std::string fault;
      try {
        Scene scene = load_scene(scratch.write("s.json", text));
        const auto over = [&](const Pipeline& base) {
          Pipeline pipeline = pipeline_from_json(scene.pipeline_text, "s.json", base);
          pipeline.width = 32, pipeline.height = 24;
          validate(pipeline);
          return pipeline;
        };
        const Pipeline pipeline = over(rows[case_number % rows.size()].pipeline);
        fault = fault_of(scene, pipeline, ++case_number % 2 == 0 ? Format::rgba32f : Format::rgba16f);
        if (fault.empty()) fault = fault_of(scene, over(*preset_pipeline("gltf")), Format::rgba32f);
        set_time(scene, 0.7);
        if (fault.empty()) fault = fault_of(scene, pipeline, Format::rgba32f);
        ++drawn;
      } catch (const Error& error) {
        if (!names_the_file(error)) fault = error.what();
        ++refused;
      }
      if (!fault.empty()) FAIL_CHECK(row.text << " with " << number << ": " << fault);
    }
    INFO(row.text);
    CHECK(drawn > drawn_before);  // or the row has keys that no number makes right
    CHECK(refused > refused_before);
  }
  CHECK(drawn > 250);
  CHECK(refused > 400);
}

TEST_CASE("values of a pipeline that are each in range and contradict each other are the file's fault, by its name") {
  constexpr const char* kContradictions[] = {
      R"({"strategy": "forward-loop", "transparency": {"mode": "into-albedo"}})",
      R"({"strategy": "forward-multipass", "transparency": {"mode": "into-albedo"}})",
      R"({"preset": "lecture", "transparency": {"mode": "into-albedo"}})",
      R"({"light_model": {"order": "albedo_last", "specular_source": "model"}})",
      R"({"gbuffer": {"position_from_depth": true}, "geometry": {"depth_near": 0.5, "depth_far": 0.5}})",
      R"({"post": {"tone_map": "reinhard", "white": 1e-7}})",
  };
  const ScratchFolder scratch;
  for (const char* pipeline : kContradictions) {
    INFO(pipeline);
    const std::string path = scratch.write("s.json", R"({"version": 1, "pipeline": )" + std::string(pipeline) + "}");
    bool refused = false;
    try {
      load_scene(path);
    } catch (const Error& error) {
      refused = names_the_file(error) && error.kind() == ErrorKind::bad_input;
    }
    CHECK(refused);
  }
}

}  // namespace
}  // namespace trueshade
