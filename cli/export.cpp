#include <optional>
#include <span>
#include <string>

#include "cli/activity.h"
#include "cli/commands.h"
#include "cli/notes.h"
#include "cli/picture_output.h"
#include "cli/preparation.h"
#include "cli/written_files.h"
#include "core/image_files/image_io.h"
#include "core/memory_cap.h"
#include "core/printable_text.h"
#include "scenes/files/gltf/writing/glb_scene.h"

namespace trueshade {
namespace {

std::vector<uint8_t> png_of_codes(const Image& image) {
  ImageFileOptions options;
  options.values = PictureValues::display_codes;
  return encode_png(image, {}, options);
}

/// The scene that is written: with all that moves at time 0, or standing still at the time that was asked for. A camera
/// of the options stands still.
Scene scene_to_write(const ExportOptions& options) {
  Scene scene = scene_of_options(options);
  const ChangedCamera camera(scene, options.camera, 1.0);
  if (options.time) set_time(scene, *options.time);
  if (options.camera.any()) {
    camera.see(scene);
    scene.camera_of_ours = false;
    scene.timeline.camera.clear(), scene.timeline.node_camera.reset();
  }
  if (!options.time) return scene;
  const double fps = scene.timeline.fps;
  scene.timeline = Timeline();
  scene.timeline.fps = fps;
  return scene;
}

/// What the file and its parts take while they are put together, about: each of them twice.
uint64_t bytes_to_write(const Scene& scene) {
  uint64_t bytes = 512 * (uint64_t(scene.instances.size()) + scene.lights.size());
  for (const Mesh& mesh : scene.meshes) bytes += 48 * uint64_t(mesh.vertex_count()) + 4 * uint64_t(mesh.indices.size());
  for (const Texture& texture : scene.textures)
    for (const TextureLevel& level : texture.levels) bytes += level.bytes.size();
  return 2 * bytes;
}

std::string number_of(size_t count, const char* one, const char* many) {
  return std::to_string(count) + ' ' + (count == 1 ? one : many);
}

}  // namespace

void export_scene(const ExportOptions& options) {
  const bool to_output = options.output == "-";
  if (to_output)
    check_output(options.output);
  else
    check_writable(options.output);
  std::optional<Activity> activity("reading the scene");
  const Scene scene = scene_to_write(options);
  require_memory(bytes_to_write(scene), scene.spec, "the file");
  activity->now("making the GLB");
  const GlbFile file = glb_of_scene(scene, png_of_codes);
  say_notes(file.notes);
  if (to_output) {
    activity.reset();
    return print_bytes(file.bytes);
  }
  activity->now("writing " + printable(options.output, Lines::one));
  write_file(options.output, file.bytes);
  activity.reset();
  if (options.quiet) return;
  say_written(options.output,
              number_of(scene.instances.size(), "object", "objects") + ", " +
                  number_of(scene.lights.size(), "light", "lights") + ", GLB",
              StandardOutput::files);
}

}  // namespace trueshade
