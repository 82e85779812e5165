#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/json_text.h"
#include "cli/looks.h"
#include "cli/option_values.h"
#include "cli/preparation.h"
#include "cli/resolved_scene.h"
#include "cli/scene_facts.h"
#include "cli/terminal.h"
#include "core/error.h"
#include "core/file_ending.h"
#include "core/image_files/image_io.h"
#include "core/image_files/picture_file.h"
#include "core/memory_cap.h"
#include "core/pixel_cap.h"
#include "scenes/scene.h"

namespace trueshade {
namespace {

// --- An image --------------------------------------------------------------------------------------------------------

std::string about_image(const ImageFileInfo& image, const std::string& path) {
  std::string text =
      info_row("image", path) + info_row("size", std::to_string(image.width) + 'x' + std::to_string(image.height));
  for (const std::string& channel : image.channels) text += info_row("channel", channel);
  for (const auto& [key, value] : image.metadata) text += info_row(key, value);
  return text + (has_ending(path, ".png") ? info_row("pixels", "read whole, all checksums right") : "");
}

std::string image_json(const ImageFileInfo& image, const std::string& path) {
  JsonArray channels;
  for (const std::string& channel : image.channels) {
    const size_t space = channel.rfind(' ');
    channels.add_raw(JsonObject().put("name", channel.substr(0, space)).put("type", channel.substr(space + 1)).text());
  }
  JsonObject metadata;
  for (const auto& [key, value] : image.metadata) metadata.put(key, value);
  return JsonObject()
             .put("image", path)
             .put("width", image.width)
             .put("height", image.height)
             .put_raw("channels", channels.text())
             .put_raw("metadata", metadata.text())
             .put("read_whole", has_ending(path, ".png"))
             .text() +
         '\n';
}

/// The pixels of a PNG are read, too, so that a damaged one is not called whole.
void print_image(const InfoOptions& options) {
  const ImageFileInfo image = read_image_info(options.file);
  require_pixels(image.width, image.height, options.file);
  if (has_ending(options.file, ".png")) check_png(options.file, options.limits.expansion);
  print(options.json ? image_json(image, options.file) : about_image(image, options.file));
}

// --- A scene ---------------------------------------------------------------------------------------------------------

void print_scene(const InfoOptions& options) {
  check_pipeline(options);
  Scene scene = scene_of_options(options);
  Pipeline pipeline = layered_pipeline(options, scene);
  set_samples(with_smooth_edges(options, scene).looks, pipeline);
  validate(pipeline);
  const SceneFacts facts = facts_of(scene, pipeline, options.seconds());
  print(options.json ? facts_json(facts, scene) : facts_text(facts, scene));
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
  show(scene, options.camera, pipeline, options.seconds());
  if (options.folder.empty())
    print_resolved(scene, pipeline, options.seconds());
  else
    write_resolved(scene, pipeline, options.seconds(), options.folder);
}

}  // namespace

void print_info(const InfoOptions& options) {
  if (options.resolved) return resolve(options);
  if (is_picture_name(options.file)) return print_image(options);
  print_scene(options);
}

}  // namespace trueshade
