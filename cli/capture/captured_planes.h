#pragma once
#include <string>
#include <vector>

#include "cli/capture/capture_files.h"
#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// A capture, with a line of text about each thing that its planes cannot tell.
struct CapturedPlanes {
  oracle::Capture capture;
  std::vector<std::string> notes;
};

/// Makes a capture of the planes in the files. Packed planes are unpacked, with their error bounds in Capture::decoded.
/// An unpacked plane is 0 where depth or id.object say that there is no surface, since nothing was packed there; so is
/// a plane that holds there one value only, the one it was cleared to. Planes that need no unpacking keep the files'
/// formats (stored_planes.h).
///   pipeline: of the capture's size; its geometry is the camera's clip space and the depth buffer's
/// Error(bad_input), naming the pixel, for values that no packing makes, values that are no depths, and NaN where a
/// surface is unpacked; also for a camera without a view space where one is needed.
CapturedPlanes captured_planes(const CaptureFiles& files, const Scene& scene, const Pipeline& pipeline);

}  // namespace trueshade
