#include "cli/frame_text.h"

#include <algorithm>

#include "cli/camera_json.h"
#include "cli/json_text.h"
#include "cli/version.h"
#include "core/threads/parallel_for.h"
#include "scenes/files/content/faults.h"

namespace trueshade {
namespace {

/// As --region takes it.
std::string region_text(const PictureRegion& region) {
  return std::to_string(region.x) + ',' + std::to_string(region.y) + ',' + std::to_string(region.width) + 'x' +
         std::to_string(region.height);
}

std::string size_text(const Image& image) { return std::to_string(image.width) + 'x' + std::to_string(image.height); }

double ratio(uint64_t part, uint64_t whole) { return whole == 0 ? 0.0 : double(part) / double(whole); }

/// Milliseconds to the microsecond: more digits would only say what the machine happened to do.
double rounded_ms(double ms) { return double(int64_t(ms * 1000.0 + 0.5)) / 1000.0; }

JsonObject scene_json(const RenderedFrame& result) {
  const Scene& scene = result.scene;
  JsonObject json;
  json.put("spec", scene.spec).put("hash", "sha256:" + result.scene_hash);
  if (!scene.timeline.empty()) json.put_raw("time", json_number(result.time));
  json.put("meshes", uint64_t(scene.meshes.size())).put("instances", uint64_t(scene.instances.size()));
  json.put("triangles", scene.triangle_count()).put("lights", uint64_t(scene.lights.size()));
  return json;
}

JsonObject execution_json(const Execution& execution, int tile) {
  JsonObject json;
  const std::string_view simd = execution.simd == "best" ? simd_targets().front() : execution.simd;
  json.put("threads", thread_count(execution.threads)).put("tile", tile).put("simd", simd);
  json.put("light_culling", execution.light_culling).put("geometry_culling", execution.geometry_culling);
  return json;
}

}  // namespace

std::string hash_line(const RenderedFrame& result) {
  const Image& color = result.frame.color;
  return "sha256:" + result.image_hash + "  " + size_text(color) + "  " + std::string(info(color.format).name) + '\n';
}

Metadata metadata_of(const RenderedFrame& result) {
  Metadata metadata = {{"trueshade:imageHash", "sha256:" + result.image_hash},
                       {"trueshade:pipeline", pipeline_json(result.pipeline)},
                       {"trueshade:scene", result.scene.spec},
                       {"trueshade:sceneHash", "sha256:" + result.scene_hash}};
  if (result.parts.animation) metadata.emplace_back(kAnimationKey, *result.parts.animation);
  if (const std::string text = camera_json(result.parts, result.camera); !text.empty())
    metadata.emplace_back(kCameraKey, text);
  if (!result.cube_map.empty()) metadata.emplace_back("trueshade:cubeMap", result.cube_map);
  if (std::string text = lenient_text(result.scene); !text.empty()) metadata.emplace_back(kLenientKey, std::move(text));
  if (!result.looks.empty()) metadata.emplace_back("trueshade:looks", result.looks.substr(1));
  if (!result.execution.region.whole()) metadata.emplace_back("trueshade:region", region_text(result.execution.region));
  const bool is_read = !result.scene.timeline.empty() || result.pipeline.light_program.used();  // the time
  if (is_read) metadata.emplace_back("trueshade:time", json_number(result.time));
  metadata.emplace_back("trueshade:version", kVersion);
  if (result.frame.view_scale > 0)
    metadata.emplace_back("trueshade:viewScale", std::to_string(result.frame.view_scale));
  return metadata;
}

std::vector<StatLine> stat_lines(const RenderedFrame& result) {
  const FrameStats& s = result.frame.stats;
  const auto count = [](const char* key, const char* label, uint64_t value) {
    return StatLine{key, label, json_number(value)};
  };
  const auto real = [](const char* key, const char* label, double value) {
    return StatLine{key, label, json_number(double(int64_t(value * 1e4 + 0.5)) / 1e4)};
  };
  const auto time = [](const char* key, const char* label, double ms) {
    return StatLine{key, label, json_number(rounded_ms(ms))};
  };
  const double culled = s.pixel_lights == 0 ? 0.0 : 1.0 - ratio(s.tile_pixel_lights, s.pixel_lights);
  std::vector<StatLine> lines = {
      count("pixels", "pixels", s.pixels),
      count("covered_pixels", "covered pixels", s.covered_pixels),
      real("covered_share", "covered share", ratio(s.covered_pixels, s.pixels)),
      count("transparent_fragments", "transparent fragments blended", s.transparent_fragments),
      count("triangles", "triangles", s.triangles),
      count("lights", "lights", s.lights),
      count("pixel_lights", "pixel-light pairs", s.pixel_lights),
      count("lit_pixel_lights", "pairs lit", s.lit_pixel_lights),
      real("lit_lights_per_pixel", "lights that light a covered pixel", ratio(s.lit_pixel_lights, s.covered_pixels)),
      count("clusters_drawn", "clusters set up", s.clusters_drawn),
      count("triangles_tested", "triangles set up", s.triangles_tested),
      count("fragments", "fragments before the depth test", s.fragments),
      count("tile_pixel_lights", "pairs left by tile culling", s.tile_pixel_lights),
      real("culled_share", "share of pairs culled by tiles", std::max(culled, 0.0)),
      count("evaluated_pixel_lights", "pairs evaluated", s.evaluated_pixel_lights),
      count("gl_draws", "as OpenGL would draw it: draws", s.gl.draws),
      count("gl_light_triangles", "  triangles of light geometry", s.gl.light_triangles),
      count("gl_light_pixels", "  covered pixels under light geometry", s.gl.light_pixels),
      count("gl_material_computations", "  material computations", s.gl.material_computations),
      count("gl_gbuffer_fragments_read", "  G-buffer fragments read", s.gl.gbuffer_fragments_read),
      count("gl_target_fragments_read", "  target fragments read", s.gl.target_fragments_read),
      count("gl_fragments_written", "  fragments written", s.gl.fragments_written),
      time("geometry_ms", "geometry, all threads [ms]", s.core_ms.geometry()),
      time("light_ms", "light, all threads [ms]", s.core_ms.light),
      time("first_tile_ms", "from the start of the program to the first tile [ms]", result.start_ms + s.first_tile_ms),
      time("total_ms", "this frame, planes included [ms]", s.total_ms)};
  if (result.frame.view_scale > 0)
    lines.push_back(count("view_scale", "count at the top of the heat map", result.frame.view_scale));
  if (!result.repeated_ms.empty())
    lines.push_back(time("frame_ms", "time per frame [ms]", result.repeated_ms[result.repeated_ms.size() / 2]));
  return lines;
}

std::string stats_text(const RenderedFrame& result) {
  const std::vector<StatLine> lines = stat_lines(result);
  size_t widest = 0, longest = 0;
  for (const StatLine& line : lines) {
    widest = std::max(widest, line.label.size());
    longest = std::max(longest, line.value.size());
  }
  std::string text;
  for (const StatLine& line : lines)
    text +=
        line.label + std::string(widest - line.label.size() + 2 + longest - line.value.size(), ' ') + line.value + '\n';
  return text;
}

std::string json_of(const RenderedFrame& result, std::span<const std::string> files) {
  JsonObject stats;
  for (const StatLine& line : stat_lines(result)) stats.put_raw(line.key, line.value);
  JsonArray aovs, paths;
  for (size_t i = 0; i < result.frame.aovs.size(); ++i) {
    const NamedImage& aov = result.frame.aovs[i];
    const std::string hash = i < result.aov_hashes.size() ? result.aov_hashes[i] : image_hash(aov.image);
    aovs.add_raw(JsonObject()
                     .put("name", aov.name)
                     .put("format", info(aov.image.format).name)
                     .put("hash", "sha256:" + hash)
                     .text());
  }
  for (const std::string& file : files) paths.add_raw(json_string(file));
  JsonObject json;
  json.put("version", kVersion);
  json.put_raw("scene", scene_json(result).text()).put_raw("pipeline", pipeline_json(result.pipeline));
  json.put_raw("execution", execution_json(result.execution, result.frame.stats.tile).text())
      .put_raw("stats", stats.text());
  json.put("hash", "sha256:" + result.image_hash);
  if (result.parts.animation) json.put("animation", *result.parts.animation);
  if (const std::string text = camera_json(result.parts, result.camera); !text.empty()) json.put_raw("camera", text);
  if (!result.cube_map.empty()) json.put("cube_map", result.cube_map);
  if (const std::string text = lenient_text(result.scene); !text.empty()) json.put("lenient", text);
  if (!result.looks.empty()) json.put("looks", result.looks.substr(1));
  if (!result.execution.region.whole()) json.put("region", region_text(result.execution.region));
  json.put_raw("aovs", aovs.text()).put_raw("files", paths.text());
  json.put_raw("ignored", ignored_json(result.notes)).put_raw("notes", lines_json(result.notes));
  return json.text() + '\n';
}

}  // namespace trueshade
