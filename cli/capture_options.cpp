#include "cli/capture_options.h"

namespace trueshade {

CaptureFiles capture_files_of(const CaptureOptions& options, const Limits& limits) {
  const CaptureMap map = options.map ? capture_map_from_option(*options.map) : CaptureMap{};
  return read_capture_files(options.gbuffer_files, options.image_file, map, limits.expansion);
}

}  // namespace trueshade
