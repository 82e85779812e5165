#pragma once
#include <string>
#include <vector>

#include "oracle/capture.h"
#include "shading/frame.h"

namespace trueshade::testing {

/// Whether a capture of our own frame can be judged: lights that are blended draw by draw are not judged yet, and our frames
/// hand out no planes of shininess or emission.
inline bool judgeable(const Pipeline& pipeline) {
  return pipeline.strategy == Strategy::deferred_loop && !pipeline.light_model.emission && !reads_specular_plane(pipeline.light_model);
}

/// Our own frame as a capture: the target and all planes, or those named.
inline oracle::Capture captured(const PreparedScene& scene, const Pipeline& pipeline,
                                std::vector<std::string> planes = {"depth", "position", "normal", "albedo", "uv", "id.object",
                                                                   "id.material", "light.count"}) {
  Frame frame = render_frame(scene, pipeline, {}, planes);
  return {"trueshade", std::move(frame.color), std::move(frame.aovs)};
}
inline oracle::Capture captured(const Scene& scene, const Pipeline& pipeline) { return captured(PreparedScene(scene), pipeline); }

}  // namespace trueshade::testing
