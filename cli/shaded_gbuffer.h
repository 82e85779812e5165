#pragma once
#include <string>

#include "cli/capture/capture_files.h"
#include "cli/options.h"
#include "core/image_files/channel_file.h"
#include "core/image_files/image_io.h"
#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// A capture's planes as the pipeline stores them, without its picture, and what they cannot tell.
struct StoredPlanes {
  oracle::Capture capture;
  std::vector<std::string> notes;
};
StoredPlanes stored_planes(const CaptureFiles& files, const Scene& scene, const Pipeline& pipeline);

/// What a picture of `trueshade shade` carries of its G-buffer: the names of the files, the map, and a hash of the
/// planes. Keys `trueshade:gbuffer`, one file a line, `trueshade:gbufferMap` and `trueshade:gbufferHash`.
Metadata gbuffer_metadata(const CaptureOptions& files, const oracle::Capture& planes);

/// Whether a picture's metadata name a G-buffer.
bool is_shaded(const Metadata& metadata);

/// The planes that a picture was shaded from, from files where the command runs or beside the picture. Throws
/// Error(bad_input) where they are not to be had, or are others today.
StoredPlanes found_gbuffer(const Metadata& metadata, const std::string& picture, const Limits& limits,
                           const Scene& scene, const Pipeline& pipeline);

}  // namespace trueshade
