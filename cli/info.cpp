#include <algorithm>
#include <string>
#include <utility>

#include "cli/commands.h"
#include "cli/json_text.h"
#include "cli/preparation.h"
#include "core/file_ending.h"
#include "core/image_files/image_io.h"
#include "core/printable_text.h"
#include "scenes/scene.h"

namespace trueshade {
namespace {

std::string info_row(const std::string& name, const std::string& value) {
  const std::string shown = printable(name, Lines::one);  // names and values of metadata are whatever a file holds
  return shown + std::string(shown.size() < 22 ? 22 - shown.size() : 1, ' ') + printable(value, Lines::one) + '\n';
}

std::string about_image(const std::string& path, uint64_t most_expansion) {
  const ImageFileInfo image = read_image_info(path);
  std::string text =
      info_row("image", path) + info_row("size", std::to_string(image.width) + 'x' + std::to_string(image.height));
  for (const std::string& channel : image.channels) text += info_row("channel", channel);
  for (const auto& [key, value] : image.metadata) text += info_row(key, value);
  if (!has_ending(path, ".png")) return text;
  read_planes(path, most_expansion);  // throws for a wrong checksum, damaged or missing texels
  return text + info_row("pixels", "read whole, all checksums right");
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
         info_row("meshes", std::to_string(scene.meshes.size()) + " (" + std::to_string(stored) + " triangles, " +
                                std::to_string(vertices) + " vertices stored)") +
         info_row("materials", std::to_string(scene.materials.size())) +
         info_row("instances", std::to_string(scene.instances.size())) +
         info_row("triangles drawn", std::to_string(scene.triangle_count())) +
         info_row("lights", std::to_string(scene.lights.size()) + (kinds.empty() ? "" : " (" + kinds + ')')) +
         (scene.timeline.empty() ? "" : info_row("moves", json_number(scene.timeline.fps) + " frames a second")) +
         (scene.pipeline_text.empty() ? "" : info_row("pipeline", scene.pipeline_text));
}

}  // namespace

void print_info(const InfoOptions& options) {
  const bool image = has_ending(options.file, ".png") || has_ending(options.file, ".exr");
  print(image ? about_image(options.file, options.limits.expansion) : about_scene(options.file, options.limits));
}

}  // namespace trueshade
