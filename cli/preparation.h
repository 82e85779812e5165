#pragma once
#include <span>
#include <string>

#include "cli/options.h"
#include "scene_cache/cached_scene.h"
#include "scenes/scene.h"

namespace trueshade {

/// Checks what can be known of the pipeline before a scene is loaded, which may take long: all of it for a built-in
/// scene, which has no pipeline of its own, and the syntax of the pipeline file for any other. Throws as pipeline_of().
void check_pipeline(const PipelineOptions& options);

/// load_scene() with the pictures that files name, within the options' limits, and by way of the cache file in
/// limits.cache.
Scene scene_of_options(const std::string& spec, const Limits& limits, const SceneParts& parts = {});
Scene scene_of_options(const SceneOptions& options);

/// The same for what draws frames alone, with the clusters of the cache file. Says why there is none.
CachedScene cached_scene_of_options(const std::string& spec, const Limits& limits, const SceneParts& parts);

double aspect_of(const Pipeline& pipeline);  ///< width / height

/// The camera of the options, of a scene as it was loaded.
ChangedCamera camera_of(const Scene& scene, const CameraChanges& changes, const Pipeline& pipeline);

/// Makes a scene, as it was loaded, the one that a picture shows: lights of ours fit the pipeline, all stands where it
/// is at the time, seconds, and the camera is that of the options.
void show(Scene& scene, const CameraChanges& changes, const Pipeline& pipeline, double time);

/// Error(limit) where the frame, with what is in memory, is predicted to be over the memory cap. `more`: bytes that are
/// taken besides the frame's.
void check_memory(const Scene& scene, const Pipeline& pipeline, const Execution& execution,
                  std::span<const std::string> aovs, uint64_t more = 0);

/// Bytes of a picture, or of a region of it, as it is stored, with its planes.
uint64_t picture_memory(const Pipeline& pipeline, const PictureRegion& region, std::span<const std::string> planes);

/// Bytes that the largest of a frame's files takes while it is made: files are made in memory, one after the other. An
/// estimate, because how much compression helps depends on the picture; write_image() holds it to the cap. `planes`: of
/// an EXR.
uint64_t file_memory(const Pipeline& pipeline, const PictureRegion& region, std::span<const std::string> paths,
                     std::span<const std::string> planes);

/// What --light-shader names: a model that ships, or a file of GLSL or SPIR-V. Without parameters.
LightProgram light_program_of(const std::string& name);

/// `gain=2` or `tint=1,0.5,0.2`. Error(usage) of other texts.
ProgramParameter parameter_of(const std::string& text);

/// The pipeline of all layers but options of light programs, whose text it may lack; not validated. For who says what a
/// frame takes and draws none.
Pipeline layered_pipeline(const PipelineOptions& options, const Scene& scene);

/// The pipeline of all layers, each over the one before: preset, scene file, pipeline file, options. Valid.
Pipeline pipeline_of(const PipelineOptions& options, const Scene& scene);

}  // namespace trueshade
