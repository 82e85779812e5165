#include <optional>
#include <utility>

#include "cli/activity.h"
#include "cli/capture_options.h"
#include "cli/commands.h"
#include "cli/frame_text.h"
#include "cli/picture_encoding.h"
#include "cli/picture_output.h"
#include "cli/preparation.h"
#include "cli/progress_bar.h"
#include "cli/shaded_gbuffer.h"
#include "cli/written_files.h"
#include "core/error.h"
#include "core/image_files/image_io.h"
#include "core/printable_text.h"
#include "scenes/pipeline/transparency.h"
#include "scenes/scene.h"
#include "shading/given_surfaces.h"

namespace trueshade {
namespace {

/// The capture's planes as the light pass takes them. Positions come from where the pipeline has them from, if that
/// plane is there.
GivenSurfaces surfaces_of(const oracle::Capture& capture, const Pipeline& pipeline) {
  GivenSurfaces given;
  given.depth = capture.plane("depth");
  given.object = capture.plane("id.object");
  given.position = capture.plane("position");
  if (surface_planes(pipeline).position_from_depth && given.depth != nullptr) given.position = nullptr;
  given.normal = capture.plane("normal");
  given.albedo = capture.plane("albedo");
  given.specular = capture.plane("specular");
  given.emission = capture.plane("emission");
  given.metallic = capture.plane("metallic"), given.roughness = capture.plane("roughness");
  given.occlusion = capture.plane("occlusion"), given.material = capture.plane("id.material");
  given.uv = capture.plane("uv"), given.uv1 = capture.plane("uv1"), given.tangent = capture.plane("tangent");
  for (size_t i = 0; i < 4; ++i) given.user[i] = capture.plane("user" + std::to_string(i));
  given.clear_depth = pipeline.geometry.clear_depth;
  return given;
}

StoredPlanes planes_to_light(const ShadeOptions& options, const CaptureFiles& files, const Scene& scene,
                             const Pipeline& pipeline) {
  StoredPlanes planes = stored_planes(files, scene, pipeline);
  if (draws_transparent(scene, pipeline) && pipeline.transparency.mode == TransparencyMode::after_lights)
    planes.notes.push_back("transparent surfaces are in no G-buffer, so they are not drawn");
  if (!options.capture.image_file.empty()) planes.notes.push_back("--image is not read: the picture is what is made");
  return planes;
}

Metadata metadata_of(const RenderedFrame& result, const ShadeOptions& options, const oracle::Capture& planes) {
  Metadata metadata = metadata_of(result);
  for (auto& entry : gbuffer_metadata(options.capture, planes)) metadata.push_back(std::move(entry));
  return metadata;
}

}  // namespace

void shade(const ShadeOptions& options) {
  check_pipeline(options);
  for (const std::string& path : options.outputs) check_output(path);
  CaptureFiles files = capture_files_of(options.capture, options.limits);
  Scene scene = scene_of_options(options);
  Pipeline pipeline = pipeline_of(options, scene);
  pipeline.width = files.width(), pipeline.height = files.height();
  show(scene, options.camera, pipeline, options.seconds());
  check_memory(scene, pipeline, execution_of(options), {}, file_memory(pipeline, {}, options.outputs, {}));
  const StoredPlanes planes = planes_to_light(options, files, scene, pipeline);
  files = {};
  RenderedFrame result{scene, pipeline, execution_of(options), options.seconds(), {}, {}, {}, {}};
  {
    ProgressBar bar("lighting", "tiles");
    result.frame = light_surfaces(scene, pipeline, result.execution, surfaces_of(planes.capture, pipeline),
                                  [&bar](int done, int total) { bar.show(done, total); });
  }
  result.image_hash = image_hash(result.frame.color);
  if (!options.outputs.empty()) result.scene_hash = scene_hash(scene);
  for (const std::string& path : options.outputs) {
    const Activity activity("writing " + printable(path, Lines::one));
    write_picture(path, result.frame.color, {}, metadata_of(result, options, planes.capture),
                  file_options(options, pipeline, scene));
    say_written(path,
                std::to_string(pipeline.width) + 'x' + std::to_string(pipeline.height) + ' ' +
                    std::string(info(pipeline.target).name) + ", " + kind_of_file(path),
                options.hash ? StandardOutput::answer : StandardOutput::files);
  }
  if (options.hash) print(hash_line(result));
  say_notes(planes.notes);
}

}  // namespace trueshade
