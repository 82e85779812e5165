#pragma once
#include <string>
#include <vector>

#include "cli/capture/capture_files.h"
#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// A capture, and what its planes cannot tell, a line each.
struct CapturedPlanes {
  oracle::Capture capture;
  std::vector<std::string> notes;
};

/// Puts the planes of files together. Packed ones are unpacked, with their bounds in Capture::decoded. Where there is
/// no surface, as depth or id.object say, an unpacked plane is 0, since nothing was packed there, and so is a plane
/// that holds a single value there, which it was cleared to. Planes that are as they were stored are still in the
/// files' formats (stored_planes.h).
///   pipeline: of the capture's size; its geometry is the camera's clip space and the depth buffer's
/// Error(bad_input) naming the pixel for values that no packing has, depths that are none, and NaN where a surface is
/// unpacked; also for a camera without a view space where one is needed.
CapturedPlanes captured_planes(const CaptureFiles& files, const Scene& scene, const Pipeline& pipeline);

}  // namespace trueshade
