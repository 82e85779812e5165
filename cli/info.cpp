#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/json_text.h"
#include "cli/notes.h"
#include "cli/preparation.h"
#include "cli/resolved_scene.h"
#include "cli/terminal.h"
#include "core/error.h"
#include "core/file_ending.h"
#include "core/image_files/image_io.h"
#include "core/image_files/picture_file.h"
#include "core/memory_cap.h"
#include "core/pixel_cap.h"
#include "core/printable_text.h"
#include "scenes/scene.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

std::string info_row(const std::string& name, const std::string& value) {
  const std::string shown = printable(name, Lines::one);  // names and values of metadata are whatever a file holds
  return shown + std::string(shown.size() < 22 ? 22 - shown.size() : 1, ' ') + printable(value, Lines::one) + '\n';
}

std::string about_image(const std::string& path, uint64_t most_expansion) {
  const ImageFileInfo image = read_image_info(path);
  require_pixels(image.width, image.height, path);
  std::string text =
      info_row("image", path) + info_row("size", std::to_string(image.width) + 'x' + std::to_string(image.height));
  for (const std::string& channel : image.channels) text += info_row("channel", channel);
  for (const auto& [key, value] : image.metadata) text += info_row(key, value);
  if (!has_ending(path, ".png")) return text;
  check_png(path, most_expansion);
  return text + info_row("pixels", "read whole, all checksums right");
}

std::string angle_text(double radians) { return json_number(std::round(radians * (180.0 / kPi) * 100.0) / 100.0); }

/// The cameras that --camera takes, and the animations that --animation takes, a line each.
std::string about_parts(const Scene& scene) {
  std::string text;
  const auto add = [&text](const char* kind, size_t number, const std::string& name, const std::string& about) {
    text +=
        info_row(kind + std::string(" ") + std::to_string(number), name.empty() ? about : name + " (" + about + ')');
  };
  for (size_t i = 0; i < scene.cameras.size(); ++i) {
    const SceneCamera& camera = scene.cameras[i];
    add("camera", i, camera.name.empty() ? camera.node : camera.name,
        camera.fov_y_rad > 0.0 ? "perspective, " + angle_text(camera.fov_y_rad) + " degrees" : "orthographic");
  }
  const Camera& own = scene.camera;
  if (scene.cameras.empty())
    add("camera", 0, "",
        scene.camera_of_ours  ? "made to see all, because the file has none"
        : own.clip_from_world ? "a matrix"
                              : "perspective, " + angle_text(double(own.fov_x_rad.value_or(own.fov_y_rad))) +
                                    (own.fov_x_rad ? " degrees across" : " degrees"));
  for (size_t i = 0; i < scene.animations.size(); ++i)
    add("animation", i, scene.animations[i].name, json_number(scene.animations[i].seconds) + " seconds");
  return text;
}

std::string about_scene(const std::string& spec, const Limits& limits) {
  const Scene scene = scene_of_options(spec, limits);
  constexpr std::pair<LightType, const char*> kTypes[] = {{LightType::ambient, "ambient"},
                                                          {LightType::directional, "directional"},
                                                          {LightType::point, "point"},
                                                          {LightType::spot, "spot"}};
  std::string kinds;
  for (const auto& [type, name] : kTypes) {
    const auto lights = std::count_if(scene.lights.begin(), scene.lights.end(),
                                      [type = type](const Light& light) { return light.type == type; });
    if (lights != 0) kinds += (kinds.empty() ? "" : ", ") + std::to_string(lights) + ' ' + name;
  }
  size_t vertices = 0, stored = 0;
  for (const Mesh& mesh : scene.meshes) {
    vertices += mesh.vertex_count();
    stored += mesh.triangle_count();
  }
  return info_row("scene", scene.spec) + info_row("hash", "sha256:" + scene_hash(scene)) +
         (scene.passed_over.empty() ? "" : info_row("drawn leniently", lenient_text(scene))) +
         info_row("meshes", std::to_string(scene.meshes.size()) + " (" + std::to_string(stored) + " triangles, " +
                                std::to_string(vertices) + " vertices stored)") +
         info_row("materials", std::to_string(scene.materials.size())) +
         info_row("instances", std::to_string(scene.instances.size())) +
         info_row("triangles drawn", std::to_string(scene.triangle_count())) +
         info_row("lights", std::to_string(scene.lights.size()) + (kinds.empty() ? "" : " (" + kinds + ')')) +
         about_parts(scene) +
         (scene.timeline.empty() ? "" : info_row("moves", json_number(scene.timeline.fps) + " frames a second")) +
         (scene.pipeline_text.empty() ? "" : info_row("pipeline", scene.pipeline_text));
}

// --- Every number, as the renderer has it ---------------------------------------------------------------------------

constexpr uint64_t kMostNumbersPrinted = uint64_t(1) << 20;  // about 10 MB of text

void print_resolved(const Scene& scene, const Pipeline& pipeline, double time) {
  const ResolvedNumbers of = resolved_numbers(scene, pipeline);
  const uint64_t numbers = of.of_scene + of.of_lights;
  if (numbers > kMostNumbersPrinted)
    throw Error(ErrorKind::limit, scene.spec,
                "has " + std::to_string(numbers) + " numbers of vertices, triangles, texels and light geometry",
                "add -o FOLDER, which takes any scene");
  require_memory(16 * numbers + 2 * resolved_text_bytes(scene), scene.spec, "its numbers as text");
  ResolvedArrays arrays(ResolvedArrays::Place::document);
  std::string text;
  for (const std::string& piece : resolved_text(scene, pipeline, time, "", arrays)) text += piece;
  print(text);
}

std::span<const uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

void write_resolved(const Scene& scene, const Pipeline& pipeline, double time, const std::string& folder) {
  const std::string json_file = folder + "/resolved.json", array_file = folder + "/resolved.bin";
  require_memory(sizeof(float) * resolved_numbers(scene, pipeline).of_lights + resolved_text_bytes(scene), scene.spec,
                 "its numbers as text and the geometry of lights");
  std::error_code error;
  const bool made = std::filesystem::create_directories(folder, error);
  if (error) throw Error(ErrorKind::io, folder, "cannot make the folder: " + error.message(), "choose another");
  try {
    for (const std::string& file : {json_file, array_file}) check_writable(file);
    ResolvedArrays arrays(ResolvedArrays::Place::file);
    const std::vector<std::string> text = resolved_text(scene, pipeline, time, "resolved.bin", arrays);
    FilePieces pieces;
    for (const std::string& piece : text) pieces.push_back(bytes_of(piece));
    std::filesystem::remove(json_file, error);  // the numbers of another run, whose arrays are about to go
    write_file(array_file, arrays.pieces());
    write_file(json_file, pieces);
  } catch (...) {
    if (!std::filesystem::exists(json_file, error)) std::filesystem::remove(array_file, error);
    if (made) std::filesystem::remove(folder, error);
    throw;
  }
  if (!is_quiet()) print(json_file + '\n' + array_file + '\n');
}

void resolve(const InfoOptions& options) {
  check_pipeline(options);
  Scene scene = scene_of_options(options);
  const Pipeline pipeline = pipeline_of(options, scene);
  show(scene, options.camera, pipeline, options.time);
  if (options.folder.empty())
    print_resolved(scene, pipeline, options.time);
  else
    write_resolved(scene, pipeline, options.time, options.folder);
}

}  // namespace

void print_info(const InfoOptions& options) {
  if (options.resolved) return resolve(options);
  const bool image = has_ending(options.file, ".png") || has_ending(options.file, ".exr");
  print(image ? about_image(options.file, options.limits.expansion) : about_scene(options.file, options.limits));
}

}  // namespace trueshade
