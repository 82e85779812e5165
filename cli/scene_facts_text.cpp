// SceneFacts as rows for people and as JSON for programs. Both have the same facts.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cli/json_text.h"
#include "cli/notes.h"
#include "cli/scene_facts.h"
#include "core/printable_text.h"
#include "scenes/files/content/faults.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

constexpr size_t kMostRows = 6;  ///< of a list

struct TexelFacts {
  int bits;
  bool is_float, is_srgb;
};

TexelFacts texel_facts(TextureFormat format) {
  const bool is_float = format == TextureFormat::rgba16f || format == TextureFormat::rgba32f;
  return {2 * bytes_per_texel(format), is_float, format == TextureFormat::srgb8_a8};
}

std::string counted(uint64_t count, const std::string& one) {
  return std::to_string(count) + ' ' + one + (count == 1 ? "" : "s");
}

/// In five digits.
std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.5g", value);
  return text;
}

std::string short_vector(const glm::dvec3& v, const char* between) {
  return short_number(v.x) + between + short_number(v.y) + between + short_number(v.z);
}

/// In two digits or three.
std::string bytes_text(uint64_t bytes) {
  char text[32];
  const bool giga = bytes >= 1'000'000'000;
  const double value = double(bytes) * (giga ? 1e-9 : 1e-6);
  std::snprintf(text, sizeof text, value < 10.0 ? "%.1f %s" : "%.0f %s", value, giga ? "GB" : "MB");
  return text;
}

double degrees(double radians) { return radians * (180.0 / kPi); }

std::string degrees_text(double radians) { return json_number(std::round(degrees(radians) * 100.0) / 100.0); }

/// Rows of a list, the first of them, and how many more there are.
template <typename Row>
std::string rows_of(const std::string& name, size_t count, const Row& row) {
  std::string text;
  for (size_t i = 0; i < std::min(count, kMostRows); ++i) text += info_row(name + ' ' + std::to_string(i), row(i));
  if (count > kMostRows) text += info_row("", "and " + std::to_string(count - kMostRows) + " more");
  return text;
}

std::string named(const std::string& name, const std::string& about) {
  return name.empty() ? about : name + " (" + about + ')';
}

// --- Cameras ---------------------------------------------------------------------------------------------------------

/// The scene's own camera, where it has no list of them.
std::string own_camera_text(const Scene& scene) {
  const Camera& own = scene.camera;
  if (scene.camera_of_ours)
    return scene.seen_from_inside ? "made to stand inside a room, because the file has none"
                                      : "made to see all, because the file has none";
  if (own.clip_from_world) return "a matrix";
  return "perspective, " + degrees_text(double(own.fov_x_rad.value_or(own.fov_y_rad))) +
         (own.fov_x_rad ? " degrees across" : " degrees");
}

std::string camera_rows(const Scene& scene) {
  if (scene.cameras.empty()) return info_row("camera 0", own_camera_text(scene));
  return rows_of("camera", scene.cameras.size(), [&scene](size_t i) {
    const SceneCamera& camera = scene.cameras[i];
    return named(
        camera.name.empty() ? camera.node : camera.name,
        camera.fov_y_rad > 0.0 ? "perspective, " + degrees_text(camera.fov_y_rad) + " degrees" : "orthographic");
  });
}

std::string cameras_json(const Scene& scene) {
  JsonArray all;
  for (const SceneCamera& camera : scene.cameras) {
    JsonObject one;
    one.put("name", camera.name).put("node", camera.node);
    one.put("type", camera.fov_y_rad > 0.0 ? "perspective" : "orthographic");
    if (camera.fov_y_rad > 0.0) one.put("fov_y_deg", degrees(camera.fov_y_rad));
    all.add_raw(one.text());
  }
  if (!scene.cameras.empty()) return all.text();
  const Camera& own = scene.camera;
  JsonObject one;
  one.put("type", own.clip_from_world ? "matrix" : "perspective");
  if (!own.clip_from_world)
    one.put(own.fov_x_rad ? "fov_x_deg" : "fov_y_deg", degrees(double(own.fov_x_rad.value_or(own.fov_y_rad))));
  return all.add_raw(one.put("of_ours", scene.camera_of_ours).text()).text();
}

// --- Textures and extensions -----------------------------------------------------------------------------------------

/// `color of 2 materials, normal of 1 material`
std::string uses_text(const MapUses& uses) {
  std::string text;
  for (size_t m = 0; m < uses.size(); ++m)
    if (uses[m] != 0)
      text += (text.empty() ? "" : ", ") + std::string(map_name(m)) + " of " + counted(uses[m], "material");
  return text.empty() ? "of no material" : text;
}

std::string texture_rows(const SceneFacts& facts, const Scene& scene) {
  return rows_of("texture", scene.textures.size(), [&](size_t i) {
    const Texture& texture = scene.textures[i];
    const TexelFacts texel = texel_facts(texture.format);
    const TextureLevel& level = texture.levels.front();
    return named(texture.name, std::to_string(level.width) + 'x' + std::to_string(level.height) + ", 4 x " +
                                   std::to_string(texel.bits) + (texel.is_float ? "-bit float, " : " bits, ") +
                                   (texel.is_srgb ? "sRGB, " : "linear, ") + counted(texture.levels.size(), "level")) +
           ": " + uses_text(facts.textures[i]);
  });
}

uint64_t bytes_of(const Texture& texture) {
  uint64_t bytes = 0;
  for (const TextureLevel& level : texture.levels) bytes += level.bytes.size();
  return bytes;
}

std::string textures_json(const SceneFacts& facts, const Scene& scene) {
  JsonArray all;
  for (size_t i = 0; i < scene.textures.size(); ++i) {
    const Texture& texture = scene.textures[i];
    const TexelFacts texel = texel_facts(texture.format);
    JsonObject maps;
    for (size_t m = 0; m < kMaterialMaps; ++m)
      if (facts.textures[i][m] != 0) maps.put(map_name(m), facts.textures[i][m]);
    const TextureLevel& level = texture.levels.front();
    all.add_raw(JsonObject()
                    .put("name", texture.name)
                    .put("width", level.width)
                    .put("height", level.height)
                    .put("channels", 4)
                    .put("bits", texel.bits)
                    .put("type", texel.is_float ? "float" : "unorm")
                    .put("color_space", texel.is_srgb ? "srgb" : "linear")
                    .put("levels", uint64_t(texture.levels.size()))
                    .put("bytes", bytes_of(texture))
                    .put_raw("materials_by_map", maps.text())
                    .text());
  }
  return all.text();
}

std::string extensions_row(const Scene& scene) {
  if (scene.extensions.empty()) return {};
  std::string text;
  for (size_t i = 0; i < std::min(scene.extensions.size(), kMostRows); ++i) {
    const SceneExtension& one = scene.extensions[i];
    text += (i > 0 ? ", " : "") + one.name + (one.required ? " (required)" : one.is_read ? "" : " (passed over)");
  }
  if (scene.extensions.size() > kMostRows)
    text += ", and " + std::to_string(scene.extensions.size() - kMostRows) + " more";
  return info_row("extensions", text);
}

std::string extensions_json(const Scene& scene) {
  JsonArray all;
  for (const SceneExtension& one : scene.extensions)
    all.add_raw(JsonObject().put("name", one.name).put("required", one.required).put("read", one.is_read).text());
  return all.text();
}

// --- The rest --------------------------------------------------------------------------------------------------------

std::string bounds_text(const std::optional<WorldBox>& box) {
  if (!box) return "nothing is drawn";
  return short_vector(box->least, ",") + " to " + short_vector(box->most, ",") + " (" +
         short_vector(box->most - box->least, " x ") + ')';
}

std::string vector_json(const glm::dvec3& v) {
  JsonArray numbers;
  for (int k = 0; k < 3; ++k) numbers.add_raw(json_number(v[k]));
  return numbers.text();
}

std::string memory_text(const SceneFacts& facts) {
  const RenderMemory& memory = facts.memory;
  const std::string size = std::to_string(facts.width) + 'x' + std::to_string(facts.height),
                    limit = bytes_text(memory.limit) + " that --max-memory allows";
  return memory.needed ? bytes_text(memory.process + *memory.needed) + " to render " + size + ", of " + limit
                       : size + " is rendered in bands, within the " + limit;
}

std::string memory_json(const SceneFacts& facts) {
  const RenderMemory& memory = facts.memory;
  JsonObject json;
  json.put("width", facts.width).put("height", facts.height).put("process_bytes", memory.process);
  if (memory.needed) json.put("needed_bytes", *memory.needed).put("render_bytes", memory.process + *memory.needed);
  return json.put("in_bands", !memory.needed).put("limit_bytes", memory.limit).text();
}

std::string lights_text(const SceneFacts& facts, const Scene& scene) {
  std::string kinds;
  for (const auto& [name, count] : facts.lights)
    kinds += (kinds.empty() ? "" : ", ") + std::to_string(count) + ' ' + std::string(name);
  return std::to_string(scene.lights.size()) + (kinds.empty() ? "" : " (" + kinds + ')') +
         (scene.lights_of_ours ? ", of ours" : "");
}

std::string lights_json(const SceneFacts& facts, const Scene& scene) {
  JsonObject json;
  json.put("count", uint64_t(scene.lights.size()));
  for (const auto& [name, count] : facts.lights) json.put(name, count);
  return json.put("of_ours", scene.lights_of_ours).text();
}

}  // namespace

std::string info_row(const std::string& name, const std::string& value) {
  constexpr size_t kColumn = 22;
  const std::string shown = printable(name, Lines::one);  // names and values of files are whatever a file holds
  return shown + std::string(shown.size() < kColumn ? kColumn - shown.size() : 1, ' ') + printable(value, Lines::one) +
         '\n';
}

std::string facts_text(const SceneFacts& facts, const Scene& scene) {
  uint64_t texture_bytes = 0;
  for (const Texture& texture : scene.textures) texture_bytes += bytes_of(texture);
  std::string text = info_row("scene", scene.spec) + info_row("hash", "sha256:" + facts.hash) +
                     (scene.passed_over.empty() ? "" : info_row("drawn leniently", lenient_text(scene))) +
                     info_row("bounds", bounds_text(facts.box)) +
                     info_row("meshes", std::to_string(scene.meshes.size()) + " (" + std::to_string(facts.triangles) +
                                            " triangles, " + std::to_string(facts.vertices) + " vertices stored)") +
                     info_row("materials", std::to_string(scene.materials.size())) +
                     info_row("instances", std::to_string(scene.instances.size())) +
                     info_row("triangles drawn", std::to_string(scene.triangle_count())) +
                     info_row("lights", lights_text(facts, scene)) + camera_rows(scene) +
                     rows_of("animation", scene.animations.size(), [&scene](size_t i) {
                       const SceneAnimation& animation = scene.animations[i];
                       return named(animation.name, json_number(animation.seconds) + " seconds");
                     });
  if (!scene.timeline.empty()) text += info_row("moves", json_number(scene.timeline.fps) + " frames a second");
  if (!scene.textures.empty())
    text += info_row("textures", std::to_string(scene.textures.size()) + " (" + bytes_text(texture_bytes) + ')');
  text += texture_rows(facts, scene) + extensions_row(scene) + info_row("memory", memory_text(facts));
  text += rows_of("note", scene.notes.size(), [&scene](size_t i) { return scene.notes[i]; });
  return scene.pipeline_text.empty() ? text : text + info_row("pipeline", scene.pipeline_text);
}

std::string facts_json(const SceneFacts& facts, const Scene& scene) {
  JsonArray animations, notes;
  for (const SceneAnimation& animation : scene.animations)
    animations.add_raw(JsonObject().put("name", animation.name).put("seconds", animation.seconds).text());
  for (const std::string& note : scene.notes) notes.add_raw(json_string(note));
  JsonObject json;
  json.put("scene", scene.spec).put("hash", "sha256:" + facts.hash).put("time", scene.time);
  if (!scene.passed_over.empty()) json.put("lenient", lenient_text(scene));
  json.put_raw("bounds", facts.box ? JsonObject()
                                         .put_raw("least", vector_json(facts.box->least))
                                         .put_raw("most", vector_json(facts.box->most))
                                         .text()
                                   : "null");
  json.put_raw("meshes", JsonObject()
                             .put("count", uint64_t(scene.meshes.size()))
                             .put("triangles", facts.triangles)
                             .put("vertices", facts.vertices)
                             .text());
  json.put("materials", uint64_t(scene.materials.size())).put("instances", uint64_t(scene.instances.size()));
  json.put("triangles_drawn", scene.triangle_count()).put("ground_of_ours", scene.ground_of_ours);
  json.put_raw("lights", lights_json(facts, scene)).put_raw("cameras", cameras_json(scene));
  json.put_raw("animations", animations.text());
  if (!scene.timeline.empty()) json.put("frames_per_second", scene.timeline.fps);
  json.put_raw("textures", textures_json(facts, scene)).put_raw("extensions", extensions_json(scene));
  json.put_raw("memory", memory_json(facts)).put_raw("notes", notes.text());
  if (!scene.pipeline_text.empty()) json.put_raw("pipeline", scene.pipeline_text);
  return json.text() + '\n';
}

}  // namespace trueshade
