#pragma once
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include "scene_cache/cached_scene.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/scratch_folder.h"

namespace trueshade {

/// The hash of a small frame of a scene by way of the cache file in a folder; `loads` counts how often it was read.
inline std::string cached_hash(const std::string& folder, const std::string& spec, int& loads, double time = 0.0,
                               const Execution& execution = {}, const SceneLimits& limits = {}) {
  CachedScene cached = cached_scene(folder, spec, limits, {}, [&] { return ++loads, load_scene(spec, limits); });
  if (!cached.clusters) cached.clusters = std::make_unique<ClusteredScene>(cluster_scene(cached.scene));
  PreparedScene prepared(cached.scene, std::move(cached.clusters));
  set_time(cached.scene, time);
  prepared.update();
  Pipeline pipeline = default_pipeline(cached.scene);
  pipeline.width = 96, pipeline.height = 64;
  return image_hash(render_frame(prepared, pipeline, execution).color) + ' ' + scene_hash(cached.scene);
}

/// The same without a cache file.
inline std::string plain_hash(const std::string& spec, double time = 0.0) {
  Scene scene = load_scene(spec);
  set_time(scene, time);
  Pipeline pipeline = default_pipeline(scene);
  pipeline.width = 96, pipeline.height = 64;
  return image_hash(render_frame(scene, pipeline).color) + ' ' + scene_hash(scene);
}

/// Longer than the time before a read in which a change of a file keeps its scene from being cached.
inline void let_files_settle() { std::this_thread::sleep_for(std::chrono::milliseconds(100)); }

inline std::string only_file(const ScratchFolder& folder) { return folder.path(folder.entries().at(0)); }

}  // namespace trueshade
